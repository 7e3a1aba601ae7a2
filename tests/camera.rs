//! Cameras: known points on known pixels, solid angles, cos⁴, and rays that find the point they were projected from.

use glam::{Mat4, Vec2, Vec3, vec2, vec3};
use proptest::prelude::*;
use radianza::camera::Camera;
use radianza::desc::{self, Fov, Lens, Projection};
use radianza::sampler::{Kind, Sampler};
use radianza::stats::{Family, Moments, chi2_test};
use std::f64::consts::{PI, TAU};

const SIZE: [u32; 2] = [40, 30];

fn camera(projection: Projection, lens: Option<Lens>, to_world: Mat4) -> Camera {
    Camera::new(&desc::Camera { name: String::new(), to_world, projection, resolution: None, aspect: None, lens }, SIZE)
}

fn perspective(fov: Fov) -> Projection {
    Projection::Perspective { fov }
}

fn pinhole() -> Camera {
    camera(perspective(Fov::Vertical(1.2)), None, Mat4::IDENTITY)
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
fn known_points_land_on_their_pixels() {
    // At distance 2 a vertical view angle of 90° shows heights of ±2 over 30 rows.
    let c = camera(perspective(Fov::Vertical(90f32.to_radians())), None, Mat4::IDENTITY);
    let near = |found: Option<Vec2>, x, y| assert!((found.unwrap() - vec2(x, y)).length() < 1e-4, "{found:?}");
    near(c.project(vec3(0.0, 0.0, -2.0)), 20.0, 15.0);
    near(c.project(vec3(0.0, 2.0, -2.0)), 20.0, 0.0);
    near(c.project(vec3(2.0, -1.0, -2.0)), 35.0, 22.5);
    assert_eq!(c.project(vec3(0.0, 0.0, 1.0)), None);
    assert_eq!(c.project(Vec3::ZERO), None);

    // The same angle across the width: ±2 over 40 columns.
    let c = camera(perspective(Fov::Horizontal(90f32.to_radians())), None, Mat4::IDENTITY);
    near(c.project(vec3(1.0, 1.0, -2.0)), 30.0, 5.0);

    // Moved and turned: at (1, 2, 3), looking along +x.
    let to_world = glam::camera::rh::view::look_at_mat4(vec3(1.0, 2.0, 3.0), vec3(2.0, 2.0, 3.0), Vec3::Y).inverse();
    let c = camera(perspective(Fov::Horizontal(90f32.to_radians())), None, to_world);
    near(c.project(vec3(3.0, 2.0, 4.0)), 30.0, 15.0);
    assert!((c.axis() - Vec3::X).length() < 1e-6);

    let c = camera(Projection::Orthographic { half_height: 3.0 }, None, Mat4::IDENTITY);
    near(c.project(vec3(1.0, 1.0, -7.0)), 25.0, 10.0);

    // −z in the middle, +x to the right, +y up, +z at the seam.
    let c = camera(Projection::Equirectangular, None, Mat4::IDENTITY);
    near(c.project(vec3(0.0, 0.0, -5.0)), 20.0, 15.0);
    near(c.project(vec3(5.0, 0.0, 0.0)), 30.0, 15.0);
    near(c.project(vec3(-5.0, 0.0, 0.0)), 10.0, 15.0);
    near(c.project(vec3(0.0, 1.0, -1.0)), 20.0, 7.5);
    assert!((c.ray(vec2(40.0, 15.0), [0.5; 2]).d - Vec3::Z).length() < 1e-6);
}

#[test]
fn pixel_solid_angles_sum_to_the_window_s() {
    // A rectangle of half-sides a, b at distance 1: 4 asin(ab/√((1 + a²)(1 + b²))).
    for fov in [1e-4f32, 0.1, 1.2, 3.0] {
        let c = camera(perspective(Fov::Vertical(fov)), None, Mat4::IDENTITY);
        let b = (0.5 * fov).tan() as f64;
        let a = b * SIZE[0] as f64 / SIZE[1] as f64;
        let window = 4.0 * (a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt()).asin();
        let sum: f64 =
            (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| c.pixel_solid_angle(x, y)).sum();
        assert!((sum / window - 1.0).abs() < 1e-6, "{fov}: {sum} for {window}");
    }
    let c = camera(Projection::Equirectangular, None, Mat4::IDENTITY);
    let sum: f64 = (0..SIZE[1]).map(|y| SIZE[0] as f64 * c.pixel_solid_angle(7, y)).sum();
    assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-12, "{sum}");
}

#[test]
fn directions_fill_a_pixel_with_its_solid_angle() {
    // Ω = ∫ dΩ/dA dA over the pixel of the window at distance 1, with dΩ/dA = cos³θ of the rays.
    let mut family = Family::new("solid angle of pixels by rays");
    let c = pinhole();
    let cell = 2.0 * (0.6f32.tan() as f64) / SIZE[1] as f64;
    for [x, y] in [[0, 0], [20, 15], [39, 3], [5, 29]] {
        let cos3: Moments = rays_of_pixel(&c, [x, y]).map(|cos| cos.powi(3) * cell * cell).collect();
        family.rounded(format!("pixel {x}, {y}"), c.pixel_solid_angle(x, y), cos3.mean(), cos3.standard_error(), 1e-5);
    }
    family.assert();
}

