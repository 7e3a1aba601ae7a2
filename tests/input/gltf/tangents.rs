//! Tangents that the file leaves out.

use super::document::{Document, U32, mesh, noted};
use glam::{Vec2, Vec3};
use proptest::prelude::*;
use radianza::desc::Mesh;
use radianza::glam;
use serde_json::json;

/// A unit square in the plane z = 0 with a normal map.
fn square(uv: [[f32; 2]; 4]) -> Document {
    let mut d = Document::mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    d.indices(U32, &[0, 1, 2, 0, 2, 3]);
    d.attribute("TEXCOORD_0", "VEC2", &uv);
    d.attribute("NORMAL", "VEC3", &[[0.0, 0.0, 1.0]; 4]);
    d.texture([1, 1], &[[128, 128, 255, 255]]);
    d.set("/materials", json!([{ "normalTexture": { "index": 0 } }]));
    d.set("/meshes/0/primitives/0/material", json!(0));
    d
}

/// v points down: (0, 1) is the lower left corner.
const UPRIGHT: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

/// Every tangent of the mesh with its sign, and that there is one a vertex, unit, orthogonal to the normal.
fn tangents(m: &Mesh) -> Vec<(Vec3, f32)> {
    assert_eq!(m.tangents.len(), m.positions.len());
    assert!(m.normals.is_empty() || m.normals.len() == m.positions.len());
    for (i, t) in m.tangents.iter().enumerate() {
        assert!(t.is_finite() && (t.truncate().length() - 1.0).abs() < 1e-4 && t.w.abs() == 1.0, "{t}");
        if let Some(n) = m.normals.get(i) {
            assert!(t.truncate().dot(*n).abs() < 1e-4, "{t} {n}");
        }
    }
    m.tangents.iter().map(|t| (t.truncate(), t.w)).collect()
}

#[test]
fn tangents_follow_u() {
    let m = square(UPRIGHT).read_mesh();
    assert_eq!((m.positions.len(), m.indices.len()), (4, 2));
    for (t, sign) in tangents(&m) {
        // The bitangent, sign × n × t, points up, to where v decreases: green is up in glTF's normal maps.
        assert!(t.abs_diff_eq(Vec3::X, 1e-5), "{t}");
        assert_eq!(sign, 1.0);
    }
}

#[test]
fn tangents_follow_the_transformed_uv() {
    let mut d = square(UPRIGHT);
    let turn = json!({ "KHR_texture_transform": { "rotation": std::f32::consts::FRAC_PI_2 } });
    d.set("/materials/0/normalTexture/extensions", turn);
    let m = d.read_mesh();
    // u' = v: it grows downwards.
    assert!(tangents(&m).iter().all(|(t, _)| t.abs_diff_eq(-Vec3::Y, 1e-5)), "{:?}", m.tangents);
}

#[test]
fn vertices_are_split_where_uv_is_mirrored() {
    // The second triangle has its u mirrored about the shared edge, which keeps position, normal and UV.
    let mut d = square([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
    d.attribute("COLOR_0", "VEC3", &[[0.0; 3], [0.1; 3], [0.2; 3], [0.3; 3]]);
    let m = d.read_mesh();
    assert_eq!(m.positions.len(), 6);
    assert_eq!((m.uv[0].len(), m.colors.len()), (6, 6));
    let signs: Vec<f32> = m.indices.iter().map(|t| m.tangents[t[0] as usize].w).collect();
    assert_eq!(signs[0], -signs[1]);
    tangents(&m);
    // The triangles are where they were.
    let corners: Vec<_> = m.indices.iter().flatten().map(|i| m.positions[*i as usize]).collect();
    assert_eq!(corners, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(m.uv[0][m.indices[0][1] as usize], Vec2::X);
}

#[test]
fn flat_meshes_get_tangents_too() {
    let mut d = square(UPRIGHT);
    d.remove("/meshes/0/primitives/0/attributes/NORMAL");
    let m = d.read_mesh();
    assert!(m.normals.is_empty());
    assert!(tangents(&m).iter().all(|(t, _)| t.abs_diff_eq(Vec3::X, 1e-5)));
}

#[test]
fn the_files_own_tangents_stay() {
    let mut d = square(UPRIGHT);
    d.attribute("TANGENT", "VEC4", &[[0.0, 1.0, 0.0, 1.0]; 4]);
    assert!(tangents(&d.read_mesh()).iter().all(|(t, sign)| *t == Vec3::Y && *sign == 1.0));
}

#[test]
fn no_normal_map_no_tangents() {
    let mut d = square(UPRIGHT);
    d.set("/materials", json!([{}]));
    assert!(d.read_mesh().tangents.is_empty());
}

#[test]
fn uv_without_extent_gives_some_tangent() {
    tangents(&square([[0.5; 2]; 4]).read_mesh());
}

#[test]
fn a_vertex_of_ten_thousand_triangles() {
    let rim = 10_000;
    let angle = |i: usize| i as f32 / rim as f32 * std::f32::consts::TAU;
    let mut positions = vec![[0.0, 0.0, 0.0]];
    positions.extend((0..rim).map(|i| [angle(i).cos(), angle(i).sin(), 0.0]));
    let uv: Vec<[f32; 2]> = positions.iter().map(|p| [p[0], p[1]]).collect();
    let mut d = Document::mesh(&positions);
    let fan: Vec<u32> = (1..rim as u32).flat_map(|i| [0, i, i + 1]).collect();
    d.indices(U32, &fan);
    d.attribute("TEXCOORD_0", "VEC2", &uv);
    d.attribute("NORMAL", "VEC3", &vec![[0.0, 0.0, 1.0]; rim + 1]);
    d.texture([1, 1], &[[128, 128, 255, 255]]);
    d.set("/materials", json!([{ "normalTexture": { "index": 0 } }]));
    d.set("/meshes/0/primitives/0/material", json!(0));
    let scene = d.read().unwrap();
    assert!(noted(&scene, "tangents are made per triangle"));
    for (t, sign) in tangents(mesh(&scene, 0)) {
        assert!(t.abs_diff_eq(Vec3::X, 1e-3) && sign == -1.0, "{t}");
    }
}

/// Few different values, so that vertices coincide, triangles fold and UV areas vanish.
fn lattice() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0f32), Just(-0.0), Just(1.0), Just(-1.0), Just(0.5), Just(3e38), Just(1e-38), Just(-3e38)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn any_mesh_gets_tangents(
        vertices in prop::collection::vec((prop::array::uniform3(lattice()), prop::array::uniform2(lattice()), prop::array::uniform3(lattice())), 3..12),
        corners in prop::collection::vec(0usize..12, 3..60),
    ) {
        let positions: Vec<[f32; 3]> = vertices.iter().map(|v| v.0).collect();
        let mut d = Document::mesh(&positions);
        d.attribute("TEXCOORD_0", "VEC2", &vertices.iter().map(|v| v.1).collect::<Vec<_>>());
        d.attribute("NORMAL", "VEC3", &vertices.iter().map(|v| v.2).collect::<Vec<_>>());
        d.indices(U32, &corners.iter().map(|c| (c % vertices.len()) as u32).collect::<Vec<_>>());
        d.texture([1, 1], &[[0; 4]]);
        d.set("/materials", json!([{ "normalTexture": { "index": 0 } }]));
        d.set("/meshes/0/primitives/0/material", json!(0));
        let scene = d.read().unwrap();
        if !scene.shapes.is_empty() {
            let m = mesh(&scene, 0);
            tangents(m);
            prop_assert!(m.indices.iter().flatten().all(|i| (*i as usize) < m.positions.len()));
        }
    }
}
