//! Cameras (glTF 2.0, section 3.10).

use super::Reader;
use crate::desc::{Camera, Error, Fov, Projection};
use glam::{DMat3, DMat4};
use gltf::json;
use json::camera::Type;
use json::validation::Checked;

impl Reader<'_> {
    /// The camera `index`, which the node at `place` puts at `world`.
    pub(super) fn camera(&mut self, index: usize, world: &DMat4, name: Option<&str>, place: &str) -> Result<(), Error> {
        let root = self.source.root;
        let camera = self.source.get(&root.cameras, index, "camera", &format!("{place}/camera"))?;
        let Some(to_world) = rigid(world) else {
            self.notes.at(place, "cameras that are scaled to nothing are left out");
            return Ok(());
        };
        if world.determinant() < 0.0 {
            self.notes.at(place, "cameras in a mirrored space are not mirrored");
        }
        let at = format!("/cameras/{index}");
        let (projection, aspect) = match (&camera.type_, &camera.perspective, &camera.orthographic) {
            (Checked::Valid(Type::Perspective), Some(p), _) => {
                let yfov = self.positive(p.yfov, &format!("{at}/perspective/yfov"))?;
                if yfov >= std::f32::consts::PI {
                    let message = format!("is {yfov}; expected less than π");
                    return Err(self.source.invalid(format!("{at}/perspective/yfov"), message));
                }
                let aspect = match p.aspect_ratio {
                    Some(a) => Some(self.positive(a, &format!("{at}/perspective/aspectRatio"))?),
                    None => None,
                };
                (Projection::Perspective { fov: Fov::Vertical(yfov) }, aspect)
            }
            (Checked::Valid(Type::Orthographic), _, Some(o)) => {
                let half_width = self.positive(o.xmag, &format!("{at}/orthographic/xmag"))?;
                let half_height = self.positive(o.ymag, &format!("{at}/orthographic/ymag"))?;
                let aspect = self.positive(half_width / half_height, &format!("{at}/orthographic"))?;
                (Projection::Orthographic { half_height }, Some(aspect))
            }
            (Checked::Invalid, ..) => {
                let message = "is no camera type; expected \"perspective\" or \"orthographic\"";
                return Err(self.source.invalid(format!("{at}/type"), message));
            }
            _ => return Err(self.source.invalid(at, "lacks the object that its type names")),
        };
        let name = name.or(camera.name.as_deref()).unwrap_or_default();
        self.budget.decode(self.source, place, 1, size_of::<Camera>() + name.len())?;
        self.scene.cameras.push(Camera {
            name: name.to_owned(),
            to_world: to_world.as_mat4(),
            projection,
            resolution: None,
            aspect,
            lens: None,
        });
        Ok(())
    }

    fn positive(&self, x: f32, place: &str) -> Result<f32, Error> {
        let fine = x > 0.0 && x.is_finite();
        fine.then_some(x).ok_or_else(|| self.source.invalid(place, format!("is {x}; expected a positive number")))
    }
}

/// `world` without scale, shear and mirroring: the z axis keeps its direction, and y its plane.
pub(super) fn rigid(world: &DMat4) -> Option<DMat4> {
    let axes = DMat3::from_mat4(*world);
    let z = axes.z_axis.try_normalize()?;
    let y = axes.y_axis.try_normalize()?;
    let x = y.cross(z).try_normalize()?;
    let y = z.cross(x);
    let at = world.w_axis;
    Some(DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), at))
}
