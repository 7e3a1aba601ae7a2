//! Vertices and triangles of a primitive: read, posed, checked, repaired.

use super::accessor::{Accessors, Elements};
use super::component::Types;
use super::draco::{self, Decoded};
use super::mesh::{Ingredients, names};
use super::{Reader, normals};
use crate::desc::{Error, Mesh};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::mesh::Mode;

/// Where the attributes of a primitive are.
pub(super) struct Attributes<'b, 'a> {
    pub accessors: Accessors<'b, 'a>,
    /// The primitive's own stream, and the numbers of attributes in it.
    stream: Option<(&'b draco::Stream, Decoded)>,
    /// The primitive.
    place: &'b str,
    /// KHR_mesh_quantization: which integers may be positions, directions and texture coordinates.
    quantized: bool,
}

impl<'b> Attributes<'b, '_> {
    /// The vectors of an attribute, none where the primitive lacks it; `count` is how many there must be.
    fn vectors<const N: usize>(
        &self,
        name: &str,
        accessor: Option<usize>,
        [types, quantized]: [Types; 2],
        count: Option<usize>,
    ) -> Result<Vec<[f32; N]>, Error> {
        let Some(accessor) = accessor else { return Ok(Vec::new()) };
        let place = format!("{}/attributes/{name}", self.place);
        let types = if self.quantized { quantized } else { types };
        let values = match self.compressed(name, accessor, &place)? {
            Some(elements) => self.accessors.vectors(&elements, types, &place)?,
            None => self.accessors.floats(accessor, &place, types)?,
        };
        self.as_many(values, count, &place)
    }

    /// The elements of an attribute, wherever they are.
    pub(super) fn elements(&self, name: &str, accessor: usize, place: &str) -> Result<Elements<'b>, Error> {
        match self.compressed(name, accessor, place)? {
            Some(elements) => Ok(elements),
            None => self.accessors.elements(accessor, place),
        }
    }

    /// The elements of an attribute if the stream holds it.
    fn compressed(&self, name: &str, accessor: usize, place: &str) -> Result<Option<Elements<'static>>, Error> {
        let Some((stream, decoded)) = &self.stream else { return Ok(None) };
        let Some(id) = stream.attributes.get(name) else { return Ok(None) };
        let Accessors { source, budget, .. } = self.accessors;
        decoded.attribute(*id, self.accessors.layout(accessor, place)?, source, place, budget).map(Some)
    }

    /// `values` if there are `count`.
    pub(super) fn as_many<T>(&self, values: Vec<T>, count: Option<usize>, place: &str) -> Result<Vec<T>, Error> {
        match count.filter(|count| *count != values.len()) {
            Some(count) => {
                let message = format!("has {} elements; expected {count}, as many as POSITION", values.len());
                Err(self.accessors.source.invalid(place, message))
            }
            None => Ok(values),
        }
    }

    /// What the displacements of positions may be stored as, and those of directions.
    pub(super) fn displacement_types(&self) -> [Types; 2] {
        if self.quantized { [Types::DISPLACEMENT, Types::DIRECTION] } else { [Types::FLOAT; 2] }
    }

    /// All attributes as they are in the file; no triangles yet.
    fn read(&self, from: &Ingredients) -> Result<Mesh, Error> {
        let [position, normal, tangent, uv0, uv1, color] = from.attributes;
        let names = names(from.uv_sets);
        let name = |i: usize| &*names[i];
        let source = self.accessors.source;
        let positions = self.vectors::<3>(name(0), position, [Types::FLOAT, Types::ANY], None)?;
        let count = positions.len();
        if u32::try_from(count).is_err() {
            let message = format!("has {count} elements; at most {} can be indexed", u32::MAX);
            return Err(source.invalid(format!("{}/attributes/{}", self.place, name(0)), message));
        }
        let count = Some(count);
        let mut mesh = Mesh { positions: map(positions, Vec3::from_array), ..Mesh::default() };
        let direction = [Types::FLOAT, Types::DIRECTION];
        mesh.normals = map(self.vectors::<3>(name(1), normal, direction, count)?, Vec3::from_array);
        if !mesh.normals.is_empty() {
            mesh.tangents = map(self.vectors::<4>(name(2), tangent, direction, count)?, Vec4::from_array);
        }
        for (set, accessor) in [uv0, uv1].into_iter().enumerate() {
            let uv = self.vectors::<2>(name(3 + set), accessor, [Types::FRACTION, Types::ANY], count)?;
            mesh.uv[set] = map(uv, Vec2::from_array);
        }
        let types = [Types::FRACTION; 2];
        mesh.colors = match color.and_then(|c| source.root.accessors.get(c)).map(|a| a.type_) {
            Some(VEC3) => map(self.vectors::<3>(name(5), color, types, count)?, |[r, g, b]| Vec4::new(r, g, b, 1.0)),
            _ => map(self.vectors::<4>(name(5), color, types, count)?, Vec4::from_array),
        };
        Ok(mesh)
    }

    /// Vertices in the order of their use; `None` where that is the order of the list.
    fn indices(&self, from: &Ingredients, count: usize) -> Result<Option<Vec<u32>>, Error> {
        let place = format!("{}/indices", self.place);
        match (&self.stream, from.indices) {
            (Some((_, decoded)), _) => {
                let Accessors { source, budget, .. } = self.accessors;
                budget.decode(source, &place, decoded.triangles(), size_of::<[u32; 3]>())?;
                let indices = decoded.indices(count);
                indices
                    .map(Some)
                    .map_err(|message| source.invalid(format!("{}/extensions/{}", self.place, draco::NAME), message))
            }
            (None, Some(accessor)) => {
                let elements = self.accessors.elements(accessor, &place)?;
                self.accessors.indices(&elements, &place, count).map(Some)
            }
            (None, None) => Ok(None),
        }
    }
}

