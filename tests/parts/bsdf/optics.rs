//! Films, gloss and the classic lobes, as written, through to their light.

use super::material::{compile, gltf, surface};
use super::{at_cosine, sampled_albedo};
use radianza::bsdf::{Bsdf, Class, Lobe, Transport};
use radianza::desc::{ColorParam, Fresnel, Iridescence, Model, Roughness, ScalarParam, SpecularGlossiness};
use radianza::glam::Vec3;
use radianza::stats::Family;
use radianza::texture::Textures;

const WHITE: ColorParam = ColorParam::constant([1.0; 3]);

fn lobes(model: Model) -> Bsdf {
    compile(model).lobes(&surface(), &Textures::default(), None, &mut Bsdf::new()).clone()
}

fn film(thickness: f32, factor: f32) -> Option<Iridescence> {
    let factor = ScalarParam::constant(factor);
    Some(Iridescence { factor, ior: 1.33, thickness: [thickness; 2], thickness_texture: None })
}

#[test]
fn a_film_colours_what_is_grey() {
    for metallic in [0.0, 1.0] {
        let lanes = |iridescence| {
            let mut m = gltf(metallic, 0.3);
            m.base_color = ColorParam::constant([0.0; 3]);
            if metallic > 0.0 {
                m.base_color = ColorParam::constant([0.4; 3]);
            }
            m.iridescence = iridescence;
            let bsdf = lobes(Model::MetallicRoughness(Box::new(m)));
            [0, 1, 2].map(|lane| sampled_albedo(&bsdf, at_cosine(0.8), lane, 256).mean())
        };
        let (bare, none) = (lanes(None), lanes(film(400.0, 0.0)));
        assert_eq!(bare, none, "a film that covers nothing");
        assert!((bare[0] - bare[1]).abs() < 1e-6 && (bare[2] - bare[1]).abs() < 1e-6, "{bare:?}");
        let [whole, half] = [1.0, 0.5].map(|factor| lanes(film(400.0, factor)));
        assert!((whole[0] - whole[1]).abs() > 0.1 * whole[1], "{whole:?}");
        for k in 0..3 {
            assert!((half[k] - 0.5 * (whole[k] + bare[k])).abs() < 2e-3, "{half:?} {whole:?} {bare:?}");
        }
    }
}

#[test]
fn films_neither_gain_nor_lose() {
    let mut family = Family::new("glTF under a film, base colour 1: albedo 1");
    for (metallic, roughness) in [(0.0, 0.0), (0.0, 0.4), (0.5, 0.5), (1.0, 0.6)] {
        for thin in [None, Some(0.7)] {
            let mut m = gltf(metallic, roughness);
            let factor = |t| radianza::desc::Transmission { factor: ScalarParam::constant(t), thin: true };
            m.transmission = thin.map(factor);
            m.iridescence = film(350.0, 0.8);
            let model = Model::MetallicRoughness(Box::new(m));
            for (mu, lane) in [(0.9, 0), (0.3, 1), (0.05, 2)] {
                let mean = sampled_albedo(&lobes(model.clone()), at_cosine(mu), lane, 256);
                family.replicated(format!("metal {metallic} r {roughness} thin {thin:?} μ {mu}"), 1.0, &mean, 1e-3);
            }
        }
    }
    family.assert();
}

fn gloss(diffuse: f32, specular: f32, glossiness: f32) -> Model {
    let [diffuse, specular] = [diffuse, specular].map(|x| ColorParam::constant([x; 3]));
    let glossiness = ScalarParam::constant(glossiness);
    Model::SpecularGlossiness(Box::new(SpecularGlossiness { diffuse, specular, glossiness }))
}

#[test]
fn gloss_over_white_neither_gains_nor_loses() {
    let mut family = Family::new("specular-glossiness, diffuse 1: albedo 1");
    for (specular, glossiness) in [(0.04, 1.0), (0.04, 0.5), (0.6, 0.2), (1.0, 0.7)] {
        for mu in [0.9, 0.3, 0.05] {
            let mean = sampled_albedo(&lobes(gloss(1.0, specular, glossiness)), at_cosine(mu), 0, 256);
            family.replicated(format!("F0 {specular} g {glossiness} μ {mu}"), 1.0, &mean, 5e-4);
        }
    }
    family.assert();
}

