//! Morph targets (glTF 2.0, section 3.7.2.2): attribute = base + Σᵢ weightᵢ · displacementᵢ.

use super::Source;
use super::component::Types;
use super::vertices::Attributes;
use crate::desc::{Error, Mesh};
use glam::{Vec2, Vec3, Vec4};
use serde_json::Value;

/// A morph target with a weight that is not zero.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct Displacement {
    /// Which target of the primitive.
    number: usize,
    /// Bits of the weight.
    weight: u32,
    /// Accessors, in the order of the [`names`](super::mesh::names); none where nothing is displaced.
    accessors: [Option<usize>; 6],
}

/// The targets of the primitive at `place` that have a weight.
pub(super) fn displacements(
    source: Source,
    weights: &[u32],
    names: &[String; 6],
    place: &str,
) -> Result<Vec<Displacement>, Error> {
    let targets = source.json.pointer(&format!("{place}/targets")).and_then(Value::as_array);
    let (mut list, targets) = (Vec::new(), targets.into_iter().flatten());
    for (number, (target, &weight)) in targets.zip(weights).enumerate().filter(|(_, (_, w))| f32::from_bits(**w) != 0.0)
    {
        let mut accessors = [None; 6];
        for (slot, name) in accessors.iter_mut().zip(names) {
            let Some(index) = target.get(name) else { continue };
            let at = format!("{place}/targets/{number}/{name}");
            let Some(index) = index.as_u64().and_then(|i| usize::try_from(i).ok()) else {
                return Err(source.invalid(at, format!("is {index}; expected the index of an accessor")));
            };
            // An accessor without bytes is all zeros: nothing moves.
            let accessor = source.get(&source.root.accessors, index, "accessor", &at)?;
            *slot = (accessor.buffer_view.is_some() || accessor.sparse.is_some()).then_some(index);
        }
        list.push(Displacement { number, weight, accessors });
    }
    Ok(list)
}

impl Attributes<'_, '_> {
    /// Displaces the vertices of `mesh`. What the base mesh lacks stays lacking.
    pub(super) fn morph(
        &self,
        mesh: &mut Mesh,
        targets: &[Displacement],
        names: &[String; 6],
        place: &str,
    ) -> Result<(), Error> {
        let [position, direction] = self.displacement_types();
        for target in targets {
            let weight = f32::from_bits(target.weight);
            let at = |i: usize| (target.accessors[i], format!("{place}/targets/{}/{}", target.number, names[i]));
            let Mesh { positions, normals, tangents, uv: [uv0, uv1], colors, .. } = &mut *mesh;
            self.add(positions, at(0), position, |p, d| *p += weight * Vec3::from_array(d))?;
            self.add(normals, at(1), direction, |n, d| *n += weight * Vec3::from_array(d))?;
            self.add(tangents, at(2), direction, |t, d| *t += weight * Vec3::from_array(d).extend(0.0))?;
            for (uv, i) in [(uv0, 3), (uv1, 4)] {
                self.add(uv, at(i), Types::UNIT, |uv, d| *uv += weight * Vec2::from_array(d))?;
            }
            let (accessor, place) = at(5);
            match accessor.map(|a| self.accessors.layout(a, &place)).transpose()? {
                Some(layout) if layout.lanes == 3 => {
                    let rgb = |c: &mut Vec4, d| *c += weight * Vec3::from_array(d).extend(0.0);
                    self.add(colors, (accessor, place), Types::UNIT, rgb)?;
                }
                _ => self.add(colors, (accessor, place), Types::UNIT, |c, d| *c += weight * Vec4::from_array(d))?,
            }
        }

        // Finite numbers can add up to infinity.
        match mesh.positions.iter().position(|p| !p.is_finite()) {
            Some(i) => {
                let message = format!("vertex {i} is displaced to {}; expected finite numbers", mesh.positions[i]);
                Err(self.accessors.source.invalid(format!("{place}/targets"), message))
            }
            None => Ok(()),
        }
    }

    /// Adds a displacement to each of `values`, if there are any.
    fn add<T, const N: usize>(
        &self,
        values: &mut [T],
        (accessor, place): (Option<usize>, String),
        types: Types,
        add: impl Fn(&mut T, [f32; N]),
    ) -> Result<(), Error> {
        let Some(accessor) = accessor.filter(|_| !values.is_empty()) else { return Ok(()) };
        let displacements = self.accessors.floats::<N>(accessor, &place, types)?;
        let displacements = self.as_many(displacements, Some(values.len()), &place)?;
        values.iter_mut().zip(displacements).for_each(|(value, d)| add(value, d));
        Ok(())
    }
}