/// The type that colours without alpha have.
const VEC3: gltf::json::validation::Checked<gltf::json::accessor::Type> =
    gltf::json::validation::Checked::Valid(gltf::json::accessor::Type::Vec3);

impl<'a> Reader<'a> {
    /// The mesh that these ingredients make.
    pub(super) fn vertices(&mut self, from: &Ingredients, mode: Mode, place: &str) -> Result<Mesh, Error> {
        let joints = match &from.binding {
            Some(binding) => Some(self.joints(binding.skin, place)?),
            None => None,
        };
        let attributes = self.attributes(from, place)?;
        let mut mesh = attributes.read(from)?;
        attributes.morph(&mut mesh, &from.morph, &names(from.uv_sets), place)?;
        // Colours are clamped after that, as the specification demands.
        mesh.colors.iter_mut().for_each(|c| *c = c.clamp(Vec4::ZERO, Vec4::ONE));
        let bent = match (&from.binding, joints) {
            (Some(binding), Some(joints)) => Some(attributes.bend(&mut mesh, binding, &joints, place)?),
            _ => None,
        };

        // Put the triangles together, and drop those without area.
        let indices = attributes.indices(from, mesh.positions.len())?;
        let used = indices.as_ref().map_or(mesh.positions.len(), Vec::len);
        self.budget.decode(self.source, place, used, size_of::<[u32; 3]>())?;
        if mode == Mode::Triangles && used % 3 != 0 {
            self.notes
                .at(place, "the number of vertices is no multiple of 3: the last triangle is incomplete and skipped");
        }
        let vertex = |i: usize| indices.as_ref().map_or(i as u32, |list| list[i]);
        mesh.indices = assemble(mode, used, vertex).unwrap_or_default();
        let assembled = mesh.indices.len();
        mesh.indices.retain(|t| normals::area_vector(&mesh.positions, *t) != glam::DVec3::ZERO);
        let note = |reader: &mut Self, n: usize, what: &str| {
            if n > 0 {
                reader.notes.add(what, place, n)
            }
        };
        note(self, assembled - mesh.indices.len(), "triangles without area are dropped");
        if let Some(bent) = bent {
            bent.turn(&mut mesh.indices);
            note(self, bent.weightless, "vertices without weights follow their first joint");
            note(self, bent.unbalanced, "weights that do not add up to 1 are scaled to do so");
        }

        let lost = normals::repair_normals(&mut mesh.normals, &mesh.positions, &mesh.indices);
        note(self, lost, "normals of length zero are replaced by the triangles' own");
        let lost = normals::repair_tangents(&mut mesh.tangents, &mesh.normals);
        note(self, lost, "tangents without a direction beside the normal are replaced");
        Ok(mesh)
    }

    /// Where the attributes of these ingredients are: the stream decoded, if there is one.
    fn attributes<'b>(&'b self, from: &'b Ingredients, place: &'b str) -> Result<Attributes<'b, 'a>, Error> {
        let accessors = self.accessors();
        let stream = match &from.stream {
            Some(stream) => {
                let at = format!("{place}/extensions/{}", draco::NAME);
                let bytes = self.buffers.view(stream.buffer_view, &format!("{at}/bufferView"), &self.budget)?.bytes;
                Some((stream, Decoded::new(bytes, self.source, &at, &self.budget)?))
            }
            None => None,
        };
        let quantized = self.source.uses("KHR_mesh_quantization");
        Ok(Attributes { accessors, stream, place, quantized })
    }
}

fn map<const N: usize, V>(arrays: Vec<[f32; N]>, f: impl Fn([f32; N]) -> V) -> Vec<V> {
    arrays.into_iter().map(f).collect()
}

/// Triangles over `count` vertices in the order of their use; `None` for points and lines (glTF 2.0, section 3.7.2.1).
/// Vertices that complete no triangle are left over.
fn assemble(mode: Mode, count: usize, vertex: impl Fn(usize) -> u32) -> Option<Vec<[u32; 3]>> {
    let pick = |t: [usize; 3]| t.map(&vertex);
    let strip = count.saturating_sub(2);
    match mode {
        Mode::Triangles => Some((0..count / 3).map(|i| pick([3 * i, 3 * i + 1, 3 * i + 2])).collect()),
        // Every other triangle of a strip runs the other way round.
        Mode::TriangleStrip => Some((0..strip).map(|i| pick([i, i + 1 + i % 2, i + 2 - i % 2])).collect()),
        Mode::TriangleFan => Some((0..strip).map(|i| pick([i + 1, i + 2, 0])).collect()),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn modes_follow_the_specification() {
        let of = |mode, count| assemble(mode, count, |i| i as u32 + 10);
        assert_eq!(of(Mode::Triangles, 7), Some(vec![[10, 11, 12], [13, 14, 15]]));
        assert_eq!(of(Mode::TriangleStrip, 5), Some(vec![[10, 11, 12], [11, 13, 12], [12, 13, 14]]));
        assert_eq!(of(Mode::TriangleFan, 4), Some(vec![[11, 12, 10], [12, 13, 10]]));
        assert_eq!(of(Mode::TriangleFan, 2), Some(vec![]));
        assert_eq!(of(Mode::LineStrip, 4), None);
    }
}
