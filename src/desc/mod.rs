//! What the author wrote: plain data, produced by the readers in this folder and by nothing else, and compiled into
//! what is traced by [`crate::scene::Scene::compile`]. Nothing here knows a BVH, a light tree or a lobe.

mod camera;
mod complete;
pub mod cube_map;
pub(crate) mod emitters;
mod error;
mod expect;
pub mod export;
pub mod files;
mod frame_camera;
pub mod gltf;
pub mod ies;
pub mod image_file;
mod interior;
mod layers;
mod load;
mod material;
mod mesh_check;
mod model;
pub mod obj;
pub mod parameter;
mod place;
pub mod ply;
pub mod primitives;
mod settings;
mod shape;
pub mod sky;
pub mod specimens;
pub mod toml;

pub use camera::{Camera, Fov, Lens, Projection};
pub use complete::{NO_LIGHT, complete};
pub use error::{Error, ErrorKind};
pub use expect::{Expect, Value};
pub use frame_camera::{bounds, framing};
pub use interior::{Dispersion, Interior, absorption};
pub use layers::{Anisotropy, Clearcoat, Layers, Sheen};
pub use load::{Options, load, load_with};
pub use material::{Alpha, ColorParam, Emission, Material, NormalMap, ScalarParam, Sides};
pub use model::{
    DiffuseTransmission, Fresnel, Iridescence, MetallicRoughness, Model, Roughness, SpecularGlossiness, Transmission,
};
pub use settings::{Filter, Integrator, RenderSettings, SamplerKind, Strategy, Tonemap};
pub use shape::{Mesh, Object, Shape};

use glam::{Affine2, Mat3, Vec3};
use std::path::PathBuf;
use std::sync::Arc;

/// A whole scene, indices everywhere: `usize` fields named after a list index it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Name for people: the file's stem, or what the file says.
    pub name: String,
    /// The file it was read from, if any.
    pub source: Option<PathBuf>,
    /// Viewpoints; the first is the default.
    pub cameras: Vec<Camera>,
    /// Geometry in object space, shared by the objects that place it.
    pub shapes: Vec<Shape>,
    /// Shapes placed in the world.
    pub objects: Vec<Object>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Ways of looking into images, and procedural patterns.
    pub textures: Vec<Texture>,
    /// Pixels, shared with what is traced.
    pub images: Vec<Arc<Image>>,
    /// Lights without a surface.
    pub lights: Vec<Light>,
    /// What surrounds everything.
    pub environment: Option<Environment>,
    /// Defaults for rendering that the file gives.
    pub render: RenderSettings,
    /// Exact answers that the image must agree with.
    pub expect: Vec<Expect>,
    /// Extensions of glTF that its files name.
    pub extensions: Vec<gltf::Use>,
    /// What its files say of themselves: XMP packets in JSON-LD (`KHR_xmp_json_ld`). At most 64 KiB each.
    pub metadata: Vec<serde_json::Value>,
    /// Names of the variants that its files offer; [`Options::variant`] chooses one.
    pub variants: Vec<String>,
    /// When its last animation ends \[s\]; `None` where nothing moves.
    pub duration: Option<f64>,
    /// What a reader did that the author may not expect (ignored extensions, an added camera), a sentence each.
    pub notes: Vec<String>,
}

