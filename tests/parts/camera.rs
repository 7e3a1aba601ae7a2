//! Cameras: rays that find the point they were projected from, and points that no projection breaks on. Known points, solid
//! angles, cos⁴ and the lens are rows of the battery.

use glam::{Mat4, Vec3, Vec3A, vec2, vec3};
use proptest::prelude::*;
use radianza::camera::Camera;
use radianza::desc::{self, Fov, Lens, Projection};

const SIZE: [u32; 2] = [40, 30];

fn camera(projection: Projection, lens: Option<Lens>, to_world: Mat4) -> Camera {
    Camera::new(&desc::Camera { name: String::new(), to_world, projection, resolution: None, aspect: None, lens }, SIZE)
}

fn perspective(fov: Fov) -> Projection {
    Projection::Perspective { fov }
}

fn kinds() -> [(Projection, Option<Lens>); 5] {
    [
        (perspective(Fov::Vertical(0.7)), None),
        (perspective(Fov::Horizontal(2.0)), None),
        (perspective(Fov::Vertical(0.7)), Some(Lens { radius: 0.05, focus_distance: 2.0 })),
        (Projection::Orthographic { half_height: 1.5 }, None),
        (Projection::Equirectangular, None),
    ]
}

#[test]
fn equirectangular_rays_are_uniform_in_longitude_and_latitude() {
    let c = camera(Projection::Equirectangular, None, Mat4::IDENTITY);
    let d = c.ray(vec2(20.0 + 40.0 / 8.0, 15.0 - 30.0 / 6.0), [0.5; 2]).d;
    // Longitude 45° to the right of −z, latitude 30°.
    let expected =
        vec3(45f32.to_radians().sin(), 0.0, -45f32.to_radians().cos()) * 30f32.to_radians().cos() + Vec3::Y * 0.5;
    assert!((Vec3::from(d) - expected).length() < 1e-6, "{d}");
}

proptest! {
    #[test]
    fn projecting_undoes_the_ray(kind in 0..5usize, x in 0.5f32..39.5, y in 0.5f32..29.5, lens in [0.0f32..1.0, 0.0f32..1.0],
                                 t in 0.01f32..100.0, eye in [-5f32..5.0, -5f32..5.0, -5f32..5.0]) {
        let (projection, aperture) = kinds()[kind];
        let to_world = glam::camera::rh::view::look_at_mat4(eye.into(), vec3(0.1, 0.2, 6.3), Vec3::Y).inverse();
        let c = camera(projection, aperture, to_world);
        let film = vec2(x, y);
        let ray = c.ray(film, lens);
        prop_assert!((ray.d.length() - 1.0).abs() < 1e-6);
        // Where there is a lens, rays of a film point agree in the plane of focus only.
        let t = aperture.map_or(t + 0.5, |a| {
            let axis = c.axis();
            (a.focus_distance - (ray.o - Vec3A::from(eye)).dot(axis)) / ray.d.dot(axis)
        });
        let found = c.project(ray.at(t));
        prop_assert!(found.is_some_and(|f| (f - film).length() < 2e-3), "{film} {found:?}");
    }

    #[test]
    fn no_point_breaks_a_projection(kind in 0..5usize, bits in any::<[u32; 3]>()) {
        let (projection, lens) = kinds()[kind];
        let p = Vec3::from(bits.map(f32::from_bits));
        if let Some(film) = camera(projection, lens, Mat4::IDENTITY).project(p) {
            prop_assert!(film.is_finite());
        }
    }
}
