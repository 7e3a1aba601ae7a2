//! Materials as written, through to their lobes.

use super::{at_cosine, sampled_albedo};
use radianza::bsdf::{Bsdf, Transport};
use radianza::desc::{self, Alpha, ColorParam, Emission, Fresnel, Model, NormalMap, Roughness, ScalarParam, Sides};
use radianza::desc::{Image, Layers, MetallicRoughness, Pixels, Texture, TextureRef, Transmission, Wrap};
use radianza::glam::{Affine2, Vec2, Vec3, Vec3A, Vec4};
use radianza::material::Material;
use radianza::shape::Surface;
use radianza::stats::Family;
use radianza::texture::Textures;

const WHITE: ColorParam = ColorParam::constant([1.0; 3]);

pub(crate) fn surface() -> Surface {
    Surface {
        p: Vec3A::ZERO,
        p_error: Vec3A::ZERO,
        ng: Vec3A::Z,
        ns: Vec3A::Z,
        tangent: Vec3A::X,
        handedness: 1.0,
        uv: [Vec2::new(0.25, 0.5), Vec2::new(0.75, 0.5)],
        color: Vec4::new(0.5, 1.0, 1.0, 0.5),
    }
}

/// Two texels: left (1, 0, 0, 0.25), right (0.2, 1, 0.6, 1).
fn textures() -> Textures {
    let pixels = Pixels::Rgba32F(vec![[1.0, 0.0, 0.0, 0.25], [0.2, 1.0, 0.6, 1.0]]);
    let image = Image { name: "two".into(), size: [2, 1], pixels };
    let texture = Texture::Image { image: 0, srgb: false, wrap: [Wrap::Clamp; 2], nearest: true };
    Textures::new(&desc::Scene { images: vec![image.into()], textures: vec![texture], ..Default::default() })
}

fn texture(uv_set: usize) -> TextureRef {
    TextureRef { texture: 0, uv_set, transform: Affine2::IDENTITY }
}

pub(crate) fn gltf(metallic: f32, roughness: f32) -> MetallicRoughness {
    MetallicRoughness {
        base_color: WHITE,
        metallic: ScalarParam::constant(metallic),
        roughness: ScalarParam::constant(roughness),
        ior: 1.5,
        specular: ScalarParam::constant(1.0),
        specular_color: WHITE,
        transmission: None,
        layers: Layers::default(),
        diffuse_transmission: None,
        iridescence: None,
    }
}

pub(crate) fn compile(model: Model) -> Material {
    Material::compile(&desc::Material::new("test", model))
}

#[test]
fn white_gltf_neither_gains_nor_loses() {
    let mut family = Family::new("glTF, base colour 1: albedo 1");
    for (metallic, roughness) in [(0.0, 0.0), (0.0, 0.1), (0.0, 0.5), (0.0, 1.0), (0.5, 0.3), (1.0, 0.6), (1.0, 0.0)] {
        for transmission in [None, Some((0.6, true)), Some((0.6, false))] {
            let mut m = gltf(metallic, roughness);
            m.transmission = transmission.map(|(t, thin)| Transmission { factor: ScalarParam::constant(t), thin });
            let material = compile(Model::MetallicRoughness(Box::new(m)));
            for mu in [0.9, 0.3, 0.05, -0.7] {
                let bsdf = material.lobes(&surface(), &Textures::default(), None, &mut Bsdf::new()).clone();
                let m = sampled_albedo(&bsdf, at_cosine(mu), 0, 256);
                let name = format!("metallic {metallic} roughness {roughness} transmission {transmission:?} μ {mu}");
                family.replicated(name, 1.0, &m, 5e-4);
            }
        }
    }
    family.assert();
}

#[test]
fn no_gltf_material_gains() {
    for i in 0..200u32 {
        let x = |k: u32| (i.wrapping_mul(2_654_435_761).wrapping_add(k * 40_503) >> 8) as f32 / (1u32 << 24) as f32;
        let mut m = gltf(x(1), x(2));
        m.base_color = ColorParam::constant([x(3), x(4), 1.0]);
        m.ior = 1.0 + 2.0 * x(5);
        m.specular = ScalarParam::constant(x(6));
        m.specular_color = ColorParam::constant([4.0 * x(7), 1.0, 0.3]);
        m.transmission = Some(Transmission { factor: ScalarParam::constant(x(8)), thin: true });
        let material = compile(Model::MetallicRoughness(Box::new(m)));
        for mu in [1.0, 0.5, 0.1, 0.01] {
            let albedo =
                material.lobes(&surface(), &Textures::default(), None, &mut Bsdf::new()).clone().albedo(at_cosine(mu));
            assert!(albedo.0.max_element() <= 1.0 + 2e-4 && albedo.0.min_element() >= 0.0, "{i} μ {mu}: {albedo:?}");
        }
    }
}

