//! Primitives as shapes.

use super::deform::{Binding, Displacement, displacements};
use super::{Reader, draco, material, normals};
use crate::desc::{Error, Shape, TextureRef};
use gltf::json;
use json::mesh::{Mode, Semantic};
use json::validation::Checked;
use std::rc::Rc;

/// A primitive in the scene.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub shape: usize,
    pub material: usize,
    /// A skin moved its vertices into the world.
    pub skinned: bool,
}

/// All that a shape is made of: equal ingredients, one shape.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct Ingredients {
    mode: u32,
    pub indices: Option<usize>,
    /// Accessors of position, normal, tangent, the material's two UV sets, colour.
    pub attributes: [Option<usize>; 6],
    /// n of the TEXCOORD_n that the two are.
    pub uv_sets: [u32; 2],
    /// What the accessors' bytes are compressed to.
    pub stream: Option<draco::Stream>,
    /// The morph targets that displace the vertices.
    pub morph: Vec<Displacement>,
    /// The skin that bends the mesh.
    pub binding: Option<Binding>,
    /// UV set and transform (bits) of the normal map that the tangents are for.
    map: Option<(usize, [u32; 6])>,
}

/// How a node holds its mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Pose {
    /// Weights of the morph targets, as bits; none where all are zero.
    pub weights: Vec<u32>,
    /// The skin.
    pub skin: Option<usize>,
}

/// The attributes that are read, in the order of [`Ingredients::attributes`]; the UV sets are the material's.
fn semantics([a, b]: [u32; 2]) -> [Semantic; 6] {
    use Semantic::{Colors, Normals, Positions, Tangents, TexCoords};
    [Positions, Normals, Tangents, TexCoords(a), TexCoords(b), Colors(0)]
}

/// Their names.
pub(super) fn names(uv_sets: [u32; 2]) -> [String; 6] {
    semantics(uv_sets).map(|semantic| semantic.to_string())
}

impl Reader<'_> {
    /// The primitives of mesh `index`, which `place` refers to, in this pose.
    pub(super) fn mesh(&mut self, index: usize, pose: &Pose, place: &str) -> Result<Rc<[Part]>, Error> {
        let key = (index, pose.clone());
        if let Some(parts) = self.meshes.get(&key) {
            return Ok(parts.clone());
        }
        let mesh = self.source.get(&self.source.root.meshes, index, "mesh", place)?;
        let mut parts = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            parts.extend(self.primitive(primitive, pose, &format!("/meshes/{index}/primitives/{i}"))?);
        }
        let parts: Rc<[Part]> = parts.into();
        self.meshes.insert(key, parts.clone());
        Ok(parts)
    }

    /// One primitive; `None` where it makes no triangle.
    fn primitive(
        &mut self,
        primitive: &json::mesh::Primitive,
        pose: &Pose,
        place: &str,
    ) -> Result<Option<Part>, Error> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(self.source.invalid(format!("{place}/mode"), "is no primitive mode; expected 0 to 6"));
        };
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.notes.at(place, "points and lines are skipped: they have no surface");
            return Ok(None);
        }
        let accessor =
            |semantic: &Semantic| primitive.attributes.get(&Checked::Valid(semantic.clone())).map(|i| i.value());
        let mut attributes = semantics([0, 1]).each_ref().map(accessor);
        if attributes[0].is_none() {
            self.notes.at(place, "primitives without POSITION are skipped");
            return Ok(None);
        }

        // Find what the material needs of the mesh: UV for its textures, tangents for its normal map.
        let (material, at) = self.chosen_material(primitive, place)?;
        let material = self.material(material, &at)?;
        let uv_sets = self.uv_sets_of[&material];
        for (set, used) in material::uv_sets(&self.scene.materials[material]).into_iter().enumerate() {
            let number = uv_sets[set];
            attributes[3 + set] = accessor(&Semantic::TexCoords(number));
            if used && attributes[3 + set].is_none() {
                let note =
                    format!("the material looks textures up by TEXCOORD_{number}, which is missing: UV is (0, 0)");
                self.notes.at(place, note);
            }
        }
        // The file's own tangents count only beside normals of its own.
        let lacks_tangents = attributes[1].is_none() || attributes[2].is_none();
        let map = material::tangent_map(&self.scene.materials[material]);
        let map = map.filter(|map| lacks_tangents && attributes[3 + map.uv_set].is_some());

        // A stream holds a list of triangles, whatever the mode that they are drawn by.
        let others = primitive.extensions.as_ref().map(|e| &e.others);
        let stream = self.source.extension::<draco::Stream>(others, draco::NAME, place)?;
        let mode = if stream.is_some() { Mode::Triangles } else { mode };
        self.budget.decode(self.source, place, pose.weights.len(), size_of::<Displacement>())?;
        let ingredients = Ingredients {
            mode: mode.as_gl_enum(),
            indices: primitive.indices.map(|i| i.value()),
            attributes,
            uv_sets,
            stream,
            morph: displacements(self.source, &pose.weights, &names(uv_sets), place)?,
            binding: pose.skin.and_then(|skin| Binding::of(skin, primitive)),
            map: map.map(|map| (map.uv_set, map.transform.to_cols_array().map(f32::to_bits))),
        };
        let skinned = ingredients.binding.is_some();
        if pose.skin.is_some() && !skinned {
            self.notes.at(place, "primitives without JOINTS_0 and WEIGHTS_0 do not follow their skin");
        }
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
        Ok(shape.map(|shape| Part { shape, material, skinned }))
    }

    /// A new shape of these ingredients; `None` where no triangle is left. `map` is what tangents are missing for.
    fn shape(
        &mut self,
        from: &Ingredients,
        mode: Mode,
        map: Option<TextureRef>,
        place: &str,
    ) -> Result<Option<usize>, Error> {
        let mut mesh = self.vertices(from, mode, place)?;
        if mesh.indices.is_empty() {
            return Ok(None);
        }
        if let Some(map) = map {
            // What MikkTSpace keeps for a corner, and the vertex that the corner may become.
            self.budget.decode(self.source, place, 3 * mesh.indices.len(), 256)?;
            if !normals::generate_tangents(&mut mesh, map.uv_set, map.transform) {
                let note = "a vertex with over a thousand triangles: tangents are made per triangle, not by MikkTSpace";
                self.notes.at(place, note);
            }
        }
        self.scene.shapes.push(Shape::Mesh(mesh.into()));
        Ok(Some(self.scene.shapes.len() - 1))
    }
}
