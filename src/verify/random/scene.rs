//! A few random objects on a floor, lit and seen by random means.

use super::SIDE;
use super::draw::Draw;
use super::feature::{Feature, Features, Pair, lawful_pairs};
use super::light;
use super::material::{Maker, Use};
use super::shape::{Form, fine, form};
use super::texture::Images;
use crate::desc::{Camera, ColorParam, Fov, Lens, Material, Model, Object, Projection, Scene, Shape, primitives};
use glam::{EulerRot, Mat4, Quat, Vec3};
use std::collections::BTreeSet;
use std::sync::{Arc, LazyLock};

/// Kinds of shapes that stand by themselves.
const SHAPES: [Feature; 7] =
    [Feature::Sphere, Feature::Disk, Feature::Cylinder, Feature::Quad, Feature::Cuboid, Feature::Facets, Feature::Ring];

/// Objects that are thrown away before any is good enough.
const TRIES: usize = 3000;

/// Pairs between those of successive turns: a prime.
const STEP: u64 = 1_000_003;

/// Scene `index` of `seed`, and what it has.
pub fn scene(seed: u64, index: u64) -> (Scene, Features) {
    let mut draw = Draw::new(seed, index);
    let mut scene = Scene { name: format!("random {seed} {index}"), ..Scene::default() };
    let images = Images::new(&mut scene, &mut draw);
    let least = draw.pick(&[0.25, 0.4, 0.55]);
    let mut place = Places { features: Features::default(), images, least };
    place.lights(&mut scene, &mut draw);
    place.ground(&mut scene, &mut draw);
    for slot in 0..1 + draw.below(3) {
        place.object_of_its_turn(&mut scene, &mut draw, slot, 3 * index + slot as u64);
    }
    place.lamp(&mut scene, &mut draw);
    let camera = place.camera(&mut draw);
    scene.cameras.push(camera);
    name(&mut scene);
    (scene, place.features)
}

/// Names for messages and for files.
fn name(scene: &mut Scene) {
    scene.materials.iter_mut().enumerate().for_each(|(i, m)| m.name = format!("material {i}"));
    scene.objects.iter_mut().enumerate().for_each(|(i, o)| o.name = format!("object {i}"));
    scene.cameras.iter_mut().for_each(|c| c.name = "camera".into());
}

/// Puts things into the scene and keeps what they are.
struct Places {
    features: Features,
    images: Images,
    least: f32,
}

impl Places {
    /// Up to three lights that are no objects.
    fn lights(&mut self, scene: &mut Scene, draw: &mut Draw) {
        for _ in 0..draw.pick(&[0, 1, 1, 2, 3]) {
            let kind = draw.pick(&light::KINDS);
            let around = matches!(kind, Feature::Environment | Feature::EnvironmentImage);
            if !(around && scene.environment.is_some()) {
                self.features.scene.extend(light::add(scene, draw, kind));
            }
        }
    }

    /// A floor, walls, or nothing.
    fn ground(&mut self, scene: &mut Scene, draw: &mut Draw) {
        let mesh = match draw.below(4) {
            0 => return,
            1 => {
                self.features.scene.insert(Feature::Room);
                let mut room = primitives::cuboid(Vec3::new(-2.5, -1.0, -2.0), Vec3::new(2.5, 3.2, 3.5));
                // Without the side of the viewer; normals inwards.
                room.indices.retain(|t| !t.iter().all(|i| room.positions[*i as usize].z > 3.0));
                room.indices.iter_mut().for_each(|t| t.swap(1, 2));
                room
            }
            _ => primitives::quad(Vec3::new(-4.0, -1.0, 4.0), Vec3::X * 8.0, Vec3::Z * -8.0),
        };
        let reflectance = ColorParam::constant(draw.rgb(0.3, 0.8));
        scene.materials.push(Material::new("", Model::Diffuse { reflectance }));
        scene.shapes.push(Shape::Mesh(Arc::new(mesh)));
        scene.objects.push(Object::new(scene.shapes.len() - 1, scene.materials.len() - 1));
    }

    /// An object in which the two features meet whose turn it is, so that rare pairs come too: others are thrown away.
    fn object_of_its_turn(&mut self, scene: &mut Scene, draw: &mut Draw, slot: usize, turn: u64) {
        static PAIRS: LazyLock<Vec<Pair>> = LazyLock::new(|| lawful_pairs().into_iter().collect());
        // A step that has no factor in common with their number goes through all of them.
        let (a, b) = PAIRS[(turn.wrapping_mul(STEP) % PAIRS.len() as u64) as usize];
        let before = [scene.textures.len(), scene.shapes.len(), scene.materials.len(), scene.objects.len()];
        let known = self.features.objects.len();
        for _ in 0..TRIES {
            self.object(scene, draw, slot);
            let has = |of: &BTreeSet<Feature>| [a, b].iter().all(|f| f.is_of_scene() || of.contains(f));
            if self.features.objects[known..].iter().any(has) {
                return;
            }
            scene.textures.truncate(before[0]);
            scene.shapes.truncate(before[1]);
            scene.materials.truncate(before[2]);
            scene.objects.truncate(before[3]);
            self.features.objects.truncate(known);
        }
        self.object(scene, draw, slot);
    }

