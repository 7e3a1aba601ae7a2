//! Normals: do the author's agree with the triangles, and are the frames made of them usable?

use super::surfaces::{Placed, area_vector, corners, meshes};
use super::{Subject, count};
use crate::bsdf::Scratch;
use crate::sampler::{Kind, Sampler};
use crate::scene::{PrimitiveRef, Shading, Vertex};
use crate::shape::{TriangleAttributes, triangle_surface};
use crate::verify::{Findings, Task, Topic, Trial};
use crate::warp::{uniform_sphere, uniform_triangle};
use glam::Vec3A;

const TOPIC: Topic = Topic {
    id: "normals",
    title: "shading frames are orthonormal and on the side of the surface; triangles face their vertices' normals",
    source: "glTF 2.0, section 3.7.2.1: normals are unit, and front faces run counter-clockwise",
};

/// Points at which frames are made, in all.
const POINTS: [usize; 2] = [200_000, 2_000_000];

/// Largest deviation of a frame from an orthonormal one.
const ROUNDING: f64 = 1e-5;

/// One task for all meshes.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    if meshes(&subject.desc).is_empty() {
        return Vec::new();
    }
    let subject = subject.clone();
    vec![Task::new(TOPIC, "all meshes", move |trial, found| judge(&subject, trial, found))]
}

fn judge(subject: &Subject, trial: &Trial, found: &mut Findings) {
    let meshes = meshes(&subject.desc);
    let mut words = Vec::new();
    for mesh in &meshes {
        words.extend(against(mesh));
    }
    if words.is_empty() {
        words.push(format!(
            "{}: every triangle has an area and faces its vertices' normals",
            count(meshes.len(), "mesh")
        ));
    }
    found.words.extend(words);

    // Frames at random points.
    let points = (trial.work(POINTS[0], POINTS[1]) / meshes.len()).clamp(8, 50_000);
    let mut worst = Frames::default();
    for mesh in &meshes {
        worst.add(subject, mesh, points, trial.seed);
    }
    found.checks.bound("frames are orthonormal", worst.skew, ROUNDING);
    found.checks.holds("frames lie on the side of the surface", worst.wrong_side == 0);
    found.checks.holds("frames and albedos are finite", worst.not_finite == 0);
    if let Some(place) = worst.first {
        found.words.push(format!(
            "{} frames on the wrong side, {} not finite; the first at {place}",
            worst.wrong_side, worst.not_finite
        ));
    }
}

/// What is odd about the triangles of a mesh, in words.
fn against(placed: &Placed) -> Vec<String> {
    let mesh = placed.mesh;
    // First triangle and number of triangles without area, with all and with some normals on the other side.
    let mut found = [(0, 0usize); 3];
    let mut note = |kind: usize, triangle: usize| {
        if found[kind].1 == 0 {
            found[kind].0 = triangle;
        }
        found[kind].1 += 1;
    };
    for (i, triangle) in mesh.indices.iter().enumerate() {
        let Some(p) = corners(&mesh.positions, *triangle) else { continue };
        let normal = area_vector(p);
        if normal.length_squared() == 0.0 {
            note(0, i);
            continue;
        }
        let Some(n) = corners(&mesh.normals, *triangle) else { continue };
        match n.iter().filter(|n| n.as_dvec3().dot(normal) < 0.0).count() {
            0 => {}
            3 => note(1, i),
            _ => note(2, i),
        }
    }
    let n = mesh.indices.len();
    let text = [
        "have no area and are never met",
        "run clockwise as seen along all their normals: they are inverted; shading turns the normals to the triangle",
        "have a normal more than 90° from the triangle's: shading turns it where it is interpolated below the surface",
    ];
    let sentence = |((first, k), text): ((usize, usize), &str)| {
        (k > 0).then(|| format!("`{}`: {k} of {n} triangles {text} (first: triangle {first})", placed.name))
    };
    found.into_iter().zip(text).filter_map(sentence).collect()
}

/// The worst of many shading frames.
#[derive(Default)]
struct Frames {
    skew: f64,
    wrong_side: usize,
    not_finite: usize,
    first: Option<String>,
}

impl Frames {
    fn add(&mut self, subject: &Subject, placed: &Placed, points: usize, seed: u64) {
        let Some(material) = subject.scene.materials.get(placed.object.material) else { return };
        let mesh = placed.mesh;
        let m = placed.object.to_world;
        let normal_matrix = glam::Mat3::from_mat4(m).inverse().transpose();
        let flip = placed.flipped();
        let mut scratch = Scratch::new();
        let stride = mesh.indices.len() as f64 / points as f64;
        for k in 0..points.min(mesh.indices.len()) {
            let index = if stride > 1.0 { (k as f64 * stride) as usize } else { k };
            let triangle = mesh.indices[index];
            let Some(p) = corners(&mesh.positions, triangle) else { continue };
            if area_vector(p).length_squared() == 0.0 {
                continue;
            }
            let attributes = TriangleAttributes {
                normals: corners(&mesh.normals, triangle).map(|n| n.map(|n| (normal_matrix * n).normalize_or_zero())),
                tangents: corners(&mesh.tangents, triangle)
                    .map(|t| t.map(|t| m.transform_vector3(t.truncate()).extend(t.w))),
                uv: [0, 1].map(|set| corners(&mesh.uv[set], triangle)),
                colors: corners(&mesh.colors, triangle),
            };
            let mut u = Sampler::new(Kind::Independent, seed, [index as u32, placed.index as u32], 0, 1);
            let [b, c] = {
                let [_, b, c] = uniform_triangle(u.next_2d());
                [b, c]
            };
            let surface = triangle_surface(p.map(|p| m.transform_point3(p)), b, c, &attributes, flip);
            let wo = Vec3A::from(uniform_sphere(u.next_2d()));
            let vertex = Vertex {
                surface,
                wo,
                material: placed.object.material as u32,
                light: None,
                front: wo.dot(surface.ng) > 0.0,
                primitive: PrimitiveRef::NONE,
            };
            let shading = Shading::new(material, &vertex, &subject.scene.textures, &mut scratch);
            let f = shading.frame;
            let albedo = shading.bsdf.albedo();
            let finite = [f.s, f.t, f.n].iter().all(|v| v.is_finite()) && albedo.is_finite();
            let right = (shading.wo.z > 0.0) == vertex.front && shading.wo.z != 0.0;
            self.skew = self.skew.max(skew([f.s, f.t, f.n]));
            self.not_finite += usize::from(!finite);
            self.wrong_side += usize::from(finite && !right);
            if (!finite || !right) && self.first.is_none() {
                self.first = Some(format!("triangle {index} of `{}`", placed.name));
            }
        }
    }
}

/// Largest deviation of dot products of three vectors from those of an orthonormal frame; 0 where they are not finite,
/// which is counted apart.
fn skew([s, t, n]: [Vec3A; 3]) -> f64 {
    let dot = |a: Vec3A, b: Vec3A| a.as_dvec3().dot(b.as_dvec3());
    let off = [dot(s, t), dot(t, n), dot(n, s), dot(s, s) - 1.0, dot(t, t) - 1.0, dot(n, n) - 1.0];
    off.into_iter().fold(0.0, |worst, x| if x.is_finite() { worst.max(x.abs()) } else { worst })
}
