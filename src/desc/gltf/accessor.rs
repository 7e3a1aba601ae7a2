//! Accessors: typed lists of elements in buffers, strided, normalised, sparse (glTF 2.0, section 3.6.2).

use super::Source;
use super::budget::Budget;
use super::buffers::Buffers;
use super::component::{self, Types};
use crate::desc::Error;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;
use std::borrow::Cow;
use std::fmt;

/// How the elements of a list are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub component: ComponentType,
    /// Components of one element.
    pub lanes: usize,
    pub normalized: bool,
}

impl Layout {
    /// Bytes of one element.
    pub(super) fn size(self) -> usize {
        self.lanes * self.component.size()
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&describe(Some(self.lanes), Some(self.component), self.normalized))
    }
}

/// The elements of a list, tightly packed.
pub(super) struct Elements<'b> {
    pub bytes: Cow<'b, [u8]>,
    pub layout: Layout,
}

impl Elements<'_> {
    /// How many.
    pub(super) fn count(&self) -> usize {
        self.bytes.len() / self.layout.size()
    }

    fn iter(&self) -> impl Iterator<Item = (usize, &[u8])> {
        self.bytes.chunks_exact(self.layout.size()).enumerate()
    }
}

/// What accessors are read with.
#[derive(Clone, Copy)]
pub(super) struct Accessors<'b, 'a> {
    pub source: Source<'a>,
    pub buffers: &'b Buffers<'a>,
    pub budget: &'b Budget,
}