#[test]
fn parameters_come_from_textures_and_vertices() {
    let textures = textures();
    let reflectance = ColorParam { factor: [0.5, 0.5, 0.5], texture: Some(texture(1)), vertex_color: true };
    let bsdf = compile(Model::Diffuse { reflectance }).lobes(&surface(), &textures, None, &mut Bsdf::new()).clone();
    let albedo = bsdf.albedo(Vec3::Z).to_rgb();
    for (a, b) in albedo.into_iter().zip([0.05, 0.5, 0.3]) {
        assert!((a - b).abs() < 1e-6, "{albedo:?}");
    }

    // Roughness from green: 0 on the left (smooth), 1 on the right.
    let roughness = |uv_set| Roughness::Perceptual(ScalarParam { factor: 1.0, texture: Some((texture(uv_set), 1)) });
    for (uv_set, smooth) in [(0, false), (1, true)] {
        let models = [
            Model::Conductor { fresnel: Fresnel::Schlick { f0: WHITE }, roughness: roughness(uv_set) },
            Model::Dielectric { ior: 1.5, roughness: roughness(uv_set), tint: WHITE },
        ];
        for model in models {
            let bsdf = compile(model.clone()).lobes(&surface(), &textures, None, &mut Bsdf::new()).clone();
            assert_eq!(bsdf.has_smooth(), smooth, "{model:?}");
            let fixed = match model {
                Model::Conductor { fresnel, .. } => {
                    Model::Conductor { fresnel, roughness: Roughness::Alpha([uv_set as f32; 2]) }
                }
                Model::Dielectric { ior, tint, .. } => {
                    Model::Dielectric { ior, tint, roughness: Roughness::Alpha([uv_set as f32; 2]) }
                }
                other => other,
            };
            let fixed = compile(fixed).lobes(&surface(), &textures, None, &mut Bsdf::new()).clone();
            let f = |b: &radianza::bsdf::Bsdf| b.eval(at_cosine(0.7), at_cosine(0.4), Transport::Radiance).f;
            assert_eq!(f(&bsdf), f(&fixed));
        }
    }
}

#[test]
fn mixtures_are_sums() {
    let half = |model| (0.5, model);
    let grey = Model::Diffuse { reflectance: ColorParam::constant([0.4; 3]) };
    let inner = Model::Mix(vec![half(grey), half(Model::Absorb)]);
    let mixed = Model::Mix(vec![half(inner), half(Model::Mirror { reflectance: WHITE })]);
    assert_eq!(radianza::material::most_lobes(&mixed), [2, 0]);
    let bsdf = compile(mixed).lobes(&surface(), &Textures::default(), None, &mut Bsdf::new()).clone();
    assert!((bsdf.albedo(Vec3::Z).0.x - (0.25 * 0.4 + 0.5)).abs() < 1e-6);
    assert!(compile(Model::Absorb).lobes(&surface(), &Textures::default(), None, &mut Bsdf::new()).clone().is_empty());
}

/// A mixture of these parts of glTF with all that it can have.
fn mixture_of(parts: usize) -> Model {
    use radianza::desc::{Clearcoat, Sheen};
    let all = ScalarParam::constant(1.0);
    let half = ScalarParam::constant(0.5);
    let layers = Layers {
        sheen: Some(Sheen { color: WHITE, roughness: half }),
        clearcoat: Some(Clearcoat { factor: half, roughness: half, normal_map: None }),
        ..Layers::default()
    };
    let transmission = Some(Transmission { factor: half, thin: true });
    let diffuse_transmission = Some(desc::DiffuseTransmission { factor: half, color: WHITE, thin: true });
    let part = MetallicRoughness { layers, transmission, diffuse_transmission, specular: all, ..gltf(0.5, 0.5) };
    let weight = 1.0 / parts as f32;
    Model::Mix((0..parts).map(|_| (weight, Model::MetallicRoughness(Box::new(part.clone())))).collect())
}

