//! Irradiance of each light against its closed form, by sampling the light and by sampling the hemisphere.

use super::*;
use radianza::glam::DVec3;
use radianza::math::{Frame, Ray};
use radianza::warp::cosine_hemisphere;
use std::f64::consts::{PI, TAU};

/// Irradiance at the origin with normal `n` of a polygon of radiance 1, either side, clipped at the horizon:
/// E = ½ Σᵢ Θᵢ Γᵢ·n with Θᵢ the angle of edge i and Γᵢ the unit normal of its plane (Lambert 1760; Arvo 1995).
pub(crate) fn polygon(vertices: &[DVec3], n: DVec3) -> f64 {
    let mut clipped = Vec::new();
    for (i, &a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        let (ha, hb) = (a.dot(n), b.dot(n));
        if ha >= 0.0 {
            clipped.push(a);
        }
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            clipped.push(a.lerp(b, ha / (ha - hb)));
        }
    }
    let edge = |i: usize| {
        let (a, b) = (clipped[i], clipped[(i + 1) % clipped.len()]);
        a.angle_between(b) * a.cross(b).normalize_or_zero().dot(n)
    };
    0.5 * (0..clipped.len()).map(edge).sum::<f64>().abs()
}

/// Irradiance estimated from samples of the light, one lane.
fn by_light(light: &Light, p: Vec3, n: Vec3, textures: &Textures, count: u32, seed: u64) -> Moments {
    let mut rng = Pcg64Mcg::new(seed.into());
    let estimate = |_| {
        let Some(s) = light.sample(p, [rng.random(), rng.random()], textures) else { return 0.0 };
        let (Pdf::SolidAngle(pdf) | Pdf::Discrete(pdf)) = s.pdf;
        f64::from(s.le.0.x) * f64::from(n.dot(s.wi).max(0.0)) / f64::from(pdf)
    };
    (0..count).map(estimate).collect()
}

/// Irradiance estimated from cosine-weighted directions that meet the light, one lane; front and back of a surface
/// count as a viewer in vacuum would see them, the nearer first.
fn by_hemisphere(light: &Light, p: Vec3, n: Vec3, textures: &Textures, count: u32, seed: u64) -> Moments {
    let (mut rng, frame) = (Pcg64Mcg::new(seed.into()), Frame::from_z(n));
    let estimate = |_| {
        let wi = frame.to_world(cosine_hemisphere([rng.random(), rng.random()]));
        let le = match light {
            Light::Environment(environment) => environment.le(wi),
            _ => light
                .intersect(&Ray::new(p, wi))
                .map_or(Spectrum::ZERO, |(_, hit)| light.le(&hit.uv, hit.color, wi.dot(hit.ng) < 0.0, textures)),
        };
        PI * f64::from(le.0.x)
    };
    (0..count).map(estimate).collect()
}

/// As many samples as a relative standard error asks for, by an independent pilot run.
fn enough(relative: f64, estimate: impl Fn(u32, u64) -> Moments, seed: u64) -> Moments {
    let pilot = estimate(20_000, seed ^ 0x5555);
    let count = pilot.variance() / (relative * pilot.mean()).powi(2);
    estimate(count.clamp(1e4, 6e6) as u32, seed)
}

/// Both estimators of the irradiance at `p` with normal `n` against the exact value, or against each other where there
/// is none. The first finds a bias of half a percent, the second, whose variance is that of the light's size, of two.
pub(crate) fn two_estimators(
    family: &mut Family,
    name: &str,
    light: &Light,
    (p, n): (Vec3, Vec3),
    exact: Option<f64>,
    textures: &Textures,
) {
    let seed = family.checks().len() as u64 * 7919 + 1;
    let a = enough(7e-4, |count, seed| by_light(light, p, n, textures, count, seed), seed);
    let b = enough(3e-3, |count, seed| by_hemisphere(light, p, n, textures, count, seed), seed + 1);
    match exact {
        // The arithmetic of a sample is right to some roundings of f32.
        Some(exact) => {
            family.rounded(format!("{name}, light"), exact, a.mean(), a.standard_error(), 2e-6);
            family.rounded(format!("{name}, hemisphere"), exact, b.mean(), b.standard_error(), 2e-6);
        }
        None => family.equal(format!("{name}, light = hemisphere"), &a, &b),
    }
}

