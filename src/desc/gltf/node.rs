//! The node hierarchy, walked once, and EXT_mesh_gpu_instancing: one mesh of a node at many places.

use super::Reader;
use super::component::Types;
use super::mesh::Pose;
use crate::desc::emitters::{EMITTER_BYTES, emitters};
use crate::desc::{Error, Object};
use crate::math::Transform;
use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::json;
use json::Index;
use json::scene::Node;
use serde::Deserialize;
use std::collections::BTreeMap;

impl Reader<'_> {
    /// Puts everything that the scene's nodes hold into the world.
    pub(super) fn nodes(&mut self) -> Result<(), Error> {
        let root = self.source.root;
        let mut stack = self.roots()?;
        stack.reverse();
        self.worlds = vec![None; root.nodes.len()];
        let mut placed = Vec::new();

        // Depth first, in the order of the file, with the transform of the parent in hand.
        while let Some(Visit { node: index, parent, visible, place }) = stack.pop() {
            let node = self.source.get(&root.nodes, index, "node", &place)?;
            if self.worlds[index].is_some() {
                let message = format!("refers to node {index}, which is reached twice; expected a tree");
                return Err(self.source.invalid(place, message));
            }
            let place = format!("/nodes/{index}");
            let world = parent * self.local(node, &place)?;
            if !world.as_mat4().is_finite() {
                let message = "has a matrix in the world that is not finite";
                return Err(self.source.invalid(place, message));
            }
            self.worlds[index] = Some(world);
            let visible = visible && self.visible(node, &place)?;
            let children = node.children.as_deref().unwrap_or_default();
            stack.extend(visits(children, &format!("{place}/children"), world, visible).rev());
            placed.push((index, world, visible));
        }

        // Fill the world once all joints stand in it.
        for (index, world, visible) in placed {
            self.content(&root.nodes[index], index, &world, visible)?;
        }
        Ok(())
    }

    /// KHR_node_visibility: whether the node itself says that it is seen.
    fn visible(&mut self, node: &Node, place: &str) -> Result<bool, Error> {
        let others = node.extensions.as_ref().map(|e| &e.others);
        let said: Option<Visibility> = self.source.extension(others, "KHR_node_visibility", place)?;
        let visible = said.is_none_or(|said| said.visible);
        if !visible {
            self.notes.at(place, "`KHR_node_visibility`: nodes that are not visible are left out, and all below them");
        }
        Ok(visible)
    }

    /// The roots of the default scene, or of the first, or of all.
    fn roots(&mut self) -> Result<Vec<Visit>, Error> {
        let root = self.source.root;
        let chosen = root.scene.map(|s| s.value()).or((!root.scenes.is_empty()).then_some(0));
        if let Some(index) = chosen {
            let scene = self.source.get(&root.scenes, index, "scene", "/scene")?;
            if root.scenes.len() > 1 {
                self.notes.say(format!("of {} scenes, number {index} is read", root.scenes.len()));
            }
            return Ok(visits(&scene.nodes, &format!("/scenes/{index}/nodes"), DMat4::IDENTITY, true).collect());
        }
        let mut child = vec![false; root.nodes.len()];
        for index in root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
            if let Some(child) = child.get_mut(index.value()) {
                *child = true;
            }
        }
        let roots = (0..root.nodes.len()).filter(|i| !child[*i]);
        let visit = |node| Visit { node, parent: DMat4::IDENTITY, visible: true, place: format!("/nodes/{node}") };
        Ok(roots.map(visit).collect())
    }

    /// Node → parent.
    fn local(&self, node: &Node, place: &str) -> Result<DMat4, Error> {
        let at = |key: &str| format!("{place}/{key}");
        let trs = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
        if let Some(columns) = node.matrix {
            let m = glam::Mat4::from_cols_array(&columns).as_dmat4();
            if trs && m != DMat4::IDENTITY {
                return Err(self
                    .source
                    .invalid(at("matrix"), "stands beside translation, rotation or scale; expected one"));
            }
            if m.row(3) != DVec4::W || !m.is_finite() {
                let message = "is not affine; expected finite numbers and 0, 0, 0, 1 in the last row";
                return Err(self.source.invalid(at("matrix"), message));
            }
            if !trs {
                return Ok(m);
            }
        }
        let vector = |v: Option<[f32; 3]>, default: f32, key: &str| {
            let v = DVec3::from(v.unwrap_or([default; 3]).map(f64::from));
            v.is_finite().then_some(v).ok_or_else(|| self.source.invalid(at(key), "has numbers that are not finite"))
        };
        let translation = vector(node.translation, 0.0, "translation")?;
        let scale = vector(node.scale, 1.0, "scale")?;
        let q = DVec4::from(node.rotation.unwrap_or_default().0.map(f64::from));
        let Some(q) = q.try_normalize() else {
            return Err(self.source.invalid(at("rotation"), format!("is {q}; expected a unit quaternion")));
        };
        Ok(DMat4::from_scale_rotation_translation(scale, DQuat::from_vec4(q), translation))
    }

    /// Mesh, camera and light of one node.
    fn content(&mut self, node: &Node, index: usize, world: &DMat4, visible: bool) -> Result<(), Error> {
        let place = format!("/nodes/{index}");
        if visible && let Some(mesh) = node.mesh.map(|m| m.value()) {
            self.objects(node, index, mesh, world, &place)?;
        }
        // Cameras do not care whether they are seen.
        if let Some(camera) = node.camera {
            self.camera(camera.value(), world, node.name.as_deref(), &place)?;
        }
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        if let Some(light) = light.filter(|_| visible) {
            self.light(light.light.value(), world, &place)?;
        }
        let light = node.extensions.as_ref().and_then(|e| e.others.get("EXT_lights_ies"));
        if let Some(light) = light.filter(|_| visible) {
            self.profile_light(light, world, &place)?;
        }
        Ok(())
    }

    /// The mesh of one node, once for each of its instances.
    fn objects(&mut self, node: &Node, index: usize, mesh: usize, world: &DMat4, place: &str) -> Result<(), Error> {
        let weights = node.weights.as_ref().or(self.source.root.meshes.get(mesh).and_then(|m| m.weights.as_ref()));
        let weights = weights.map_or(&[][..], Vec::as_slice);
        if let Some(i) = weights.iter().position(|w| !w.is_finite()) {
            let message = format!("element {i} is {}; expected finite numbers", weights[i]);
            return Err(self.source.invalid(format!("{place}/weights"), message));
        }
        self.budget.decode(self.source, place, weights.len(), size_of::<u32>())?;
        if let Some(skin) = node.skin {
            self.source.get(&self.source.root.skins, skin.value(), "skin", &format!("{place}/skin"))?;
        }
        let moved = weights.iter().any(|w| *w != 0.0);
        let bits = || weights.iter().map(|w| w.to_bits()).collect();
        let pose = Pose { weights: if moved { bits() } else { Vec::new() }, skin: node.skin.map(|s| s.value()) };
        let parts = self.mesh(mesh, &pose, &format!("{place}/mesh"))?;
        let instances = self.instances(node, place)?;
        let of_file = self.source.root.meshes.get(mesh);
        let closed = [Some(&node.extras), of_file.map(|m| &m.extras)].into_iter().flatten().any(declares_closed);
        let name = node.name.clone().or_else(|| of_file.and_then(|m| m.name.clone()));
        let name = name.unwrap_or_else(|| format!("node {index}"));

        for part in parts.iter() {
            // What hangs on a skin stands in the world already.
            let list = match (&instances, part.skinned) {
                (_, true) => &[DMat4::IDENTITY][..],
                (Some(list), _) => list,
                (None, _) => &[DMat4::IDENTITY],
            };
            if part.skinned && instances.is_some() {
                self.notes.at(place, "meshes on skins are not instanced");
            }
            self.budget.decode(self.source, place, list.len(), size_of::<Object>() + 64 + name.len())?;
            // Every triangle that emits is a light at every place but for the first, which the mesh has paid for.
            let emitters = emitters(&self.scene, part.shape, part.material);
            let placed = list.len() - usize::from(emitters > 0 && self.lit.insert(part.shape)).min(list.len());
            self.budget.decode(self.source, place, placed.saturating_mul(emitters), EMITTER_BYTES)?;
            for instance in list {
                let to_world = if part.skinned { *instance } else { *world * *instance }.as_mat4();
                if !to_world.is_finite() {
                    let message = "has an instance whose matrix in the world is not finite";
                    return Err(self.source.invalid(place, message));
                }
                if Transform::from_mat4(to_world).is_none() {
                    self.notes.at(place, "objects that are scaled to nothing are left out");
                    continue;
                }
                self.scene.objects.push(Object {
                    name: name.clone(),
                    shape: part.shape,
                    to_world,
                    material: part.material,
                    emission: None,
                    reversed: false,
                    closed,
                });
            }
        }
        Ok(())
    }
}

