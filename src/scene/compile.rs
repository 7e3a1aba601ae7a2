//! `desc::Scene` → [`Scene`].

use super::geometry::{Geometry, Owner, Part, corners};
use super::instance::{Instance, Prototype, map_error};
use super::object::{Object, PrimitiveRef};
use super::{Info, Media, Scene};
use crate::bsdf::{MAX_LAYERS, MAX_LOBES};
use crate::bvh::{Passages, Quality, TriangleBvh};
use crate::desc::{self, Error, Mesh, Shape};
use crate::light::{Emitter, Environment, Light, Lights, QuadricLight, TriangleLight};
use crate::material::{self, Material, most_lobes};
use crate::math::Transform;
use crate::shape::{PlacedQuadric, Primitive, Quadric};
use crate::texture::Textures;
use glam::{Affine3A, Vec3A};
use std::path::Path;
use std::sync::Arc;

/// A mesh that stands in several places is kept once, unless copies of it would be this few triangles: then one flat
/// tree is faster.
const FEW_TRIANGLES: usize = 4096;

/// Most vertices of such copies: more than triangles without any shared vertex have.
const FEW_VERTICES: usize = 4 * FEW_TRIANGLES;

impl Scene {
    /// Builds what is traced.
    ///
    /// # Errors
    /// Where an object's transform is singular or not affine, its material a mixture of too much, and where instances of
    /// emissive meshes are too many lights.
    pub fn compile(desc: &desc::Scene) -> Result<Self, Error> {
        Self::compile_with(desc, Quality::default())
    }

    /// Builds what is traced, with hierarchies of the given quality.
    ///
    /// # Errors
    /// As [`compile`](Self::compile).
    pub fn compile_with(desc: &desc::Scene, quality: Quality) -> Result<Self, Error> {
        desc::emitters::check(desc)?;
        check_materials(desc)?;
        let textures = Textures::new(desc);
        let mut builder = Builder::new(desc, quality);
        for object in &desc.objects {
            builder.place(object)?;
        }
        builder.chart();
        let Builder { compiled, parts, prototypes, objects, emitters, materials, mut lights, .. } = builder;
        let geometry = Geometry::new(parts, prototypes, objects, quality);

        // Lights without a surface.
        lights.extend(desc.lights.iter().map(Light::from_desc));
        let image = |e: &desc::Environment| e.image.map(|i| &*desc.images[i]);
        lights.extend(desc.environment.iter().map(|e| Light::Environment(Box::new(Environment::new(e, image(e))))));
        let bounds = geometry.bounds();
        let (center, radius) = if bounds.is_empty() {
            (glam::Vec3::ZERO, 1.0)
        } else {
            let half = (bounds.max * 0.5 - bounds.min * 0.5).length();
            (bounds.min * 0.5 + bounds.max * 0.5, half)
        };
        let lights = Lights::new(lights, (center, radius), &textures);

        let mut primitives = vec![PrimitiveRef::NONE; lights.all().len()];
        for (emitter, primitive) in emitters.iter().zip(geometry.emitters(emitters.len())) {
            if let Some(light) = *emitter {
                primitives[light as usize] = primitive;
            }
        }

        let [stored_triangles, triangles, instances, quadrics] = geometry.counts();
        let [mesh_bytes, bvh_bytes] = geometry.memory();
        let info = Info {
            bounds,
            stored_triangles,
            triangles,
            instances,
            quadrics,
            materials: desc.materials.iter().map(|m| m.name.clone()).collect(),
            lights: lights.all().len(),
            textures: textures.len(),
            mesh_bytes,
            bvh_bytes,
            texture_bytes: textures.memory(),
        };
        Ok(Self {
            geometry,
            has_holes: compiled.iter().any(Material::has_holes),
            media: Media::new(&materials),
            materials: compiled,
            textures,
            lights,
            emitters,
            primitives,
            cameras: desc.cameras.clone(),
            info,
        })
    }
}

/// Every material that is used finds room for its lobes at a hit.
fn check_materials(desc: &desc::Scene) -> Result<(), Error> {
    let mut used = vec![false; desc.materials.len()];
    desc.objects.iter().for_each(|object| used[object.material] = true);
    for (material, _) in desc.materials.iter().zip(&used).filter(|(_, used)| **used) {
        let [lobes, layers] = most_lobes(&material.model);
        for (number, most, what) in [(lobes, MAX_LOBES, "lobes"), (layers, MAX_LAYERS, "layers")] {
            if number > most {
                let file = desc.source.as_deref().unwrap_or(Path::new("scene"));
                let name = &material.name;
                let text =
                    format!("material `{name}` mixes up to {number} {what} at a point, of which {most} are possible");
                return Err(Error::invalid(file, "", text));
            }
        }
    }
    Ok(())
}

