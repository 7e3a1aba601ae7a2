//! Lights: darkness, environments that add up, pictures the right way round, flux. Irradiance, densities and choice are
//! rows of the battery.

use radianza::bsdf::Pdf;
use radianza::desc::{self, ColorParam, Emission, Sides};
use radianza::glam::{Mat3, Mat4, Vec3, Vec3A};
use radianza::light::{
    Emitter, Environment, Facing, Light, LightSampleContext, LightSampler, Lights, QuadricLight, TriangleLight,
};
use radianza::math::Transform;
use radianza::shape::{PlacedQuadric, Quadric, TriangleAttributes};
use radianza::spectrum::Spectrum;
use radianza::texture::Textures;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

fn environment(radiance: f32, image: Option<desc::Image>, to_world: Mat3) -> Light {
    let written = desc::Environment { radiance: [radiance; 3], image: image.as_ref().map(|_| 0), to_world };
    Light::Environment(Box::new(Environment::new(&written, image.as_ref())))
}

/// No lights, and lights that are all black.
#[test]
fn darkness_is_empty() {
    let textures = Textures::default();
    let black =
        Light::from_desc(&desc::Light::Point { position: Vec3::ZERO, intensity: [0.0; 3], range: f32::INFINITY });
    for lights in [vec![], vec![black.clone(), black]] {
        let lights = Lights::new(lights, (Vec3::ZERO, 1.0), &textures);
        assert!(lights.is_empty());
        assert!(lights.sample(&LightSampleContext::anywhere(Vec3::ONE), 0.5, [0.5; 2], &textures).is_none());
        assert_eq!(lights.environment_le(Vec3A::X), Spectrum::ZERO);
        assert_eq!(lights.environment_pdf(&LightSampleContext::anywhere(Vec3::ZERO), Vec3A::X), 0.0);
        assert_eq!(lights.total_power(), Spectrum::ZERO);
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
    assert_eq!(lights.environment_le(Vec3A::X), Spectrum::splat(3.5));
    assert_eq!(lights.environment_le(-Vec3A::X), Spectrum::splat(0.5));
    let mut rng = Pcg64Mcg::new(9);
    for _ in 0..1000 {
        let u = [rng.random(), rng.random()];
        let (_, s) = lights
            .sample(&LightSampleContext::anywhere(Vec3::ZERO), rng.random(), u, &textures)
            .expect("light from everywhere");
        assert_eq!(s.le, lights.environment_le(s.wi));
        assert_eq!(s.pdf, Pdf::SolidAngle(lights.environment_pdf(&LightSampleContext::anywhere(Vec3::ZERO), s.wi)));
    }
}

/// Flux of area lights and of light from infinity in closed form.
#[test]
fn powers_are_the_integrals_of_what_is_emitted() {
    let pi = std::f64::consts::PI;
    let emitter = |sides| Emitter::new(&Emission { radiance: ColorParam::constant([1.0; 3]), sides, coat: None });
    let identity = Transform::from_mat4(Mat4::IDENTITY).expect("invertible");
    let sphere = PlacedQuadric::new(Quadric::Sphere { radius: 2.0 }, identity, false);
    let sphere = Light::Quadric(Box::new(QuadricLight::new(sphere, emitter(Sides::Front))));
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let sheet = TriangleLight::new(corners, &TriangleAttributes::default(), false, emitter(Sides::Both));
    let sheet = Light::Triangle(sheet.expect("a triangle with an area"));
    for (light, exact) in [
        (&sphere, 16.0 * pi * pi),
        (&sheet, pi),
        (&environment(3.0, None, Mat3::IDENTITY), 3.0 * 4.0 * pi * 4.0 * pi),
        (
            &Light::from_desc(&desc::Light::Point { position: Vec3::ZERO, intensity: [2.0; 3], range: f32::INFINITY }),
            8.0 * pi,
        ),
    ] {
        let power = f64::from(light.power(2.0).0.x);
        assert!((power / exact - 1.0).abs() < 1e-6, "{power} is not {exact}");
    }
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
    let rgb = |w: Vec3| light.le((turn * w).into()).to_rgb();
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
        Light::Environment(light) => light.le(Vec3A::X).to_rgb(),
        _ => unreachable!(),
    };
    let [r, g, b] = le(desc::Pixels::Rgba8(vec![[255, 0, 188, 9]]));
    assert!((r, g) == (2.0, 0.0) && (b - 2.0 * 0.502_886_5).abs() < 1e-5, "{b}");
    assert_eq!(le(desc::Pixels::Rgba32F(vec![[f32::NAN, f32::INFINITY, -1.0, 1.0]])), [0.0; 3]);
}