/// Lobes that find no room are an error, and never lost.
#[test]
fn too_many_lobes_are_an_error() {
    let scene = |parts| {
        let materials = vec![desc::Material::new("much", mixture_of(parts))];
        let shapes = vec![desc::Shape::Sphere { radius: 1.0 }];
        let objects = vec![desc::Object::new(0, 0)];
        radianza::scene::Scene::compile(&desc::Scene { materials, shapes, objects, ..Default::default() })
    };
    let lobes =
        |parts| compile(mixture_of(parts)).lobes(&surface(), &Textures::default(), None, &mut Bsdf::new()).len();
    for parts in [1, 2] {
        assert!(scene(parts).is_ok());
        assert_eq!([lobes(parts), 2 * parts], radianza::material::most_lobes(&mixture_of(parts)));
    }
    let error = scene(3).expect_err("18 lobes").to_string();
    assert!(error.contains("`much`") && error.contains("18 lobes"), "{error}");
}

#[test]
fn emission_and_coverage() {
    let textures = textures();
    let s = surface();
    let mut m = desc::Material::new("test", Model::Absorb);
    assert!(!Material::compile(&m).is_emissive() && !Material::compile(&m).has_holes());
    m.emission = Some(Emission { radiance: ColorParam::constant([3.0, 2.0, 1.0]), sides: Sides::Front, coat: None });
    m.alpha = Alpha::Blend { coverage: ScalarParam { factor: 0.8, texture: Some((texture(0), 3)) } };
    let blend = Material::compile(&m);
    assert!(blend.is_emissive() && blend.has_holes());
    assert_eq!(blend.emission(&s.uv, s.color, 1.0, &textures).to_rgb(), [3.0, 2.0, 1.0]);
    assert!(blend.emission(&s.uv, s.color, -1.0, &textures).is_black());
    // Beneath a coat of half the surface: 1 − 0.04/2 along the normal, less towards the horizon.
    let coat = Some(ScalarParam::constant(0.5));
    let coated = desc::Material { emission: m.emission.map(|e| Emission { coat, ..e }), ..m.clone() };
    for (cos, share) in [(1.0, 0.98), (0.5, 1.0 - 0.5 * (0.04 + 0.96 / 32.0))] {
        let le = Material::compile(&coated).emission(&s.uv, s.color, cos, &textures).to_rgb();
        assert!((le[0] - 3.0 * share).abs() < 1e-5, "{cos}: {le:?}");
    }
    // 0.8 × 0.25 × vertex alpha 0.5.
    assert!((blend.coverage(&s.uv, s.color, &textures) - 0.1).abs() < 1e-6);
    for (cutoff, there) in [(0.09, 1.0), (0.11, 0.0)] {
        let coverage = ScalarParam { factor: 0.8, texture: Some((texture(0), 3)) };
        m.alpha = Alpha::Mask { coverage, cutoff };
        assert_eq!(Material::compile(&m).coverage(&s.uv, s.color, &textures), there);
    }
}

#[test]
fn normal_maps_stay_above_the_surface() {
    let textures = textures();
    let mut m = desc::Material::new("test", Model::Absorb);
    assert!(Material::compile(&m).shading_normal(&surface(), &textures).is_none());
    m.normal_map = Some(NormalMap { texture: texture(1), scale: 0.5 });
    // (2 rgb − 1) × (0.5, 0.5, 1) of (0.2, 1, 0.6).
    let expected = Vec3A::new(-0.3, 0.5, 0.2).normalize();
    let n = Material::compile(&m).shading_normal(&surface(), &textures).expect("there is a map");
    assert!((n - expected).length() < 1e-6, "{n}");
    let mirrored = Surface { handedness: -1.0, ..surface() };
    let n = Material::compile(&m).shading_normal(&mirrored, &textures).expect("there is a map");
    assert!((n - expected * Vec3A::new(1.0, -1.0, 1.0)).length() < 1e-6, "{n}");
    // The left texel points along (1, −1, −1).
    m.normal_map = Some(NormalMap { texture: texture(0), scale: 1.0 });
    let n = Material::compile(&m).shading_normal(&surface(), &textures).expect("there is a map");
    assert!(n.z > 0.0 && n.x > 0.0 && n.y < 0.0 && (n.length() - 1.0).abs() < 1e-6, "{n}");
}

