//! Where things stand: transformations as written.

use super::keys::keys;
use super::number::{Angle, Number};
use super::read::{At, Fault, Node, Read, mismatch};
use super::schema::Defs;
use super::short::Each;
use super::write::{Write, array};
use crate::desc::mesh_check::unit_vector;
use crate::math::Transform;
use glam::{Mat3, Mat4, Quat, Vec3};
use serde_json::{Value as Json, json};
use std::ops::Range;

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
        angle: Angle,
    }
}

impl Rotation {
    /// As a unit quaternion.
    pub(super) fn quat(&self) -> Result<Quat, Fault> {
        Ok(Quat::from_axis_angle(unit(&self.axis)?, self.angle.0))
    }
}

/// The unit vector along a written one, which stays as it is where it is one already.
pub(super) fn unit(v: &At<Vec3>) -> Result<Vec3, Fault> {
    let unit = unit_vector(v.value);
    unit.ok_or_else(|| Fault::new(&v.at, "found [0, 0, 0], expected a direction"))
}

/// A scale.
type Scale = Each<Number, 3>;

/// A matrix, by rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix(pub(super) Mat4);

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

impl Write for Matrix {
    fn text(&self) -> String {
        let rows = self.0.transpose();
        array(&[rows.x_axis, rows.y_axis, rows.z_axis])
    }
}

/// A rotation as a matrix of three rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows(pub(super) Mat3);

impl Rows {
    /// The matrix at `at`, if it is a rotation.
    pub(super) fn rotation(&self, at: &Range<usize>) -> Result<Mat3, Fault> {
        if is_rotation(self.0) { Ok(self.0) } else { Err(Fault::new(at, "its three rows are not a rotation's")) }
    }
}

/// Whether the columns are a right-handed orthonormal basis, as far as f32 tells.
pub(super) fn is_rotation(m: Mat3) -> bool {
    (m.transpose() * m).abs_diff_eq(Mat3::IDENTITY, 1e-4) && m.determinant() > 0.0
}

impl Read for Rows {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let rows = <[[Number; 3]; 3]>::read(node)?.map(|row| row.map(|x| x.0));
        Ok(Self(Mat3::from_cols_array_2d(&rows).transpose()))
    }
    fn one() -> String {
        "three rows of three numbers".into()
    }
    fn many() -> String {
        "matrices".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        <[[Number; 3]; 3]>::schema(defs)
    }
}

impl Write for Rows {
    fn text(&self) -> String {
        array(&self.0.transpose().to_cols_array_2d().map(|row| row.map(Number)))
    }
}

impl Place {
    /// Object → parent. `at` is where a singular one is reported.
    pub(super) fn matrix(&self, at: &Range<usize>) -> Result<Mat4, Fault> {
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
                let scale = scale.as_ref().map_or(Vec3::ONE, |s| scaling(&s.value));
                (scale_at, Mat4::from_scale_rotation_translation(scale, rotate, translate.unwrap_or(Vec3::ZERO)))
            }
            _ => {
                let message = "gives its place twice; expected `transform`, or `matrix`, or any of `translate`, `rotate` and `scale`";
                return Err(Fault::new(at, message));
            }
        };
        invertible(at, product)
    }

    /// The inverse of [`Self::matrix`]: scale and translation where that is all, else the matrix.
    pub(super) fn of(m: Mat4) -> Self {
        let mut place = Self { translate: None, rotate: None, scale: None, matrix: None, transform: None };
        let (scale, translate) = (Vec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), m.w_axis.truncate());
        let plain = Mat4::from_scale_rotation_translation(scale, Quat::IDENTITY, translate);
        if plain.to_cols_array().map(f32::to_bits) == m.to_cols_array().map(f32::to_bits) {
            place.translate = translate.to_array().iter().any(|x| x.to_bits() != 0).then_some(translate);
            place.scale = (scale != Vec3::ONE).then(|| At::nowhere(Each(scale.to_array().map(Number))));
        } else {
            place.matrix = Some(At::nowhere(Matrix(m)));
        }
        place
    }
}

impl Step {
    fn matrix(&self, at: &Range<usize>) -> Result<Mat4, Fault> {
        match self {
            Self { translate: Some(t), rotate: None, scale: None, matrix: None } => Ok(Mat4::from_translation(*t)),
            Self { translate: None, rotate: Some(r), scale: None, matrix: None } => r.quat().map(Mat4::from_quat),
            Self { translate: None, rotate: None, scale: Some(s), matrix: None } => Ok(Mat4::from_scale(scaling(s))),
            Self { translate: None, rotate: None, scale: None, matrix: Some(m) } => Ok(m.0),
            _ => Err(Fault::new(at, "a step must have exactly one of `translate`, `rotate`, `scale` and `matrix`")),
        }
    }
}

fn scaling(scale: &Scale) -> Vec3 {
    scale.0.map(|x| x.0).into()
}

/// The matrix, if it can be inverted.
pub(super) fn invertible(at: &Range<usize>, m: Mat4) -> Result<Mat4, Fault> {
    match Transform::from_mat4(m) {
        Some(_) => Ok(m),
        None => Err(Fault::new(at, "the transformation cannot be inverted: it flattens or overflows")),
    }
}
