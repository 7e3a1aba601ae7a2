//! Where things stand: transformations as written.

use super::keys::keys;
use super::read::{At, Fault, Node, Number, Read, mismatch};
use super::schema::Defs;
use crate::math::Transform;
use ::toml::de::DeValue;
use glam::{Mat4, Quat, Vec3};
use serde_json::{Value as Json, json};

keys! {
    /// Where a thing stands.
    struct Place {
        /// Shift [x, y, z] in metres, applied after `scale` and `rotate`. Default 0.
        translate: Option<Vec3>,
        /// Rotation { axis = [x, y, z], angle = degrees }, counter-clockwise as seen against the axis, applied after `scale`.
        rotate: Option<Rotation>,
        /// Scale, one number or [x, y, z]; negative numbers mirror. Default 1.
        scale: Option<At<Scale>>,
        /// Matrix of four rows (or three: the last is 0 0 0 1) of four numbers, in place of the three keys above.
        matrix: Option<At<Matrix>>,
        /// Steps, the first one applied first, in place of the four keys above: [{ scale = 2 }, { translate = [0, 1, 0] }].
        transform: Option<At<Vec<Step>>>,
    }
}

keys! {
    /// One step of a transformation; exactly one key.
    struct Step {
        /// Shift [x, y, z] in metres.
        translate: Option<Vec3>,
        /// Rotation { axis = [x, y, z], angle = degrees }.
        rotate: Option<Rotation>,
        /// Scale, one number or [x, y, z].
        scale: Option<Scale>,
        /// Matrix of four (or three) rows of four numbers.
        matrix: Option<Matrix>,
    }
}

keys! {
    /// A rotation.
    struct Rotation {
        /// Axis, of any length but 0.
        axis: At<Vec3>,
        /// Angle in degrees, counter-clockwise as seen against the axis.
        angle: Number,
    }
}

impl Rotation {
    /// As a unit quaternion.
    pub(super) fn quat(&self) -> Result<Quat, Fault> {
        Ok(Quat::from_axis_angle(unit(&self.axis)?, self.angle.0.to_radians()))
    }
}

/// The unit vector along a written one.
pub(super) fn unit(v: &At<Vec3>) -> Result<Vec3, Fault> {
    let unit = v.value.as_dvec3().try_normalize().map(|v| v.as_vec3());
    unit.ok_or_else(|| Fault::new(&v.at, "found [0, 0, 0], expected a direction"))
}

/// A scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale(Vec3);

impl Read for Scale {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => Vec3::read(node).map(Self),
            _ => Number::read(node).map(|x| Self(Vec3::splat(x.0))).map_err(|_| mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        "a number or an array of 3 numbers".into()
    }
    fn many() -> String {
        "scales".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [Number::schema(defs), Vec3::schema(defs)] })
    }
}

/// A matrix, by rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix(Mat4);

impl Read for Matrix {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let rows =
            node.get_ref().as_array().filter(|a| matches!(a.len(), 3 | 4)).ok_or_else(|| mismatch::<Self>(node))?;
        let mut matrix = [[0.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0, 0.0, 0.0, 1.0]];
        for (row, node) in matrix.iter_mut().zip(rows.iter()) {
            *row = <[Number; 4]>::read(node)?.map(|x| x.0);
        }
        if matrix[3] != [0.0, 0.0, 0.0, 1.0] {
            return Err(Fault::new(&node.span(), format!("its last row is {:?}, expected [0, 0, 0, 1]", matrix[3])));
        }
        Ok(Self(Mat4::from_cols_array_2d(&matrix).transpose()))
    }
    fn one() -> String {
        "an array of 4 rows (or 3) of 4 numbers".into()
    }
    fn many() -> String {
        "matrices".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "type": "array", "items": <[Number; 4]>::schema(defs), "minItems": 3, "maxItems": 4 })
    }
}

impl Place {
    /// Object → parent. `at` is where a singular one is reported.
    pub(super) fn matrix(&self, at: &std::ops::Range<usize>) -> Result<Mat4, Fault> {
        let Self { translate, rotate, scale, matrix, transform } = self;
        let simple = translate.is_some() || rotate.is_some() || scale.is_some();
        let (at, product) = match (matrix, transform) {
            (Some(m), None) if !simple => (&m.at, m.value.0),
            (None, Some(steps)) if !simple => {
                let mut product = Mat4::IDENTITY;
                for step in &steps.value {
                    product = step.matrix(&steps.at)? * product;
                }
                (&steps.at, product)
            }
            (None, None) => {
                let scale_at = scale.as_ref().map_or(at, |s| &s.at);
                let rotate = rotate.as_ref().map_or(Ok(Quat::IDENTITY), Rotation::quat)?;
                let scale = scale.as_ref().map_or(Vec3::ONE, |s| s.value.0);
                (scale_at, Mat4::from_scale_rotation_translation(scale, rotate, translate.unwrap_or(Vec3::ZERO)))
            }
            _ => {
                let message = "gives its place twice; expected `transform`, or `matrix`, or any of `translate`, `rotate` and `scale`";
                return Err(Fault::new(at, message));
            }
        };
        invertible(at, product)
    }
}

impl Step {
    fn matrix(&self, at: &std::ops::Range<usize>) -> Result<Mat4, Fault> {
        match self {
            Self { translate: Some(t), rotate: None, scale: None, matrix: None } => Ok(Mat4::from_translation(*t)),
            Self { translate: None, rotate: Some(r), scale: None, matrix: None } => r.quat().map(Mat4::from_quat),
            Self { translate: None, rotate: None, scale: Some(s), matrix: None } => Ok(Mat4::from_scale(s.0)),
            Self { translate: None, rotate: None, scale: None, matrix: Some(m) } => Ok(m.0),
            _ => Err(Fault::new(at, "a step must have exactly one of `translate`, `rotate`, `scale` and `matrix`")),
        }
    }
}

/// The matrix, if it can be inverted.
pub(super) fn invertible(at: &std::ops::Range<usize>, m: Mat4) -> Result<Mat4, Fault> {
    match Transform::from_mat4(m) {
        Some(_) => Ok(m),
        None => Err(Fault::new(at, "the transformation cannot be inverted: it flattens or overflows")),
    }
}