fn check(family: &mut Family, name: &str, light: &Light, p: Vec3, n: Vec3, exact: Option<f64>) {
    two_estimators(family, name, light, (p, n), exact, &Textures::default());
}

/// L1 (E = I cos θ/r²), and the spot with the fall-off of KHR_lights_punctual, and parallel light.
#[test]
fn l1_point_spot_directional() {
    let mut family = Family::new("L1 point, spot, directional");
    let mut rng = Pcg64Mcg::new(1);
    for i in 0..20 {
        let scale = 10f32.powi(i % 7 - 3);
        let (position, p) = (random_direction(&mut rng) * scale, random_direction(&mut rng) * scale * 0.7);
        let (n, direction) = (random_direction(&mut rng), random_direction(&mut rng));
        let to = position.as_dvec3() - p.as_dvec3();
        let cos = to.normalize().dot(n.as_dvec3()).max(0.0);
        let intensity = [2.0; 3];
        let (inner, outer) = (0.5, 2.5);
        let c = -to.normalize().dot(direction.as_dvec3());
        let (ci, co) = (f64::from(inner).cos(), f64::from(outer).cos());
        let falloff = ((c - co) / (ci - co)).clamp(0.0, 1.0).powi(2);
        let e = 2.0 * cos / to.length_squared();
        let parallel = 2.0 * (-n.dot(direction)).max(0.0) as f64;
        for (name, light, exact) in [
            ("point", desc::Light::Point { position, intensity }, e),
            ("spot", desc::Light::Spot { position, direction, intensity, inner, outer }, e * falloff),
            ("directional", desc::Light::Directional { direction, irradiance: intensity }, parallel),
        ] {
            let estimate = by_light(&Light::from_desc(&light), p, n, &Textures::default(), 2, 0);
            // Nothing random is left: agreement to the rounding that the cosines amplify.
            family.rounded(format!("{name} {i}"), exact, estimate.mean(), estimate.standard_error(), 2e-5);
        }
    }
    family.assert();
}

/// L2: triangles at random poses, among them ones that dip below the horizon.
#[test]
fn l2_polygons_clipped_at_the_horizon() {
    let mut family = Family::new("L2 polygonal lights");
    let mut rng = Pcg64Mcg::new(2);
    let mut clipped = 0;
    while family.checks().len() < 36 {
        let centre = random_direction(&mut rng) * (0.3 + 1.2 * rng.random::<f32>());
        let corners = [(); 3].map(|()| centre + random_direction(&mut rng));
        let n = Vec3::Z;
        let exact = polygon(&corners.map(|p| p.as_dvec3()), n.as_dvec3());
        if exact < 0.05 {
            continue;
        }
        let dips = corners.iter().any(|p| p.z < 0.0);
        clipped += u32::from(dips);
        let name = format!("triangle {}{}", family.checks().len() / 2, if dips { ", clipped" } else { "" });
        // The exact value is of both sides; only one is seen.
        check(&mut family, &name, &triangle(corners, Sides::Both), Vec3::ZERO, n, Some(exact));
    }
    assert!(clipped >= 6, "{clipped} clipped poses");
    family.assert();
}