    /// An object in its place, at times with copies of it, or with another inside.
    fn object(&mut self, scene: &mut Scene, draw: &mut Draw, slot: usize) {
        let center = Vec3::new(-1.1 + 1.1 * slot as f32, draw.between(-0.3, 0.3), draw.between(-0.5, 0.5));
        let copies = draw.chance(0.15);
        let form = if copies { fine(draw) } else { form(draw.pick(&SHAPES), draw) };
        let bounds = matches!(form.shape, Shape::Sphere { .. }) || form.features.contains(&Feature::Cuboid);
        let nests = bounds && draw.chance(0.4);
        let mut features = self.put(scene, draw, &form, center, 1.0);
        if nests {
            features.insert(Feature::Nesting);
        }
        self.features.objects.push(features);
        if nests {
            let inner = self::form(draw.pick(&SHAPES), draw);
            let mut features = self.put(scene, draw, &inner, center, 0.5);
            features.insert(Feature::Nested);
            self.features.objects.push(features);
        }
        if copies {
            let original = scene.objects[scene.objects.len() - 1].clone();
            for offset in [Vec3::new(0.3, 1.0, -0.8), Vec3::new(-0.2, 1.2, 0.5)] {
                let turn = Mat4::from_rotation_y(draw.between(-3.0, 3.0));
                let to_world = Mat4::from_translation(offset) * original.to_world * turn;
                scene.objects.push(Object { to_world, ..original.clone() });
            }
        }
    }

    /// Puts a shape with a material of its own at a place; its features.
    fn put(&mut self, scene: &mut Scene, draw: &mut Draw, form: &Form, center: Vec3, size: f32) -> BTreeSet<Feature> {
        let mut features = form.features.clone();
        let reversed = draw.chance(0.15);
        if reversed {
            features.insert(Feature::Reversed);
        }
        let of = Use {
            closed: form.is_closed() && !reversed,
            colored: features.contains(&Feature::VertexColors),
            uv_set: form.uv_set(),
        };
        let mut maker = Maker { scene, draw, images: self.images, least: self.least };
        let (material, more) = maker.material(of);
        features.extend(more);
        let own = maker.draw.chance(0.12);
        let emission = own.then(|| maker.own_emission(of, &mut features));
        scene.materials.push(material);

        let mut scale = Vec3::splat(size);
        if draw.chance(0.35) {
            features.insert(Feature::Uneven);
            scale *= Vec3::from(draw.rgb(0.5, 1.3));
        }
        if draw.chance(0.25) {
            features.insert(Feature::Mirrored);
            scale.x = -scale.x;
        }
        let [a, b, c] = draw.rgb(-3.0, 3.0);
        let turn = Quat::from_euler(EulerRot::XYZ, a, b, c);
        scene.shapes.push(form.shape.clone());
        scene.objects.push(Object {
            to_world: Mat4::from_scale_rotation_translation(scale, turn, center),
            emission,
            reversed,
            ..Object::new(scene.shapes.len() - 1, scene.materials.len() - 1)
        });
        features
    }

    /// Where nothing emits, an object does.
    fn lamp(&mut self, scene: &mut Scene, draw: &mut Draw) {
        let shines = |o: &Object| o.emission.is_some() || scene.materials[o.material].emission.is_some();
        if scene.environment.is_some() || !scene.lights.is_empty() || scene.objects.iter().any(shines) {
            return;
        }
        let form = form(draw.pick(&SHAPES), draw);
        let of = Use {
            closed: form.is_closed(),
            colored: form.features.contains(&Feature::VertexColors),
            uv_set: form.uv_set(),
        };
        let mut features = self.put(scene, draw, &form, Vec3::new(0.0, 1.8, 0.5), 1.2);
        let mut maker = Maker { scene, draw, images: self.images, least: self.least };
        let emission = maker.own_emission(of, &mut features);
        if let Some(last) = scene.objects.last_mut() {
            last.emission = Some(emission);
        }
        self.features.objects.push(features);
    }

    fn camera(&mut self, draw: &mut Draw) -> Camera {
        let eye = Vec3::new(draw.between(-1.0, 1.0), draw.between(0.0, 1.2), 4.5);
        let target = draw.within(Vec3::splat(0.2));
        let (projection, feature) = match draw.below(5) {
            0 => (Projection::Orthographic { half_height: draw.between(1.2, 2.0) }, Feature::Orthographic),
            1 => (Projection::Equirectangular, Feature::Panorama),
            2 => {
                let fov = Fov::Horizontal(draw.between(0.5, 0.9));
                (Projection::Perspective { fov }, Feature::Perspective)
            }
            _ => {
                let fov = Fov::Vertical(draw.between(0.5, 0.9));
                (Projection::Perspective { fov }, Feature::Perspective)
            }
        };
        self.features.scene.insert(feature);
        let lens = (feature == Feature::Perspective && draw.chance(0.3)).then(|| {
            self.features.scene.insert(Feature::Lens);
            Lens { radius: draw.between(0.02, 0.15), focus_distance: draw.between(3.0, 6.0) }
        });
        // A panorama looks from among the objects.
        let eye = if feature == Feature::Panorama { Vec3::new(0.3, 1.4, 2.0) } else { eye };
        let z = (eye - target).normalize();
        let x = Vec3::Y.cross(z).normalize();
        let to_world = Mat4::from_cols(x.extend(0.0), z.cross(x).extend(0.0), z.extend(0.0), eye.extend(1.0));
        Camera { name: String::new(), to_world, projection, resolution: Some([SIDE; 2]), aspect: None, lens }
    }
}
