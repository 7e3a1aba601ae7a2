//! Cameras as written.

use glam::Mat4;

/// A viewpoint: at the origin of its own space, looking along −z with +y up (as in glTF).
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name for `--camera`; may be empty.
    pub name: String,
    /// Camera space → world: a rigid motion (readers remove scale).
    pub to_world: Mat4,
    /// How film points become rays.
    pub projection: Projection,
    /// Width and height in pixels that the file asks for.
    pub resolution: Option<[u32; 2]>,
    /// Width over height that the file asks for where it gives no resolution.
    pub aspect: Option<f32>,
    /// A thin lens instead of a pinhole (perspective only).
    pub lens: Option<Lens>,
}

/// How film points become rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Through the centre of projection.
    Perspective {
        /// The view angle.
        fov: Fov,
    },
    /// Parallel to the axis.
    Orthographic {
        /// Half the height of the view window \[m\]; the width follows from the resolution.
        half_height: f32,
    },
    /// The whole sphere of directions: longitude across, latitude down, −z in the middle.
    Equirectangular,
}

/// Full view angle \[rad\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fov {
    /// Across the image's width.
    Horizontal(f32),
    /// Across the image's height.
    Vertical(f32),
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the aperture \[m\].
    pub radius: f32,
    /// Distance along the axis to the plane in focus \[m\].
    pub focus_distance: f32,
}