/// L2 where the plain Arvo formula meets f32: very large, very small, far and almost touching.
#[test]
fn l2_polygons_at_every_scale() {
    let mut family = Family::new("L2 polygonal lights at every scale");
    let shape = [Vec3::new(-1.0, -0.8, 0.0), Vec3::new(1.2, -0.7, 0.0), Vec3::new(0.1, 0.9, 0.0)];
    for (name, size, p) in [
        ("1 mm", 1e-3, Vec3::new(0.2, 0.1, 0.5)),
        ("1000 km", 1e6, Vec3::new(0.2, 0.1, 0.5)),
        ("almost touching", 1.0, Vec3::new(0.1, -0.1, 0.003)),
        ("touching at 10 km", 1e4, Vec3::new(0.1, -0.1, 1e-4)),
        ("afar", 1.0, Vec3::new(3.0, -4.0, 200.0)),
        ("grazing", 1.0, Vec3::new(2.5, 0.3, 0.01)),
    ] {
        let corners = shape.map(|x| x * size);
        let p = p * size;
        let n = Vec3::new(-0.48, 0.0, -0.877_268_5).normalize();
        let exact = polygon(&corners.map(|x| x.as_dvec3() - p.as_dvec3()), n.as_dvec3());
        let light = triangle(corners, Sides::Front);
        let estimate = enough(7e-4, |count, seed| by_light(&light, p, n, &Textures::default(), count, seed), 3);
        family.rounded(name, exact, estimate.mean(), estimate.standard_error(), 1e-5);
    }
    family.assert();
}

/// L3: E = π L R²/(R² + h²) for a disk parallel to the receiver on its axis.
#[test]
fn l3_disk() {
    let mut family = Family::new("L3 disk");
    for (radius, h) in [(0.5f32, 1.0f32), (2.0, 0.7), (30.0, 10.0)] {
        let n = Vec3::new(0.36, -0.48, 0.8);
        let turn = Quat::from_rotation_arc(Vec3::Z, -n);
        let to_world = Mat4::from_rotation_translation(turn, n * h);
        let light = quadric(Quadric::Disk { radius }, to_world, Sides::Front);
        let exact = PI * f64::from(radius).powi(2) / (f64::from(radius).powi(2) + f64::from(h).powi(2));
        check(&mut family, &format!("R {radius}, h {h}"), &light, Vec3::ZERO, n, Some(exact));
    }
    // A tilted ellipse has no such form: two estimators, one integral.
    let tilted = Mat4::from_scale_rotation_translation(
        Vec3::new(1.0, 0.4, -1.0),
        Quat::from_rotation_x(0.6),
        Vec3::new(0.3, 0.2, 1.0),
    );
    let light = quadric(Quadric::Disk { radius: 1.0 }, tilted, Sides::Both);
    check(&mut family, "tilted ellipse", &light, Vec3::ZERO, Vec3::Z, None);
    family.assert();
}

