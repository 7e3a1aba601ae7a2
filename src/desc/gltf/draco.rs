//! KHR_draco_mesh_compression: primitives whose vertices and triangles are compressed.
//!
//! What the stream holds counts: numbers of vertices and triangles are the stream's, component types too where they
//! are not normalised. The accessors only say what the numbers mean.

use super::Source;
use super::accessor::{Elements, Layout};
use super::budget::Budget;
use crate::desc::Error;
use draco_core::draco_types::DataType;
use draco_core::geometry_attribute::PointAttribute;
use draco_core::geometry_indices::PointIndex;
use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};
use gltf::json::accessor::ComponentType;
use serde::Deserialize;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Name of the extension.
pub(super) const NAME: &str = "KHR_draco_mesh_compression";

/// Bytes that the decoder may need for a triangle beside what it returns: corners, their opposites, traversal.
const FACE: u64 = 96;
/// Bytes that the decoder may need for a vertex beside what it returns.
const POINT: u64 = 32;

/// A primitive's stream.
#[derive(Clone, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Stream {
    /// View of its bytes.
    pub buffer_view: usize,
    /// Names of attributes → their numbers in the stream.
    pub attributes: BTreeMap<String, u32>,
}

/// A stream, decoded.
pub(super) struct Decoded(Mesh);

impl Decoded {
    /// Decodes the bytes of the stream at `place`; what it may become is limited by what is left of the budget.
    pub(super) fn new(bytes: &[u8], source: Source, place: &str, budget: &Budget) -> Result<Self, Error> {
        let left = budget.left();
        let limits = DecodeLimits::default()
            .with_max_points(left / POINT)
            .with_max_faces(left / FACE)
            .with_max_decoded_bytes(left / 2);
        let mut mesh = Mesh::new();
        MeshDecoder::new()
            .decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh)
            .map_err(|e| source.invalid(place, format!("is no Draco stream of triangles: {e}")))?;
        budget.decode(source, place, mesh.num_faces(), FACE as usize)?;
        budget.decode(source, place, mesh.num_points(), POINT as usize)?;
        Ok(Self(mesh))
    }

    /// Number of triangles.
    pub(super) fn triangles(&self) -> usize {
        self.0.num_faces()
    }

    /// The triangles' vertices one after the other, or which of them is not below `bound`.
    pub(super) fn indices(&self, bound: usize) -> Result<Vec<u32>, String> {
        let flat: Vec<u32> = self.0.faces().iter().flatten().map(|point| point.0).collect();
        match flat.iter().find(|index| **index as usize >= bound) {
            Some(index) => Err(format!("has a triangle with the vertex {index}; there are {bound} vertices")),
            None => Ok(flat),
        }
    }

    /// The attribute `id`, which the accessor says is stored like `stated`.
    pub(super) fn attribute(
        &self,
        id: u32,
        stated: Layout,
        source: Source,
        place: &str,
        budget: &Budget,
    ) -> Result<Elements<'static>, Error> {
        let wrong = |message: String| source.invalid(place, message);
        let Some(attribute) = self.0.attribute_by_unique_id(id) else {
            return Err(wrong(format!("refers to attribute {id} of the stream, which is not there")));
        };
        let component = component(attribute.data_type());
        let lanes = usize::from(attribute.num_components());
        let layout = component.map(|component| Layout { component, lanes, normalized: stated.normalized });
        let fits = |layout: &Layout| {
            layout.lanes == stated.lanes && (!stated.normalized || layout.component == stated.component)
        };
        let Some(layout) = layout.filter(fits) else {
            let found = format!("{lanes} components of {:?}", attribute.data_type());
            return Err(wrong(format!("has {found} in the stream; its accessor says {stated}")));
        };
        budget.decode(source, place, self.0.num_points(), layout.size())?;
        match values(attribute, self.0.num_points(), layout.size()) {
            Some(bytes) => Ok(Elements { bytes: Cow::Owned(bytes), layout }),
            None => Err(wrong("has vertices without a value in the stream".into())),
        }
    }
}

/// The values of all vertices, `size` bytes each.
fn values(attribute: &PointAttribute, points: usize, size: usize) -> Option<Vec<u8>> {
    let (data, stride) = (attribute.buffer().data(), usize::try_from(attribute.byte_stride()).ok()?);
    let mut bytes = Vec::with_capacity(points * size);
    for point in 0..u32::try_from(points).ok()? {
        let start = stride.checked_mul(attribute.mapped_index(PointIndex(point)).0 as usize)?;
        bytes.extend_from_slice(data.get(start..start.checked_add(size)?)?);
    }
    Some(bytes)
}

fn component(of: DataType) -> Option<ComponentType> {
    match of {
        DataType::Int8 => Some(ComponentType::I8),
        DataType::Uint8 => Some(ComponentType::U8),
        DataType::Int16 => Some(ComponentType::I16),
        DataType::Uint16 => Some(ComponentType::U16),
        DataType::Uint32 => Some(ComponentType::U32),
        DataType::Float32 => Some(ComponentType::F32),
        _ => None,
    }
}
