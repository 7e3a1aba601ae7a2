//! Vertices that do not stay where the file puts them: morph targets and skins.
//!
//! Morph targets (glTF 2.0, section 3.7.2.2): attribute = base + Σᵢ weightᵢ · displacementᵢ.
//!
//! Skins (section 3.7.3): p' = Σᵢ wᵢ Jᵢ Bᵢ p with the joints' matrices J in the world and the inverse bind matrices B. The
//! node that holds the mesh does not move it.

use super::component::Types;
use super::vertices::Attributes;
use super::{Reader, Source};
use crate::desc::{Error, Mesh};
use glam::{DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};
use gltf::json;
use json::mesh::{Primitive, Semantic};
use json::validation::Checked;
use serde_json::Value;
use std::rc::Rc;

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

/// Weights may miss a sum of 1 by so much, twice the rounding of four 8-bit numbers, without a word about it.
const BALANCE: f64 = 0.01;

/// How a primitive hangs on a skin.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct Binding {
    /// Which skin.
    pub skin: usize,
    /// Accessors of JOINTS_n and WEIGHTS_n, for n = 0, 1, ….
    sets: Vec<[usize; 2]>,
}

impl Binding {
    /// `None` where the primitive has no weights.
    pub(super) fn of(skin: usize, primitive: &Primitive) -> Option<Self> {
        let accessor = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(|i| i.value());
        let set = |n| Some([accessor(Semantic::Joints(n))?, accessor(Semantic::Weights(n))?]);
        let sets: Vec<_> = (0..).map_while(set).collect();
        (!sets.is_empty()).then_some(Self { skin, sets })
    }
}

/// What a skin did to a mesh.
pub(super) struct Bent {
    /// Whether the vertex is mirrored.
    mirrored: Vec<bool>,
    /// Vertices whose weights are all zero.
    pub weightless: usize,
    /// Vertices whose weights do not add up to 1.
    pub unbalanced: usize,
}

impl Bent {
    /// Turns the triangles that are mirrored, so that they run counter-clockwise from outside again.
    pub(super) fn turn(&self, triangles: &mut [[u32; 3]]) {
        let mirrored = |t: &&mut [u32; 3]| t.iter().all(|v| self.mirrored[*v as usize]);
        triangles.iter_mut().filter(mirrored).for_each(|t| t.swap(1, 2));
    }
}

impl Reader<'_> {
    /// Mesh space → world for every joint of skin `index`.
    pub(super) fn joints(&mut self, index: usize, place: &str) -> Result<Rc<[DMat4]>, Error> {
        if let Some(joints) = self.skins.get(&index) {
            return Ok(joints.clone());
        }
        let skin = self.source.get(&self.source.root.skins, index, "skin", place)?;
        let place = format!("/skins/{index}");
        let at = format!("{place}/inverseBindMatrices");
        let bind = match skin.inverse_bind_matrices {
            Some(accessor) => {
                let matrices = self.accessors().floats::<16>(accessor.value(), &at, Types::FLOAT)?;
                if matrices.len() < skin.joints.len() {
                    let message = format!("has {} elements; there are {} joints", matrices.len(), skin.joints.len());
                    return Err(self.source.invalid(at, message));
                }
                matrices.iter().map(|m| DMat4::from_cols_array(&m.map(f64::from))).collect()
            }
            None => vec![DMat4::IDENTITY; skin.joints.len()],
        };
        let mut joints = Vec::new();
        for (i, (joint, bind)) in skin.joints.iter().zip(bind).enumerate() {
            let at = format!("{place}/joints/{i}");
            let world = self.source.get(&self.worlds, joint.value(), "node", &at)?;
            let Some(world) = world else {
                let message = format!("refers to node {}, which is not in the scene", joint.value());
                return Err(self.source.invalid(at, message));
            };
            joints.push(*world * bind);
        }
        let joints: Rc<[DMat4]> = joints.into();
        self.skins.insert(index, joints.clone());
        Ok(joints)
    }
}

