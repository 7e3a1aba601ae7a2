//! Normals of triangles and vertices, and tangents: the file's, made usable, or those of MikkTSpace (Mikkelsen 2008), for
//! which normal maps are baked.

use crate::desc::Mesh;
use crate::math::Frame;
use bevy_mikktspace::{Geometry, TangentSpace};
use glam::{Affine2, DVec3, Vec2, Vec3, Vec4};
use std::collections::HashMap;

/// Twice the area times the normal of a triangle, without overflow or underflow.
pub(super) fn area_vector(positions: &[Vec3], [a, b, c]: [u32; 3]) -> DVec3 {
    let p = |i: u32| positions[i as usize].as_dvec3();
    (p(b) - p(a)).cross(p(c) - p(a))
}

/// The unit normal of a triangle that has an area.
pub(super) fn face(positions: &[Vec3], triangle: [u32; 3]) -> Vec3 {
    area_vector(positions, triangle).try_normalize().map_or(Vec3::Z, DVec3::as_vec3)
}

/// Makes all normals unit. Those of length zero become the mean of their triangles' normals, weighted by area; returns
/// how many those are.
pub(super) fn repair_normals(normals: &mut [Vec3], positions: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let mut lost = Vec::new();
    for (i, n) in normals.iter_mut().enumerate() {
        match n.as_dvec3().try_normalize() {
            Some(unit) => *n = unit.as_vec3(),
            None => lost.push(i as u32),
        }
    }
    if lost.is_empty() {
        return 0;
    }
    let mut sums = vec![DVec3::ZERO; lost.len()];
    let mut any = vec![Vec3::Z; lost.len()];
    for triangle in triangles {
        for vertex in triangle {
            if let Ok(slot) = lost.binary_search(vertex) {
                sums[slot] += area_vector(positions, *triangle);
                any[slot] = face(positions, *triangle);
            }
        }
    }
    for ((vertex, sum), any) in lost.iter().zip(sums).zip(any) {
        normals[*vertex as usize] = sum.try_normalize().map_or(any, DVec3::as_vec3);
    }
    lost.len()
}

/// Most corners that may meet in one vertex for MikkTSpace, which recurses once for each of them and compares them all
/// with each other.
const MAX_VALENCE: usize = 1000;

/// Makes tangents unit, and their w a sign. Those along the normal or of length zero become some tangent; returns how
/// many those are.
pub(super) fn repair_tangents(tangents: &mut [Vec4], normals: &[Vec3]) -> usize {
    let mut lost = 0;
    for (t, n) in tangents.iter_mut().zip(normals) {
        let sign = if t.w < 0.0 { -1.0 } else { 1.0 };
        let unit = t.truncate().as_dvec3().try_normalize().map(|t| t.as_vec3());
        let usable = unit.filter(|t| n.cross(*t).length_squared() > 1e-8);
        lost += usize::from(usable.is_none());
        *t = usable.unwrap_or_else(|| Frame::from_z(*n).s.into()).extend(sign);
    }
    lost
}

/// Gives `mesh` tangents for a map that looks `transform(uv)` up. Vertices are split where the triangles about them
/// disagree. False where a vertex has so many triangles that each triangle got a tangent of its own instead.
///
/// The green of glTF's normal maps points up in the image, and v down: v is negated, so that the bitangent w n × t
/// points to where v decreases.
pub(super) fn generate_tangents(mesh: &mut Mesh, uv_set: usize, transform: Affine2) -> bool {
    let flipped = |uv: &Vec2| transform.transform_point2(*uv) * Vec2::new(1.0, -1.0);
    let uv = mesh.uv[uv_set].iter().map(flipped).collect();
    let corners = vec![None; 3 * mesh.indices.len()];
    let mut task = Task { mesh, uv, corners };
    let welded = task.valence() <= MAX_VALENCE && bevy_mikktspace::generate_tangents(&mut task).is_ok();
    if !welded {
        task.per_triangle();
    }
    let tangents = task.finish();
    split(mesh, &tangents);
    welded
}

