//! `[[light]]`: lights without a surface.

use super::build::Builder;
use super::color::Rgb;
use super::keys::{keys, one_of};
use super::number::{Angle, HalfAngle, NonNegative, Positive, ViewAngle};
use super::place::{Rows, unit};
use super::read::{At, Fault};
use super::short::Each;
use super::write::degrees;
use super::writer::Names;
use crate::desc::sky::SUN_DIAMETER;
use crate::desc::{Light, ies};
use glam::{Mat3, Vec3};
use std::f32::consts::{FRAC_PI_4, PI};

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
        intensity: Option<Rgb<NonNegative>>,
        /// Power in W, a number or [r, g, b], in place of the intensity: power = 4π intensity.
        power: Option<Rgb<NonNegative>>,
        /// Distance in metres at which the light ends, as in glTF: intensity/r² × clamp(1 − (r/range)⁴, 0, 1). Default: nowhere, as light does.
        range: Option<Positive>,
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
        intensity: Rgb<NonNegative>,
        /// Angle between the axis and the edge of the full light in degrees. Default 0.
        inner_angle: HalfAngle = HalfAngle(0.0),
        /// Angle between the axis and the edge of all light in degrees. Default 45.
        outer_angle: At<HalfAngle> = At::nowhere(HalfAngle(FRAC_PI_4)),
        /// Distance in metres at which the light ends, as for a point. Default: nowhere.
        range: Option<Positive>,
    }
}

keys! {
    /// Parallel light from infinity.
    struct DirectionalLight {
        /// Direction of travel [x, y, z].
        direction: At<Vec3>,
        /// Irradiance in W/m² on a surface that faces the light, a number or [r, g, b].
        irradiance: Rgb<NonNegative>,
    }
}

keys! {
    /// A disk at infinity.
    struct SunLight {
        /// Direction of travel [x, y, z] of the light from its middle.
        direction: At<Vec3>,
        /// Irradiance in W/m² on a surface that faces the light, a number or [r, g, b].
        irradiance: Rgb<NonNegative>,
        /// Angular diameter in degrees, between 0 and 180. Default 0.533.
        diameter: ViewAngle = ViewAngle(SUN_DIAMETER.to_radians()),
    }
}

keys! {
    /// Radiates from a point as an IES file (LM-63) says.
    struct IesLight {
        /// The IES file, below the scene's folder.
        file: Option<At<String>>,
        /// Name of a profile of this file, in place of an IES file.
        profile: Option<At<String>>,
        /// Place [x, y, z] in metres.
        position: At<Vec3>,
        /// Aim [x, y, z]: where the file's vertical angle is 0.
        direction: Option<At<Vec3>>,
        /// Point on the aim [x, y, z] in metres, in place of the direction.
        target: Option<Vec3>,
        /// Turn about the aim in degrees, counter-clockwise as seen from behind the light. At 0 the horizontal angle 0 lies towards +x (+z where the light aims along x).
        turn: Angle = Angle(0.0),
        /// Light to world, in place of direction, target and turn: a rotation as three rows of three numbers. The light aims along its −z axis.
        rotation: Option<At<Rows>>,
        /// Factor on the candelas of the file, which count as W/sr, a number or [r, g, b]. Default 1.
        multiplier: Rgb<NonNegative> = Each([NonNegative(1.0); 3]),
    }
}

