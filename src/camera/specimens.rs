//! The family, for tests and verification: every projection, at rest and posed.

use super::Camera;
use crate::desc::{self, Fov, Lens, Projection};
use glam::{EulerRot, Mat4, Quat, Vec3};

/// A camera with a name.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Name for reports.
    pub name: &'static str,
    /// As it was written: projection, lens and pose.
    pub written: desc::Camera,
    /// The camera ready for a film of [`SIZE`].
    pub camera: Camera,
}

/// Pixels across and down of the specimens.
pub const SIZE: [u32; 2] = [40, 30];

/// Every projection, with narrow and wide angles, with a lens, moved and turned.
pub fn specimens() -> Vec<Specimen> {
    let turned = Quat::from_euler(EulerRot::YXZ, 0.7, -0.4, 0.2);
    let posed = Mat4::from_rotation_translation(turned, Vec3::new(1.0, -2.0, 0.5));
    let perspective = |fov| Projection::Perspective { fov };
    let lens = Some(Lens { radius: 0.2, focus_distance: 3.0 });
    [
        ("pinhole 69°", perspective(Fov::Vertical(1.2)), None, Mat4::IDENTITY),
        ("pinhole 0.006°", perspective(Fov::Vertical(1e-4)), None, posed),
        ("pinhole 172°", perspective(Fov::Vertical(3.0)), None, posed),
        ("pinhole 115° across", perspective(Fov::Horizontal(2.0)), None, posed),
        ("thin lens", perspective(Fov::Vertical(0.8)), lens, posed),
        ("orthographic", Projection::Orthographic { half_height: 1.5 }, None, posed),
        ("equirectangular", Projection::Equirectangular, None, posed),
    ]
    .map(|(name, projection, lens, to_world)| {
        let written = desc::Camera { name: name.into(), to_world, projection, resolution: None, aspect: None, lens };
        Specimen { name, camera: Camera::new(&written, SIZE), written }
    })
    .into()
}