/// KHR_node_visibility.
#[derive(Deserialize)]
struct Visibility {
    #[serde(default = "seen")]
    visible: bool,
}

fn seen() -> bool {
    true
}

/// Whether a node or mesh says `"extras": {"closed": true}`: its surface bounds a volume.
fn declares_closed(extras: &json::Extras) -> bool {
    let extras: Option<serde_json::Value> = extras.as_ref().and_then(|raw| serde_json::from_str(raw.get()).ok());
    extras.is_some_and(|extras| extras.get("closed") == Some(&serde_json::Value::Bool(true)))
}

/// A node to be visited.
struct Visit {
    node: usize,
    /// Parent → world.
    parent: DMat4,
    /// Whether all above it are visible.
    visible: bool,
    /// Where the document refers to the node.
    place: String,
}

fn visits(list: &[Index<Node>], place: &str, parent: DMat4, visible: bool) -> impl DoubleEndedIterator<Item = Visit> {
    let visit =
        move |(i, n): (usize, &Index<Node>)| Visit { node: n.value(), parent, visible, place: format!("{place}/{i}") };
    list.iter().enumerate().map(visit)
}

/// The extension of instances.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Accessors by name.
#[derive(Deserialize)]
struct Instances {
    attributes: BTreeMap<String, usize>,
}

