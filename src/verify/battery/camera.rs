//! C1: cameras.
//!
//! A known point lands on its known pixel, and rays find the point that was projected; pixel solid angles sum to the window's
//! 4 asin(ab/√((1 + a²)(1 + b²))) and are those of the rays, Ω = ∫ cos³θ dA over the pixel at distance 1; flux of uniform radiance
//! falls as cos⁴: ∫ cosθ dΩ over the pixel, Lambert's formula for its rectangle; lens points are uniform on the disk and their
//! rays meet in the plane of focus; equirectangular pixels have Δλ (cos θ₀ − cos θ₁).

use crate::camera::{Camera, SIZE, Specimen, specimens};
use crate::desc::{self, Fov, Lens, Projection};
use crate::stats::chi2_test;
use crate::verify::measure::replicates;
use crate::verify::{Exhibit, Findings, HeatMap, Task, Topic, Trial};
use glam::{DVec3, Mat4, Vec2, Vec3, Vec3A, vec2, vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::{PI, TAU};

const C1: Topic = Topic {
    id: "C1",
    title: "cameras: known points on known pixels, solid angles, cos⁴, the lens",
    source: "view window; Lambert 1760; thin lens",
};

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = vec![Task::new(C1, "known points", known_points)];
    for Specimen { name, written, camera } in specimens() {
        tasks.push(Task::new(C1, name, move |trial, found| {
            round_trip(&camera, written.lens, trial, found);
            match written.projection {
                Projection::Perspective { fov } => {
                    window(&camera, fov, found);
                    // With a lens the solid angles are those of its chief rays.
                    pixels(&camera, fov, trial, found);
                }
                Projection::Equirectangular => sphere(&camera, trial, found),
                Projection::Orthographic { .. } => parallel(&camera, found),
            }
            if let Some(lens) = written.lens {
                aperture(&camera, lens, trial, found);
            }
        }));
    }
    tasks
}

/// Points whose pixels are known by hand.
fn known_points(_: &Trial, found: &mut Findings) {
    let square = 90f32.to_radians();
    let camera = |projection, to_world| {
        let written =
            desc::Camera { name: String::new(), to_world, projection, resolution: None, aspect: None, lens: None };
        Camera::new(&written, SIZE)
    };
    let perspective = |fov, to_world| camera(Projection::Perspective { fov }, to_world);
    // At (1, 2, 3), looking along +x.
    let moved = Mat4::from_rotation_translation(glam::Quat::from_rotation_y(-square), vec3(1.0, 2.0, 3.0));
    // At distance 2 a vertical view angle of 90° shows heights of ±2 over 30 rows.
    let high = perspective(Fov::Vertical(square), Mat4::IDENTITY);
    // The same angle across the width: ±2 over 40 columns.
    let wide = perspective(Fov::Horizontal(square), Mat4::IDENTITY);
    let turned = perspective(Fov::Horizontal(square), moved);
    let parallel = camera(Projection::Orthographic { half_height: 3.0 }, Mat4::IDENTITY);
    // −z in the middle, +x to the right, +y up, +z at the seam.
    let round = camera(Projection::Equirectangular, Mat4::IDENTITY);
    let off = [
        (&high, vec3(0.0, 0.0, -2.0), vec2(20.0, 15.0)),
        (&high, vec3(0.0, 2.0, -2.0), vec2(20.0, 0.0)),
        (&high, vec3(2.0, -1.0, -2.0), vec2(35.0, 22.5)),
        (&wide, vec3(1.0, 1.0, -2.0), vec2(30.0, 5.0)),
        (&turned, vec3(3.0, 2.0, 4.0), vec2(30.0, 15.0)),
        (&parallel, vec3(1.0, 1.0, -7.0), vec2(25.0, 10.0)),
        (&round, vec3(0.0, 0.0, -5.0), vec2(20.0, 15.0)),
        (&round, vec3(5.0, 0.0, 0.0), vec2(30.0, 15.0)),
        (&round, vec3(-5.0, 0.0, 0.0), vec2(10.0, 15.0)),
        (&round, vec3(0.0, 1.0, -1.0), vec2(20.0, 7.5)),
    ]
    .map(|(camera, p, pixel)| camera.project(p).map_or(f32::INFINITY, |film| (film - pixel).length()));
    found.checks.bound("known points, in pixels", off.into_iter().fold(0.0, f32::max).into(), 1e-4);
    let unseen = [high.project(Vec3::Z), high.project(Vec3::ZERO), round.project(Vec3::ZERO)];
    found.checks.holds("what is behind is not seen", unseen.iter().all(Option::is_none));
}