/// A light without a surface. Positions and directions in world space.
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// Radiates `intensity` \[W/sr\] in all directions.
    Point {
        /// Place.
        position: Vec3,
        /// Linear RGB intensity \[W/sr\].
        intensity: [f32; 3],
        /// Distance \[m\] at which the light ends, infinite for what light does: E⊥ = (I/r²) clamp(1 − (r/range)⁴, 0, 1)
        /// (KHR_lights_punctual).
        range: f32,
    },
    /// A point that radiates about `direction`: fully inside `inner`, nothing beyond `outer` (half-angles, radians),
    /// between them as KHR_lights_punctual says: clamp((cos θ − cos outer)/(cos inner − cos outer))².
    Spot {
        /// Place.
        position: Vec3,
        /// Axis, unit.
        direction: Vec3,
        /// Linear RGB intensity on the axis \[W/sr\].
        intensity: [f32; 3],
        /// Half-angle of the full cone \[rad\].
        inner: f32,
        /// Half-angle of the whole cone \[rad\].
        outer: f32,
        /// Distance \[m\] at which the light ends, as for a point.
        range: f32,
    },
    /// A point that radiates as was measured.
    Profile {
        /// Place.
        position: Vec3,
        /// Rotation of the profile's frame, in which it aims along −z (EXT_lights_ies).
        to_world: Mat3,
        /// Linear RGB factor on the profile's candelas.
        intensity: [f32; 3],
        /// The measurement, shared by the lights that have it.
        profile: Arc<ies::Profile>,
    },
    /// Parallel light that travels along `direction`.
    Directional {
        /// Direction of travel, unit.
        direction: Vec3,
        /// Linear RGB irradiance on a surface that faces it \[W/m²\].
        irradiance: [f32; 3],
    },
    /// A disk at infinity.
    Sun {
        /// Direction of travel of the light from its middle, unit.
        direction: Vec3,
        /// Linear RGB irradiance on a surface that faces it \[W/m²\].
        irradiance: [f32; 3],
        /// Angular diameter \[rad\], between 0 and π.
        diameter: f32,
    },
}

/// Light from infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Linear RGB radiance, or the factor on the image \[W·sr⁻¹·m⁻²\].
    pub radiance: [f32; 3],
    /// Equirectangular image: column 0.5 of its width looks along the local −z, the upper edge is +y, and columns
    /// grow towards +x (as seen from inside).
    pub image: Option<usize>,
    /// Local → world, a rotation.
    pub to_world: Mat3,
}

/// A use of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Which texture.
    pub texture: usize,
    /// Which of the mesh's UV sets.
    pub uv_set: usize,
    /// UV → UV before the look-up (KHR_texture_transform).
    pub transform: Affine2,
}

/// A function of UV.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// Look-up in an image. UV (0, 0) is the corner of the first pixel of the first row, v grows downwards (glTF).
    Image {
        /// Which image.
        image: usize,
        /// Whether RGB is stored with the sRGB curve (alpha never is).
        srgb: bool,
        /// Outside [0, 1], per axis.
        wrap: [Wrap; 2],
        /// Nearest instead of bilinear.
        nearest: bool,
    },
    /// Squares of two linear RGB colours, `scale` squares per unit of u and v.
    Checker {
        /// Colour where ⌊su⌋ + ⌊sv⌋ is even.
        even: [f32; 3],
        /// Colour elsewhere.
        odd: [f32; 3],
        /// Squares per unit.
        scale: [f32; 2],
    },
}

/// What stands outside the unit square of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored.
    Mirror,
    /// The border's pixel.
    Clamp,
}

/// A decoded image, first row on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Where it came from, for messages.
    pub name: String,
    /// Width and height in pixels, both at least 1.
    pub size: [u32; 2],
    /// Pixels, row by row.
    pub pixels: Pixels,
}

/// Pixels of an [`Image`].
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// 8 bits a channel, RGBA.
    Rgba8(Vec<[u8; 4]>),
    /// 16 bits a channel, RGBA.
    Rgba16(Vec<[u16; 4]>),
    /// Linear float RGBA.
    Rgba32F(Vec<[f32; 4]>),
}

impl Pixels {
    /// Codes, that a texture reads as numbers or by the sRGB curve; floats are linear.
    pub fn are_codes(&self) -> bool {
        !matches!(self, Self::Rgba32F(_))
    }

    /// Bytes of memory.
    pub fn memory(&self) -> usize {
        match self {
            Self::Rgba8(pixels) => size_of_val(&pixels[..]),
            Self::Rgba16(pixels) => size_of_val(&pixels[..]),
            Self::Rgba32F(pixels) => size_of_val(&pixels[..]),
        }
    }
}
