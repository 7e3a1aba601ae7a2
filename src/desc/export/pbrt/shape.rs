//! Shapes: meshes, quadrics, objects and their instances.

use super::super::ExportError;
use super::super::beside::Beside;
use super::super::form::{Form, Kind, Placed, copies, is_instance, medium_of};
use super::super::value::Color;
use super::material::MaterialUse;
use super::words::{Named, Words};
use crate::desc::Sides;
use glam::Mat4;
use std::collections::HashMap;

pub(super) fn write(
    placed: &[Placed],
    materials: &[Option<MaterialUse>],
    beside: &mut Beside,
    out: &mut Words,
) -> Result<(), ExportError> {
    let copies = copies(placed);
    let mut objects: HashMap<Kind, String> = HashMap::new();
    for one in placed {
        let (true, Form::Mesh { to_world, .. }) = (is_instance(one, &copies), one.form) else {
            whole(one, materials, beside, out)?;
            continue;
        };
        let known = objects.get(&one.kind()).cloned();
        let name = match known {
            Some(name) => name,
            None => {
                let name = format!("object-{}", objects.len());
                out.line(&format!("ObjectBegin \"{name}\""));
                surface(one, materials, beside, out)?;
                out.line("ObjectEnd");
                objects.insert(one.kind(), name.clone());
                name
            }
        };
        out.line("AttributeBegin");
        out.matrix("ConcatTransform", to_world);
        out.line(&format!("ObjectInstance \"{name}\""));
        out.line("AttributeEnd");
    }
    Ok(())
}

/// An object where it stands.
fn whole(
    one: &Placed,
    materials: &[Option<MaterialUse>],
    beside: &mut Beside,
    out: &mut Words,
) -> Result<(), ExportError> {
    let (Form::Sphere { to_world, .. }
    | Form::Disk { to_world, .. }
    | Form::Cylinder { to_world, .. }
    | Form::Mesh { to_world, .. }) = one.form;
    out.line("AttributeBegin");
    if to_world != Mat4::IDENTITY {
        out.matrix("ConcatTransform", to_world);
    }
    if let Some(medium) = medium_of(one.material, one.object.material) {
        out.line(&format!("MediumInterface \"{medium}\" \"\""));
    }
    if let Some(emission) = one.emission {
        if emission.coat.is_some() {
            beside.note("the clear coat over emitters takes none of their light");
        }
        let radiance = beside.radiance(&emission.radiance)?;
        out.line("AreaLightSource \"diffuse\"").boolean("twosided", emission.sides == Sides::Both);
        match &radiance {
            Color::Texture(source) => match source.file() {
                Some(file) => {
                    beside.note("the texture of an emitter is looked up without its transform");
                    out.string("filename", file);
                }
                None => {
                    beside.note("the checker of an emitter is left out");
                    out.rgb("L", emission.radiance.factor);
                }
            },
            plain => {
                out.rgb("L", plain.plain().unwrap_or_default());
            }
        }
    }
    surface(one, materials, beside, out)?;
    out.line("AttributeEnd");
    Ok(())
}

/// Material, orientation and shape. A map that mirrors is seen by pbrt itself, which turns normals with it.
fn surface(
    one: &Placed,
    materials: &[Option<MaterialUse>],
    beside: &mut Beside,
    out: &mut Words,
) -> Result<(), ExportError> {
    let used = materials[one.object.material].as_ref();
    if let Some(used) = used {
        out.line(&format!("NamedMaterial \"{}\"", used.material));
    }
    if one.object.reversed {
        out.line("ReverseOrientation");
    }
    match one.form {
        Form::Sphere { radius, .. } => out.line("Shape \"sphere\"").float("radius", radius),
        Form::Disk { radius, .. } => out.line("Shape \"disk\"").float("radius", radius),
        Form::Cylinder { radius, height, .. } => {
            let cylinder = out.line("Shape \"cylinder\"").float("radius", radius);
            cylinder.float("zmin", 0.0).float("zmax", height)
        }
        Form::Mesh { .. } => {
            let file = beside.mesh_of(one, false, false, false)?;
            out.line("Shape \"plymesh\"").string("filename", &file)
        }
    };
    match used.and_then(|used| used.alpha.as_ref()) {
        Some(Named::Constant(x)) if *x >= 1.0 => {}
        Some(alpha) => {
            out.scalar("alpha", alpha);
        }
        None => {}
    }
    Ok(())
}
