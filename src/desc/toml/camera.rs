//! `[camera]`, or several `[[camera]]`.

use super::keys::{keys, one_of};
use super::place::unit;
use super::read::{At, Fault, NonNegative, PixelCount, Positive, ViewAngle};
use crate::desc::{Camera, Fov, Lens, Projection};
use glam::{Mat4, Vec3};

keys! {
    /// A viewpoint.
    struct CameraTable {
        /// Name for `--camera`. Default: empty.
        name: String = String::new(),
        /// Centre of projection [x, y, z] in metres.
        position: At<Vec3>,
        /// Point in the middle of the image [x, y, z] in metres.
        target: Vec3,
        /// Direction that is up in the image. Default [0, 1, 0].
        up: At<Vec3> = At { at: 0..0, value: Vec3::Y },
        /// Width and height of the image in pixels. Default: what the command line says.
        resolution: Option<[PixelCount; 2]>,
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
    /// The camera.
    pub(super) fn build(&self) -> Result<Camera, Fault> {
        let CameraTable { name, position, target, up, resolution, kind } = self;
        let to_world = look_at(position, *target, up)?;
        let (projection, lens) = match kind {
            CameraKind::Perspective(p) => {
                let fov = match (p.view_angle, &p.horizontal_view_angle) {
                    (Some(_), Some(h)) => {
                        return Err(Fault::new(&h.at, "`view_angle` is given too; expected one of the two"));
                    }
                    (None, Some(h)) => Fov::Horizontal(h.value.0.to_radians()),
                    (v, None) => Fov::Vertical(v.map_or(45.0f32, |v| v.0).to_radians()),
                };
                let focus_distance = p.focus_distance.map_or(position.value.distance(*target), |f| f.0);
                let lens = (p.lens_radius.0 > 0.0).then_some(Lens { radius: p.lens_radius.0, focus_distance });
                (Projection::Perspective { fov }, lens)
            }
            CameraKind::Orthographic(o) => (Projection::Orthographic { half_height: 0.5 * o.height.0 }, None),
            CameraKind::Equirectangular(_) => (Projection::Equirectangular, None),
        };
        let resolution = resolution.map(|r| r.map(|n| n.0));
        Ok(Camera { name: name.clone(), to_world, projection, resolution, aspect: None, lens })
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
