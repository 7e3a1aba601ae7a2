//! Lights against closed forms (VERIFICATION L1–L6), their densities against their samples, and the choice among them.

#[path = "light/density.rs"]
mod density;
#[path = "light/irradiance.rs"]
mod irradiance;

use radianza::bsdf::Pdf;
use radianza::desc::{self, ColorParam, Emission, Sides};
use radianza::glam::{Mat3, Mat4, Quat, Vec2, Vec3, Vec4};
use radianza::light::{Environment, Light, Lights, QuadricLight, TriangleLight};
use radianza::math::{Transform, safe_sqrt};
use radianza::shape::{PlacedQuadric, Quadric, TriangleAttributes};
use radianza::spectrum::Spectrum;
use radianza::stats::{Family, Moments, chi2_test};
use radianza::texture::Textures;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Uniform grey emission of radiance 1.
fn emission(sides: Sides) -> Emission {
    Emission { radiance: ColorParam::constant([1.0; 3]), sides }
}

fn triangle(p: [Vec3; 3], sides: Sides) -> Light {
    let light = TriangleLight::new(p, &TriangleAttributes::default(), false, &emission(sides));
    Light::Triangle(light.expect("a triangle with an area"))
}

fn quadric(quadric: Quadric, to_world: Mat4, sides: Sides) -> Light {
    let transform = Transform::from_mat4(to_world).expect("an invertible map");
    Light::Quadric(Box::new(QuadricLight::new(PlacedQuadric::new(quadric, transform, false), &emission(sides))))
}

fn environment(radiance: f32, image: Option<desc::Image>, to_world: Mat3) -> Light {
    let written = desc::Environment { radiance: [radiance; 3], image: image.as_ref().map(|_| 0), to_world };
    Light::Environment(Box::new(Environment::new(&written, image.as_ref())))
}

/// Directions of a specimen-like random pose.
fn random_direction(rng: &mut Pcg64Mcg) -> Vec3 {
    let z = 1.0 - 2.0 * rng.random::<f32>();
    let (sin, cos) = (std::f32::consts::TAU * rng.random::<f32>()).sin_cos();
    let rho = safe_sqrt(1.0 - z * z);
    Vec3::new(rho * cos, rho * sin, z)
}

fn solid_angle_pdf(pdf: Pdf) -> Option<f32> {
    match pdf {
        Pdf::SolidAngle(pdf) => Some(pdf),
        Pdf::Discrete(_) => None,
    }
}

/// Lights of very different powers, some black.
fn a_few_lights() -> Vec<Light> {
    let point = |z: f32, intensity: f32| {
        Light::from_desc(&desc::Light::Point { position: Vec3::new(0.3, 0.1, z), intensity: [intensity; 3] })
    };
    let sun = desc::Light::Directional { direction: Vec3::new(0.6, 0.0, -0.8), irradiance: [0.3; 3] };
    let disk = Quadric::Disk { radius: 0.5 };
    let facing_down = Mat4::from_rotation_translation(Quat::from_rotation_x(std::f32::consts::PI), Vec3::Z);
    vec![
        point(2.0, 0.7),
        point(1.0, 0.0),
        Light::from_desc(&sun),
        quadric(disk, facing_down, Sides::Front),
        environment(0.1, None, Mat3::IDENTITY),
        point(0.3, 1e-4),
        environment(0.2, None, Mat3::IDENTITY),
        triangle([Vec3::new(-1.0, 0.0, 1.0), Vec3::new(-1.0, 1.0, 1.0), Vec3::new(-2.0, 0.0, 1.0)], Sides::Both),
    ]
}

/// χ² of the light chosen against the probabilities stated; black lights are never chosen.
#[test]
fn the_choice_follows_its_probabilities() {
    let lights = Lights::new(a_few_lights(), (Vec3::ZERO, 3.0), &Textures::default());
    let count = lights.all().len();
    let choices: Vec<f64> = (0..count as u32).map(|i| f64::from(lights.choice(i))).collect();
    assert_eq!(choices.iter().sum::<f64>(), 1.0);
    assert_eq!(choices[1], 0.0);
    assert!(choices.iter().enumerate().all(|(i, &p)| i == 1 || p > 1e-3), "{choices:?}");

    // From above everything every light is seen but those that face down: count through the sample.
    let (mut rng, n) = (Pcg64Mcg::new(5), 1_000_000);
    let mut chosen = vec![0.0; count];
    for _ in 0..n {
        let u = [rng.random(), rng.random()];
        if let Some((i, _)) = lights.sample(Vec3::ZERO, rng.random(), u, &Textures::default()) {
            chosen[i as usize] += 1.0;
        }
    }
    let expected: Vec<f64> = choices.iter().map(|p| p * f64::from(n)).collect();
    let mut family = Family::new("choice of a light");
    family.p("by power", chi2_test(&chosen, &expected, 5.0).p);
    family.assert();
}

