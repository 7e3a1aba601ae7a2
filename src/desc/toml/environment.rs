//! `[environment]`: light from infinity all around.

use super::build::Builder;
use super::color::Rgb;
use super::keys::{keys, one_of};
use super::number::{Angle, NonNegative};
use super::place::{Rotation, Rows};
use super::read::{At, Fault, Node, Read, mismatch};
use super::schema::Defs;
use super::short::Each;
use super::sky::ClearSky;
use super::write::Write;
use super::writer::Names;
use crate::desc::Environment;
use ::toml::de::DeValue;
use glam::{Mat3, Quat};
use serde_json::{Value as Json, json};
use std::ops::Range;

keys! {
    /// Light from infinity all around.
    struct EnvironmentTable {
        /// Factor on the image, the sky or the radiance, a number or [r, g, b]. Default 1.
        strength: Rgb<NonNegative> = Each([NonNegative(1.0); 3]),
        /// Rotation: degrees counter-clockwise about the y axis as seen from above, or { axis = [x, y, z], angle = degrees }, or three rows of a matrix. Default 0.
        rotation: At<Turn> = At::nowhere(Turn::About(Angle(0.0))),
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
        radiance: Option<At<Rgb<NonNegative>>>,
        /// Equirectangular image (.exr, .hdr, .png, .jpg) in place of the radiance. Its middle lies towards −z, its upper edge towards +y, +x to the right of the middle.
        file: Option<At<String>>,
        /// Name of an image of this file, in place of a file of its own.
        image: Option<At<String>>,
    }
}

/// An angle about +y, or any rotation.
#[derive(Clone, Debug)]
pub(super) enum Turn {
    /// About +y.
    About(Angle),
    /// About any axis.
    Axis(Rotation),
    /// As a matrix.
    Matrix(Rows),
}

impl Read for Turn {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Table(_) => Rotation::read(node).map(Self::Axis),
            DeValue::Array(_) => Rows::read(node).map(Self::Matrix),
            _ => Angle::read(node).map(Self::About).map_err(|_| mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        "an angle in degrees or { axis = …, angle = … }".into()
    }
    fn many() -> String {
        "rotations".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [Angle::schema(defs), defs.reference::<Rotation>(), Rows::schema(defs)] })
    }
}

impl Write for Turn {
    fn text(&self) -> String {
        match self {
            Self::About(angle) => angle.text(),
            Self::Axis(rotation) => rotation.text(),
            Self::Matrix(rows) => rows.text(),
        }
    }
}

impl EnvironmentTable {
    /// The environment, its image decoded.
    pub(super) fn build(&self, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Environment, Fault> {
        let strength = self.strength.0.map(|x| x.0);
        let to_world = match &self.rotation.value {
            Turn::About(angle) => about_y(*angle),
            Turn::Axis(rotation) => Mat3::from_quat(rotation.quat()?),
            Turn::Matrix(rows) => rows.rotation(&self.rotation.at)?,
        };
        let plain = match &self.kind {
            EnvironmentKind::PlainEnvironment(plain) => plain,
            EnvironmentKind::ClearSky(sky) => return sky.build(at, strength, to_world, b),
        };
        let (radiance, image) = match (&plain.radiance, &plain.file, &plain.image) {
            (Some(r), None, None) => ([0, 1, 2].map(|i| r.value.0[i].0 * strength[i]), None),
            (None, Some(file), None) => (strength, Some(b.environment_file(file)?)),
            (None, None, Some(name)) => (strength, Some(b.environment_image(name)?)),
            _ => return Err(Fault::new(at, "`environment` needs one of `radiance` and `file`")),
        };
        Ok(Environment { radiance, image, to_world })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(environment: &Environment, names: &Names) -> Self {
        let Environment { radiance, image, to_world } = environment;
        let rgb = Each(radiance.map(NonNegative));
        let plain = PlainEnvironment {
            radiance: image.is_none().then(|| At::nowhere(rgb)),
            file: None,
            image: image.map(|image| names.image(image)),
        };
        let bits = |m: Mat3| m.to_cols_array().map(f32::to_bits);
        let plain_turn = bits(*to_world) == bits(about_y(Angle(0.0)));
        let turn = if plain_turn { Turn::About(Angle(0.0)) } else { Turn::Matrix(Rows(*to_world)) };
        Self {
            strength: if image.is_some() { rgb } else { Each([NonNegative(1.0); 3]) },
            rotation: At::nowhere(turn),
            kind: EnvironmentKind::PlainEnvironment(plain),
        }
    }
}

fn about_y(angle: Angle) -> Mat3 {
    Mat3::from_quat(Quat::from_rotation_y(angle.0))
}
