//! Accessors: typed lists of elements in buffers, strided, normalised, sparse (glTF 2.0, section 3.6.2).

use super::Reader;
use crate::desc::Error;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use std::borrow::Cow;

/// The elements of an accessor, tightly packed.
struct Elements<'a> {
    bytes: Cow<'a, [u8]>,
    component: ComponentType,
    /// Bytes of one element.
    size: usize,
}

impl Reader<'_> {
    /// Vectors of N floats, or of normalised unsigned integers where `integers` allows them; all finite.
    pub(super) fn floats<const N: usize>(
        &self,
        accessor: usize,
        place: &str,
        integers: bool,
    ) -> Result<Vec<[f32; N]>, Error> {
        let a = self.source.get(&self.source.root.accessors, accessor, "accessor", place)?;
        let fits = match component(a) {
            Some(ComponentType::F32) => !a.normalized,
            Some(ComponentType::U8 | ComponentType::U16) => integers && a.normalized,
            _ => false,
        };
        if !fits || lanes(a) != Some(N) {
            let or = if integers { " or of normalised u8 or u16" } else { "" };
            let message = format!("accessor {accessor} is {}; expected VEC{N} of f32{or}", describe(a));
            return Err(self.source.invalid(place, message));
        }
        let elements = self.elements(a, accessor)?;
        self.budget.decode(self.source, place, elements.bytes.len() / elements.size, size_of::<[f32; N]>())?;

        // Decode, and refuse what is not a number.
        let width = elements.size / N;
        let decode = |(i, element): (usize, &[u8])| {
            let vector: [f32; N] = std::array::from_fn(|lane| {
                let b = &element[lane * width..][..width];
                match elements.component {
                    ComponentType::U8 => f32::from(b[0]) / 255.0,
                    ComponentType::U16 => f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0,
                    _ => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
                }
            });
            match vector.iter().all(|x| x.is_finite()) {
                true => Ok(vector),
                false => Err(self.source.invalid(place, format!("element {i} is {vector:?}; expected finite numbers"))),
            }
        };
        elements.bytes.chunks_exact(elements.size).enumerate().map(decode).collect()
    }

    /// Indices below `bound`, of 8, 16 or 32 bits.
    pub(super) fn indices(&self, accessor: usize, place: &str, bound: usize) -> Result<Vec<u32>, Error> {
        let a = self.source.get(&self.source.root.accessors, accessor, "accessor", place)?;
        let unsigned = matches!(component(a), Some(ComponentType::U8 | ComponentType::U16 | ComponentType::U32));
        if !unsigned || lanes(a) != Some(1) || a.normalized {
            let message = format!("accessor {accessor} is {}; expected SCALAR of u8, u16 or u32", describe(a));
            return Err(self.source.invalid(place, message));
        }
        let elements = self.elements(a, accessor)?;
        self.budget.decode(self.source, place, elements.bytes.len() / elements.size, size_of::<u32>())?;
        let decode = |(i, b): (usize, &[u8])| match index(elements.component, b) {
            index if (index as usize) < bound => Ok(index),
            index => {
                let message =
                    format!("element {i} is {index}; expected an index below {bound}, the number of vertices");
                Err(self.source.invalid(place, message))
            }
        };
        elements.bytes.chunks_exact(elements.size).enumerate().map(decode).collect()
    }

    /// Number of lanes of an accessor, to choose between VEC3 and VEC4.
    pub(super) fn lanes(&self, accessor: usize) -> Option<usize> {
        self.source.root.accessors.get(accessor).and_then(lanes)
    }

    /// The raw elements, in range of their buffer.
    fn elements(&self, accessor: &Accessor, number: usize) -> Result<Elements<'_>, Error> {
        let place = format!("/accessors/{number}");
        let (Some(component), Some(lanes)) = (component(accessor), lanes(accessor)) else {
            return Err(self.source.invalid(place, format!("is {}", describe(accessor))));
        };
        let size = component.size() * lanes;
        let count = self.count(accessor.count.0, size, &format!("{place}/count"))?;
        let offset = accessor.byte_offset.unwrap_or_default().0;

        // Take the elements out of their view, without a copy where they are packed already.
        let mut bytes = match accessor.buffer_view {
            Some(view) => {
                let view = self.buffers.view(view.value(), &format!("{place}/bufferView"), &self.budget)?;
                self.packed(view.bytes, view.stride, offset, count, size, &place)?
            }
            None if accessor.sparse.is_some() => {
                self.budget.decode(self.source, &place, count, size)?;
                Cow::Owned(vec![0; count * size])
            }
            None => {
                return Err(self.source.invalid(place, "has neither bufferView nor sparse; there is nothing to read"));
            }
        };
        if let Some(sparse) = &accessor.sparse {
            self.substitute(sparse, bytes.to_mut(), count, size, &format!("{place}/sparse"))?;
        }
        Ok(Elements { bytes, component, size })
    }

    /// `count` as a usable number: positive, and `count * size` within what memory can address.
    fn count(&self, count: u64, size: usize, place: &str) -> Result<usize, Error> {
        let fits = usize::try_from(count).ok().filter(|n| *n > 0 && n.checked_mul(size).is_some());
        fits.ok_or_else(|| self.source.invalid(place, format!("is {count}; expected at least 1 that fits its buffer")))
    }

    /// `count` elements of `size` bytes, the first at `offset`, the others `stride` bytes apart.
    fn packed<'b>(
        &self,
        view: &'b [u8],
        stride: Option<usize>,
        offset: u64,
        count: usize,
        size: usize,
        place: &str,
    ) -> Result<Cow<'b, [u8]>, Error> {
        let stride = stride.unwrap_or(size);
        if stride < size {
            let message = format!("has elements of {size} bytes; its view's byteStride is {stride}");
            return Err(self.source.invalid(place, message));
        }
        let last = (count as u64 - 1).checked_mul(stride as u64).and_then(|b| b.checked_add(size as u64));
        let range = last.and_then(|length| {
            let end = offset.checked_add(length)?;
            view.get(usize::try_from(offset).ok()?..usize::try_from(end).ok()?)
        });
        let Some(range) = range else {
            let message = format!(
                "has {count} elements of {size} bytes, {stride} apart, from byte {offset}; its view has {} bytes",
                view.len()
            );
            return Err(self.source.invalid(place, message));
        };
        if stride == size {
            return Ok(Cow::Borrowed(range));
        }
        self.budget.decode(self.source, place, count, size)?;
        Ok(Cow::Owned(range.chunks(stride).flat_map(|element| &element[..size]).copied().collect()))
    }

    /// Puts the values of a sparse accessor in their places.
    fn substitute(
        &self,
        sparse: &gltf::json::accessor::sparse::Sparse,
        bytes: &mut [u8],
        count: usize,
        size: usize,
        place: &str,
    ) -> Result<(), Error> {
        let Checked::Valid(component) = sparse.indices.component_type else {
            let message = "is not an index type; expected 5121, 5123 or 5125";
            return Err(self.source.invalid(format!("{place}/indices/componentType"), message));
        };
        let width = component.0.size();
        let n = self.count(sparse.count.0, size.max(width), &format!("{place}/count"))?;
        let read = |view: usize, offset: u64, size: usize, place: &str| {
            let view = self.buffers.view(view, &format!("{place}/bufferView"), &self.budget)?;
            self.packed(view.bytes, None, offset, n, size, place)
        };
        let at = format!("{place}/indices");
        let indices = read(sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, width, &at)?;
        let from = format!("{place}/values");
        let values = read(sparse.values.buffer_view.value(), sparse.values.byte_offset.0, size, &from)?;
        for (i, (at_bytes, value)) in indices.chunks_exact(width).zip(values.chunks_exact(size)).enumerate() {
            let target = index(component.0, at_bytes) as usize;
            if target >= count {
                let message = format!("element {i} is {target}; expected an index below {count}");
                return Err(self.source.invalid(at, message));
            }
            bytes[target * size..][..size].copy_from_slice(value);
        }
        Ok(())
    }
}