struct Task<'a> {
    mesh: &'a Mesh,
    uv: Vec<Vec2>,
    /// Tangent of each corner of each triangle.
    corners: Vec<Option<Vec4>>,
}

impl Task<'_> {
    fn vertex(&self, triangle: usize, corner: usize) -> usize {
        self.mesh.indices[triangle][corner] as usize
    }

    fn shading_normal(&self, triangle: usize, corner: usize) -> Vec3 {
        match self.mesh.normals.get(self.vertex(triangle, corner)) {
            Some(n) => *n,
            None => face(&self.mesh.positions, self.mesh.indices[triangle]),
        }
    }

    /// Most corners with the same position: at least as many as are welded to one vertex.
    fn valence(&self) -> usize {
        let mut counts: HashMap<[u32; 3], usize> = HashMap::new();
        for vertex in self.mesh.indices.as_flattened() {
            // Adding zero makes −0 and 0 one.
            let key = (self.mesh.positions[*vertex as usize] + 0.0).to_array().map(f32::to_bits);
            *counts.entry(key).or_default() += 1;
        }
        counts.into_values().max().unwrap_or(0)
    }

    /// ∂p/∂u of each triangle by itself.
    fn per_triangle(&mut self) {
        for (i, &[a, b, c]) in self.mesh.indices.iter().enumerate() {
            let p = |v: u32| self.mesh.positions[v as usize].as_dvec3();
            let uv = |v: u32| self.uv[v as usize].as_dvec2();
            let (e1, e2, d1, d2) = (p(b) - p(a), p(c) - p(a), uv(b) - uv(a), uv(c) - uv(a));
            let area = d1.perp_dot(d2);
            let dpdu = ((e1 * d2.y - e2 * d1.y) * area.signum()).try_normalize();
            let tangent = dpdu.filter(|_| area != 0.0).map(|t| t.as_vec3().extend(area.signum() as f32));
            self.corners[3 * i..][..3].fill(tangent);
        }
    }

    /// Makes all tangents unit and orthogonal to the normal, those that UV does not determine included.
    fn finish(self) -> Vec<Vec4> {
        let corner = |(i, t): (usize, &Option<Vec4>)| {
            let n = self.shading_normal(i / 3, i % 3);
            let t = t.filter(|t| t.is_finite()).unwrap_or(Vec4::W);
            Frame::from_z_tangent(n, t.truncate(), 1.0).s.extend(t.w)
        };
        self.corners.iter().enumerate().map(corner).collect()
    }
}

impl Geometry for Task<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.indices.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, vert)].to_array()
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.shading_normal(face, vert).to_array()
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        self.uv[self.vertex(face, vert)].to_array()
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, vert: usize) {
        self.corners[3 * face + vert] = tangent.map(|t| Vec4::from_array(t.tangent_encoded()));
    }
}

/// Gives every vertex one tangent: a copy of the vertex for each different tangent of its corners.
fn split(mesh: &mut Mesh, tangents: &[Vec4]) {
    let old = std::mem::take(mesh);
    let mut known: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    let mut sources: Vec<u32> = Vec::new();
    let corner = |(vertex, tangent): (&u32, &Vec4)| {
        *known.entry((*vertex, tangent.to_array().map(f32::to_bits))).or_insert_with(|| {
            sources.push(*vertex);
            mesh.tangents.push(*tangent);
            sources.len() as u32 - 1
        })
    };
    let flat: Vec<u32> = old.indices.as_flattened().iter().zip(tangents).map(corner).collect();
    mesh.indices = flat.as_chunks::<3>().0.to_vec();
    mesh.positions = gather(&old.positions, &sources);
    mesh.normals = gather(&old.normals, &sources);
    mesh.uv = old.uv.each_ref().map(|uv| gather(uv, &sources));
    mesh.colors = gather(&old.colors, &sources);
}

/// The elements at these indices; nothing where there is no such attribute.
fn gather<T: Copy>(from: &[T], at: &[u32]) -> Vec<T> {
    if from.is_empty() { Vec::new() } else { at.iter().map(|i| from[*i as usize]).collect() }
}
