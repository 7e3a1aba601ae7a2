//! `[[light]]` and `[environment]`.

use super::build::Builder;
use super::color::Grey;
use super::keys::{keys, one_of};
use super::place::{Rotation, unit};
use super::read::{At, Fault, HalfAngle, Node, NonNegative, Number, Read, ViewAngle, mismatch};
use super::schema::Defs;
use super::sky::ClearSky;
use crate::desc::sky::SUN_DIAMETER;
use crate::desc::{Environment, Light, ies};
use ::toml::de::DeValue;
use glam::{Mat3, Quat, Vec3};
use serde_json::{Value as Json, json};
use std::f32::consts::PI;

one_of! {
    /// A light without a surface.
    enum LightTable {
        "point" => PointLight,
        "spot" => SpotLight,
        "directional" => DirectionalLight,
        "sun" => SunLight,
        "ies" => IesLight,
    } default None
}

keys! {
    /// Radiates from a point in all directions alike.
    struct PointLight {
        /// Place [x, y, z] in metres.
        position: At<Vec3>,
        /// Intensity in W/sr, a number or [r, g, b].
        intensity: Option<Grey<NonNegative>>,
        /// Power in W, a number or [r, g, b], in place of the intensity: power = 4π intensity.
        power: Option<Grey<NonNegative>>,
    }
}

keys! {
    /// Radiates from a point about a direction.
    struct SpotLight {
        /// Place [x, y, z] in metres.
        position: At<Vec3>,
        /// Axis [x, y, z].
        direction: Option<At<Vec3>>,
        /// Point on the axis [x, y, z] in metres, in place of the direction.
        target: Option<Vec3>,
        /// Intensity on the axis in W/sr, a number or [r, g, b].
        intensity: Grey<NonNegative>,
        /// Angle between the axis and the edge of the full light in degrees. Default 0.
        inner_angle: HalfAngle = HalfAngle(0.0),
        /// Angle between the axis and the edge of all light in degrees. Default 45.
        outer_angle: At<HalfAngle> = At { at: 0..0, value: HalfAngle(45.0) },
    }
}

keys! {
    /// Parallel light from infinity.
    struct DirectionalLight {
        /// Direction of travel [x, y, z].
        direction: At<Vec3>,
        /// Irradiance in W/m² on a surface that faces the light, a number or [r, g, b].
        irradiance: Grey<NonNegative>,
    }
}

keys! {
    /// A disk at infinity.
    struct SunLight {
        /// Direction of travel [x, y, z] of the light from its middle.
        direction: At<Vec3>,
        /// Irradiance in W/m² on a surface that faces the light, a number or [r, g, b].
        irradiance: Grey<NonNegative>,
        /// Angular diameter in degrees, between 0 and 180. Default 0.533.
        diameter: ViewAngle = ViewAngle(SUN_DIAMETER),
    }
}

keys! {
    /// Radiates from a point as an IES file (LM-63) says.
    struct IesLight {
        /// The IES file, below the scene's folder.
        file: At<String>,
        /// Place [x, y, z] in metres.
        position: At<Vec3>,
        /// Aim [x, y, z]: where the file's vertical angle is 0.
        direction: Option<At<Vec3>>,
        /// Point on the aim [x, y, z] in metres, in place of the direction.
        target: Option<Vec3>,
        /// Turn about the aim in degrees, counter-clockwise as seen from behind the light. At 0 the horizontal angle 0 lies towards +x (+z where the light aims along x).
        turn: Number = Number(0.0),
        /// Factor on the candelas of the file, which count as W/sr, a number or [r, g, b]. Default 1.
        multiplier: Grey<NonNegative> = Grey([NonNegative(1.0); 3]),
    }
}

