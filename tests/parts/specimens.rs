//! Every variant of every closed family is somewhere under test: a specimen of its own, or a part of random scenes.
//!
//! The lists here are matches without a wildcard: a new variant does not compile until it is named here, and is not named
//! without a specimen.

use radianza::camera;
use radianza::desc::{
    self, Alpha, Dispersion, Fov, Fresnel, Model, Pixels, Projection, Roughness, Scene, Shape, Sides, Texture, Wrap,
};
use radianza::light::{self, Light};
use radianza::sampler::{self, Kind};
use radianza::shape::Quadric;
use radianza::verify::random::scene;
use radianza::warp::{self, Warp};
use std::collections::BTreeSet;

/// Checks that among these values there is one of each variant of their enum.
macro_rules! every {
    ($values:expr, $family:ident { $($variant:ident)* }) => {{
        let variant = |value: &$family| match value {
            $($family::$variant { .. } => stringify!($variant),)*
        };
        let seen: BTreeSet<&str> = $values.iter().map(variant).collect();
        let missing: Vec<&str> = [$(stringify!($variant)),*].into_iter().filter(|v| !seen.contains(v)).collect();
        assert!(missing.is_empty(), "no specimen of {}::{missing:?}", stringify!($family));
    }};
}

#[test]
fn every_light_has_a_specimen() {
    let lights: Vec<Light> = light::specimens().into_iter().map(|s| s.light).collect();
    every!(lights, Light { Triangle Quadric Environment Point Spot Profile Directional Sun });
    let quadrics = lights.iter().filter_map(|light| match light {
        Light::Quadric(quadric) => Some(quadric.shape.quadric),
        _ => None,
    });
    every!(quadrics.collect::<Vec<_>>(), Quadric { Sphere Disk Cylinder });
}

#[test]
fn every_camera_has_a_specimen() {
    let cameras: Vec<desc::Camera> = camera::specimens().into_iter().map(|s| s.written).collect();
    let projections: Vec<Projection> = cameras.iter().map(|c| c.projection).collect();
    every!(projections, Projection { Perspective Orthographic Equirectangular });
    let fovs = projections.iter().filter_map(|p| match p {
        Projection::Perspective { fov } => Some(*fov),
        _ => None,
    });
    every!(fovs.collect::<Vec<_>>(), Fov { Horizontal Vertical });
    assert!(cameras.iter().any(|c| c.lens.is_some()), "no specimen of a lens");
}

#[test]
fn every_sampler_and_warp_has_a_specimen() {
    let kinds: Vec<Kind> = sampler::specimens().into_iter().map(|s| s.kind).collect();
    every!(kinds, Kind { Independent Sobol Lattice });
    let warps: Vec<Warp> = warp::specimens().into_iter().map(|s| s.warp).collect();
    every!(warps, Warp { Disk Triangle CosineHemisphere Hemisphere Sphere Cone Table1 Table2 });
}

/// Models with the parts of mixtures.
fn models(model: &Model) -> Vec<Model> {
    let parts = match model {
        Model::Mix(parts) => parts.iter().flat_map(|(_, part)| models(part)).collect(),
        _ => Vec::new(),
    };
    [vec![model.clone()], parts].concat()
}

#[test]
fn every_part_of_a_description_is_in_a_random_scene() {
    let scenes: Vec<Scene> = (0..200).map(|index| scene(0, index).0).collect();
    let materials: Vec<&desc::Material> = scenes.iter().flat_map(|s| &s.materials).collect();
    let all: Vec<Model> = materials.iter().flat_map(|m| models(&m.model)).collect();
    every!(all, Model {
        Diffuse RoughDiffuse Phong Mirror Dielectric Conductor CookTorrance Mix MetallicRoughness SpecularGlossiness Absorb
    });
    let (mut roughnesses, mut fresnels) = (Vec::new(), Vec::new());
    for model in all {
        match model {
            Model::Dielectric { roughness, .. } => roughnesses.push(roughness),
            Model::Conductor { fresnel, roughness } | Model::CookTorrance { fresnel, roughness } => {
                roughnesses.push(roughness);
                fresnels.push(fresnel);
            }
            _ => {}
        }
    }
    every!(roughnesses, Roughness { Perceptual Glossiness Alpha Stretched });
    every!(fresnels, Fresnel { Complex Schlick });
    every!(materials.iter().map(|m| m.alpha).collect::<Vec<_>>(), Alpha { Opaque Mask Blend });
    let dispersions: Vec<Dispersion> = materials.iter().map(|m| m.interior.dispersion).collect();
    every!(dispersions, Dispersion { None InverseAbbe Cauchy });
    let sides: Vec<Sides> = materials.iter().filter_map(|m| m.emission.map(|e| e.sides)).collect();
    every!(sides, Sides { Front Both });

    let shapes: Vec<Shape> = scenes.iter().flat_map(|s| s.shapes.clone()).collect();
    every!(shapes, Shape { Sphere Disk Cylinder Mesh });
    {
        use desc::Light;
        let lights: Vec<Light> = scenes.iter().flat_map(|s| s.lights.clone()).collect();
        every!(lights, Light { Point Spot Profile Directional Sun });
    }
    let projections: Vec<Projection> = scenes.iter().flat_map(|s| &s.cameras).map(|c| c.projection).collect();
    every!(projections, Projection { Perspective Orthographic Equirectangular });
    let textures: Vec<Texture> = scenes.iter().flat_map(|s| s.textures.clone()).collect();
    every!(textures, Texture { Image Checker });
    let wraps = textures.iter().flat_map(|t| match t {
        Texture::Image { wrap, .. } => wrap.to_vec(),
        Texture::Checker { .. } => Vec::new(),
    });
    every!(wraps.collect::<Vec<_>>(), Wrap { Repeat Mirror Clamp });
    let pixels: Vec<Pixels> = scenes.iter().flat_map(|s| &s.images).map(|i| i.pixels.clone()).collect();
    every!(pixels, Pixels { Rgba8 Rgba16 Rgba32F });
}