impl Reader<'_> {
    /// Instance → node, for each instance of the node at `place`; `None` where the node is not instanced.
    pub(super) fn instances(&mut self, node: &Node, place: &str) -> Result<Option<Vec<DMat4>>, Error> {
        let others = node.extensions.as_ref().map(|e| &e.others);
        let Some(Instances { attributes }) = self.source.extension(others, INSTANCING, place)? else { return Ok(None) };
        let place = format!("{place}/extensions/{INSTANCING}/attributes");
        for name in attributes.keys().filter(|name| !["TRANSLATION", "ROTATION", "SCALE"].contains(&name.as_str())) {
            self.notes.at(&format!("{place}/{name}"), "attributes of instances that do not place them are ignored");
        }
        let translations = self.vectors::<3>(&attributes, "TRANSLATION", Types::FLOAT, &place)?;
        let rotations = self.vectors::<4>(&attributes, "ROTATION", Types::DIRECTION, &place)?;
        let scales = self.vectors::<3>(&attributes, "SCALE", Types::FLOAT, &place)?;

        // All attributes that are there have as many elements.
        let counts =
            [&translations.as_ref().map(Vec::len), &rotations.as_ref().map(Vec::len), &scales.as_ref().map(Vec::len)];
        let mut counts = counts.into_iter().flatten();
        let Some(&count) = counts.next() else {
            return Err(self.source.invalid(place, "has none of TRANSLATION, ROTATION and SCALE"));
        };
        if let Some(other) = counts.find(|other| **other != count) {
            return Err(self
                .source
                .invalid(place, format!("have {count} and {other} elements; expected as many of each")));
        }
        self.budget.decode(self.source, &place, count, size_of::<DMat4>())?;
        let vector = |list: &Option<Vec<[f32; 3]>>, i: usize, default| {
            list.as_ref().map_or(default, |list| DVec3::from_array(list[i].map(f64::from)))
        };
        let matrix = |i: usize| {
            let q = rotations.as_ref().map_or(DVec4::W, |list| DVec4::from_array(list[i].map(f64::from)));
            let Some(q) = q.try_normalize() else {
                let message = format!("element {i} is {q}; expected a unit quaternion");
                return Err(self.source.invalid(format!("{place}/ROTATION"), message));
            };
            let (t, s) = (vector(&translations, i, DVec3::ZERO), vector(&scales, i, DVec3::ONE));
            Ok(DMat4::from_scale_rotation_translation(s, DQuat::from_vec4(q), t))
        };
        (0..count).map(matrix).collect::<Result<_, _>>().map(Some)
    }

    fn vectors<const N: usize>(
        &self,
        attributes: &BTreeMap<String, usize>,
        name: &str,
        types: Types,
        place: &str,
    ) -> Result<Option<Vec<[f32; N]>>, Error> {
        let accessor = attributes.get(name);
        accessor.map(|a| self.accessors().floats(*a, &format!("{place}/{name}"), types)).transpose()
    }
}
