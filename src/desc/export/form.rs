//! An object as a shape that both targets know.

use super::ExportError;
use super::Target;
use super::beside::Beside;
use super::mesh::Variant;
use crate::desc::{Emission, Error, Material, Object, Shape, TextureRef};
use crate::math::Transform;
use glam::{Mat3, Mat4, Vec3};
use std::collections::HashMap;
use std::path::Path;

/// Geometry in the world. Maps of quadrics are rotations and translations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Form {
    Sphere {
        radius: f32,
        to_world: Mat4,
    },
    Disk {
        radius: f32,
        to_world: Mat4,
    },
    Cylinder {
        radius: f32,
        height: f32,
        to_world: Mat4,
    },
    /// A PLY file under a map, which mirrors or not.
    Mesh {
        to_world: Mat4,
        mirrors: bool,
    },
}

/// What an object is to both targets.
#[derive(Clone, Debug)]
pub(super) struct Placed<'a> {
    pub(super) object: &'a Object,
    pub(super) material: &'a Material,
    pub(super) emission: Option<Emission>,
    pub(super) form: Form,
    pub(super) uv_set: usize,
}

/// Shape, material, orientation and texture coordinates.
pub(super) type Kind = (usize, usize, bool, usize);

impl Placed<'_> {
    /// What makes copies of each other, but for their places.
    pub(super) fn kind(&self) -> Kind {
        (self.object.shape, self.object.material, self.object.reversed, self.uv_set)
    }
}

/// Whether an object shares one mesh with others of its kind, all of them instances; emitters and interiors stand for
/// themselves.
pub(super) fn is_instance(one: &Placed, copies: &HashMap<Kind, usize>) -> bool {
    let alone = one.emission.is_some() || medium_of(one.material, one.object.material).is_some();
    matches!(one.form, Form::Mesh { .. }) && !alone && copies[&one.kind()] > 1
}

/// How many objects of each kind do not emit.
pub(super) fn copies(placed: &[Placed]) -> HashMap<Kind, usize> {
    let mut counts = HashMap::new();
    placed.iter().filter(|p| p.emission.is_none()).for_each(|p| *counts.entry(p.kind()).or_default() += 1);
    counts
}

