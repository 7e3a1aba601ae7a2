//! `[camera]`, or several `[[camera]]`.

use super::keys::{keys, one_of};
use super::number::{NonNegative, PixelCount, Positive, ViewAngle};
use super::place::{Matrix, is_rotation, unit};
use super::read::{At, Fault, Read};
use crate::desc::{Camera, Fov, Lens, Projection};
use glam::{Mat3, Mat4, Vec3};
use std::ops::Range;

keys! {
    /// A viewpoint.
    struct CameraTable {
        /// Name for `--camera`. Default: empty.
        name: String = String::new(),
        /// Centre of projection [x, y, z] in metres.
        position: Option<At<Vec3>>,
        /// Point in the middle of the image [x, y, z] in metres.
        target: Option<Vec3>,
        /// Direction that is up in the image. Default [0, 1, 0].
        up: Option<At<Vec3>>,
        /// Camera to world, in place of the three keys above: a rigid motion as a matrix of three rows of four numbers. The camera looks along its −z axis, +y is up.
        matrix: Option<At<Matrix>>,
        /// Width and height of the image in pixels. Default: what the command line says.
        resolution: Option<[PixelCount; 2]>,
        /// Width over height of the image where no resolution is given. Default: what the command line says.
        aspect: Option<Positive>,
        ..kind: CameraKind,
    }
}

one_of! {
    /// How film points become rays.
    enum CameraKind {
        "perspective" => Perspective,
        "orthographic" => Orthographic,
        "equirectangular" => Equirectangular,
    } default Some("perspective")
}

keys! {
    /// Rays through the centre of projection, or from a thin lens about it.
    struct Perspective {
        /// Full angle of view across the image's height in degrees. Default 45.
        view_angle: Option<ViewAngle>,
        /// Full angle of view across the image's width in degrees, in place of `view_angle`.
        horizontal_view_angle: Option<At<ViewAngle>>,
        /// Radius of the lens in metres; 0 is a pinhole, where everything is sharp. Default 0.
        lens_radius: NonNegative = NonNegative(0.0),
        /// Distance along the axis to the plane in focus in metres. Default: to the target.
        focus_distance: Option<Positive>,
    }
}

keys! {
    /// Parallel rays.
    struct Orthographic {
        /// Height of the view window in metres; its width follows from the resolution.
        height: Positive,
    }
}

keys! {
    /// The whole sphere of directions, the target in the middle of the image.
    struct Equirectangular {
    }
}

impl CameraTable {
    /// The camera. `at` is the place of its table.
    pub(super) fn build(&self, at: &Range<usize>) -> Result<Camera, Fault> {
        let CameraTable { name, resolution, aspect, kind, .. } = self;
        let (to_world, distance) = self.placed(at)?;
        let (projection, lens) = match kind {
            CameraKind::Perspective(p) => {
                let fov = match (p.view_angle, &p.horizontal_view_angle) {
                    (Some(_), Some(h)) => {
                        return Err(Fault::new(&h.at, "`view_angle` is given too; expected one of the two"));
                    }
                    (None, Some(h)) => Fov::Horizontal(h.value.0),
                    (v, None) => Fov::Vertical(v.map_or(45f32.to_radians(), |v| v.0)),
                };
                let focus_distance = p.focus_distance.map(|f| f.0).or(distance);
                let lens = match (p.lens_radius.0 > 0.0, focus_distance) {
                    (false, _) => None,
                    (true, Some(focus_distance)) => Some(Lens { radius: p.lens_radius.0, focus_distance }),
                    (true, None) => return Err(Fault::new(at, "missing key `focus_distance`; expected a number > 0")),
                };
                (Projection::Perspective { fov }, lens)
            }
            CameraKind::Orthographic(o) => (Projection::Orthographic { half_height: 0.5 * o.height.0 }, None),
            CameraKind::Equirectangular(_) => (Projection::Equirectangular, None),
        };
        let resolution = resolution.map(|r| r.map(|n| n.0));
        Ok(Camera { name: name.clone(), to_world, projection, resolution, aspect: aspect.map(|a| a.0), lens })
    }

    /// Camera → world, and the distance to the target where one is given.
    fn placed(&self, at: &Range<usize>) -> Result<(Mat4, Option<f32>), Fault> {
        match (&self.matrix, &self.position, self.target) {
            (Some(m), None, None) if self.up.is_none() => {
                let Matrix(to_world) = m.value;
                if !is_rotation(Mat3::from_mat4(to_world)) {
                    return Err(Fault::new(&m.at, "is no rigid motion: expected a rotation and a translation"));
                }
                Ok((to_world, None))
            }
            (Some(m), ..) => Err(Fault::new(&m.at, "`position`, `target` or `up` is given too; expected one way")),
            (None, Some(position), Some(target)) => {
                let up = self.up.clone().unwrap_or(At::nowhere(Vec3::Y));
                Ok((look_at(position, target, &up)?, Some(position.value.distance(target))))
            }
            (None, position, _) => {
                let key = if position.is_none() { "position" } else { "target" };
                Err(Fault::new(at, format!("missing key `{key}`; expected {}", Vec3::one())))
            }
        }
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(camera: &Camera) -> Self {
        let Camera { name, to_world, projection, resolution, aspect, lens } = camera;
        let kind = match *projection {
            Projection::Perspective { fov } => {
                let (view_angle, horizontal_view_angle) = match fov {
                    Fov::Vertical(v) => (Some(ViewAngle(v)), None),
                    Fov::Horizontal(h) => (None, Some(At::nowhere(ViewAngle(h)))),
                };
                CameraKind::Perspective(Perspective {
                    view_angle,
                    horizontal_view_angle,
                    lens_radius: NonNegative(lens.map_or(0.0, |lens| lens.radius)),
                    focus_distance: lens.map(|lens| Positive(lens.focus_distance)),
                })
            }
            Projection::Orthographic { half_height } => {
                CameraKind::Orthographic(Orthographic { height: Positive(2.0 * half_height) })
            }
            Projection::Equirectangular => CameraKind::Equirectangular(Equirectangular {}),
        };
        Self {
            name: name.clone(),
            position: None,
            target: None,
            up: None,
            matrix: Some(At::nowhere(Matrix(*to_world))),
            resolution: resolution.map(|r| r.map(PixelCount)),
            aspect: aspect.map(Positive),
            kind,
        }
    }
}

/// Camera → world: −z to the target, y as near to `up` as that allows. In f64: positions may be far from the origin.
fn look_at(position: &At<Vec3>, target: Vec3, up: &At<Vec3>) -> Result<Mat4, Fault> {
    let from = position.value.as_dvec3();
    let Some(z) = (from - target.as_dvec3()).try_normalize() else {
        return Err(Fault::new(&position.at, "`position` is also the `target`; expected two points"));
    };
    let at = if up.at.is_empty() { &position.at } else { &up.at };
    let x = unit(up)?.as_dvec3().cross(z);
    let Some(x) = x.try_normalize().filter(|_| x.length() > 1e-6) else {
        return Err(Fault::new(at, "`up` is the direction of view; expected another direction"));
    };
    let [x, y, z, w] = [x.extend(0.0), z.cross(x).extend(0.0), z.extend(0.0), from.extend(1.0)].map(|v| v.as_vec4());
    Ok(Mat4::from_cols(x, y, z, w))
}
