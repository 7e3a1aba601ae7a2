//! A2 and A3: the microsurface.

use crate::bsdf::{Beckmann, Ggx};
use crate::stats::Moments;
use crate::verify::measure::to_detect;
use crate::verify::scattering::{Closures, Density, Draw, at_cosine, density};
use crate::verify::{Task, Topic, Trial};
use crate::warp::uniform_hemisphere;
use glam::{DVec3, Vec3};
use std::f32::consts::PI;

/// D is the area of normals over the area of the surface, and G1 leaves what is seen of it from o.
const NORMALS: Topic = Topic {
    id: "A2",
    title: "∫ D (n·m) dm = 1; ∫ G1(o,m) ⟨o,m⟩ D dm = cos θo; ∫ D_o dm = 1, and drawn normals follow D_o",
    source: "Heitz 2014, eqs. 10, 16 and 19",
};

/// Every visible normal reflects once, whatever becomes of the light afterwards.
const FURNACE: Topic =
    Topic {
        id: "A3", title: "weak white furnace ∫ G1(o,h) D(h)/(4 cos θo) dωi = 1", source: "Heitz 2014, eq. 107"
    };

/// A microsurface under test.
#[derive(Clone, Copy)]
enum Surface {
    Ggx(Ggx),
    Beckmann(Beckmann),
}

/// Asks either distribution.
macro_rules! either {
    ($surface:expr, $s:ident => $answer:expr) => {
        match $surface {
            Surface::Ggx($s) => $answer,
            Surface::Beckmann($s) => $answer,
        }
    };
}

impl Surface {
    fn alpha(&self) -> [f32; 2] {
        either!(self, s => [s.ax, s.ay])
    }
    fn d(&self, m: Vec3) -> f32 {
        either!(self, s => s.d(m))
    }
    fn g1(&self, w: Vec3) -> f32 {
        either!(self, s => s.g1(w))
    }
    fn visible_pdf(&self, o: Vec3, m: Vec3) -> f32 {
        either!(self, s => s.visible_pdf(o, m))
    }
    fn sample_visible(&self, o: Vec3, u: [f32; 2]) -> Vec3 {
        either!(self, s => s.sample_visible(o, u))
    }
}

/// Roughnesses of Beckmann's microsurface.
const BECKMANN: [[f32; 2]; 3] = [[0.05, 0.05], [0.6, 0.6], [0.15, 0.5]];

const SURFACES: [[f32; 2]; 8] =
    [[1e-3, 1e-3], [0.01, 0.01], [0.1, 0.1], [0.3, 0.3], [1.0, 1.0], [0.15, 0.6], [0.9, 0.2], [0.01, 0.3]];

/// Rounding of f32 in D where α is small.
const ROUNDING: f64 = 1e-5;
/// Rounding of f32 in D where α is small and h is found again from two directions.
const HALF_VECTOR: f64 = 1e-4;
/// Smallest relative bias that must be found.
const AIM: f64 = 1e-3;

fn cosines(trial: &Trial) -> &'static [f32] {
    trial.pick(&[1.0, 0.5, 0.05], &[1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 0.05, 0.01])
}

pub(super) fn tasks() -> Vec<Task> {
    let surfaces = || {
        let ggx = SURFACES.into_iter().map(|[ax, ay]| (format!("GGX α {ax} {ay}"), Surface::Ggx(Ggx { ax, ay })));
        let beckmann = |[ax, ay]: [f32; 2]| (format!("Beckmann α {ax} {ay}"), Surface::Beckmann(Beckmann { ax, ay }));
        ggx.chain(BECKMANN.into_iter().map(beckmann))
    };
    let normals = surfaces().map(|(name, g)| {
        Task::new(NORMALS, name, move |trial, found| {
            let projected = over_normals(trial, g, 1.0, |m| g.d(m) * m.z);
            found.checks.replicated("∫ D (n·m)", 1.0, &projected, ROUNDING);
            for &mu in cosines(trial) {
                let (o, trial) = (at_cosine(mu.into()).as_vec3(), &trial.part(&format!("{mu}")));
                let masked = over_normals(trial, g, mu, |m| g.g1(o) * o.dot(m).max(0.0) * g.d(m));
                found.checks.replicated(format!("cos {mu}: ∫ G1 ⟨o,m⟩ D"), mu.into(), &masked, ROUNDING);
                let visible = over_normals(trial, g, 1.0, |m| g.visible_pdf(o, m));
                found.checks.replicated(format!("cos {mu}: ∫ D_o"), 1.0, &visible, ROUNDING);
                density(found, trial, &format!("cos {mu}: drawn normals"), &normals_of(g), at_cosine(mu.into()));
            }
        })
    });
    let furnace = surfaces().map(|(name, g)| {
        Task::new(FURNACE, name, move |trial, found| {
            for &mu in cosines(trial) {
                let (o, trial) = (at_cosine(mu.into()).as_vec3(), &trial.part(&format!("{mu}")));
                // Over all directions i of reflection, above the horizon or below: dωi = 4 |o·m| dm.
                let m = over_normals(trial, g, 1.0, |m| {
                    let cos = o.dot(m);
                    let i = m * (2.0 * cos) - o;
                    let h = (o + i).normalize_or_zero();
                    if cos > 0.0 && h.z > 0.0 { g.g1(o) * g.d(h) / (4.0 * mu) * 4.0 * cos } else { 0.0 }
                });
                found.checks.replicated(format!("cos {mu}"), 1.0, &m, HALF_VECTOR);
            }
        })
    });
    normals.chain(furnace).collect()
}

/// ∫ f(m) dm by uniform directions w of the hemisphere scaled by α along x and y, under which D of GGX is constant: the linear
/// map M takes the density p(w) to p(M⁻¹m/|M⁻¹m|) |M⁻¹| / |M⁻¹m|³.
fn over_normals(trial: &Trial, g: Surface, exact: f32, f: impl Fn(Vec3) -> f32) -> Moments {
    let [ax, ay] = g.alpha();
    to_detect(trial, exact.into(), AIM, trial.work(1 << 14, 1 << 17), |u: [f32; 2]| {
        let w = uniform_hemisphere(u);
        let m = Vec3::new(ax * w.x, ay * w.y, w.z).normalize();
        let length = Vec3::new(m.x / ax, m.y / ay, m.z).length();
        f64::from(f(m) * (2.0 * PI * ax * ay * length * length * length))
    })
}

/// Visible normals as if they were scattered light.
fn normals_of(g: Surface) -> impl crate::verify::scattering::Scattering {
    let visible =
        move |o: DVec3, m: DVec3| if m.z > 0.0 { f64::from(g.visible_pdf(o.as_vec3(), m.as_vec3())) } else { 0.0 };
    Closures {
        sample: move |o: DVec3, [_, u, v]: [f32; 3]| {
            let wi = g.sample_visible(o.as_vec3(), [u, v]).as_dvec3();
            let density = Density::SolidAngle(visible(o, wi));
            Some(Draw { wi, weight: [1.0; 3], density, eta: 1.0 })
        },
        eval: move |o, m: DVec3| [visible(o, m) / m.z.max(1e-9); 3],
        pdf: visible,
    }
}