impl LightTable {
    /// The light.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Light, Fault> {
        let end = |range: Option<Positive>| range.map_or(f32::INFINITY, |range| range.0);
        let rgb = |c: &Rgb<NonNegative>| c.0.map(|x| x.0);
        match self {
            Self::PointLight(p) => {
                let intensity = match (&p.intensity, &p.power) {
                    (Some(i), None) => rgb(i),
                    (None, Some(power)) => rgb(power).map(|x| x / (4.0 * PI)),
                    _ => return Err(Fault::new(&p.position.at, "the light needs one of `intensity` and `power`")),
                };
                Ok(Light::Point { position: p.position.value, intensity, range: end(p.range) })
            }
            Self::SpotLight(s) => {
                let position = s.position.value;
                let direction = aim(&s.position, &s.direction, s.target)?;
                let (inner, outer) = (s.inner_angle.0, s.outer_angle.value.0);
                if !(outer > 0.0 && inner <= outer) {
                    let at = if s.outer_angle.at.is_empty() { &s.position.at } else { &s.outer_angle.at };
                    let [inner, outer] = [inner, outer].map(degrees);
                    let message = format!(
                        "`inner_angle` is {inner} and `outer_angle` {outer}, expected inner ≤ outer, outer > 0"
                    );
                    return Err(Fault::new(at, message));
                }
                let (intensity, range) = (rgb(&s.intensity), end(s.range));
                Ok(Light::Spot { position, direction, intensity, inner, outer, range })
            }
            Self::DirectionalLight(d) => {
                Ok(Light::Directional { direction: unit(&d.direction)?, irradiance: rgb(&d.irradiance) })
            }
            Self::SunLight(s) => Ok(Light::Sun {
                direction: unit(&s.direction)?,
                irradiance: rgb(&s.irradiance),
                diameter: s.diameter.0,
            }),
            Self::IesLight(l) => {
                let profile = match (&l.file, &l.profile) {
                    (Some(file), None) => b.profile(file)?,
                    (None, Some(name)) => b.named_profile(name)?,
                    _ => return Err(Fault::new(&l.position.at, "the light needs one of `file` and `profile`")),
                };
                let to_world = l.to_world()?;
                Ok(Light::Profile { position: l.position.value, to_world, intensity: rgb(&l.multiplier), profile })
            }
        }
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(light: &Light, names: &Names) -> Self {
        let rgb = |c: [f32; 3]| Each(c.map(NonNegative));
        let end = |range: f32| range.is_finite().then_some(Positive(range));
        match light {
            Light::Point { position, intensity, range } => Self::PointLight(PointLight {
                position: At::nowhere(*position),
                intensity: Some(rgb(*intensity)),
                power: None,
                range: end(*range),
            }),
            Light::Spot { position, direction, intensity, inner, outer, range } => Self::SpotLight(SpotLight {
                position: At::nowhere(*position),
                direction: Some(At::nowhere(*direction)),
                target: None,
                intensity: rgb(*intensity),
                inner_angle: HalfAngle(*inner),
                outer_angle: At::nowhere(HalfAngle(*outer)),
                range: end(*range),
            }),
            Light::Directional { direction, irradiance } => Self::DirectionalLight(DirectionalLight {
                direction: At::nowhere(*direction),
                irradiance: rgb(*irradiance),
            }),
            Light::Sun { direction, irradiance, diameter } => Self::SunLight(SunLight {
                direction: At::nowhere(*direction),
                irradiance: rgb(*irradiance),
                diameter: ViewAngle(*diameter),
            }),
            Light::Profile { position, to_world, intensity, profile } => Self::IesLight(IesLight {
                file: None,
                profile: Some(names.profile(profile)),
                position: At::nowhere(*position),
                direction: None,
                target: None,
                turn: Angle(0.0),
                rotation: Some(At::nowhere(Rows(*to_world))),
                multiplier: rgb(*intensity),
            }),
        }
    }
}

impl IesLight {
    /// Rotation of the profile's frame.
    fn to_world(&self) -> Result<Mat3, Fault> {
        if let Some(rows) = &self.rotation {
            if self.direction.is_some() || self.target.is_some() || self.turn.0 != 0.0 {
                return Err(Fault::new(&rows.at, "`direction`, `target` or `turn` is given too; expected one way"));
            }
            return rows.value.rotation(&rows.at);
        }
        let z = -aim(&self.position, &self.direction, self.target)?;
        let across = if z.x.abs() > 0.999 { Vec3::Z } else { Vec3::X };
        Ok(ies::frame(z, across) * Mat3::from_rotation_z(self.turn.0))
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
