//! Primitives as meshes.

use super::{Reader, material, normals, tangents, triangles};
use crate::desc::{Error, Mesh, Shape, TextureRef};
use glam::{Vec2, Vec3, Vec4};
use gltf::json;
use json::mesh::{Mode, Semantic};
use json::validation::Checked;
use std::rc::Rc;

/// A primitive in the scene.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub shape: usize,
    pub material: usize,
}

/// All that a shape is made of: equal ingredients, one shape.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct Ingredients {
    mode: u32,
    indices: Option<usize>,
    /// Accessors of position, normal, tangent, UV 0, UV 1, colour.
    attributes: [Option<usize>; 6],
    /// UV set and transform (bits) of the normal map that the tangents are for.
    map: Option<(usize, [u32; 6])>,
}

/// The attributes that are read, in the order of [`Ingredients::attributes`].
const ATTRIBUTES: [(Semantic, &str); 6] = [
    (Semantic::Positions, "POSITION"),
    (Semantic::Normals, "NORMAL"),
    (Semantic::Tangents, "TANGENT"),
    (Semantic::TexCoords(0), "TEXCOORD_0"),
    (Semantic::TexCoords(1), "TEXCOORD_1"),
    (Semantic::Colors(0), "COLOR_0"),
];

impl Reader<'_> {
    /// The primitives of mesh `index`, which `place` refers to.
    pub(super) fn mesh(&mut self, index: usize, place: &str) -> Result<Rc<[Part]>, Error> {
        if let Some(parts) = self.meshes.get(&index) {
            return Ok(parts.clone());
        }
        let mesh = self.source.get(&self.source.root.meshes, index, "mesh", place)?;
        let mut parts = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            parts.extend(self.primitive(primitive, &format!("/meshes/{index}/primitives/{i}"))?);
        }
        let parts: Rc<[Part]> = parts.into();
        self.meshes.insert(index, parts.clone());
        Ok(parts)
    }

    /// One primitive; `None` where it makes no triangle.
    fn primitive(&mut self, primitive: &json::mesh::Primitive, place: &str) -> Result<Option<Part>, Error> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(self.source.invalid(format!("{place}/mode"), "is no primitive mode; expected 0 to 6"));
        };
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.notes.at(place, "points and lines are skipped: they have no surface");
            return Ok(None);
        }
        if primitive.targets.as_ref().is_some_and(|t| !t.is_empty()) {
            self.notes.at(place, "morph targets are not applied: the base mesh is used");
        }
        let accessor =
            |semantic: &Semantic| primitive.attributes.get(&Checked::Valid(semantic.clone())).map(|i| i.value());
        let attributes = ATTRIBUTES.each_ref().map(|(semantic, _)| accessor(semantic));
        if attributes[0].is_none() {
            self.notes.at(place, "primitives without POSITION are skipped");
            return Ok(None);
        }

        // Find what the material needs of the mesh: UV for its textures, tangents for its normal map.
        let material = self.material(primitive.material.map(|m| m.value()), &format!("{place}/material"))?;
        for (set, used) in material::uv_sets(&self.scene.materials[material]).into_iter().enumerate() {
            if used && attributes[3 + set].is_none() {
                let note = format!("the material looks textures up by TEXCOORD_{set}, which is missing: UV is (0, 0)");
                self.notes.at(place, note);
            }
        }
        // The file's own tangents count only beside normals of its own.
        let lacks_tangents = attributes[1].is_none() || attributes[2].is_none();
        let map = material::tangent_map(&self.scene.materials[material]);
        let map = map.filter(|map| lacks_tangents && attributes[3 + map.uv_set].is_some());

        let ingredients = Ingredients {
            mode: mode.as_gl_enum(),
            indices: primitive.indices.map(|i| i.value()),
            attributes,
            map: map.map(|map| (map.uv_set, map.transform.to_cols_array().map(f32::to_bits))),
        };
        let shape = match self.geometry.get(&ingredients) {
            Some(shape) => *shape,
            None => {
                let shape = self.shape(&ingredients, mode, map, place)?;
                self.geometry.insert(ingredients, shape);
                shape
            }
        };
        if shape.is_none() {
            self.notes.at(place, "primitives without a triangle are skipped");
        }
        Ok(shape.map(|shape| Part { shape, material }))
    }

    /// A new shape of these ingredients; `None` where no triangle is left. `map` is what tangents are missing for.
    fn shape(
        &mut self,
        from: &Ingredients,
        mode: Mode,
        map: Option<TextureRef>,
        place: &str,
    ) -> Result<Option<usize>, Error> {
        let mut mesh = self.triangles(from, mode, place)?;
        if mesh.indices.is_empty() {
            return Ok(None);
        }
        if let Some(map) = map {
            // What MikkTSpace keeps for a corner, and the vertex that the corner may become.
            self.budget.decode(self.source, place, 3 * mesh.indices.len(), 256)?;
            if !tangents::generate(&mut mesh, map.uv_set, map.transform) {
                let note = "a vertex with over a thousand triangles: tangents are made per triangle, not by MikkTSpace";
                self.notes.at(place, note);
            }
        }
        self.scene.shapes.push(Shape::Mesh(mesh));
        Ok(Some(self.scene.shapes.len() - 1))
    }

    /// Vertices and triangles as the file has them, checked and repaired.
    fn triangles(&mut self, from: &Ingredients, mode: Mode, place: &str) -> Result<Mesh, Error> {
        let [position, normal, tangent, uv0, uv1, color] = from.attributes;
        let at = |i: usize| format!("{place}/attributes/{}", ATTRIBUTES[i].1);
        let positions = self.attribute::<3>(position, &at(0), false, None)?;
        let count = positions.len();
        if u32::try_from(count).is_err() {
            return Err(self
                .source
                .invalid(at(0), format!("has {count} elements; at most {} can be indexed", u32::MAX)));
        }
        let mut mesh = Mesh { positions: vectors(positions, Vec3::from_array), ..Mesh::default() };
        mesh.normals = vectors(self.attribute::<3>(normal, &at(1), false, Some(count))?, Vec3::from_array);
        if !mesh.normals.is_empty() {
            mesh.tangents = vectors(self.attribute::<4>(tangent, &at(2), false, Some(count))?, Vec4::from_array);
        }
        for (set, accessor) in [uv0, uv1].into_iter().enumerate() {
            mesh.uv[set] = vectors(self.attribute::<2>(accessor, &at(3 + set), true, Some(count))?, Vec2::from_array);
        }
        // Colours are clamped, as the specification demands.
        mesh.colors = match color.and_then(|c| self.lanes(c)) {
            Some(3) => {
                let rgb = self.attribute::<3>(color, &at(5), true, Some(count))?;
                vectors(rgb, |[r, g, b]| Vec4::new(r, g, b, 1.0).clamp(Vec4::ZERO, Vec4::ONE))
            }
            _ => {
                let rgba = self.attribute::<4>(color, &at(5), true, Some(count))?;
                vectors(rgba, |c| Vec4::from_array(c).clamp(Vec4::ZERO, Vec4::ONE))
            }
        };

        // Put the triangles together, and drop those without area.
        let indices = match from.indices {
            Some(accessor) => Some(self.indices(accessor, &format!("{place}/indices"), count)?),
            None => None,
        };
        let used = indices.as_ref().map_or(count, Vec::len);
        self.budget.decode(self.source, place, used, size_of::<[u32; 3]>())?;
        if mode == Mode::Triangles && used % 3 != 0 {
            self.notes
                .at(place, "the number of vertices is no multiple of 3: the last triangle is incomplete and skipped");
        }
        let vertex = |i: usize| indices.as_ref().map_or(i as u32, |list| list[i]);
        mesh.indices = triangles::assemble(mode, used, vertex).unwrap_or_default();
        let assembled = mesh.indices.len();
        mesh.indices.retain(|t| normals::area_vector(&mesh.positions, *t) != glam::DVec3::ZERO);
        let note = |reader: &mut Self, n: usize, what: &str| {
            if n > 0 {
                reader.notes.add(what, place, n)
            }
        };
        note(self, assembled - mesh.indices.len(), "triangles without area are dropped");

        let lost = normals::repair(&mut mesh.normals, &mesh.positions, &mesh.indices);
        note(self, lost, "normals of length zero are replaced by the triangles' own");
        let lost = tangents::repair(&mut mesh.tangents, &mesh.normals);
        note(self, lost, "tangents without a direction beside the normal are replaced");
        Ok(mesh)
    }

    /// The values of an attribute, as many as there are positions; none where the primitive lacks it.
    fn attribute<const N: usize>(
        &self,
        accessor: Option<usize>,
        place: &str,
        integers: bool,
        count: Option<usize>,
    ) -> Result<Vec<[f32; N]>, Error> {
        let Some(accessor) = accessor else { return Ok(Vec::new()) };
        let values = self.floats::<N>(accessor, place, integers)?;
        match count.filter(|count| *count != values.len()) {
            Some(count) => {
                let message = format!("has {} elements; expected {count}, as many as POSITION", values.len());
                Err(self.source.invalid(place, message))
            }
            None => Ok(values),
        }
    }
}

fn vectors<const N: usize, V>(arrays: Vec<[f32; N]>, f: impl Fn([f32; N]) -> V) -> Vec<V> {
    arrays.into_iter().map(f).collect()
}
