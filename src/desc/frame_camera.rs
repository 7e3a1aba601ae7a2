//! A camera that sees everything.

use super::{Camera, Fov, Projection, Scene, Shape};
use glam::{DVec3, Mat4, Vec3};

/// Vertical angle of view \[degrees\].
const VIEW_ANGLE: f64 = 40.0;

/// How much farther than needed the camera stands.
const MARGIN: f64 = 1.05;

/// A perspective camera in front of the scene (+z), somewhat to the right and above, from which its whole bounding box
/// fits into a square image.
pub fn framing(scene: &Scene) -> Camera {
    let (min, max) = bounds(scene).unwrap_or((DVec3::NEG_ONE, DVec3::ONE));
    let center = 0.5 * (min + max);
    let half = (0.5 * (max - min)).max(DVec3::splat(1e-6 * center.abs().max_element().max(1e-3)));

    // The camera's axes, and how far back every corner of the box has to be seen from.
    let z = DVec3::new(0.5, 0.35, 1.0).normalize();
    let x = DVec3::Y.cross(z).normalize();
    let y = z.cross(x);
    let slope = (0.5 * VIEW_ANGLE).to_radians().tan();
    let needed = (0..8).map(|i| {
        let sign = |bit: i32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let corner = half * DVec3::new(sign(0), sign(1), sign(2));
        corner.dot(z) + corner.dot(x).abs().max(corner.dot(y).abs()) / slope
    });
    let position = center + z * (MARGIN * needed.fold(0.0, f64::max));

    let [x, y, z, w] = [x.extend(0.0), y.extend(0.0), z.extend(0.0), position.extend(1.0)].map(|v| v.as_vec4());
    Camera {
        name: String::new(),
        to_world: Mat4::from_cols(x, y, z, w),
        projection: Projection::Perspective { fov: Fov::Vertical(VIEW_ANGLE.to_radians() as f32) },
        resolution: None,
        aspect: None,
        lens: None,
    }
}

/// The box around all objects in the world; `None` where there is none.
pub fn bounds(scene: &Scene) -> Option<(DVec3, DVec3)> {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for object in &scene.objects {
        let Some(shape) = scene.shapes.get(object.shape) else { continue };
        let m = object.to_world.as_dmat4();
        let mut add = |p: Vec3| {
            let p = m.transform_point3(p.as_dvec3());
            (min, max) = (min.min(p), max.max(p));
        };
        let corners = |lo: Vec3, hi: Vec3| {
            (0..8).map(move |i| Vec3::from_array([0, 1, 2].map(|a| if i >> a & 1 == 0 { lo[a] } else { hi[a] })))
        };
        match shape {
            Shape::Sphere { radius } => corners(Vec3::splat(-radius), Vec3::splat(*radius)).for_each(&mut add),
            Shape::Disk { radius } => {
                corners(Vec3::new(-radius, -radius, 0.0), Vec3::new(*radius, *radius, 0.0)).for_each(&mut add);
            }
            Shape::Cylinder { radius, height } => {
                corners(Vec3::new(-radius, -radius, 0.0), Vec3::new(*radius, *radius, *height)).for_each(&mut add);
            }
            Shape::Mesh(mesh) => {
                // Only what triangles use: files may hold stray vertices.
                mesh.indices.iter().flatten().for_each(|i| add(mesh.positions[*i as usize]));
            }
        }
    }
    (min.is_finite() && max.is_finite()).then_some((min, max))
}