#[test]
fn flux_through_a_pixel_falls_as_the_fourth_power_of_the_cosine() {
    // Of uniform radiance, E = ∫ cosθ dΩ over the pixel: cos⁴θ per projected area. The closed form is Lambert's for the
    // pixel's rectangle seen from the centre of projection (VERIFICATION L2 with L = 1).
    let mut family = Family::new("flux through pixels");
    let c = pinhole();
    let half = 0.6f32.tan() as f64;
    let cell = 2.0 * half / SIZE[1] as f64;
    for [x, y] in [[0, 0], [20, 15], [39, 3], [5, 29]] {
        let (x0, y0) = (x as f64 * cell - half * 4.0 / 3.0, y as f64 * cell - half);
        let corners = [[x0, y0], [x0 + cell, y0], [x0 + cell, y0 + cell], [x0, y0 + cell]];
        let exact = lambert(&corners.map(|[x, y]| glam::dvec3(x, y, 1.0)));
        let cos4: Moments = rays_of_pixel(&c, [x, y]).map(|cos| cos.powi(4) * cell * cell).collect();
        family.rounded(format!("pixel {x}, {y}"), exact, cos4.mean(), cos4.standard_error(), 1e-5);
    }
    family.assert();
}

/// Cosines to the axis of rays uniform over a pixel.
fn rays_of_pixel(c: &Camera, [x, y]: [u32; 2]) -> impl Iterator<Item = f64> {
    let axis = c.axis();
    (0..100_000).map(move |i| {
        let [u, v] = Sampler::new(Kind::Independent, 1, [x, y], i, 1).next_2d();
        c.ray(vec2(x as f32 + u, y as f32 + v), [0.5; 2]).d.dot(axis) as f64
    })
}

/// E/L = ½ Σ Θᵢ (Γᵢ·n) at the origin with normal +z of a polygon above the horizon (Lambert 1760).
fn lambert(polygon: &[glam::DVec3]) -> f64 {
    let edge = |i: usize| {
        let (a, b) = (polygon[i].normalize(), polygon[(i + 1) % polygon.len()].normalize());
        0.5 * a.angle_between(b) * a.cross(b).normalize().z
    };
    (0..polygon.len()).map(edge).sum::<f64>().abs()
}

#[test]
fn lens_rays_meet_in_the_plane_of_focus_and_fill_the_lens() {
    let (radius, focus_distance) = (0.2, 3.0);
    let to_world =
        glam::camera::rh::view::look_at_mat4(vec3(1.0, -2.0, 0.5), vec3(0.0, 0.3, -4.0), vec3(0.1, 1.0, 0.0)).inverse();
    let c = camera(perspective(Fov::Vertical(0.8)), Some(Lens { radius, focus_distance }), to_world);
    let to_camera = to_world.inverse();
    let n = 100_000;
    let film = vec2(31.3, 4.6);
    let focus = {
        let chief = c.ray(film, [0.5; 2]);
        chief.o + chief.d * (focus_distance / chief.d.dot(c.axis()))
    };
    let mut counts = vec![0.0; 10 * 20];
    for i in 0..n {
        let ray = c.ray(film, Sampler::new(Kind::Independent, 9, [0, 0], i, 1).next_2d());
        assert!((ray.d.length() - 1.0).abs() < 1e-6);
        let distance = (focus - ray.o).cross(ray.d).length();
        assert!(distance < 1e-5, "passes the focus at {distance}");
        let lens = to_camera.transform_point3(ray.o);
        assert!(lens.z.abs() < 1e-6 && lens.truncate().length() <= radius * 1.000_01);
        let ring = ((lens.truncate().length() / radius).powi(2) * 10.0) as usize;
        let sector = ((lens.y as f64).atan2(lens.x as f64).rem_euclid(TAU) / TAU * 20.0) as usize;
        counts[ring.min(9) * 20 + sector.min(19)] += 1.0;
    }
    let mut family = Family::new("uniform on the lens");
    family.chi2("disk", chi2_test(&counts, &vec![n as f64 / 200.0; 200], 5.0));
    family.assert();
}

#[test]
fn equirectangular_rays_are_uniform_in_longitude_and_latitude() {
    let c = camera(Projection::Equirectangular, None, Mat4::IDENTITY);
    let d = c.ray(vec2(20.0 + 40.0 / 8.0, 15.0 - 30.0 / 6.0), [0.5; 2]).d;
    // Longitude 45° to the right of −z, latitude 30°.
    let expected =
        vec3(45f32.to_radians().sin(), 0.0, -45f32.to_radians().cos()) * 30f32.to_radians().cos() + Vec3::Y * 0.5;
    assert!((d - expected).length() < 1e-6, "{d}");
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
            (a.focus_distance - (ray.o - Vec3::from(eye)).dot(axis)) / ray.d.dot(axis)
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
