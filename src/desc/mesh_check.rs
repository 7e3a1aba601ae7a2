//! What every reader guarantees of a mesh.

use super::Mesh;

/// The mesh with unit normals and without triangles of no area, and how many of these there were; or what is wrong with it.
///
/// A triangle whose area underflows has no normal and no chance of being hit; `normals` of length 0 become the
/// geometric normal of a triangle that uses them.
pub(crate) fn checked(mut mesh: Mesh) -> Result<(Mesh, usize), String> {
    let count = mesh.positions.len();
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(format!("vertex {i} is {:?}, expected finite coordinates", mesh.positions[i].to_array()));
    }
    for (what, length) in [
        ("normals", mesh.normals.len()),
        ("tangents", mesh.tangents.len()),
        ("texture coordinates", mesh.uv[0].len()),
        ("texture coordinates of the second set", mesh.uv[1].len()),
        ("colours", mesh.colors.len()),
    ] {
        if length != 0 && length != count {
            return Err(format!("{length} {what} for {count} vertices; expected one each"));
        }
    }
    if let Some(i) = mesh.normals.iter().position(|n| !n.is_finite()) {
        return Err(format!("the normal of vertex {i} is {:?}, expected finite numbers", mesh.normals[i].to_array()));
    }
    if let Some(i) = mesh.uv.iter().flat_map(|uv| uv.iter().enumerate()).find(|(_, uv)| !uv.is_finite()) {
        return Err(format!(
            "the texture coordinates of vertex {} are {:?}, expected finite numbers",
            i.0,
            i.1.to_array()
        ));
    }
    if let Some(i) = mesh.colors.iter().position(|c| !c.is_finite() || c.min_element() < 0.0) {
        return Err(format!("the colour of vertex {i} is {:?}, expected numbers ≥ 0", mesh.colors[i].to_array()));
    }
    for (i, triangle) in mesh.indices.iter().enumerate() {
        if let Some(index) = triangle.iter().find(|index| **index as usize >= count) {
            return Err(format!("triangle {i} has the vertex {index}; there are {count}, numbered from 0"));
        }
    }

    let before = mesh.indices.len();
    let positions = &mesh.positions;
    mesh.indices.retain(|t| normal(t, positions).is_some());
    repair_normals(&mut mesh);
    let dropped = before - mesh.indices.len();
    Ok((mesh, dropped))
}

/// Twice the area times the normal, unless f32 cannot hold it as anything but 0.
fn normal(triangle: &[u32; 3], positions: &[glam::Vec3]) -> Option<glam::DVec3> {
    let [a, b, c] = triangle.map(|i| positions[i as usize].as_dvec3());
    let n = (b - a).cross(c - a);
    (n.length() >= f64::from(f32::MIN_POSITIVE)).then_some(n)
}

/// Makes the shading normals unit.
fn repair_normals(mesh: &mut Mesh) {
    if mesh.normals.is_empty() {
        return;
    }
    for triangle in &mesh.indices {
        for i in triangle.map(|i| i as usize) {
            if mesh.normals[i] == glam::Vec3::ZERO {
                mesh.normals[i] = normal(triangle, &mesh.positions).map_or(glam::Vec3::Z, |n| n.normalize().as_vec3());
            }
        }
    }
    for n in &mut mesh.normals {
        *n = unit_vector(*n).unwrap_or(glam::Vec3::Z);
    }
}

/// The unit vector along `v`, which stays as it is where it is one as far as f32 tells: normalised again it might end an
/// ulp away, and what was written would not be read.
pub(crate) fn unit_vector(v: glam::Vec3) -> Option<glam::Vec3> {
    let exact = v.as_dvec3();
    if (exact.length_squared() - 1.0).abs() <= 4.0 * f64::from(f32::EPSILON) {
        return Some(v);
    }
    exact.try_normalize().map(|unit| unit.as_vec3())
}