/// L4: E = π L (R/d)² cos θ for a sphere above the horizon; πL from inside, for an ellipsoid too.
#[test]
fn l4_sphere() {
    let mut family = Family::new("L4 sphere");
    let sphere = |radius: f32, centre: Vec3| {
        let to_world = Mat4::from_rotation_translation(Quat::from_rotation_y(1.0), centre);
        quadric(Quadric::Sphere { radius }, to_world, Sides::Both)
    };
    for (name, radius, centre) in [
        ("R 0.7, d 2", 0.7f32, Vec3::new(0.0, 0.0, 2.0)),
        ("oblique", 1.0, Vec3::new(0.8, -0.9, 1.3)),
        ("almost touching", 1.0, Vec3::new(0.0, 0.0, 1.001)),
        ("on the horizon", 1.0, Vec3::new(3.0, 0.0, 1.01)),
    ] {
        let d = centre.as_dvec3();
        let exact = PI * f64::from(radius).powi(2) / d.length_squared() * (d.z / d.length());
        check(&mut family, name, &sphere(radius, centre), Vec3::ZERO, Vec3::Z, Some(exact));
    }
    for (name, radius, distance) in [("sun", 7e8f32, 1.5e11f32), ("1 nm at 1 m", 1e-9, 1.0), ("far", 1e-3, 1e6)] {
        let n = Vec3::new(0.6, 0.0, 0.8);
        let light = sphere(radius, Vec3::Z * distance);
        let estimate = by_light(&light, Vec3::ZERO, n, &Textures::default(), 10_000, 4);
        let exact = PI * (f64::from(radius) / f64::from(distance)).powi(2) * 0.8;
        // Directions across so small a sphere differ by less than the rounding of f32.
        family.rounded(name, exact, estimate.mean(), estimate.standard_error(), 1e-6);
    }
    let n = Vec3::new(0.6, 0.0, 0.8);
    let ellipsoid = Mat4::from_scale(Vec3::new(1.0, 2.0, 0.7));
    let p = Vec3::new(0.3, -0.4, 0.2);
    check(&mut family, "from inside", &sphere(1.0, Vec3::ZERO), p, n, Some(PI));
    let light = quadric(Quadric::Sphere { radius: 1.0 }, ellipsoid, Sides::Both);
    check(&mut family, "ellipsoid from inside", &light, p, n, Some(PI));
    let light = quadric(Quadric::Sphere { radius: 1.0 }, ellipsoid, Sides::Front);
    let outside = Vec3::new(1.5, -2.0, -1.0);
    check(&mut family, "ellipsoid from outside", &light, outside, -outside.normalize(), None);
    let cylinder = Quadric::Cylinder { radius: 0.5, height: 2.0 };
    let light = quadric(cylinder, Mat4::from_translation(Vec3::new(0.5, 1.0, -0.5)), Sides::Front);
    check(&mut family, "cylinder", &light, Vec3::ZERO, Vec3::new(0.6, 0.8, 0.0), None);
    family.assert();
}

/// L5: E = π L₀ in a uniform environment, as a constant and as an image of equal texels.
#[test]
fn l5_uniform_environment() {
    let mut family = Family::new("L5 uniform environment");
    let white = |size: [u32; 2]| desc::Image {
        name: "white".into(),
        size,
        pixels: desc::Pixels::Rgba32F(vec![[1.0; 4]; (size[0] * size[1]) as usize]),
    };
    let n = Vec3::new(0.48, 0.6, -0.64);
    let turned = Mat3::from_quat(Quat::from_rotation_x(0.8));
    for (name, image) in [("constant", None), ("8×4", Some([8, 4])), ("3×1", Some([3, 1])), ("1×64", Some([1, 64]))]
    {
        let light = environment(1.5, image.map(white), turned);
        check(&mut family, name, &light, Vec3::ZERO, n, Some(1.5 * PI));
    }
    family.assert();
}

/// Irradiance on a receiver with normal `n` (local) from texel (column, row) of radiance 1, wholly above its horizon:
/// n·∫ω dω, with ∫ω dω over Δφ × Δθ in closed form.
fn texel_irradiance([width, height]: [u32; 2], column: u32, row: u32, n: DVec3) -> f64 {
    let phi = |c: u32| TAU * (f64::from(c) / f64::from(width) - 0.5);
    let theta = |r: u32| PI * f64::from(r) / f64::from(height);
    let (p0, p1, t0, t1) = (phi(column), phi(column + 1), theta(row), theta(row + 1));
    // ∫ sin² θ dθ and ∫ sin θ cos θ dθ.
    let sin2 = 0.5 * (t1 - t0) - 0.25 * ((2.0 * t1).sin() - (2.0 * t0).sin());
    let sin_cos = 0.5 * (t1.sin().powi(2) - t0.sin().powi(2));
    n.dot(DVec3::new(sin2 * (p0.cos() - p1.cos()), sin_cos * (p1 - p0), -sin2 * (p1.sin() - p0.sin())))
}

