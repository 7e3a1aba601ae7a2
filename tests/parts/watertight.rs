//! No ray slips between triangles that share an edge or a vertex, and none through the surface that it leaves.

use crate::common::closed_mesh;
use glam::Vec3;
use radianza::bsdf::Scratch;
use radianza::bvh::{Isa, Quality, TriangleBvh, TriangleRef};
use radianza::desc::{self, ColorParam, Model, Object, Shape};
use radianza::math::Ray;
use radianza::medium::MediumStack;
use radianza::sampler::{Kind, Sampler};
use radianza::scene::{MediumInterface, PrimitiveRef, Scene};
use radianza::warp;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Rays aimed at edges and vertices, all together.
const AIMED: u64 = 10_000_000;

/// Sizes and places: from a millimetre to a thousand kilometres, and far from the origin.
const PLACES: [(f32, Vec3); 5] = [
    (1.0, Vec3::ZERO),
    (1e-3, Vec3::new(0.1, -0.2, 0.3)),
    (1e3, Vec3::new(-1e3, 0.0, 2e3)),
    (1e6, Vec3::ZERO),
    (1.0, Vec3::new(1000.0, -500.0, 300.0)),
];

#[test]
fn ten_million_rays_at_edges_and_vertices_of_closed_meshes_find_them() {
    let kernels = Isa::ALL.into_iter().filter(|(isa, _)| isa.is_available());
    let kernels = kernels.map(|(isa, _)| (isa, Quality::Default)).chain([(Isa::detect(), Quality::Best)]);
    let kernels: Vec<(Isa, Quality)> = kernels.collect();
    let grazed = AtomicU64::new(0);
    for (scale, centre) in PLACES {
        let (positions, indices) = closed_mesh(24, scale, centre);
        for &(isa, quality) in &kernels {
            let bvh = TriangleBvh::build(&positions, &indices, quality).with_isa(isa).expect("it is available");
            (0..AIMED / (2 * (PLACES.len() * kernels.len()) as u64)).into_par_iter().for_each(|i| {
                let mut u = Sampler::new(Kind::Independent, 1, [scale.to_bits(), isa as u32], i, 1);
                let t = indices[i as usize % indices.len()];
                let [a, b] = [t[0], t[1]].map(|i| positions[i as usize]);
                let at = if u.next_1d() < 0.3 { a } else { a + (b - a) * u.next_1d() };
                // From inside, and from outside towards the far side.
                let inside = centre + warp::uniform_sphere(u.next_2d()) * scale * 0.5 * u.next_1d();
                let outside = centre + warp::uniform_sphere(u.next_2d()) * scale * 3.0;
                for o in [inside, outside] {
                    let ray = Ray::new(o, (at - o).normalize());
                    // At the silhouette the rounding of the direction alone may lead past the mesh.
                    let grazing = o == outside && ray.d.dot((at - centre).normalize().into()).abs() < 0.15;
                    let met = (bvh.nearest(&ray, TriangleRef::NONE).is_some(), bvh.occluded(&ray, TriangleRef::NONE));
                    assert!(grazing || met == (true, true), "{isa:?}: a ray from {o} at {at} slipped through: {met:?}");
                    grazed.fetch_add(u64::from(grazing), Ordering::Relaxed);
                }
            });
        }
    }
    let grazed = grazed.into_inner();
    println!("{AIMED} rays at edges and vertices, {grazed} of them at silhouettes: no miss");
    assert!(grazed < AIMED / 10);
}

#[test]
fn paths_in_a_closed_furnace_of_a_million_triangles_do_not_get_out() {
    let (positions, indices) = closed_mesh(290, 2.0, Vec3::new(3.0, -1.0, 7.0));
    let (triangles, mesh) = (indices.len(), desc::Mesh { positions, indices, ..Default::default() });
    assert!(triangles > 1_000_000);
    let white = Model::Diffuse { reflectance: ColorParam::constant([1.0; 3]) };
    let object = Object { closed: true, ..Object::new(0, 0) };
    let scene = Scene::compile(&desc::Scene {
        shapes: vec![Shape::Mesh(mesh.into())],
        objects: vec![object],
        materials: vec![desc::Material::new("white", white)],
        ..Default::default()
    });
    let scene = scene.expect("a mesh compiles");
    const PATHS: u64 = 20_000;
    const BOUNCES: u32 = 50;
    (0..PATHS).into_par_iter().for_each(|i| {
        let mut u = Sampler::new(Kind::Independent, 2, [0, 0], i, 1);
        let mut scratch = Scratch::new();
        let (mut ray, mut leaving) =
            (Ray::new(Vec3::new(3.0, -1.0, 7.0), warp::uniform_sphere(u.next_2d())), PrimitiveRef::NONE);
        for bounce in 0..BOUNCES {
            let met = scene.intersect_from(&ray, leaving, &mut MediumStack::default(), &mut || 0.5);
            let vertex = met.unwrap_or_else(|| panic!("path {i} got out at bounce {bounce}: {ray:?}"));
            let interface = MediumInterface::default();
            let shading = scene.shade(&vertex, &interface, None, || [0.5; 2], &mut scratch);
            let wi = warp::cosine_hemisphere(u.next_2d());
            let wi = if shading.wo.z < 0.0 { -wi } else { wi };
            ray = shading.ray(shading.frame.to_world(wi).normalize());
            leaving = vertex.primitive;
        }
    });
    println!("{PATHS} paths of {BOUNCES} bounces among {triangles} triangles: none got out");
}