/// A point on the ray through a film point is seen at that film point.
fn round_trip(camera: &Camera, lens: Option<Lens>, trial: &Trial, found: &mut Findings) {
    let mut rng = Pcg64Mcg::seed_from_u64(trial.seed);
    let (mut worst, mut unit) = (0f32, 0f32);
    let eye = camera.ray(vec2(20.0, 15.0), [0.5; 2]).o;
    for _ in 0..trial.work(20_000, 400_000) {
        let film = vec2(0.5 + 39.0 * rng.random::<f32>(), 0.5 + 29.0 * rng.random::<f32>());
        let ray = camera.ray(film, [rng.random(), rng.random()]);
        // Where there is a lens, rays of a film point agree in the plane of focus only.
        let t = lens.map_or(10f32.powf(3.0 * rng.random::<f32>()), |lens| {
            (lens.focus_distance - (ray.o - eye).dot(camera.axis())) / ray.d.dot(camera.axis())
        });
        let found = camera.project(ray.at(t));
        worst = worst.max(found.map_or(f32::INFINITY, |found| (found - film).length()));
        unit = unit.max((ray.d.length() - 1.0).abs());
    }
    // Some last digits of a coordinate, at a distance of 1 from an eye 2 from the origin, over the size of a pixel there.
    let pixel = camera.pixel_solid_angle(20, 15).sqrt();
    let bound = if pixel > 0.0 { 1e-3 + 1e-6 / pixel } else { 1e-2 };
    found.checks.bound("point of a ray → its film point, in pixels", worst.into(), bound);
    found.checks.bound("unit directions", unit.into(), 1e-6);
}

/// tan of half the view angle, across and down.
fn half_window(fov: Fov) -> [f64; 2] {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    match fov {
        Fov::Vertical(angle) => [f64::from(0.5 * angle).tan() * aspect, f64::from(0.5 * angle).tan()],
        Fov::Horizontal(angle) => [f64::from(0.5 * angle).tan(), f64::from(0.5 * angle).tan() / aspect],
    }
}

/// Solid angles of all pixels sum to that of a rectangle of half-sides a, b at distance 1.
fn window(camera: &Camera, fov: Fov, found: &mut Findings) {
    let [a, b] = half_window(fov);
    let exact = 4.0 * (a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt()).asin();
    // The window's half-size is an f32.
    found.checks.bound("Σ Ω of pixels = Ω of the window", (total(camera) / exact - 1.0).abs(), 1e-6);
}

/// Σ of the pixels' solid angles.
fn total(camera: &Camera) -> f64 {
    (0..SIZE[0] * SIZE[1]).map(|i| camera.pixel_solid_angle(i % SIZE[0], i / SIZE[0])).sum()
}

/// Solid angle of a pixel, and flux through it, by rays uniform over it.
fn pixels(camera: &Camera, fov: Fov, trial: &Trial, found: &mut Findings) {
    let [a, b] = half_window(fov);
    let cell = [2.0 * a / f64::from(SIZE[0]), 2.0 * b / f64::from(SIZE[1])];
    for (k, [x, y]) in [[0, 0], [20, 15], [39, 3], [5, 29]].into_iter().enumerate() {
        let power = |exponent| {
            replicates(trial.seed.wrapping_add(k as u64), trial.work(256, 4096), |u| {
                let film = vec2(x as f32, y as f32) + Vec2::from(u);
                let cos = f64::from(camera.ray(film, [0.5; 2]).d.dot(camera.axis()));
                cos.powi(exponent) * cell[0] * cell[1]
            })
        };
        let corner = [f64::from(x) * cell[0] - a, f64::from(y) * cell[1] - b];
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
            .map(|[i, j]| DVec3::new(corner[0] + f64::from(i) * cell[0], corner[1] + f64::from(j) * cell[1], 1.0));
        // f32: a pixel's film point is known to 4e-6 of its size at x = 40, its cosine to 2e-7, to the fourth power.
        let rounding = 1e-5;
        let solid_angle = camera.pixel_solid_angle(x, y);
        found.checks.replicated(format!("Ω of pixel ({x}, {y}) by rays"), solid_angle, &power(3), rounding);
        found.checks.replicated(format!("cos⁴: flux of pixel ({x}, {y})"), lambert(&corners), &power(4), rounding);
    }
}

/// E/L = ½ Σ Θᵢ (Γᵢ·n) at the origin with normal +z of a polygon above the horizon, which runs counter-clockwise.
fn lambert(polygon: &[DVec3]) -> f64 {
    let edge = |i: usize| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let cross = a.cross(b);
        // Small angles from the sine.
        let angle = cross.length().atan2(a.dot(b));
        0.5 * angle * cross.z / cross.length()
    };
    (0..polygon.len()).map(edge).sum::<f64>().abs()
}

