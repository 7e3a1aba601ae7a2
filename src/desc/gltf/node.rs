//! The node hierarchy, walked once.

use super::Reader;
use crate::desc::{Error, Object};
use crate::math::Transform;
use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::json;
use json::Index;
use json::scene::Node;

impl Reader<'_> {
    /// Puts everything that the scene's nodes hold into the world.
    pub(super) fn nodes(&mut self) -> Result<(), Error> {
        let root = self.source.root;
        let mut stack = self.roots()?;
        stack.reverse();
        let mut seen = vec![false; root.nodes.len()];

        // Depth first, in the order of the file, with the transform of the parent in hand.
        while let Some(Visit { node: index, parent, place }) = stack.pop() {
            let node = self.source.get(&root.nodes, index, "node", &place)?;
            if std::mem::replace(&mut seen[index], true) {
                let message = format!("refers to node {index}, which is reached twice; expected a tree");
                return Err(self.source.invalid(place, message));
            }
            let place = format!("/nodes/{index}");
            let world = parent * self.local(node, &place)?;
            if !world.as_mat4().is_finite() {
                let message = "has a matrix in the world that is not finite";
                return Err(self.source.invalid(place, message));
            }
            self.content(node, index, &world, &place)?;
            let children = node.children.as_deref().unwrap_or_default();
            stack.extend(visits(children, &format!("{place}/children"), world).rev());
        }
        Ok(())
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
            return Ok(visits(&scene.nodes, &format!("/scenes/{index}/nodes"), DMat4::IDENTITY).collect());
        }
        let mut child = vec![false; root.nodes.len()];
        for index in root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
            if let Some(child) = child.get_mut(index.value()) {
                *child = true;
            }
        }
        let roots = (0..root.nodes.len()).filter(|i| !child[*i]);
        Ok(roots.map(|node| Visit { node, parent: DMat4::IDENTITY, place: format!("/nodes/{node}") }).collect())
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
    fn content(&mut self, node: &Node, index: usize, world: &DMat4, place: &str) -> Result<(), Error> {
        if let Some(mesh) = node.mesh.map(|m| m.value()) {
            let parts = self.mesh(mesh, &format!("{place}/mesh"))?;
            let to_world = world.as_mat4();
            if Transform::from_mat4(to_world).is_none() {
                self.notes.at(place, "objects that are scaled to nothing are left out");
            } else {
                self.budget.decode(self.source, place, parts.len(), size_of::<Object>() + 64)?;
                let of_file = self.source.root.meshes.get(mesh).map(|m| &m.extras);
                let closed = [Some(&node.extras), of_file].into_iter().flatten().any(declares_closed);
                let of_mesh = || self.source.root.meshes.get(mesh).and_then(|m| m.name.clone());
                let name = node.name.clone().or_else(of_mesh).unwrap_or_else(|| format!("node {index}"));
                self.scene.objects.extend(parts.iter().map(|part| Object {
                    name: name.clone(),
                    shape: part.shape,
                    to_world,
                    material: part.material,
                    emission: None,
                    reversed: false,
                    closed,
                }));
            }
        }
        if let Some(camera) = node.camera {
            self.camera(camera.value(), world, node.name.as_deref(), place)?;
        }
        if let Some(light) = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()) {
            self.light(light.light.value(), world, place)?;
        }
        if let Some(light) = node.extensions.as_ref().and_then(|e| e.others.get("EXT_lights_ies")) {
            self.profile_light(light, world, place)?;
        }
        Ok(())
    }
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
    /// Where the document refers to the node.
    place: String,
}

fn visits(list: &[Index<Node>], place: &str, parent: DMat4) -> impl DoubleEndedIterator<Item = Visit> {
    list.iter().enumerate().map(move |(i, n)| Visit { node: n.value(), parent, place: format!("{place}/{i}") })
}