/// Irradiance from all lights at once is the sum of their closed forms.
#[test]
fn all_lights_together_give_the_sum() {
    let lights = Lights::new(a_few_lights(), (Vec3::ZERO, 3.0), &Textures::default());
    let point = |z: f64, intensity: f64| {
        let r2: f64 = 0.3 * 0.3 + 0.1 * 0.1 + z * z;
        intensity * z / r2.powf(1.5)
    };
    let pi = std::f64::consts::PI;
    let patch = [Vec3::new(-1.0, 0.0, 1.0), Vec3::new(-1.0, 1.0, 1.0), Vec3::new(-2.0, 0.0, 1.0)];
    let exact = point(2.0, 0.7)
        + 0.3 * 0.8
        + pi * 0.25 / (0.25 + 1.0)
        + pi * 0.1
        + point(0.3, 1e-4)
        + pi * 0.2
        + irradiance::polygon(&patch.map(|p| p.as_dvec3()), Vec3::Z.as_dvec3());
    let mut rng = Pcg64Mcg::new(6);
    let estimate: Moments = (0..4_000_000)
        .map(|_| {
            let u = [rng.random(), rng.random()];
            let Some((_, s)) = lights.sample(Vec3::ZERO, rng.random(), u, &Textures::default()) else { return 0.0 };
            let (Pdf::SolidAngle(p) | Pdf::Discrete(p)) = s.pdf;
            f64::from(s.le.0.x * s.wi.z.max(0.0) / p)
        })
        .collect();
    let mut family = Family::new("all lights");
    // The disk's z = 0 plane was turned by π in f32: 1e-7.
    family.rounded("sum of closed forms", exact, estimate.mean(), estimate.standard_error(), 1e-6);
    family.assert();
}

/// No lights, and lights that are all black.
#[test]
fn darkness_is_empty() {
    let textures = Textures::default();
    let black = Light::from_desc(&desc::Light::Point { position: Vec3::ZERO, intensity: [0.0; 3] });
    for lights in [vec![], vec![black.clone(), black]] {
        let lights = Lights::new(lights, (Vec3::ZERO, 1.0), &textures);
        assert!(lights.is_empty());
        assert!(lights.sample(Vec3::ONE, 0.5, [0.5; 2], &textures).is_none());
        assert_eq!(lights.environment_le(Vec3::X), Spectrum::ZERO);
        assert_eq!(lights.environment_pdf(Vec3::X), 0.0);
        assert_eq!(lights.total_power(), Spectrum::ZERO);
    }
}

/// `pdf_hit` and `environment_pdf` are what `sample` said, the choice included.
#[test]
fn densities_include_the_choice() {
    let textures = Textures::default();
    let lights = Lights::new(a_few_lights(), (Vec3::ZERO, 3.0), &textures);
    let mut rng = Pcg64Mcg::new(8);
    for _ in 0..10_000 {
        let u = [rng.random(), rng.random()];
        let Some((i, s)) = lights.sample(Vec3::ZERO, rng.random(), u, &textures) else { continue };
        let Some(pdf) = solid_angle_pdf(s.pdf) else { continue };
        let light = &lights.all()[i as usize];
        let expected = match light {
            Light::Environment(_) => lights.environment_pdf(s.wi),
            _ => match light.intersect(&radianza::math::Ray::new(Vec3::ZERO, s.wi)) {
                Some((_, hit)) => lights.pdf_hit(i, Vec3::ZERO, hit.p, hit.ng),
                None => continue,
            },
        };
        assert!((pdf / expected - 1.0).abs() < 1e-4, "{pdf} {expected} of {light:?}");
    }
}