/// L6: one bright texel over a dim rest, at the poles and elsewhere, turned: E = (L − L_b) n·∫ω dω + π L_b.
#[test]
fn l6_one_bright_texel() {
    let mut family = Family::new("L6 one bright texel");
    let size = [16u32, 8];
    let rotation = Mat3::from_quat(Quat::from_axis_angle(Vec3::new(1.0, -2.0, 0.5).normalize(), 2.0));
    for (column, row, rest) in [(8, 3, 0.0), (3, 0, 0.0), (15, 7, 0.0), (0, 5, 0.1), (11, 0, 0.3), (7, 7, 0.01)] {
        let bright = row * size[0] + column;
        let pixel = |i: u32| if i == bright { [200.0, 0.0, 0.0, 1.0] } else { [rest, 0.0, 0.0, 1.0] };
        let image = desc::Image {
            name: "texel".into(),
            size,
            pixels: desc::Pixels::Rgba32F((0..size[0] * size[1]).map(pixel).collect()),
        };
        // The receiver faces the texel obliquely: all of it is above the horizon.
        let theta = std::f32::consts::PI * (row as f32 + 0.5) / size[1] as f32;
        let phi = std::f32::consts::TAU * ((column as f32 + 0.5) / size[0] as f32 - 0.5);
        let towards = Vec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos());
        let local = (towards + 0.5 * towards.any_orthonormal_vector()).normalize();
        let n = (rotation * local).normalize();
        let local = (rotation.transpose() * n).as_dvec3();
        let rest = f64::from(rest);
        let exact = (200.0 - rest) * texel_irradiance(size, column, row, local) + PI * rest;
        let light = environment(1.0, Some(image), rotation);
        let name = format!("texel ({column}, {row}), rest {rest}");
        check(&mut family, &name, &light, Vec3::ZERO, n, Some(exact));
    }
    family.assert();
}

/// The picture is the right way round: the middle looks along −z, the top is +y, columns grow towards +x.
#[test]
fn environment_images_are_oriented() {
    // Red in the middle column, green right of it, blue on the top row, white at the bottom; the rest is black.
    let pixel = |i: u32| match (i % 5, i / 5) {
        (_, 0) => [0.0, 0.0, 1.0, 1.0],
        (_, 4) => [1.0; 4],
        (2, _) => [1.0, 0.0, 0.0, 1.0],
        (3, _) => [0.0, 1.0, 0.0, 1.0],
        _ => [0.0, 0.0, 0.0, 1.0],
    };
    let image = desc::Image {
        name: "compass".into(),
        size: [5, 5],
        pixels: desc::Pixels::Rgba32F((0..25).map(pixel).collect()),
    };
    let turn = Mat3::from_rotation_y(0.4);
    let Light::Environment(light) = environment(1.0, Some(image), turn) else { unreachable!() };
    let rgb = |w: Vec3| light.le(turn * w).to_rgb();
    assert_eq!(rgb(Vec3::NEG_Z), [1.0, 0.0, 0.0]);
    assert_eq!(rgb(Vec3::X), [0.0, 1.0, 0.0]);
    assert_eq!(rgb(Vec3::NEG_X), [0.0, 0.0, 0.0]);
    assert_eq!(rgb(Vec3::Z), [0.0, 0.0, 0.0]);
    assert_eq!(rgb(Vec3::Y), [0.0, 0.0, 1.0]);
    assert_eq!(rgb(Vec3::NEG_Y), [1.0, 1.0, 1.0]);
}

/// 8-bit pictures are sRGB; numbers that no radiance can have count as 0.
#[test]
fn environment_pixels_are_decoded() {
    let image = |pixels| desc::Image { name: "one".into(), size: [1, 1], pixels };
    let le = |pixels| match environment(2.0, Some(image(pixels)), Mat3::IDENTITY) {
        Light::Environment(light) => light.le(Vec3::X).to_rgb(),
        _ => unreachable!(),
    };
    let [r, g, b] = le(desc::Pixels::Rgba8(vec![[255, 0, 188, 9]]));
    assert!((r, g) == (2.0, 0.0) && (b - 2.0 * 0.502_886_5).abs() < 1e-5, "{b}");
    assert_eq!(le(desc::Pixels::Rgba32F(vec![[f32::NAN, f32::INFINITY, -1.0, 1.0]])), [0.0; 3]);
}
