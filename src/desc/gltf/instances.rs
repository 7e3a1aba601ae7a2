//! EXT_mesh_gpu_instancing: one mesh at many places.

use super::Reader;
use super::component::Types;
use crate::desc::Error;
use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::json::scene::Node;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Name of the extension.
const NAME: &str = "EXT_mesh_gpu_instancing";

/// Accessors by name.
#[derive(Deserialize)]
struct Instances {
    attributes: BTreeMap<String, usize>,
}

impl Reader<'_> {
    /// Instance → node, for each instance of the node at `place`; `None` where the node is not instanced.
    pub(super) fn instances(&mut self, node: &Node, place: &str) -> Result<Option<Vec<DMat4>>, Error> {
        let others = node.extensions.as_ref().map(|e| &e.others);
        let Some(Instances { attributes }) = self.source.extension(others, NAME, place)? else { return Ok(None) };
        let place = format!("{place}/extensions/{NAME}/attributes");
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