/// Two environments are one for whoever meets both.
#[test]
fn environments_add_up() {
    let textures = Textures::default();
    let image = desc::Image {
        name: "half".into(),
        size: [2, 1],
        pixels: desc::Pixels::Rgba32F(vec![[0.0, 0.0, 0.0, 1.0], [3.0, 3.0, 3.0, 1.0]]),
    };
    let both = vec![environment(0.5, None, Mat3::IDENTITY), environment(1.0, Some(image), Mat3::IDENTITY)];
    let lights = Lights::new(both, (Vec3::ZERO, 1.0), &textures);
    // The brighter half of the image is the right one, towards +x.
    assert_eq!(lights.environment_le(Vec3::X), Spectrum::splat(3.5));
    assert_eq!(lights.environment_le(-Vec3::X), Spectrum::splat(0.5));
    let mut rng = Pcg64Mcg::new(9);
    for _ in 0..1000 {
        let u = [rng.random(), rng.random()];
        let (_, s) = lights.sample(Vec3::ZERO, rng.random(), u, &textures).expect("light from everywhere");
        assert_eq!(s.le, lights.environment_le(s.wi));
        assert_eq!(s.pdf, Pdf::SolidAngle(lights.environment_pdf(s.wi)));
    }
}

/// Flux: closed forms of area lights, and the spot's fall-off integrated by sampling.
#[test]
fn powers_are_the_integrals_of_what_is_emitted() {
    let none = |_: usize| Vec4::ONE;
    let power = |light: &Light| f64::from(light.power(2.0, &none).0.x);
    let pi = std::f64::consts::PI;
    let sphere = quadric(Quadric::Sphere { radius: 2.0 }, Mat4::IDENTITY, Sides::Front);
    let sheet = triangle([Vec3::ZERO, Vec3::X, Vec3::Y], Sides::Both);
    for (light, exact) in [
        (&sphere, 16.0 * pi * pi),
        (&sheet, pi),
        (&environment(3.0, None, Mat3::IDENTITY), 3.0 * 4.0 * pi * 4.0 * pi),
        (&Light::from_desc(&desc::Light::Point { position: Vec3::ZERO, intensity: [2.0; 3] }), 8.0 * pi),
    ] {
        assert!((power(light) / exact - 1.0).abs() < 1e-6, "{} is not {exact}", power(light));
    }

    let mut family = Family::new("flux of spots");
    let mut rng = Pcg64Mcg::new(10);
    for (inner, outer) in [(0.0, 1.0), (0.5, 0.9), (0.7, 0.7), (1.5, 3.1)] {
        let spot = Light::from_desc(&desc::Light::Spot {
            position: Vec3::ZERO,
            direction: Vec3::Y,
            intensity: [2.0; 3],
            inner,
            outer,
        });
        let flux: Moments = (0..400_000)
            .map(|_| {
                let sample = spot.sample(random_direction(&mut rng), [0.5; 2], &Textures::default());
                4.0 * pi * sample.map_or(0.0, |s| f64::from(s.le.0.x))
            })
            .collect();
        family.rounded(format!("{inner} to {outer}"), power(&spot), flux.mean(), flux.standard_error(), 1e-6);
    }
    family.assert();
}

/// Texture and vertex colour: light sampling agrees with meeting the triangle along cosine-weighted directions, and
/// the power with the mean.
#[test]
fn textured_emission() {
    let texture = desc::TextureRef { texture: 0, uv_set: 1, transform: radianza::glam::Affine2::IDENTITY };
    let scene = desc::Scene {
        textures: vec![desc::Texture::Checker { even: [1.0, 0.2, 0.0], odd: [0.0, 0.6, 2.0], scale: [3.0, 2.0] }],
        ..desc::Scene::default()
    };
    let textures = Textures::new(&scene);
    let emission = Emission {
        radiance: ColorParam { factor: [2.0, 1.0, 0.5], texture: Some(texture), vertex_color: true },
        sides: Sides::Front,
    };
    let attributes = TriangleAttributes {
        uv: [None, Some([Vec2::ZERO, Vec2::X, Vec2::Y])],
        colors: Some([Vec4::ONE, Vec4::splat(0.5), Vec4::new(0.0, 1.0, 0.0, 1.0)]),
        ..TriangleAttributes::default()
    };
    let mut family = Family::new("textured emission");
    for (name, height) in [("near", 0.4), ("far", 5.0)] {
        let p = [Vec3::new(1.0, -0.5, height), Vec3::new(-1.0, -1.0, height), Vec3::new(0.2, 1.5, height)];
        let light = TriangleLight::new(p, &attributes, false, &emission).expect("a triangle with an area");
        let light = Light::Triangle(light);
        irradiance::two_estimators(&mut family, name, &light, (Vec3::ZERO, Vec3::Z), None, &textures);
    }
    family.assert();
}
