//! Uses of textures, and the numbers beside them, wherever they stand: in the core, or inside an extension's object that
//! has no type.

use super::extensions::kind;
use super::{Reader, Source};
use crate::desc::{Error, TextureRef};
use glam::{Affine2, Mat2, Vec2};
use gltf::json;
use json::extensions::texture::TextureTransform;
use serde::Deserialize;
use serde_json::Value;

/// A use of a texture: a `textureInfo` of glTF 2.0 (section 5.30) with its KHR_texture_transform.
pub(super) struct Slot {
    /// Which texture of the document.
    pub texture: usize,
    /// n of TEXCOORD_n.
    pub uv_set: u32,
    /// UV → UV before the look-up.
    pub transform: Affine2,
}

impl Slot {
    /// One that the `gltf` crate knows, at `place`.
    pub(super) fn of_info(info: &json::texture::Info, source: Source, place: &str) -> Result<Self, Error> {
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        Self::new(info.index.value(), info.tex_coord, transform, source, place)
    }

    /// That of a normal map, whose extensions the `gltf` crate leaves untyped.
    pub(super) fn of_normals(info: &json::material::NormalTexture, source: Source, place: &str) -> Result<Self, Error> {
        let transform = match info.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform")) {
            Some(value) => Some(
                TextureTransform::deserialize(value)
                    .map_err(|e| source.invalid(format!("{place}/extensions/KHR_texture_transform"), e.to_string()))?,
            ),
            None => None,
        };
        Self::new(info.index.value(), info.tex_coord, transform.as_ref(), source, place)
    }

    /// One in plain JSON, at `place`.
    #[allow(dead_code, reason = "for extensions that the `gltf` crate leaves untyped")]
    pub(super) fn of_json(value: &Value, source: Source, place: &str) -> Result<Self, Error> {
        if !value.is_object() {
            return Err(source.invalid(place, format!("is {}; expected an object with an index", kind(value))));
        }
        let info = json::texture::Info::deserialize(value).map_err(|e| source.invalid(place, e.to_string()))?;
        Self::of_info(&info, source, place)
    }

    fn new(
        texture: usize,
        uv_set: u32,
        transform: Option<&TextureTransform>,
        source: Source,
        place: &str,
    ) -> Result<Self, Error> {
        let Some(t) = transform else { return Ok(Self { texture, uv_set, transform: Affine2::IDENTITY }) };
        let transform = affine(t.offset.0.into(), t.rotation.0, t.scale.0.into());
        if !transform.is_finite() {
            let place = format!("{place}/extensions/KHR_texture_transform");
            return Err(source.invalid(place, "has numbers that are not finite"));
        }
        Ok(Self { texture, uv_set: t.tex_coord.unwrap_or(uv_set), transform })
    }
}

#[allow(dead_code, reason = "for extensions that the `gltf` crate leaves untyped")]
impl Reader<'_> {
    /// The texture under `key` of an extension's object, which stands at `place`; `None` where the object has no such
    /// key. `srgb`: it holds colours, not numbers.
    pub(super) fn texture_under(
        &mut self,
        object: &Value,
        key: &str,
        srgb: bool,
        place: &str,
    ) -> Result<Option<TextureRef>, Error> {
        let Some(value) = object.get(key) else { return Ok(None) };
        let place = format!("{place}/{key}");
        let slot = Slot::of_json(value, self.source, &place)?;
        self.texture(slot, srgb, &place)
    }

    /// The finite number under `key` of an extension's object, which stands at `place`; `default` where there is none.
    pub(super) fn number_under(&self, object: &Value, key: &str, default: f32, place: &str) -> Result<f32, Error> {
        let Some(value) = object.get(key) else { return Ok(default) };
        let place = format!("{place}/{key}");
        let number = value
            .as_f64()
            .ok_or_else(|| self.source.invalid(&place, format!("is {}; expected a number", kind(value))))?;
        self.finite(number as f32, &place)
    }

    /// The `N` finite numbers under `key` of an extension's object, which stands at `place`; `default` where there are
    /// none.
    pub(super) fn numbers_under<const N: usize>(
        &self,
        object: &Value,
        key: &str,
        default: [f32; N],
        place: &str,
    ) -> Result<[f32; N], Error> {
        let Some(value) = object.get(key) else { return Ok(default) };
        let place = format!("{place}/{key}");
        let numbers = value.as_array().filter(|list| list.len() == N);
        let numbers: Option<Vec<f64>> = numbers.and_then(|list| list.iter().map(Value::as_f64).collect());
        let numbers = numbers.ok_or_else(|| self.source.invalid(&place, format!("is not a list of {N} numbers")))?;
        let mut found = default;
        for (x, number) in found.iter_mut().zip(numbers) {
            *x = self.finite(number as f32, &place)?;
        }
        Ok(found)
    }
}

/// KHR_texture_transform: uv' = T R S uv, with R a counter-clockwise turn of UV as seen with v pointing downwards.
fn affine(offset: Vec2, rotation: f32, scale: Vec2) -> Affine2 {
    let (sin, cos) = rotation.sin_cos();
    let turn = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
    Affine2::from_mat2_translation(turn * Mat2::from_diagonal(scale), offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The extension's first example: the lower left quadrant of the image, turned clockwise by 90°.
    #[test]
    fn transform_selects_the_lower_left_quadrant() {
        let map = affine(Vec2::new(0.0, 1.0), std::f32::consts::FRAC_PI_2, Vec2::splat(0.5));
        for (uv, expected) in
            [([0.0, 0.0], [0.0, 1.0]), ([1.0, 0.0], [0.0, 0.5]), ([0.0, 1.0], [0.5, 1.0]), ([1.0, 1.0], [0.5, 0.5])]
        {
            assert!(map.transform_point2(uv.into()).abs_diff_eq(expected.into(), 1e-6), "{uv:?}");
        }
    }

    /// A slot in plain JSON says the same as a typed one: index, set (overridden by the transform), transform.
    #[test]
    fn slots_in_plain_json() {
        let root = json::Root::default();
        let source = Source { file: std::path::Path::new("x.gltf"), root: &root };
        let transform = serde_json::json!({ "offset": [1, 2], "scale": [3, 4], "texCoord": 5 });
        let plain =
            serde_json::json!({ "index": 7, "texCoord": 1, "extensions": { "KHR_texture_transform": transform } });
        let slot = Slot::of_json(&plain, source, "/x").unwrap();
        assert_eq!((slot.texture, slot.uv_set), (7, 5));
        assert_eq!(slot.transform.transform_point2(Vec2::ONE), Vec2::new(4.0, 6.0));
        for (bad, place) in [
            (serde_json::json!(3), "/x"),
            (serde_json::json!({ "texCoord": 0 }), "/x"),
            (
                serde_json::json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [1e39, 1] } } }),
                "/x/extensions/KHR_texture_transform",
            ),
        ] {
            assert_eq!(Slot::of_json(&bad, source, "/x").err().unwrap().place, place, "{bad}");
        }
    }
}