/// The whole sphere: solid angles by closed form and by the area that rays sweep.
fn sphere(camera: &Camera, trial: &Trial, found: &mut Findings) {
    found.checks.bound("Σ Ω of pixels = 4π", (total(camera) / (2.0 * TAU) - 1.0).abs(), 1e-12);
    let rows = (0..SIZE[1]).map(|y| {
        let cos = |y: u32| (PI * f64::from(y) / f64::from(SIZE[1])).cos();
        let exact = TAU / f64::from(SIZE[0]) * (cos(y) - cos(y + 1));
        (camera.pixel_solid_angle(7, y) / exact - 1.0).abs()
    });
    found.checks.bound("Ω = Δλ (cos θ₀ − cos θ₁)", rows.fold(0.0, f64::max), 1e-12);
    // Directions uniform on the sphere land in a pixel with probability Ω/4π.
    let mut rng = Pcg64Mcg::seed_from_u64(trial.seed ^ 2);
    let n = trial.work(400_000, 6_000_000);
    let eye = camera.ray(Vec2::ZERO, [0.5; 2]).o;
    let mut observed = vec![0.0; (SIZE[0] * SIZE[1]) as usize];
    let mut lost = 0;
    for _ in 0..n {
        let film = camera.project(eye + Vec3A::from(crate::warp::uniform_sphere([rng.random(), rng.random()])));
        match film.map(|film| film.max(Vec2::ZERO).as_uvec2()) {
            Some(p) => observed[(p.y.min(SIZE[1] - 1) * SIZE[0] + p.x.min(SIZE[0] - 1)) as usize] += 1.0,
            None => lost += 1,
        }
    }
    let share = |i: u32| camera.pixel_solid_angle(i % SIZE[0], i / SIZE[0]) / (2.0 * TAU);
    let expected: Vec<f64> = (0..SIZE[0] * SIZE[1]).map(|i| share(i) * f64::from(n)).collect();
    found.checks.holds("every direction is seen", lost == 0);
    found.checks.chi2("χ² of directions over pixels", chi2_test(&observed, &expected, 20.0));
    let (title, columns) = ("uniform directions over pixels".into(), SIZE[0] as usize);
    let axes = ["longitude", "latitude"];
    found.exhibits.push(Exhibit::HeatMap(HeatMap { title, axes, columns, observed, expected }));
}

/// Parallel rays have no solid angle, and all one direction.
fn parallel(camera: &Camera, found: &mut Findings) {
    let d = |x: f32, y: f32| camera.ray(vec2(x, y), [0.5; 2]).d;
    let worst = [[0.0, 0.0], [40.0, 0.0], [3.0, 30.0]].map(|[x, y]| (d(x, y) - camera.axis()).length());
    found.checks.bound("rays are parallel to the axis", worst.into_iter().fold(0.0, f32::max).into(), 1e-6);
    found.checks.holds("no solid angle", total(camera) == 0.0);
}

/// Lens points fill the disk evenly, and their rays meet where the chief ray crosses the plane in focus.
fn aperture(camera: &Camera, lens: Lens, trial: &Trial, found: &mut Findings) {
    const RINGS: usize = 10;
    const SECTORS: usize = 20;
    let mut rng = Pcg64Mcg::seed_from_u64(trial.seed ^ 3);
    let film = vec2(31.3, 4.6);
    let chief = camera.ray(film, [0.5; 2]);
    let focus = chief.o + chief.d * (lens.focus_distance / chief.d.dot(camera.axis()));
    let (s, t) = camera.axis().any_orthonormal_pair();
    let n = trial.work(200_000, 3_000_000);
    let (mut apart, mut off_plane, mut widest) = (0f32, 0f32, 0f32);
    let mut observed = vec![0.0; RINGS * SECTORS];
    for _ in 0..n {
        let ray = camera.ray(film, [rng.random(), rng.random()]);
        apart = apart.max((focus - ray.o).cross(ray.d).length());
        let p = ray.o - chief.o;
        off_plane = off_plane.max(p.dot(camera.axis()).abs());
        let p = vec2(p.dot(s), p.dot(t)) / lens.radius;
        widest = widest.max(p.length());
        let ring = (p.length_squared() * RINGS as f32) as usize;
        let sector = (f64::from(p.y).atan2(p.x.into()).rem_euclid(TAU) / TAU * SECTORS as f64) as usize;
        observed[ring.min(RINGS - 1) * SECTORS + sector.min(SECTORS - 1)] += 1.0;
    }
    let expected = vec![f64::from(n) / (RINGS * SECTORS) as f64; RINGS * SECTORS];
    found.checks.chi2("χ² of the points of the lens", chi2_test(&observed, &expected, 20.0));
    found.checks.bound("rays pass the focus", apart.into(), 1e-5);
    found.checks.bound("lens points lie in the lens", off_plane.max(widest - 1.0).into(), 1e-5);
    let (title, axes) = ("points of the lens".into(), ["angle", "r²"]);
    found.exhibits.push(Exhibit::HeatMap(HeatMap { title, axes, columns: SECTORS, observed, expected }));
}