/// Collects what objects turn into.
struct Builder<'a> {
    desc: &'a desc::Scene,
    quality: Quality,
    /// Materials as written, then those of objects with an emission of their own.
    materials: Vec<desc::Material>,
    /// What they become.
    compiled: Vec<Material>,
    parts: Vec<Part>,
    prototypes: Vec<Prototype>,
    /// Prototype of each shape that is instanced.
    prototype_of: Vec<Option<u32>>,
    /// Objects that place each shape.
    uses: Vec<usize>,
    objects: Vec<Object>,
    emitters: Vec<Option<u32>>,
    lights: Vec<Light>,
}

impl<'a> Builder<'a> {
    fn new(desc: &'a desc::Scene, quality: Quality) -> Self {
        let mut uses = vec![0; desc.shapes.len()];
        desc.objects.iter().for_each(|o| uses[o.shape] += 1);
        let colored = |shape: &Shape| matches!(shape, Shape::Mesh(mesh) if !mesh.colors.is_empty());
        let mut materials = desc.materials.clone();
        if !desc.shapes.iter().any(colored) {
            materials.iter_mut().for_each(desc::Material::ignore_vertex_colors);
        }
        Self {
            desc,
            quality,
            materials,
            compiled: Vec::new(),
            parts: Vec::new(),
            prototypes: Vec::new(),
            prototype_of: vec![None; desc.shapes.len()],
            uses,
            objects: Vec::new(),
            emitters: Vec::new(),
            lights: Vec::new(),
        }
    }

    fn place(&mut self, object: &desc::Object) -> Result<(), Error> {
        let transform = Transform::from_mat4(object.to_world).ok_or_else(|| {
            let file = self.desc.source.as_deref().unwrap_or(Path::new("scene"));
            let name = &object.name;
            Error::invalid(file, "", format!("the transform of object `{name}` is singular or not affine"))
        })?;
        let material = self.material(object);
        let written = &self.materials[material as usize];
        let emission = written.emission.filter(desc::Emission::is_light);
        let emitter = emission.map(|emission| Emitter::new(&emission).with_alpha(written.alpha));
        let flip = transform.mirrors() != object.reversed;
        match &self.desc.shapes[object.shape] {
            Shape::Mesh(mesh) => {
                let uses = self.uses[object.shape];
                let few = uses.saturating_mul(mesh.indices.len()) <= FEW_TRIANGLES
                    && uses.saturating_mul(mesh.positions.len()) <= FEW_VERTICES;
                let instanced = uses > 1 && !few;
                let emitter = emitter.map(|emitter| {
                    let first = self.emitters.len() as u32;
                    for triangle in 0..mesh.indices.len() as u32 {
                        let (local, attributes) = corners(mesh, triangle, true);
                        let p = local.map(|p| transform.to_world.transform_point3(p));
                        let light = TriangleLight::new(p, &attributes, flip, emitter.clone());
                        let error = if instanced { map_error(&transform, local, p[0].into()) } else { Vec3A::ZERO };
                        self.emit(light.map(|light| Light::Triangle(light.with_error(error))));
                    }
                    first
                });
                let owner = Owner { material, emitter, needs_uv: true, passages: 0 };
                if !instanced {
                    let mesh = to_world(mesh, &transform);
                    self.parts.push(Part { plain: false, mesh, owner, flip });
                } else {
                    let prototype = *self.prototype_of[object.shape].get_or_insert_with(|| {
                        let bvh = TriangleBvh::build(&mesh.positions, &mesh.indices, self.quality);
                        self.prototypes.push(Prototype { mesh: mesh.clone(), bvh });
                        (self.prototypes.len() - 1) as u32
                    });
                    self.objects.push(Object::Instance(Instance { prototype, transform, owner, flip }));
                }
            }
            shape => {
                if let Some(quadric) = Quadric::from_desc(shape) {
                    let placed = PlacedQuadric::new(quadric, transform, object.reversed);
                    let emitter = emitter.map(|emitter| {
                        self.emit(Some(Light::Quadric(Box::new(QuadricLight::new(placed, emitter)))));
                        (self.emitters.len() - 1) as u32
                    });
                    let owner = Owner { material, emitter, needs_uv: true, passages: 0 };
                    self.objects.push(Object::Primitive(Primitive::Quadric(placed), owner));
                }
            }
        }
        Ok(())
    }