impl LightTable {
    /// The light.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Light, Fault> {
        let rgb = |c: &Grey<NonNegative>| c.0.map(|x| x.0);
        match self {
            Self::PointLight(p) => {
                let intensity = match (&p.intensity, &p.power) {
                    (Some(i), None) => rgb(i),
                    (None, Some(power)) => rgb(power).map(|x| x / (4.0 * PI)),
                    _ => return Err(Fault::new(&p.position.at, "the light needs one of `intensity` and `power`")),
                };
                Ok(Light::Point { position: p.position.value, intensity, range: f32::INFINITY })
            }
            Self::SpotLight(s) => {
                let position = s.position.value;
                let direction = aim(&s.position, &s.direction, s.target)?;
                let (inner, outer) = (s.inner_angle.0, s.outer_angle.value.0);
                if !(outer > 0.0 && inner <= outer) {
                    let at = if s.outer_angle.at.is_empty() { &s.position.at } else { &s.outer_angle.at };
                    let message = format!(
                        "`inner_angle` is {inner} and `outer_angle` {outer}, expected inner ≤ outer, outer > 0"
                    );
                    return Err(Fault::new(at, message));
                }
                let [inner, outer] = [inner, outer].map(f32::to_radians);
                let (intensity, range) = (rgb(&s.intensity), f32::INFINITY);
                Ok(Light::Spot { position, direction, intensity, inner, outer, range })
            }
            Self::DirectionalLight(d) => {
                Ok(Light::Directional { direction: unit(&d.direction)?, irradiance: rgb(&d.irradiance) })
            }
            Self::SunLight(s) => Ok(Light::Sun {
                direction: unit(&s.direction)?,
                irradiance: rgb(&s.irradiance),
                diameter: s.diameter.0.to_radians(),
            }),
            Self::IesLight(l) => {
                let z = -aim(&l.position, &l.direction, l.target)?;
                let across = if z.x.abs() > 0.999 { Vec3::Z } else { Vec3::X };
                let to_world = ies::frame(z, across) * Mat3::from_rotation_z(l.turn.0.to_radians());
                let profile = b.profile(&l.file)?;
                Ok(Light::Profile { position: l.position.value, to_world, intensity: rgb(&l.multiplier), profile })
            }
        }
    }
}

/// The direction of a light that gives one of the two.
fn aim(position: &At<Vec3>, direction: &Option<At<Vec3>>, target: Option<Vec3>) -> Result<Vec3, Fault> {
    match (direction, target) {
        (Some(d), None) => unit(d),
        (None, Some(t)) => unit(&At { at: position.at.clone(), value: t - position.value }),
        _ => Err(Fault::new(&position.at, "the light needs one of `direction` and `target`")),
    }
}

keys! {
    /// Light from infinity all around.
    struct EnvironmentTable {
        /// Factor on the image, the sky or the radiance, a number or [r, g, b]. Default 1.
        strength: Grey<NonNegative> = Grey([NonNegative(1.0); 3]),
        /// Rotation: degrees counter-clockwise about the y axis as seen from above, or { axis = [x, y, z], angle = degrees }. Default 0.
        rotation: Turn = Turn(None, Number(0.0)),
        ..kind: EnvironmentKind,
    }
}

one_of! {
    /// Light from infinity all around: given, or computed.
    enum EnvironmentKind {
        "plain" => PlainEnvironment,
        "sky" => ClearSky,
    } default Some("plain")
}

keys! {
    /// Uniform, or an image.
    struct PlainEnvironment {
        /// Radiance in W/(sr m²), a number or [r, g, b].
        radiance: Option<At<Grey<NonNegative>>>,
        /// Equirectangular image (.exr, .hdr, .png, .jpg) in place of the radiance. Its middle lies towards −z, its upper edge towards +y, +x to the right of the middle.
        file: Option<At<String>>,
    }
}

/// An angle about +y, or any rotation.
#[derive(Clone, Debug)]
pub(super) struct Turn(Option<Rotation>, Number);

impl Read for Turn {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Table(_) => Ok(Self(Some(Rotation::read(node)?), Number(0.0))),
            _ => Number::read(node).map(|angle| Self(None, angle)).map_err(|_| mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        "an angle in degrees or { axis = …, angle = … }".into()
    }
    fn many() -> String {
        "rotations".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [Number::schema(defs), defs.reference::<Rotation>()] })
    }
}

impl EnvironmentTable {
    /// The environment, its image decoded.
    pub(super) fn build(&self, at: &std::ops::Range<usize>, b: &mut Builder<'_>) -> Result<Environment, Fault> {
        let strength = self.strength.0.map(|x| x.0);
        let rotation = match &self.rotation {
            Turn(Some(rotation), _) => rotation.quat()?,
            Turn(None, angle) => Quat::from_rotation_y(angle.0.to_radians()),
        };
        let to_world = Mat3::from_quat(rotation);
        let plain = match &self.kind {
            EnvironmentKind::PlainEnvironment(plain) => plain,
            EnvironmentKind::ClearSky(sky) => return sky.build(at, strength, to_world, b),
        };
        let (radiance, image) = match (&plain.radiance, &plain.file) {
            (Some(r), None) => ([0, 1, 2].map(|i| r.value.0[i].0 * strength[i]), None),
            (None, Some(file)) => (strength, Some(b.environment_image(file)?)),
            _ => return Err(Fault::new(at, "`environment` needs one of `radiance` and `file`")),
        };
        Ok(Environment { radiance, image, to_world })
    }
}