impl<'b> Accessors<'b, '_> {
    /// Vectors of N numbers, all finite.
    pub(super) fn floats<const N: usize>(
        self,
        accessor: usize,
        place: &str,
        types: Types,
    ) -> Result<Vec<[f32; N]>, Error> {
        self.fit::<N>(self.layout(accessor, place)?, types, place)?;
        self.vectors(&self.elements(accessor, place)?, types, place)
    }

    /// Elements as vectors of N numbers, all finite.
    pub(super) fn vectors<const N: usize>(
        self,
        elements: &Elements,
        types: Types,
        place: &str,
    ) -> Result<Vec<[f32; N]>, Error> {
        let Layout { component, normalized, .. } = elements.layout;
        self.fit::<N>(elements.layout, types, place)?;
        self.budget.decode(self.source, place, elements.count(), size_of::<[f32; N]>())?;

        // Decode, and refuse what is not a number.
        let decode = |(i, element): (usize, &[u8])| {
            let lane = |lane| component::number(component, normalized, &element[lane * component.size()..]);
            let vector: [f32; N] = std::array::from_fn(lane);
            match vector.iter().all(|x| x.is_finite()) {
                true => Ok(vector),
                false => Err(self.source.invalid(place, format!("element {i} is {vector:?}; expected finite numbers"))),
            }
        };
        elements.iter().map(decode).collect()
    }

    /// Whether elements of this layout are vectors of N numbers.
    fn fit<const N: usize>(self, layout: Layout, types: Types, place: &str) -> Result<(), Error> {
        if types.hold(layout.component, layout.normalized) && layout.lanes == N {
            return Ok(());
        }
        Err(self.source.invalid(place, format!("is {layout}; expected {} of {types}", kind(Some(N)))))
    }

    /// Vectors of N unsigned integers.
    pub(super) fn integers<const N: usize>(self, elements: &Elements, place: &str) -> Result<Vec<[u32; N]>, Error> {
        let Layout { component, lanes, normalized } = elements.layout;
        let unsigned = matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if !unsigned || lanes != N || normalized {
            let message = format!("is {}; expected {} of u8, u16 or u32", elements.layout, kind(Some(N)));
            return Err(self.source.invalid(place, message));
        }
        self.budget.decode(self.source, place, elements.count(), size_of::<[u32; N]>())?;
        let decode = |(_, element): (usize, &[u8])| {
            std::array::from_fn(|lane| component::index(component, &element[lane * component.size()..]))
        };
        Ok(elements.iter().map(decode).collect())
    }

    /// Indices below `bound`, the number of vertices.
    pub(super) fn indices(self, elements: &Elements, place: &str, bound: usize) -> Result<Vec<u32>, Error> {
        let indices = self.integers::<1>(elements, place)?;
        match indices.iter().position(|[index]| *index as usize >= bound) {
            Some(i) => {
                let [index] = indices[i];
                let message =
                    format!("element {i} is {index}; expected an index below {bound}, the number of vertices");
                Err(self.source.invalid(place, message))
            }
            None => Ok(indices.into_flattened()),
        }
    }

    /// How the elements of accessor `number`, which `place` refers to, are stored.
    pub(super) fn layout(self, number: usize, place: &str) -> Result<Layout, Error> {
        let accessor = self.source.get(&self.source.root.accessors, number, "accessor", place)?;
        let component = match accessor.component_type {
            Checked::Valid(c) => Some(c.0),
            Checked::Invalid => None,
        };
        let lanes = match accessor.type_ {
            Checked::Valid(Type::Scalar) => Some(1),
            Checked::Valid(Type::Vec2) => Some(2),
            Checked::Valid(Type::Vec3) => Some(3),
            Checked::Valid(Type::Vec4) => Some(4),
            // Columns of other matrices may be padded; none of them has a use.
            Checked::Valid(Type::Mat4) => Some(16),
            _ => None,
        };
        match (component, lanes) {
            (Some(component), Some(lanes)) => Ok(Layout { component, lanes, normalized: accessor.normalized }),
            _ => Err(self.source.invalid(place, format!("is {}", describe(lanes, component, accessor.normalized)))),
        }
    }

    /// The elements of accessor `number`, which `place` refers to, in range of their buffer.
    pub(super) fn elements(self, number: usize, place: &str) -> Result<Elements<'b>, Error> {
        let layout = self.layout(number, place)?;
        let accessor = self.source.get(&self.source.root.accessors, number, "accessor", place)?;
        let place = format!("/accessors/{number}");
        let size = layout.size();
        let count = self.count(accessor.count.0, size, &format!("{place}/count"))?;
        let offset = accessor.byte_offset.unwrap_or_default().0;

        // Take the elements out of their view, without a copy where they are packed already.
        let mut bytes = match accessor.buffer_view {
            Some(view) => {
                let view = self.buffers.view(view.value(), &format!("{place}/bufferView"), self.budget)?;
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
        Ok(Elements { bytes, layout })
    }

    /// `count` as a usable number: positive, and `count * size` within what memory can address.
    fn count(self, count: u64, size: usize, place: &str) -> Result<usize, Error> {
        let fits = usize::try_from(count).ok().filter(|n| *n > 0 && n.checked_mul(size).is_some());
        fits.ok_or_else(|| self.source.invalid(place, format!("is {count}; expected at least 1 that fits its buffer")))
    }

    /// `count` elements of `size` bytes, the first at `offset`, the others `stride` bytes apart.
    fn packed(
        self,
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
        self,
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
            let view = self.buffers.view(view, &format!("{place}/bufferView"), self.budget)?;
            self.packed(view.bytes, None, offset, n, size, place)
        };
        let at = format!("{place}/indices");
        let indices = read(sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, width, &at)?;
        let from = format!("{place}/values");
        let values = read(sparse.values.buffer_view.value(), sparse.values.byte_offset.0, size, &from)?;
        for (i, (at_bytes, value)) in indices.chunks_exact(width).zip(values.chunks_exact(size)).enumerate() {
            let target = component::index(component.0, at_bytes) as usize;
            if target >= count {
                let message = format!("element {i} is {target}; expected an index below {count}");
                return Err(self.source.invalid(at, message));
            }
            bytes[target * size..][..size].copy_from_slice(value);
        }
        Ok(())
    }
}

/// The name of a type with so many components.
fn kind(lanes: Option<usize>) -> &'static str {
    match lanes {
        Some(1) => "SCALAR",
        Some(2) => "VEC2",
        Some(3) => "VEC3",
        Some(4) => "VEC4",
        Some(16) => "MAT4",
        _ => "an unknown type",
    }
}

fn describe(lanes: Option<usize>, component: Option<ComponentType>, normalized: bool) -> String {
    let component = component.map_or("an unknown componentType".into(), |c| format!("{c:?}").to_lowercase());
    format!("{} of {}{component}", kind(lanes), if normalized { "normalised " } else { "" })
}
