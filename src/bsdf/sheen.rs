//! Sheen: fibres that stand on the surface and glow at grazing angles.
//!
//! Microfacets whose normals follow the distribution of Estevez & Kulla (2017, "Production Friendly Microfacet Sheen
//! BRDF"), which KHR_materials_sheen takes over,
//!
//! ```text
//! D(m) = (2 + 1/α)/(2π) (sin θm)^(1/α),    f = C D(h) G₂(o, i)/(4 |cos o||cos i|),    α = r²
//! ```
//!
//! with Smith's masking of that very distribution in place of their fitted polynomial, under which f reflects up to 2.8 times
//! what arrives (α = 0.005, grazing). σ(w) = ∫ D(m) ⟨w·m⟩ dm, the area of facets seen from w, is 1 + Λ = σ/|cos|, so that
//!
//! ```text
//! f = C D(h) / (4 (σ(o)|cos i| + σ(i)|cos o| − |cos o||cos i|))
//! ```
//!
//! G₂ ≤ G₁ keeps E ≤ 1 (Heitz 2014, section 5). σ, E and the densities of draws are tabulated once; below r = 0.05,
//! where next to nothing is scattered, r is 0.05.

use super::energy::{Grid, Stencil, gauss_legendre};
use super::ggx::half_vector;
use super::lobe::{Aspect, importance};
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec4};
use std::f32::consts::TAU;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The least perceptual roughness.
const MIN_ROUGHNESS: f32 = 0.05;

/// Nodes in √μ and in roughness.
const NODES: [usize; 2] = [33, 24];

/// Nodes of the densities in √μ of the view, and intervals in √μ of the draw.
const VIEWS: usize = 24;
const INTERVALS: usize = 24;

/// Share of draws that are uniform over the hemisphere.
const UNIFORM: f32 = 0.1;

/// The sheen lobe. Two-sided.
#[derive(Clone, Copy, Debug)]
pub struct Sheen {
    color: Spectrum,
    albedo: SheenAlbedo,
}

/// Directional albedo E of white sheen of one roughness.
#[derive(Clone, Copy, Debug)]
pub struct SheenAlbedo {
    roughness: f32,
    row: Stencil,
}

/// Nodes and weights on \[0, 1\].
type Rule = [(f64, f64); 32];

struct Tables {
    /// (σ, ⁴√E): E falls by many powers of ten towards the normal.
    grid: Grid<Vec4>,
    /// For each roughness and view: densities of x = √μ at its nodes, and their running integral.
    draws: Vec<[[f32; INTERVALS + 1]; 2]>,
}

/// Place of a roughness among the nodes, in [0, 1].
fn place(roughness: f32) -> f32 {
    (roughness - MIN_ROUGHNESS) / (1.0 - MIN_ROUGHNESS)
}

/// The tables, made the first time on the thread that asks: of those that wait for them none takes up other work.
fn tables() -> &'static Tables {
    static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);
    &TABLES
}

/// D(m) by sin²θm.
#[inline]
fn d(sin2: f32, alpha: f32) -> f32 {
    let power = sin2.max(0.0).powf(0.5 / alpha);
    // Numbers beyond the precision of f32 would make quotients of noise.
    if power > 1e-30 { (2.0 + 1.0 / alpha) * power / TAU } else { 0.0 }
}

/// ∫ D(m) ⟨w·m⟩ dm at the cosine `mu`. In t = cos θm, which D is a function of; over the azimuth
/// ∫ ⟨w·m⟩ dφ = 2 (a sin φ₀ + b φ₀), a = sin θ sin θm, b = μ t, where facets turn away at cos φ₀ = −b/a.
fn seen_area(rule: &Rule, mu: f64, alpha: f64) -> f64 {
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    let mut sum = 0.0;
    // From t = sin θ on, no azimuth turns away.
    for (from, to) in [(0.0, sin), (sin, 1.0)] {
        for &(x, w) in rule {
            // Graded to the edge and to the horizon, about which D is as narrow as √α.
            let (x, w) = (x * x * (3.0 - 2.0 * x), w * 6.0 * x * (1.0 - x));
            let t = from + (to - from) * x;
            let sin_m = (1.0 - t * t).max(0.0).sqrt();
            let (a, b) = (sin * sin_m, mu * t);
            let phi = if b >= a { PI } else { (-b / a).acos() };
            let density = (2.0 + 1.0 / alpha) * sin_m.powf(1.0 / alpha) / (2.0 * PI);
            sum += w * (to - from) * density * 2.0 * (a * phi.sin() + b * phi);
        }
    }
    sum
}

