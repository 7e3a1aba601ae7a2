//! A2 and A3: the microsurface (Heitz 2014).

use crate::{at_cosine, replicates};
use radianza::bsdf::Ggx;
use radianza::stats::Family;
use radianza::warp::{UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, uniform_hemisphere, uniform_sphere};

const SURFACES: [Ggx; 5] = [
    Ggx { ax: 0.1, ay: 0.1 },
    Ggx { ax: 0.3, ay: 0.3 },
    Ggx { ax: 1.0, ay: 1.0 },
    Ggx { ax: 0.15, ay: 0.6 },
    Ggx { ax: 0.9, ay: 0.2 },
];

#[test]
fn normals_project_to_the_surface() {
    let mut family = Family::new("A2: normals");
    let over_normals = |f: &dyn Fn(radianza::glam::Vec3) -> f32| {
        replicates(2, 32, 8192, |_, u| f64::from(f(uniform_hemisphere(u)) / UNIFORM_HEMISPHERE_PDF))
    };
    for g in SURFACES {
        family.moments(format!("∫ D (n·m) {g:?}"), 1.0, &over_normals(&|m| g.d(m) * m.z));
        for mu in [1.0, 0.7, 0.3, 0.05] {
            let o = at_cosine(mu);
            let masked = over_normals(&|m| g.g1(o) * o.dot(m).max(0.0) * g.d(m));
            family.moments(format!("∫ G1 ⟨o,m⟩ D {g:?} μ {mu}"), f64::from(mu), &masked);
            family.moments(format!("∫ D_o {g:?} μ {mu}"), 1.0, &over_normals(&|m| g.visible_pdf(o, m)));
        }
    }
    family.assert();
}

#[test]
fn weak_white_furnace() {
    let mut family = Family::new("A3: ∫ G1(o,h) D(h)/(4 cos θo) dωi");
    for g in SURFACES {
        for mu in [1.0, 0.7, 0.3, 0.05] {
            let o = at_cosine(mu);
            let moments = replicates(4, 32, 8192, |_, u| {
                let h = (o + uniform_sphere(u)).normalize_or_zero();
                let f = if h.z > 0.0 { g.g1(o) * g.d(h) / (4.0 * mu) } else { 0.0 };
                f64::from(f / UNIFORM_SPHERE_PDF)
            });
            family.rounded(format!("{g:?} μ {mu}"), 1.0, moments.mean(), moments.standard_error(), 2e-6);
        }
    }
    family.assert();
}

/// Drawn normals have the mean of the visible distribution: ∫ m D_o(m) dm, by quadrature-free symmetry checks in two
/// ways (drawn, and weighted).
#[test]
fn drawn_normals_have_the_visible_moments() {
    let mut family = Family::new("visible normals: drawn against weighted");
    for g in SURFACES {
        for mu in [0.9, 0.2] {
            let o = at_cosine(mu);
            for axis in 0..3 {
                let drawn = replicates(5, 32, 8192, |_, u| f64::from(g.sample_visible(o, u)[axis]));
                let weighted = replicates(6, 32, 8192, |_, u| {
                    let m = uniform_hemisphere(u);
                    f64::from(m[axis] * g.visible_pdf(o, m) / UNIFORM_HEMISPHERE_PDF)
                });
                family.equal(format!("{g:?} μ {mu} axis {axis}"), &drawn, &weighted);
            }
        }
    }
    family.assert();
}
