//! A2 and A3: the microsurface (Heitz 2014).

use crate::{at_cosine, replicates};
use radianza::bsdf::Ggx;
use radianza::glam::Vec3;
use radianza::stats::Family;
use radianza::warp::cosine_hemisphere;
use std::f32::consts::PI;

const SURFACES: [Ggx; 6] = [
    Ggx { ax: 0.01, ay: 0.01 },
    Ggx { ax: 0.1, ay: 0.1 },
    Ggx { ax: 0.3, ay: 0.3 },
    Ggx { ax: 1.0, ay: 1.0 },
    Ggx { ax: 0.15, ay: 0.6 },
    Ggx { ax: 0.9, ay: 0.2 },
];

const MUS: [f32; 4] = [1.0, 0.7, 0.3, 0.05];

/// A cosine-distributed direction scaled by 1.5 α along x and y: a broader density than any under test. The linear map
/// M takes the density p(w) to p(M⁻¹m/|M⁻¹m|) |M⁻¹| / |M⁻¹m|³.
fn broad(g: Ggx, u: [f32; 2]) -> (Vec3, f32) {
    let (a, b) = (1.5 * g.ax, 1.5 * g.ay);
    let w = cosine_hemisphere(u);
    let m = Vec3::new(a * w.x, b * w.y, w.z).normalize();
    let length = Vec3::new(m.x / a, m.y / b, m.z).length();
    (m, m.z / length / PI / (a * b * length.powi(3)))
}

fn over_normals(g: Ggx, f: impl Fn(Vec3) -> f32) -> radianza::stats::Moments {
    replicates(2, 16, 8192, |_, u| {
        let (m, pdf) = broad(g, u);
        if pdf > 0.0 { f64::from(f(m) / pdf) } else { 0.0 }
    })
}

/// Rounding of f32 in D at α = 0.01.
const ROUNDING: f64 = 1e-5;

#[test]
fn normals_project_to_the_surface() {
    let mut family = Family::new("A2: normals");
    let mut add = |name: String, exact: f32, m: radianza::stats::Moments| {
        family.rounded(name, f64::from(exact), m.mean(), m.standard_error(), ROUNDING);
    };
    for g in SURFACES {
        add(format!("∫ D (n·m) {g:?}"), 1.0, over_normals(g, |m| g.d(m) * m.z));
        for mu in MUS {
            let o = at_cosine(mu);
            let masked = over_normals(g, |m| g.g1(o) * o.dot(m).max(0.0) * g.d(m));
            add(format!("∫ G1 ⟨o,m⟩ D {g:?} μ {mu}"), mu, masked);
            add(format!("∫ D_o {g:?} μ {mu}"), 1.0, over_normals(g, |m| g.visible_pdf(o, m)));
        }
    }
    family.assert();
}

#[test]
fn weak_white_furnace() {
    let mut family = Family::new("A3: ∫ G1(o,h) D(h)/(4 cos θo) dωi");
    for g in SURFACES {
        for mu in MUS {
            let o = at_cosine(mu);
            let moments = replicates(4, 16, 8192, |_, u| {
                // Over all directions i of reflection, above the horizon or below: dωi = 4 |o·m| dm.
                let (m, pdf) = broad(g, u);
                let cos = o.dot(m);
                let i = m * (2.0 * cos) - o;
                let h = (o + i).normalize_or_zero();
                let f = if cos > 0.0 && h.z > 0.0 { g.g1(o) * g.d(h) / (4.0 * mu) } else { 0.0 };
                if pdf > 0.0 { f64::from(f * 4.0 * cos / pdf) } else { 0.0 }
            });
            // h is found again from o and i: its error is that of f32 over α.
            family.rounded(format!("{g:?} μ {mu}"), 1.0, moments.mean(), moments.standard_error(), 1e-4);
        }
    }
    family.assert();
}

/// Drawn normals have the mean of the visible distribution.
#[test]
fn drawn_normals_have_the_visible_mean() {
    let mut family = Family::new("visible normals: drawn against weighted");
    // Relative to 1, not to the small mean slope.
    for g in SURFACES {
        for mu in [0.9, 0.2] {
            let o = at_cosine(mu);
            for axis in 0..3 {
                let drawn = replicates(5, 16, 8192, |_, u| f64::from(1.0 + g.sample_visible(o, u)[axis] / g.ax));
                let weighted = over_normals(g, |m| (1.0 + m[axis] / g.ax) * g.visible_pdf(o, m));
                let se = drawn.standard_error().hypot(weighted.standard_error());
                let name = format!("{g:?} μ {mu} axis {axis}");
                family.rounded(name, weighted.mean(), drawn.mean(), se, 1e-4);
            }
        }
    }
    family.assert();
}
