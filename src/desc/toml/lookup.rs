//! How a use of a texture looks it up: which texture coordinates, and what becomes of them.

use super::build::Builder;
use super::keys::keys;
use super::number::Number;
use super::read::{At, Fault, Node, Read};
use super::schema::Defs;
use super::short::{NameOr, OfTexture};
use super::write::{Write, array};
use super::writer::Names;
use crate::desc::TextureRef;
use glam::Affine2;
use serde_json::Value as Json;

keys! {
    /// How a texture is looked up.
    struct Lookup {
        /// Which of the mesh's UV sets: 0 or 1. Default 0.
        uv_set: u32 = 0,
        /// What (u, v) become before the texture's own scale, rotation and offset: two rows [a, b, c] for a u + b v + c. Default: what they are.
        uv_matrix: Option<UvMatrix>,
    }
}

impl Lookup {
    /// The first UV set as it is.
    pub(super) fn plain() -> Self {
        Self { uv_set: 0, uv_matrix: None }
    }

    /// UV → UV of this use of a texture that maps them by `own`.
    pub(super) fn transform(&self, own: Affine2) -> Affine2 {
        match self.uv_matrix {
            None => own,
            Some(UvMatrix(m)) if own == Affine2::IDENTITY => m,
            Some(UvMatrix(m)) => own * m,
        }
    }

    /// The lookup of a texture that maps nothing itself.
    pub(super) fn of(texture: &TextureRef) -> Self {
        let matrix = (texture.transform != Affine2::IDENTITY).then_some(UvMatrix(texture.transform));
        Self { uv_set: texture.uv_set as u32, uv_matrix: matrix }
    }
}

/// An affine map of UV, by rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct UvMatrix(Affine2);

impl Read for UvMatrix {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let [[a, b, x], [c, d, y]] = <[[Number; 3]; 2]>::read(node)?.map(|row| row.map(|x| x.0));
        Ok(Self(Affine2::from_cols_array(&[a, c, b, d, x, y])))
    }
    fn one() -> String {
        "two rows of three numbers".into()
    }
    fn many() -> String {
        "matrices".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        <[[Number; 3]; 2]>::schema(defs)
    }
}

impl Write for UvMatrix {
    fn text(&self) -> String {
        let [a, c, b, d, x, y] = self.0.to_cols_array();
        array(&[[a, b, x].map(Number), [c, d, y].map(Number)])
    }
}

keys! {
    /// A texture.
    struct TextureUse {
        /// Name of the texture.
        texture: At<String>,
        ..lookup: Lookup,
    }
}

/// A texture by its name, or a table with more to say.
pub(super) type TextureValue = NameOr<TextureUse>;

impl OfTexture for TextureUse {
    const KEY: &'static str = "uv_set";
    fn of_texture(texture: At<String>) -> Self {
        Self { texture, lookup: Lookup::plain() }
    }
}

impl TextureValue {
    /// The use of a texture of numbers.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<TextureRef, Fault> {
        b.texture(&self.0.texture, &self.0.lookup, false)
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(texture: &TextureRef, names: &Names) -> Self {
        NameOr(TextureUse { texture: names.texture(texture), lookup: Lookup::of(texture) })
    }
}