/// ∫ f cos θi dφ of white sheen at the cosine `i`, for the view of cosine `o`.
fn ring(rule: &Rule, o: f64, i: f64, alpha: f64, area: impl Fn(f64) -> f64 + Copy) -> f64 {
    let (so, si) = ((1.0 - o * o).max(0.0).sqrt(), (1.0 - i * i).max(0.0).sqrt());
    let masked = 4.0 * (area(o) * i + area(i) * o - o * i);
    let mut sum = 0.0;
    for &(x, w) in rule {
        // Crowded where the directions face each other.
        let phi = PI * (1.0 - x * x);
        let h = (o + i).powi(2) / (2.0 + 2.0 * (so * si * phi.cos() + o * i)).max(1e-12);
        sum += w * 2.0 * x * (1.0 - h).max(0.0).powf(0.5 / alpha);
    }
    sum * 2.0 * PI * (2.0 + 1.0 / alpha) / (2.0 * PI) * i / masked.max(1e-12)
}

impl Tables {
    fn new() -> Self {
        let [nx, ny] = NODES;
        let rule = &gauss_legendre::<32>();
        let root = |i: usize, n: usize| i as f64 / (n - 1) as f64;
        let roughness = |j: usize| f64::from(MIN_ROUGHNESS) + (1.0 - f64::from(MIN_ROUGHNESS)) * root(j, ny);
        let areas = Grid::tabulate_here(nx, ny, |i, j| {
            Vec4::X * seen_area(rule, root(i, nx).powi(2), roughness(j).powi(2)) as f32
        });
        let area = |j: usize| {
            let row = Stencil::new(root(j, ny) as f32, ny);
            let areas = &areas;
            move |mu: f64| f64::from(areas.at((mu as f32).sqrt(), row).x)
        };
        let grid = Grid::tabulate_here(nx, ny, |i, j| {
            let (o, alpha, area) = (root(i, nx).powi(2), roughness(j).powi(2), area(j));
            let term = |&(x, w): &(f64, f64)| w * 2.0 * x * ring(rule, o, x * x, alpha, area);
            let albedo: f64 = rule.iter().map(term).sum();
            Vec4::new(area(o) as f32, albedo.sqrt().sqrt() as f32, 0.0, 0.0)
        });
        let draws = (0..VIEWS * ny).map(|index| {
            let (o, j) = (((index % VIEWS) as f64 + 0.5) / VIEWS as f64, index / VIEWS);
            let (alpha, area) = (roughness(j).powi(2), area(j));
            let node = |k: usize| {
                let x = k as f64 / INTERVALS as f64;
                (2.0 * x * ring(rule, o * o, x * x, alpha, area)) as f32
            };
            let pdf: [f32; INTERVALS + 1] = std::array::from_fn(node);
            let mut cdf = [0.0; INTERVALS + 1];
            for k in 0..INTERVALS {
                cdf[k + 1] = cdf[k] + 0.5 * (pdf[k] + pdf[k + 1]) / INTERVALS as f32;
            }
            let total = cdf[INTERVALS].max(f32::MIN_POSITIVE);
            [pdf.map(|p| p / total), cdf.map(|c| c / total)]
        });
        let draws = draws.collect();
        Self { grid, draws }
    }
}

impl SheenAlbedo {
    /// Makes the tables, which takes some hundredths of a second: when a material is compiled.
    pub fn prepare() {
        tables();
    }

    /// Of this perceptual roughness.
    pub fn new(roughness: f32) -> Self {
        let roughness = roughness.clamp(MIN_ROUGHNESS, 1.0);
        Self { roughness, row: Stencil::new(place(roughness), NODES[1]) }
    }

    /// σ and E at the cosine `mu` ≥ 0.
    #[inline]
    fn table(&self, mu: f32) -> (f32, f32) {
        let v = tables().grid.at(mu.min(1.0).sqrt(), self.row);
        (v.x, v.y.powi(4).min(1.0))
    }

    /// E at the cosine `mu` ≥ 0.
    #[inline]
    pub fn at(&self, mu: f32) -> f32 {
        self.table(mu).1
    }

    /// Densities of the draws towards the cosine `mu`.
    #[inline]
    fn draws(&self, mu: f32) -> &'static [[f32; INTERVALS + 1]; 2] {
        let row = (place(self.roughness) * (NODES[1] - 1) as f32).round() as usize;
        let view = (mu.sqrt() * VIEWS as f32) as usize;
        &tables().draws[row.min(NODES[1] - 1) * VIEWS + view.min(VIEWS - 1)]
    }
}