#[test]
fn layers_change_what_they_cover_and_make_no_light() {
    use radianza::desc::{Anisotropy, Clearcoat, Sheen};
    let sheen = Sheen { color: WHITE, roughness: ScalarParam::constant(0.5) };
    let coat = |roughness: f32| Clearcoat {
        factor: ScalarParam::constant(1.0),
        roughness: ScalarParam::constant(roughness),
        normal_map: None,
    };
    let stretched = Anisotropy { strength: ScalarParam::constant(0.8), rotation: 0.6, direction: None };
    let (wo, wi) = (at_cosine(0.4), Vec3::new(-0.5, 0.7, 0.5).normalize());
    let lobes = |m: &MetallicRoughness| {
        let model = Model::MetallicRoughness(Box::new(m.clone()));
        compile(model).lobes(&surface(), &textures(), None, &mut Bsdf::new()).clone()
    };
    for (metallic, roughness) in [(0.0, 0.5), (1.0, 0.3), (0.5, 0.0)] {
        let plain = gltf(metallic, roughness);
        let before = lobes(&plain).eval(wo, wi, Transport::Radiance).f;
        for (name, layers) in [
            ("sheen", Layers { sheen: Some(sheen), ..Layers::default() }),
            ("rough coat", Layers { clearcoat: Some(coat(0.3)), ..Layers::default() }),
            ("all", Layers { anisotropy: Some(stretched), sheen: Some(sheen), clearcoat: Some(coat(0.0)) }),
        ] {
            let bsdf = lobes(&MetallicRoughness { layers, ..plain.clone() });
            assert_ne!(bsdf.eval(wo, wi, Transport::Radiance).f, before, "{name}");
            for mu in [1.0, 0.4, 0.05] {
                let albedo = sampled_albedo(&bsdf, at_cosine(mu), 1, 2_000);
                let (most, se) = (albedo.mean(), albedo.standard_error());
                assert!(most < 1.003 + 5.0 * se && most > 0.85, "{name} over {metallic} {roughness}: {most} ± {se}");
            }
        }
    }

    // Turned by half a turn grooves are the same, by a quarter not; and without strength they are none.
    let turned = |strength: f32, rotation: f32| {
        let anisotropy = Anisotropy { strength: ScalarParam::constant(strength), rotation, direction: None };
        let layers = Layers { anisotropy: Some(anisotropy), ..Layers::default() };
        lobes(&MetallicRoughness { layers, ..gltf(1.0, 0.4) }).eval(wo, wi, Transport::Radiance).f.0.x
    };
    use std::f32::consts::{FRAC_PI_2, PI};
    assert!((turned(0.7, 0.3) / turned(0.7, 0.3 + PI) - 1.0).abs() < 1e-3);
    assert!((turned(0.7, 0.3) / turned(0.7, 0.3 + FRAC_PI_2) - 1.0).abs() > 0.05);
    assert_eq!(turned(0.0, 0.3), lobes(&gltf(1.0, 0.4)).eval(wo, wi, Transport::Radiance).f.0.x);
}

/// A coat whose map bends it mirrors about its own normal.
#[test]
fn a_coat_has_its_own_normal() {
    use radianza::desc::Clearcoat;
    let clearcoat = Clearcoat {
        factor: ScalarParam::constant(1.0),
        roughness: ScalarParam::constant(0.0),
        normal_map: Some(NormalMap { texture: texture(1), scale: 0.1 }),
    };
    let layers = Layers { clearcoat: Some(clearcoat), ..Layers::default() };
    let model = Model::MetallicRoughness(Box::new(MetallicRoughness { layers, ..gltf(0.0, 0.5) }));
    let (wo, textures) = (at_cosine(0.9), textures());
    let bsdf = compile(model).lobes(&surface(), &textures, None, &mut Bsdf::new()).clone();
    // (2 rgb − 1) × (0.1, 0.1, 1) of (0.2, 1, 0.6).
    let n = Vec3::new(-0.06, 0.1, 0.2).normalize();
    let deltas = bsdf.deltas(wo, Transport::Radiance);
    assert!(deltas.len() == 1 && deltas[0].wi.abs_diff_eq(2.0 * wo.dot(n) * n - wo, 1e-5), "{deltas:?}");
}