impl Attributes<'_, '_> {
    /// Bends `mesh` into the world.
    pub(super) fn bend(
        &self,
        mesh: &mut Mesh,
        binding: &Binding,
        joints: &[DMat4],
        place: &str,
    ) -> Result<Bent, Error> {
        let count = mesh.positions.len();
        let source = self.accessors.source;
        let mut bent = Bent { mirrored: vec![false; count], weightless: 0, unbalanced: 0 };
        self.accessors.budget.decode(source, place, count, size_of::<DMat4>() + size_of::<f64>())?;

        // M = Σ w J B of every vertex, and Σ w.
        let mut blends = vec![(DMat4::ZERO, 0.0); count];
        let mut first = vec![0; count];
        for (n, [joint, weight]) in binding.sets.iter().enumerate() {
            let at = |what: &str| format!("{place}/attributes/{what}_{n}");
            let influences = self.elements(&format!("JOINTS_{n}"), *joint, &at("JOINTS"))?;
            let influences = self.accessors.integers::<4>(&influences, &at("JOINTS"))?;
            let influences = self.as_many(influences, Some(count), &at("JOINTS"))?;
            let weights = self.elements(&format!("WEIGHTS_{n}"), *weight, &at("WEIGHTS"))?;
            let weights = self.accessors.vectors::<4>(&weights, Types::FRACTION, &at("WEIGHTS"))?;
            let weights = self.as_many(weights, Some(count), &at("WEIGHTS"))?;
            for (vertex, (indices, weights)) in influences.into_iter().zip(weights).enumerate() {
                for (index, weight) in indices.into_iter().zip(weights) {
                    let Some(joint) = joints.get(index as usize) else {
                        let message = format!("vertex {vertex} has the joint {index}; the skin has {}", joints.len());
                        return Err(source.invalid(at("JOINTS"), message));
                    };
                    if weight < 0.0 {
                        let message = format!("vertex {vertex} has the weight {weight}; expected none below 0");
                        return Err(source.invalid(at("WEIGHTS"), message));
                    }
                    let (matrix, sum) = &mut blends[vertex];
                    *matrix += *joint * f64::from(weight);
                    *sum += f64::from(weight);
                }
                if n == 0 {
                    first[vertex] = indices[0] as usize;
                }
            }
        }

        // Move positions by M, directions along the surface too, normals by its inverse transpose.
        for (i, (matrix, sum)) in blends.into_iter().enumerate() {
            bent.weightless += usize::from(sum == 0.0);
            bent.unbalanced += usize::from(sum != 0.0 && (sum - 1.0).abs() > BALANCE);
            let matrix = if sum == 0.0 { joints[first[i]] } else { matrix * (1.0 / sum) };
            let axes = DMat3::from_mat4(matrix);
            let mirror = if axes.determinant() < 0.0 { -1.0 } else { 1.0 };
            bent.mirrored[i] = mirror < 0.0;
            mesh.positions[i] = matrix.transform_point3(mesh.positions[i].as_dvec3()).as_vec3();
            if !mesh.positions[i].is_finite() {
                let message = format!("vertex {i} is moved to {}; expected finite numbers", mesh.positions[i]);
                return Err(source.invalid(format!("/skins/{}", binding.skin), message));
            }
            if let Some(normal) = mesh.normals.get_mut(i) {
                *normal = unit(cofactors(axes) * normal.as_dvec3() * mirror);
            }
            if let Some(tangent) = mesh.tangents.get_mut(i) {
                *tangent = unit(axes * tangent.truncate().as_dvec3()).extend(tangent.w * mirror as f32);
            }
        }
        Ok(bent)
    }
}

/// det(M) M⁻ᵀ, which also exists where M has no inverse.
fn cofactors(m: DMat3) -> DMat3 {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

fn unit(v: DVec3) -> Vec3 {
    v.try_normalize().unwrap_or_default().as_vec3()
}