/// A computed sky and its sun: the irradiance from samples of both is the sum over the image's texels and E⊥ sin(elevation).
#[test]
fn the_sky_and_its_sun_light_the_ground_together() {
    let text = "[environment]\ntype = 'sky'\nelevation = 35\nazimuth = 90\nstrength = 0.01\n";
    let scene = desc::toml::parse(text, std::path::Path::new("sky.toml")).expect("a scene");
    let [desc::Light::Sun { direction, irradiance, .. }] = scene.lights[..] else { panic!("{:?}", scene.lights) };
    // In the east, which is +x.
    assert!((direction.y + 35f32.to_radians().sin()).abs() < 1e-5 && direction.x < -0.8 && direction.z.abs() < 1e-5);
    let desc::Pixels::Rgba32F(pixels) = &scene.images[0].pixels else { panic!() };
    let [width, height] = scene.images[0].size.map(|n| n as usize);
    let edge = |row: usize| (std::f64::consts::PI * row as f64 / height as f64).sin().powi(2);
    let sky = |(i, p): (usize, &[f32; 4])| {
        let row = i / width;
        let cosine = 0.5 * (edge(row + 1) - edge(row)) * std::f64::consts::TAU / width as f64;
        0.01 * f64::from(p[1]) * cosine
    };
    let sky: f64 = pixels.iter().enumerate().take(width * height / 2).map(sky).sum();
    let exact = sky + f64::from(irradiance[1] * -direction.y);

    let compiled = radianza::scene::Scene::compile(&scene).expect("compiles");
    let receiver = LightSampleContext { p: Vec3A::ZERO, facing: Facing::Half(Vec3A::Y) };
    let (mut rng, mut seen) = (Pcg64Mcg::new(4), radianza::stats::Moments::default());
    for _ in 0..200_000 {
        let u = [rng.random(), rng.random()];
        let sample = compiled.lights.sample(&receiver, rng.random(), u, &compiled.textures);
        let e = sample.map_or(0.0, |(_, s)| {
            let (Pdf::SolidAngle(p) | Pdf::Discrete(p)) = s.pdf;
            f64::from(s.le.to_rgb()[1] * s.wi.y.max(0.0) / p)
        });
        seen.push(e);
    }
    assert!(seen.z(exact).abs() < 4.5 && seen.standard_error() < 0.01 * exact, "{} is not {exact}", seen.mean());
}

/// More lights than the numbers of a sampler: each is chosen as often as its probability says.
#[test]
fn more_lights_than_numbers_of_24_bits() {
    let n = (1 << 23) + 3;
    // The last has as much as all others together.
    let fluxes: Vec<f64> = (0..n).map(|i| if i == n - 1 { (n - 1) as f64 } else { 1.0 }).collect();
    let choice = LightSampler::new(&[], &fluxes, 1.0);
    let receiver = LightSampleContext::anywhere(Vec3::ZERO);
    assert!(!choice.is_empty());
    let last = f64::from(choice.probability(&receiver, n as u32 - 1));
    assert!((last - 0.5).abs() < 0.01, "{last}");
    let (mut rng, mut chosen) = (Pcg64Mcg::new(7), [0.0; 9]);
    let draws = 200_000;
    for _ in 0..draws {
        let u = [rng.random(), rng.random()];
        let (light, probability) = choice.choose(&receiver, rng.random(), u).expect("a light");
        assert_eq!(probability, choice.probability(&receiver, light));
        assert!(probability > 0.0);
        // Eighths of the weak ones, and the strong one.
        chosen[if light == n as u32 - 1 { 8 } else { (light >> 20).min(7) as usize }] += 1.0;
    }
    let expected: Vec<f64> =
        (0..9).map(|k| f64::from(draws) * if k == 8 { last } else { (1.0 - last) / 8.0 }).collect();
    assert!(radianza::stats::chi2_test(&chosen, &expected, 20.0).p > 1e-4, "{chosen:?}");
}
