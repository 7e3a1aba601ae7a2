//! # Radianza
//!
//! A Monte Carlo path tracer that solves the rendering equation
//!
//! ```text
//! L(x, ω) = Le(x, ω) + ∫_Ω f(x, ωi, ω) L(x, ωi) (ωi·n) dωi                          (2)
//! ```
//!
//! (Kajiya 1986, in the hemisphere form) and says how far each pixel may be from the solution.
//!
//! Data goes one way:
//!
//! ```text
//! file ─ desc (what the author wrote) ─ Scene::compile ─ integrator ─ film (sums) ─ image + error
//!                                                            ▲
//!                            a sample = pure function of (seed, pixel, index, dimension)
//! ```
//!
//! ## Conventions
//!
//! * `wo` points to where the path came from, `wi` to where it goes on; both are unit vectors and point away from
//!   the surface. `f` \[1/sr\] is the BSDF without the cosine, `pdf` \[1/sr\] a density over solid angle, `le` emitted
//!   radiance, `beta` the product of `f |cos| / pdf` along the path, `eta` a relative index of refraction (transmitted
//!   side over incident side), `alpha` GGX roughness, `ng` and `ns` geometric and shading normal.
//! * Local frames have z = `ns`. World space is right-handed; cameras look along −z with +y up. What rays meet and carry in
//!   world (or object) space is a `Vec3A`, one SIMD register; local directions and what is stored in files are `Vec3`.
//! * Metres; W·sr⁻¹·m⁻² for radiance, W·sr⁻¹ for intensity, W·m⁻² for irradiance; nm; radians in code, degrees in
//!   files. Photometric numbers of glTF are carried one to one into the linear RGB lanes.
//! * f32 in tracing, f64 in film sums, statistics and closed forms.
//!
//! ## Map
//!
//! Lower layers know nothing of higher ones; `tests/parts/layers.rs` holds the table.
//!
//! | layer | module | what is there |
//! | --- | --- | --- |
//! | 0 | [`math`] | frames, rays and their robust offsets, small solvers |
//! | 1 | [`spectrum`] | four lanes of radiance: linear RGB today |
//! | 1 | [`sampler`] | `u(seed, pixel, index, dimension)`: independent, Owen-scrambled Sobol, shifted lattices |
//! | 1 | [`warp`] | square to disk, hemisphere, cone, triangle, table; each with pdf and inverse |
//! | 1 | [`stats`] | moments, standard errors, z, χ², Šidák |
//! | 2 | [`bsdf`] | lobes: `sample`, `eval`, `pdf` |
//! | 2 | [`medium`] | what is inside closed surfaces: absorption, index, nesting |
//! | 2 | [`texture`] | constants, images, checkers |
//! | 2 | [`shape`] | triangles and quadrics: intersect, sample |
//! | 2 | [`desc`] | what the author wrote, the readers of TOML, glTF, OBJ, PLY, the writers of TOML and for Mitsuba and pbrt |
//! | 2 | [`film`] | layers of sums per pixel, errors, splats, EXR and PNG |
//! | 3 | [`material`] | parameters and textures at a hit → lobes |
//! | 3 | [`bvh`] | nearest hit? occluded? |
//! | 3 | [`light`] | area, environment, sun, point, spot, measured, directional; choosing one of thousands |
//! | 3 | [`camera`] | film point → ray, world point → film point |
//! | 4 | [`scene`] | desc → what is traced |
//! | 5 | [`integrator`] | raycast, local, whitted, path |
//! | 6 | [`render`] | rounds of tiles × sample indices → film; what comes next |
//! | 7 | [`verify`] | the checks of all of it, as a command and as a library |

pub mod bsdf;
pub mod bvh;
pub mod camera;
pub mod desc;
pub mod film;
pub mod integrator;
pub mod light;
pub mod material;
pub mod math;
pub mod medium;
pub mod render;
pub mod sampler;
pub mod scene;
pub mod shape;
pub mod spectrum;
pub mod stats;
pub mod texture;
pub mod verify;
pub mod warp;

pub use glam;

/// The README's Rust, compiled with the documentation's tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