fn component(a: &Accessor) -> Option<ComponentType> {
    match a.component_type {
        Checked::Valid(c) => Some(c.0),
        Checked::Invalid => None,
    }
}

/// Number of components of scalars and vectors; no attribute is a matrix.
fn lanes(a: &Accessor) -> Option<usize> {
    match a.type_ {
        Checked::Valid(Type::Scalar) => Some(1),
        Checked::Valid(Type::Vec2) => Some(2),
        Checked::Valid(Type::Vec3) => Some(3),
        Checked::Valid(Type::Vec4) => Some(4),
        _ => None,
    }
}

fn describe(a: &Accessor) -> String {
    let component = component(a).map_or("an unknown componentType".into(), |c| format!("{c:?}").to_lowercase());
    let lanes = match a.type_ {
        Checked::Valid(t) => format!("{t:?}").to_uppercase(),
        Checked::Invalid => "an unknown type".into(),
    };
    format!("{lanes} of {}{component}", if a.normalized { "normalised " } else { "" })
}

/// A little-endian unsigned integer of 1, 2 or 4 bytes.
fn index(component: ComponentType, b: &[u8]) -> u32 {
    match component {
        ComponentType::U8 => u32::from(b[0]),
        ComponentType::U16 => u32::from(u16::from_le_bytes([b[0], b[1]])),
        _ => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
    }
}