impl Sheen {
    /// Sheen of this colour and roughness.
    pub fn new(color: Spectrum, albedo: SheenAlbedo) -> Self {
        Self { color, albedo }
    }

    /// Directional albedo.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        self.color * self.albedo.at(wo.z.abs())
    }

    /// What is asked again and again of the direction `w`.
    #[inline]
    pub(super) fn aspect(&self, w: Vec3) -> Aspect {
        let (area, albedo) = self.albedo.table(w.z.abs());
        Aspect { loss: area, weight: importance(self.color * albedo), ..Aspect::NONE }
    }

    /// f \[1/sr\], and the densities \[1/sr\] of `wi` and, seen from there, of `wo`; nothing across the surface.
    #[inline]
    pub(super) fn eval(&self, [wo, wi]: [Vec3; 2], [seen_o, seen_i]: [&Aspect; 2]) -> (Spectrum, f32, f32) {
        if wo.z * wi.z <= 0.0 {
            return (Spectrum::ZERO, 0.0, 0.0);
        }
        let (o, i) = (wo.z.abs().min(1.0), wi.z.abs().min(1.0));
        let (h, _) = half_vector(wo, wi);
        let alpha = self.albedo.roughness * self.albedo.roughness;
        let masked = 4.0 * (seen_o.loss * i + seen_i.loss * o - o * i);
        let f = self.color * (d(h.x * h.x + h.y * h.y, alpha) / masked);
        (f, self.density(o, i), self.density(i, o))
    }

    /// Density of draws at the cosine `i`, seen from the cosine `o`.
    #[inline]
    fn density(&self, o: f32, i: f32) -> f32 {
        // dω = 2π dμ = 4π x dx.
        let [pdf, _] = self.albedo.draws(o);
        let t = i.sqrt() * INTERVALS as f32;
        let k = (t as usize).min(INTERVALS - 1);
        let p = pdf[k] + (pdf[k + 1] - pdf[k]) * (t - k as f32);
        (1.0 - UNIFORM) * p / (2.0 * TAU * i.sqrt()) + UNIFORM / TAU
    }

    /// Draws `wi`: a height by the table, and any azimuth.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<Vec3> {
        let mu = if uc < UNIFORM {
            u[0]
        } else {
            let [pdf, cdf] = self.albedo.draws(wo.z.abs().min(1.0));
            let k = cdf.partition_point(|c| *c <= u[0]).clamp(1, INTERVALS) - 1;
            // The integral of a + (b − a) t over an interval of width 1/n, ½ (b − a) t² + a t, is n times what is left.
            let (a, b, rest) = (pdf[k], pdf[k + 1], (u[0] - cdf[k]) * INTERVALS as f32);
            let t = 2.0 * rest / (a + (a * a + 2.0 * (b - a) * rest).max(0.0).sqrt()).max(1e-20);
            ((k as f32 + t.clamp(0.0, 1.0)) / INTERVALS as f32).powi(2)
        };
        let (sin, cos) = (TAU * u[1]).sin_cos();
        let r = (1.0 - mu * mu).max(0.0).sqrt();
        (mu > 0.0).then(|| Vec3::new(r * cos, r * sin, mu.copysign(wo.z)).normalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_seen_from_above_cover_the_surface() {
        let rule = gauss_legendre::<32>();
        for alpha in [0.0025, 0.05, 0.3, 1.0] {
            assert!((seen_area(&rule, 1.0, alpha) - 1.0).abs() < 1e-4, "{alpha}");
            assert!(seen_area(&rule, 0.0, alpha) > 0.3);
        }
    }

    #[test]
    fn sheen_glows_at_grazing_angles_and_never_reflects_more_than_all() {
        let start = std::time::Instant::now();
        tables();
        println!("tabulated in {:.0?}", start.elapsed());
        for roughness in [0.05, 0.2, 0.5, 1.0] {
            let e = SheenAlbedo::new(roughness);
            let all: Vec<f32> = (1..=50).map(|i| e.at(i as f32 / 50.0)).collect();
            assert!(all.iter().all(|e| *e <= 1.0) && all[0] > 2.0 * all[49], "{roughness}: {all:?}");
            println!("{roughness}: {:?}", [0.0, 0.001, 0.01, 0.05, 0.2, 0.5, 1.0].map(|mu| e.table(mu)));
        }
    }
}
