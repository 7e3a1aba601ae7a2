//! Random lights: what they send to the objects about the origin is of the order of 1.

use super::draw::Draw;
use super::feature::Feature;
use crate::desc::{Environment, Image, Light, Pixels, Scene, ies};
use glam::{Mat3, Quat, Vec3};
use std::f32::consts::PI;
use std::sync::Arc;

/// All kinds of lights without a surface.
pub(super) const KINDS: [Feature; 7] = [
    Feature::Point,
    Feature::Spot,
    Feature::Profile,
    Feature::Directional,
    Feature::Sun,
    Feature::Environment,
    Feature::EnvironmentImage,
];

/// A luminaire that is brighter to one side.
const PROFILE: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 3 1 2 0 0 0\n1 1 0\n0 30 60 90\n0 90 180\n\
                       9 8 4 0.5\n9 7 3 0\n9 5 1 0\n";

/// Adds a light of a kind; the features that the scene has by it.
pub(super) fn add(scene: &mut Scene, draw: &mut Draw, kind: Feature) -> Vec<Feature> {
    let position = Vec3::new(draw.between(-2.5, 2.5), draw.between(2.2, 3.0), draw.between(-0.5, 2.5));
    let direction = (draw.within(Vec3::splat(0.4)) - position).normalize();
    let ranged = draw.chance(0.4);
    let range = if ranged { draw.between(4.0, 7.0) } else { f32::INFINITY };
    let mut features = vec![kind];
    match kind {
        Feature::Point => scene.lights.push(Light::Point { position, intensity: draw.rgb(3.0, 9.0), range }),
        Feature::Spot => {
            let outer = draw.between(0.3, 1.0);
            let inner = outer * draw.between(0.0, 0.9);
            let intensity = draw.rgb(3.0, 9.0);
            scene.lights.push(Light::Spot { position, direction, intensity, inner, outer, range });
        }
        Feature::Profile => {
            let profile = ies::parse(PROFILE.as_bytes()).unwrap_or_else(|e| unreachable!("our own profile: {e}"));
            let to_world = ies::frame(-direction, draw.direction());
            let intensity = draw.rgb(0.5, 1.0);
            scene.lights.push(Light::Profile { position, to_world, intensity, profile: Arc::new(profile) });
        }
        Feature::Directional => scene.lights.push(Light::Directional { direction, irradiance: draw.rgb(0.5, 2.0) }),
        Feature::Sun => {
            let (irradiance, diameter) = (draw.rgb(0.5, 2.0), draw.between(0.3, 1.2));
            scene.lights.push(Light::Sun { direction, irradiance, diameter });
        }
        Feature::Environment => {
            let radiance = draw.rgb(0.2, 1.0);
            scene.environment = Some(Environment { radiance, image: None, to_world: Mat3::IDENTITY });
        }
        _ => {
            let texel = |draw: &mut Draw| {
                let bright = if draw.chance(0.15) { 5.0 } else { 0.6 };
                let [r, g, b] = draw.rgb(0.0, bright);
                [r, g, b, 1.0]
            };
            let pixels = Pixels::Rgba32F((0..32).map(|_| texel(draw)).collect());
            scene.images.push(Arc::new(Image { name: "sky.exr".into(), size: [8, 4], pixels }));
            let to_world = Mat3::from_quat(Quat::from_axis_angle(draw.direction(), draw.between(0.0, PI)));
            let image = Some(scene.images.len() - 1);
            scene.environment = Some(Environment { radiance: draw.rgb(0.4, 1.0), image, to_world });
        }
    }
    if ranged && matches!(kind, Feature::Point | Feature::Spot) {
        features.push(Feature::Range);
    }
    features
}