impl<'a> Beside<'a> {
    /// All objects, in their order.
    pub(super) fn placed(&mut self) -> Result<Vec<Placed<'a>>, ExportError> {
        let scene = self.scene;
        scene.objects.iter().map(|object| self.place(object)).collect()
    }

    fn place(&mut self, object: &'a Object) -> Result<Placed<'a>, ExportError> {
        let scene = self.scene;
        let transform = Transform::from_mat4(object.to_world).ok_or_else(|| {
            let file = scene.source.as_deref().unwrap_or(Path::new("scene"));
            let message = format!("the transform of object `{}` is singular or not affine", object.name);
            Error::invalid(file, "", message)
        })?;
        let material = &scene.materials[object.material];
        let emission = object.emission.or(material.emission);
        let emission = emission.filter(|e| e.radiance.factor.iter().any(|x| *x > 0.0));
        let uses = textures(material, emission.as_ref());
        let uv_set = uses.first().map_or(0, |t| t.uv_set.min(1));
        if uses.iter().any(|t| t.uv_set.min(1) != uv_set) {
            let name = &material.name;
            self.note(format!("material `{name}`: one set of texture coordinates serves all its textures; it has two"));
        }
        let form = form(&scene.shapes[object.shape], &transform, !uses.is_empty());
        if matches!(form, Form::Mesh { .. }) && !matches!(scene.shapes[object.shape], Shape::Mesh(_)) {
            self.note("quadrics under maps that bend them, and textured disks and cylinders, are meshes");
        }
        Ok(Placed { object, material, emission, form, uv_set })
    }

    /// The file of an object's mesh; `inset` for its back.
    pub(super) fn mesh_of(
        &mut self,
        placed: &Placed,
        turned: bool,
        negated: bool,
        inset: bool,
    ) -> Result<String, ExportError> {
        let (shape, uv_set, upwards) = (placed.object.shape, placed.uv_set, self.target() != Target::Mitsuba);
        self.mesh(Variant { shape, turned, negated, uv_set, upwards, inset })
    }

    /// Whether the normal map of a material has its y turned: the targets' bitangent is n × ∂p/∂u, whichever way v runs.
    pub(super) fn turns_normals(&mut self, placed: &[Placed], material: usize) -> bool {
        if self.scene.materials[material].normal_map.is_none() {
            return false;
        }
        let worn = placed.iter().filter(|p| p.object.material == material);
        let turned: Vec<bool> = worn.filter_map(|p| self.is_left_handed(p)).collect();
        if turned.contains(&true) && turned.contains(&false) {
            let name = &self.scene.materials[material].name;
            self.note(format!(
                "material `{name}`: where its texture coordinates are mirrored, its bumps are dents one way"
            ));
        }
        2 * turned.iter().filter(|turned| **turned).count() > turned.len()
    }

    /// Whether n × tangent is the negative bitangent; `None` where there is no tangent.
    fn is_left_handed(&self, placed: &Placed) -> Option<bool> {
        let (Shape::Mesh(mesh), Form::Mesh { mirrors, .. }) = (&self.scene.shapes[placed.object.shape], placed.form)
        else {
            return Some(false);
        };
        let flip = mirrors != placed.object.reversed;
        if let Some(tangent) = mesh.tangents.first() {
            return Some((tangent.w < 0.0) != flip);
        }
        let uv = &mesh.uv[placed.uv_set];
        let corner = |i: u32| uv.get(i as usize).copied();
        let areas = mesh.indices.iter().filter_map(|[a, b, c]| {
            let (a, b, c) = (corner(*a)?, corner(*b)?, corner(*c)?);
            Some((b - a).perp_dot(c - a))
        });
        areas.into_iter().find(|area| *area != 0.0).map(|area| (area > 0.0) != flip)
    }

    /// The shape has no normals of its own.
    pub(super) fn is_flat(&self, placed: &Placed) -> bool {
        matches!(&self.scene.shapes[placed.object.shape], Shape::Mesh(mesh) if mesh.normals.is_empty())
    }
}

/// The target's own quadric under a similarity; a sphere also with textures, whose coordinates are the same everywhere.
fn form(shape: &Shape, transform: &Transform, textured: bool) -> Form {
    let m = transform.to_world.matrix3;
    let (to_world, mirrors) = (Mat4::from(transform.to_world), transform.mirrors());
    let scale = m.determinant().abs().cbrt();
    let rotation = Mat3::from(m) * (1.0 / scale);
    let gram = rotation.transpose() * rotation;
    let similar = gram.abs_diff_eq(Mat3::IDENTITY, 1e-4);
    // A quadric is its own mirror image: of these, that which turns the map into a rotation.
    let place = |mirror: Vec3| {
        let axes = if mirrors { rotation * Mat3::from_diagonal(mirror) } else { rotation };
        Mat4::from_translation(transform.to_world.translation.into()) * Mat4::from_mat3(axes)
    };
    match *shape {
        Shape::Sphere { radius } if similar && !(textured && mirrors) => {
            Form::Sphere { radius: radius * scale, to_world: place(Vec3::NEG_ONE) }
        }
        Shape::Disk { radius } if similar && !textured => {
            Form::Disk { radius: radius * scale, to_world: place(Vec3::new(1.0, -1.0, 1.0)) }
        }
        Shape::Cylinder { radius, height } if similar && !textured => Form::Cylinder {
            radius: radius * scale,
            height: height * scale,
            to_world: place(Vec3::new(1.0, -1.0, 1.0)),
        },
        _ => Form::Mesh { to_world, mirrors },
    }
}

/// Everything that a material, with this emission, looks up.
fn textures(material: &Material, emission: Option<&Emission>) -> Vec<TextureRef> {
    Material { emission: emission.copied(), ..material.clone() }.textures()
}

/// Name of the medium inside, where that absorbs.
pub(super) fn medium_of(material: &Material, index: usize) -> Option<String> {
    (material.model.refracts() && material.interior.absorption != [0.0; 3]).then(|| format!("medium-{index}"))
}