/// Black under F₀ = 0.04 and glossiness 1 − r is the coat of the metallic-roughness model at roughness r.
#[test]
fn glossiness_is_the_complement_of_roughness() {
    let (a, b) = (at_cosine(0.7), Vec3::new(-0.6, -0.3, 0.741_619_9));
    for r in [0.2, 0.5, 0.9] {
        let mut m = gltf(0.0, r);
        m.base_color = ColorParam::constant([0.0; 3]);
        let models = [gloss(0.0, 0.04, 1.0 - r), Model::MetallicRoughness(Box::new(m))];
        let [x, y] = models.map(|model| lobes(model).eval(a, b, Transport::Radiance).f.0.x);
        assert!((x - y).abs() < 1e-4 * y && x > 0.0, "{r}: {x} {y}");
    }
}

#[test]
fn roughness_flattens_what_is_diffuse() {
    let rough = |r| {
        let roughness = ScalarParam::constant(r);
        lobes(Model::RoughDiffuse { reflectance: WHITE, roughness })
    };
    let f = |r, wi| rough(r).eval(at_cosine(0.5), wi, Transport::Radiance).f.0.x;
    let (back, mirrored) = (at_cosine(0.5), at_cosine(0.5) * Vec3::new(-1.0, -1.0, 1.0));
    let lambert = std::f32::consts::FRAC_1_PI;
    assert!((f(0.0, back) - lambert).abs() < 1e-6 && (f(0.0, mirrored) - lambert).abs() < 1e-6);
    // Grooves show their lit sides to whom the light comes from.
    assert!(f(0.8, back) > 1.1 * lambert && f(0.8, mirrored) < 0.9 * lambert);
    assert_eq!(rough(0.8).eval(at_cosine(0.5), back, Transport::Radiance).specular.0.x, 0.0);
    assert_eq!(Lobe::Eon(radianza::bsdf::Eon::new(Default::default(), 0.5)).class(), Class::Diffuse);
}

/// At normal incidence all of Phong's lobe is above the horizon: its albedo is ρ, and f peaks at ρ (n + 2)/(2π).
#[test]
fn phong_is_normalised() {
    for exponent in [0.0f32, 1.0, 40.0, 5000.0] {
        let bsdf = lobes(Model::Phong { reflectance: ColorParam::constant([0.6; 3]), exponent });
        assert!((bsdf.albedo(Vec3::Z).0.x - 0.6).abs() < 1e-4, "{exponent}: {:?}", bsdf.albedo(Vec3::Z));
        let peak = bsdf.eval(Vec3::Z, Vec3::Z, Transport::Radiance).f.0.x;
        let exact = 0.6 * (exponent + 2.0) / std::f32::consts::TAU;
        assert!((peak - exact).abs() < 1e-5 * exact, "{exponent}: {peak} {exact}");
    }
}

/// Beckmann's D falls off faster than that of GGX, and where α → 0 both are a mirror of the same Fresnel term.
#[test]
fn cook_torrance_has_beckmanns_tail() {
    let fresnel = Fresnel::Complex { eta: [1.5; 3], k: [0.0; 3] };
    let f = |beckmann: bool, degrees: f32| {
        let (fresnel, roughness) = (fresnel.clone(), Roughness::Alpha([0.2; 2]));
        let model = match beckmann {
            true => Model::CookTorrance { fresnel, roughness },
            false => Model::Conductor { fresnel, roughness },
        };
        let (sin, cos) = degrees.to_radians().sin_cos();
        lobes(model).eval(Vec3::Z, Vec3::new(sin, 0.0, cos), Transport::Radiance).f.0.x
    };
    // f = F₀ D/4 at the pole, D = 1/(π α²), but for masking and multiple scattering.
    for beckmann in [true, false] {
        let peak = f(beckmann, 0.0);
        assert!((peak / (0.04 / (4.0 * std::f32::consts::PI * 0.04)) - 1.0).abs() < 0.01, "{peak}");
    }
    assert!(f(true, 60.0) < 0.05 * f(false, 60.0), "{} {}", f(true, 60.0), f(false, 60.0));
}

/// A volume is seen through its film: what is reflected is coloured, and nothing is lost.
#[test]
fn volumes_have_films() {
    let mut m = gltf(0.0, 0.0);
    m.transmission = Some(radianza::desc::Transmission { factor: ScalarParam::constant(1.0), thin: false });
    m.iridescence = film(400.0, 1.0);
    let bsdf = lobes(Model::MetallicRoughness(Box::new(m)));
    let wo = at_cosine(0.8);
    let deltas = bsdf.deltas(wo, Transport::Importance);
    let [reflected, refracted] = [1.0, -1.0].map(|side| deltas.iter().find(|d| d.wi.z * side > 0.0).unwrap().weight.0);
    assert!((reflected + refracted - radianza::glam::Vec4::ONE).abs().max_element() < 1e-5, "{reflected} {refracted}");
    assert!((reflected.x - reflected.y).abs() > 0.05 * reflected.y, "{reflected}");
}
