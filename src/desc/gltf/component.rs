//! Numbers as accessors store them (glTF 2.0, section 3.6.2.2; KHR_mesh_quantization; KHR_animation_pointer).

use gltf::json::accessor::ComponentType;
use std::fmt;

/// Which integers, beside f32, stand for numbers in one use of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Types {
    /// Normalised u8 and u16: c / (2ⁿ − 1).
    unsigned_unit: bool,
    /// Normalised i8 and i16: max(c / (2ⁿ⁻¹ − 1), −1).
    signed_unit: bool,
    /// u8 and u16 as they are.
    unsigned: bool,
    /// i8 and i16 as they are.
    signed: bool,
}

impl Types {
    /// f32 alone: positions, normals, tangents, matrices, times.
    pub(super) const FLOAT: Self = Self::new(false, false, false, false);
    /// Texture coordinates, colours, weights.
    pub(super) const FRACTION: Self = Self::new(true, false, false, false);
    /// Directions and quaternions: quantised normals and tangents, rotations of instances.
    pub(super) const DIRECTION: Self = Self::new(false, true, false, false);
    /// Displacements of quantised positions.
    pub(super) const DISPLACEMENT: Self = Self::new(false, true, false, true);
    /// Outputs of animations; displacements of texture coordinates and colours.
    pub(super) const UNIT: Self = Self::new(true, true, false, false);
    /// Quantised positions and texture coordinates; what a JSON pointer animates.
    pub(super) const ANY: Self = Self::new(true, true, true, true);

    const fn new(unsigned_unit: bool, signed_unit: bool, unsigned: bool, signed: bool) -> Self {
        Self { unsigned_unit, signed_unit, unsigned, signed }
    }

    /// Whether a component of this type is meant.
    pub(super) fn hold(self, component: ComponentType, normalized: bool) -> bool {
        match (component, normalized) {
            (ComponentType::F32, normalized) => !normalized,
            (ComponentType::U8 | ComponentType::U16, true) => self.unsigned_unit,
            (ComponentType::I8 | ComponentType::I16, true) => self.signed_unit,
            (ComponentType::U8 | ComponentType::U16, false) => self.unsigned,
            (ComponentType::I8 | ComponentType::I16, false) => self.signed,
            (ComponentType::U32, _) => false,
        }
    }
}

impl fmt::Display for Types {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("f32")?;
        let kinds = [
            (self.unsigned_unit, "normalised u8 or u16"),
            (self.signed_unit, "normalised i8 or i16"),
            (self.unsigned, "u8 or u16"),
            (self.signed, "i8 or i16"),
        ];
        kinds.into_iter().filter(|(allowed, _)| *allowed).try_for_each(|(_, kind)| write!(f, " or of {kind}"))
    }
}

/// The number that the first bytes of `b` stand for.
pub(super) fn number(component: ComponentType, normalized: bool, b: &[u8]) -> f32 {
    let (c, one) = match component {
        ComponentType::F32 | ComponentType::U32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        ComponentType::U8 => (f32::from(b[0]), 255.0),
        ComponentType::I8 => (f32::from(b[0] as i8), 127.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
    };
    if normalized { (c / one).max(-1.0) } else { c }
}

/// A little-endian unsigned integer of 1, 2 or 4 bytes.
pub(super) fn index(component: ComponentType, b: &[u8]) -> u32 {
    match component {
        ComponentType::U8 => u32::from(b[0]),
        ComponentType::U16 => u32::from(u16::from_le_bytes([b[0], b[1]])),
        _ => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_numbers() {
        assert_eq!(number(ComponentType::I8, true, &[0x80]), -1.0);
        assert_eq!(number(ComponentType::I8, true, &[0x81]), -1.0);
        assert_eq!(number(ComponentType::I8, false, &[0x80]), -128.0);
        assert_eq!(number(ComponentType::I16, true, &[0xff, 0x7f]), 1.0);
        assert_eq!(number(ComponentType::U16, false, &[0x34, 0x12]), 4660.0);
        assert_eq!(number(ComponentType::U8, true, &[51]), 0.2);
    }

    #[test]
    fn types_say_what_they_hold() {
        assert_eq!(Types::FRACTION.to_string(), "f32 or of normalised u8 or u16");
        assert!(Types::ANY.hold(ComponentType::I16, false) && !Types::ANY.hold(ComponentType::U32, false));
        assert!(!Types::DIRECTION.hold(ComponentType::I8, false) && !Types::FLOAT.hold(ComponentType::F32, true));
    }
}