    /// Compiles the materials, and says of everything placed whether its own looks at texture coordinates, tangents and
    /// colours (to find them takes as long as all else at a hit), and why shadow rays may pass it.
    fn chart(&mut self) {
        self.compiled = self.materials.iter().map(Material::compile).collect();
        let look = |owner: &mut Owner| {
            let (material, written) =
                (&self.compiled[owner.material as usize], &self.materials[owner.material as usize]);
            owner.needs_uv = material.needs_uv();
            let reasons = [material.has_holes(), material.is_sheet(), material::interior(written).is_some()];
            owner.passages = reasons.iter().enumerate().map(|(i, &reason)| Passages::from(reason) << i).sum();
        };
        for part in &mut self.parts {
            look(&mut part.owner);
            part.plain = part.mesh.normals.is_empty() && !(part.owner.needs_uv && part.mesh.has_chart());
        }
        self.objects.iter_mut().for_each(|object| look(object.owner_mut()));
    }

    /// Lists an emitter and, where it can emit, its light.
    fn emit(&mut self, light: Option<Light>) {
        self.emitters.push(light.is_some().then_some(self.lights.len() as u32));
        self.lights.extend(light);
    }

    /// The object's material, with the object's own emission where it has one.
    fn material(&mut self, object: &desc::Object) -> u32 {
        let Some(emission) = object.emission else { return object.material as u32 };
        let own = desc::Material { emission: Some(emission), ..self.materials[object.material].clone() };
        self.materials.push(own);
        (self.materials.len() - 1) as u32
    }
}

/// The mesh in the world; where it is there already, itself.
fn to_world(shared: &Arc<Mesh>, transform: &Transform) -> Arc<Mesh> {
    let m = &transform.to_world;
    if *m == Affine3A::IDENTITY && shared.normals.is_empty() && shared.tangents.is_empty() {
        return shared.clone();
    }
    let mut mesh = Mesh::clone(shared);
    mesh.positions.iter_mut().for_each(|p| *p = m.transform_point3(*p));
    mesh.normals.iter_mut().for_each(|n| *n = transform.normal_to_world(*n).normalize_or_zero().into());
    mesh.tangents.iter_mut().for_each(|t| *t = m.transform_vector3(t.truncate()).normalize_or_zero().extend(t.w));
    Arc::new(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{ColorParam, Model, Sides};
    use glam::Vec3;

    /// One triangle among many vertices, at many places: kept once.
    #[test]
    fn vertices_are_not_copied_to_every_place() {
        let mut positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        positions.resize(50_000, Vec3::ONE);
        let mesh = Mesh { positions, indices: vec![[0, 1, 2]], ..Mesh::default() };
        let scene = desc::Scene {
            shapes: vec![Shape::Mesh(mesh.into())],
            materials: vec![desc::Material::new("m", Model::Absorb)],
            objects: vec![desc::Object::new(0, 0); 100],
            ..desc::Scene::default()
        };
        let compiled = Scene::compile(&scene).unwrap();
        let info = compiled.info();
        assert_eq!((info.instances, info.triangles), (100, 100));
        assert!(info.mesh_bytes < 2_000_000, "{}", info.mesh_bytes);
    }

    /// Objects with an emission of their own keep the scattering and the interior of their material.
    #[test]
    fn an_emission_of_its_own_is_all_that_an_object_changes() {
        let glass = Model::Dielectric {
            ior: 1.5,
            roughness: desc::Roughness::Alpha([0.0; 2]),
            tint: ColorParam::constant([1.0; 3]),
        };
        let emission = |x| desc::Emission { radiance: ColorParam::constant([x; 3]), sides: Sides::Front, coat: None };
        let mut scene = desc::Scene {
            shapes: vec![Shape::Sphere { radius: 1.0 }],
            materials: vec![desc::Material::new("glass", glass)],
            objects: vec![desc::Object::new(0, 0); 3],
            ..desc::Scene::default()
        };
        scene.objects[1].emission = Some(emission(2.0));
        scene.objects[2].emission = Some(emission(0.0));
        let compiled = Scene::compile(&scene).unwrap();
        assert_eq!(compiled.materials.len(), 3);
        assert_eq!(compiled.materials.iter().map(Material::is_emissive).collect::<Vec<_>>(), [false, true, false]);
        assert_eq!(compiled.lights.all().len(), 1);
    }
}
