//! Shapes: meshes, quadrics, groups and their instances.

use super::super::ExportError;
use super::super::beside::Beside;
use super::super::form::{Form, Kind, Placed, copies, is_instance, medium_of};
use super::super::mesh::INSET;
use super::xml::Element;
use crate::desc::{Alpha, Sides};
use glam::{Mat4, Vec3};
use std::collections::HashMap;

/// All shapes, groups before their instances.
pub(super) fn elements(placed: &[Placed], beside: &mut Beside) -> Result<Vec<Element>, ExportError> {
    let mut elements = Vec::new();
    let copies = copies(placed);
    let mut groups: HashMap<Kind, String> = HashMap::new();
    for one in placed {
        let Form::Mesh { to_world, .. } = one.form else {
            elements.extend(quadric(one, beside)?);
            continue;
        };
        if !is_instance(one, &copies) {
            elements.extend(mesh(one, beside)?);
            continue;
        }
        let known = groups.get(&one.kind()).cloned();
        let id = match known {
            Some(id) => id,
            None => {
                let id = format!("group-{}", groups.len());
                let file = beside.mesh_of(one, one.object.reversed, one.object.reversed, false)?;
                let shape = owned(ply(&file, one, beside), one);
                elements.push(Element::plugin("shape", "shapegroup").with("id", &id).child(shape));
                groups.insert(one.kind(), id.clone());
                id
            }
        };
        let group = Element::new("ref").with("id", id);
        elements.push(Element::plugin("shape", "instance").child(group).transform("to_world", to_world));
    }
    Ok(elements)
}

fn ply(file: &str, one: &Placed, beside: &Beside) -> Element {
    let shape = Element::plugin("shape", "ply").string("filename", file);
    if beside.is_flat(one) { shape.boolean("face_normals", true) } else { shape }
}

/// A mesh under its map. Vertices run the other way where the map mirrors, so that the front stays in front.
fn mesh(one: &Placed, beside: &mut Beside) -> Result<Vec<Element>, ExportError> {
    let Form::Mesh { to_world, mirrors } = one.form else { return Ok(Vec::new()) };
    let reversed = one.object.reversed;
    let file = beside.mesh_of(one, mirrors != reversed, reversed, false)?;
    let shape = |file: &str, wear: fn(Element, &Placed) -> Element, beside: &Beside| {
        let shape = wear(ply(file, one, beside), one);
        if to_world == Mat4::IDENTITY { shape } else { shape.transform("to_world", to_world) }
    };
    let mut elements = vec![emitting(shape(&file, owned, beside), one, beside)?];
    if is_two_sided(one, beside) {
        let back = beside.mesh_of(one, mirrors == reversed, !reversed, true)?;
        elements.push(emitting(shape(&back, backed, beside), one, beside)?);
    }
    Ok(elements)
}

/// Whether the back emits too. Emitters have one side there, so that it becomes a surface of its own.
fn is_two_sided(one: &Placed, beside: &mut Beside) -> bool {
    let two = one.emission.is_some_and(|e| e.sides == Sides::Both);
    if two {
        beside.note(
            "what emits from both sides has a second surface for its back, a hundred-thousandth of its extent behind",
        );
    }
    two
}

fn quadric(one: &Placed, beside: &mut Beside) -> Result<Vec<Element>, ExportError> {
    let turned = one.object.reversed;
    let mut elements = vec![emitting(owned(body(&one.form, turned, 0.0), one), one, beside)?];
    if is_two_sided(one, beside) {
        let inset = if turned { -INSET } else { INSET };
        elements.push(emitting(backed(body(&one.form, !turned, inset), one), one, beside)?);
    }
    Ok(elements)
}

/// The shape alone, the share `inset` smaller or further down.
fn body(form: &Form, turned: bool, inset: f32) -> Element {
    let shape = match *form {
        Form::Sphere { radius, to_world } => {
            let shape = Element::plugin("shape", "sphere").float("radius", radius * (1.0 - inset));
            shape.transform("to_world", to_world)
        }
        Form::Disk { radius, to_world } => {
            let depth = Mat4::from_translation(Vec3::NEG_Z * inset * radius);
            let scale = Mat4::from_scale(Vec3::splat(radius));
            Element::plugin("shape", "disk").transform("to_world", to_world * depth * scale)
        }
        Form::Cylinder { radius, height, to_world } => {
            let end = |name: &str, z: f32| {
                let p = to_world.transform_point3(Vec3::Z * z);
                Element::new("point").with("name", name).with("x", p.x).with("y", p.y).with("z", p.z)
            };
            let shape = Element::plugin("shape", "cylinder").float("radius", radius * (1.0 - inset));
            shape.child(end("p0", 0.0)).child(end("p1", height))
        }
        Form::Mesh { .. } => Element::plugin("shape", "ply"),
    };
    if turned { shape.boolean("flip_normals", true) } else { shape }
}

/// The second surface of what emits from both sides. Where that has holes the first alone lets through a share and scatters
/// the rest: here everything passes.
fn backed(shape: Element, one: &Placed) -> Element {
    if one.material.alpha == Alpha::Opaque { owned(shape, one) } else { shape.child(Element::bsdf("null")) }
}

/// With its material, and what is inside.
fn owned(shape: Element, one: &Placed) -> Element {
    let index = one.object.material;
    let shape = shape.child(Element::new("ref").with("id", format_args!("material-{index}")));
    match medium_of(one.material, index) {
        Some(id) => shape.child(Element::new("ref").with("name", "interior").with("id", id)),
        None => shape,
    }
}

fn emitting(shape: Element, one: &Placed, beside: &mut Beside) -> Result<Element, ExportError> {
    let Some(emission) = one.emission else { return Ok(shape) };
    if emission.coat.is_some() {
        beside.note("the clear coat over emitters takes none of their light");
    }
    let radiance = beside.covered_radiance(&emission.radiance, &one.material.alpha)?;
    Ok(shape.child(Element::plugin("emitter", "area").color("radiance", &radiance)))
}
