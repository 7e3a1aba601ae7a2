//! Emissive triangle.

use super::area::{Sight, in_plane};
use super::cells::Cells;
use super::tree::LightBounds;
use super::{Emitter, LightSample, SphericalTriangle};
use crate::bsdf::Pdf;
use crate::math::UNIT_ROUNDOFF;
use crate::shape::{Primitive, Triangle, TriangleAttributes, interpolate, triangle_area, triangle_normal};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use crate::warp::to_unit;
use crate::warp::uniform_triangle;
use glam::{DVec3, Vec2, Vec3, Vec3A, Vec4};
use std::f32::consts::PI;

/// Reference points nearer than this many radii of the triangle (about its centroid) sample it by solid angle, farther
/// ones by area: from two radii above it cos θ/r² has a standard deviation of a tenth over the triangle, and area
/// sampling takes a fifth of the time.
const NEAR: f32 = 2.0;

/// Share of the draws that goes by cells, where there are any; the others know how the triangle is seen.
const BY_CELL: f32 = 0.75;

/// Steps along an edge for emission that changes from vertex to vertex.
const GRADIENT: f32 = 16.0;

/// A triangle that emits.
#[derive(Clone, Debug)]
pub struct TriangleLight {
    p: [Vec3A; 3],
    ng: Vec3A,
    area: f32,
    centroid: Vec3A,
    /// Square of the distance from the centroid within which it is sampled by solid angle.
    near2: f32,
    /// How far rounding moves a point of it along the normal, at most.
    error: f32,
    /// How it emits.
    pub emitter: Emitter,
    /// Texture coordinates and colours, where the emission or the coverage depends on them.
    attributes: Option<Box<TriangleAttributes>>,
    flip: bool,
    /// Where the emission changes over the triangle: once [`divide`](Self::divide) has looked.
    picture: Option<Box<Picture>>,
}

/// What the triangle shows.
#[derive(Clone, Debug)]
struct Picture {
    /// Mean Lₑ of a side that emits.
    mean: Spectrum,
    /// Where parts are much brighter than that.
    cells: Option<Cells>,
}

impl TriangleLight {
    /// World-space triangle `p`, its front to the side from which it runs counter-clockwise, or to the other with
    /// `flip`; `None` where it has no area.
    pub fn new(p: [Vec3; 3], attributes: &TriangleAttributes, flip: bool, emitter: Emitter) -> Option<Self> {
        let front = Vec3A::from(triangle_normal(p)?);
        let area = triangle_area(p);
        let p = p.map(Vec3A::from);
        let centroid = p[0] / 3.0 + p[1] / 3.0 + p[2] / 3.0;
        let radius2 = p.iter().map(|p| p.distance_squared(centroid)).fold(0.0, f32::max);
        let is_pictured = !emitter.is_uniform(attributes.colors.is_some());
        (area > 0.0 && area.is_finite() && radius2.is_finite()).then(|| Self {
            p,
            ng: if flip { -front } else { front },
            area,
            centroid,
            near2: NEAR * NEAR * radius2,
            error: UNIT_ROUNDOFF
                * (p.iter().fold(Vec3A::ZERO, |m, p| m.max(p.abs())).dot(front.abs()) + 8.0 * radius2.sqrt()),
            attributes: is_pictured.then(|| Box::new(*attributes)),
            emitter,
            flip,
            picture: None,
        })
    }

    /// Of a triangle that rays meet up to `error` away from where its vertices say, as in an instance of a mesh.
    #[must_use]
    pub fn with_error(mut self, error: Vec3A) -> Self {
        self.error += error.dot(self.ng.abs());
        self
    }

    /// Whether the emission changes over the triangle.
    pub fn is_pictured(&self) -> bool {
        self.attributes.is_some()
    }

    /// Finds the mean of what the triangle shows, and its bright parts, in at most `lookups` look-ups.
    pub fn divide(&mut self, textures: &Textures, lookups: usize) {
        if !self.is_pictured() {
            return;
        }
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|at| self.appearance(at).0);
        let steps = self.emitter.steps(&corners, textures).unwrap_or(GRADIENT);
        let le = |at: [f32; 2]| {
            let (uv, color) = self.appearance(at);
            self.emitter.mean_le(&uv, color, 1.0, textures)
        };
        let (mean, cells) = Cells::new(le, steps, lookups.max(1));
        self.picture = Some(Box::new(Picture { mean, cells }));
    }

    /// Draws a point of the triangle: by solid angle from near, by area from afar; or by how brightly its parts shine.
    #[inline(always)]
    pub fn sample(&self, reference: Vec3A, u: [f32; 2], textures: &Textures) -> Option<LightSample> {
        if !self.is_seen(reference) {
            return None;
        }
        if self.picture.is_some() || self.is_near(reference) {
            return self.sample_apart(reference, u, textures);
        }
        let [_, v, w] = uniform_triangle(u);
        let (sight, p) = self.sight(reference, [v, w])?;
        self.drawn([v, w], &sight, p, sight.solid_angle_pdf(1.0 / self.area), textures)
    }

    /// [`sample`](Self::sample) by solid angle or by cells. Outlined, so that sampling by area stays in registers.
    #[inline(never)]
    fn sample_apart(&self, reference: Vec3A, u: [f32; 2], textures: &Textures) -> Option<LightSample> {
        let (weights, sight, p, pdf) = match self.cells() {
            None => self.sample_plain(reference, u)?,
            Some(cells) if u[0] < BY_CELL => {
                let weights = cells.sample([to_unit(u[0] / BY_CELL), u[1]]);
                let (sight, p) = self.sight(reference, weights)?;
                (weights, sight, p, self.pdf_plain(reference, &sight))
            }
            Some(_) => self.sample_plain(reference, [to_unit((u[0] - BY_CELL) / (1.0 - BY_CELL)), u[1]])?,
        };
        let pdf = self.pdf_mixed(pdf, &sight, weights);
        self.drawn(weights, &sight, p, pdf, textures)
    }

    /// Light from the point with these weights.
    #[inline(always)]
    fn drawn(&self, weights: [f32; 2], sight: &Sight, p: Vec3A, pdf: f32, textures: &Textures) -> Option<LightSample> {
        let (uv, color) = self.appearance(weights);
        let le = self.emitter.mean_le(&uv, color, sight.cos, textures);
        (!le.is_black() && pdf > 0.0 && pdf.is_finite()).then_some(LightSample {
            wi: sight.wi,
            distance: sight.distance,
            p,
            margin: sight.margin(self.error),
            le,
            pdf: Pdf::SolidAngle(pdf),
        })
    }

    /// Weights of the second and third vertex, how the point is seen, the point, density: by solid angle from near, by area
    /// from afar.
    fn sample_plain(&self, reference: Vec3A, u: [f32; 2]) -> Option<([f32; 2], Sight, Vec3A, f32)> {
        if self.is_near(reference)
            && let Some(spherical) = SphericalTriangle::new(&self.p, reference)
        {
            return self.sample_spherical(&spherical, reference, u);
        }
        let [_, u, v] = uniform_triangle(u);
        let (sight, p) = self.sight(reference, [u, v])?;
        Some(([u, v], sight, p, sight.solid_angle_pdf(1.0 / self.area)))
    }

    fn sample_spherical(
        &self,
        spherical: &SphericalTriangle,
        reference: Vec3A,
        u: [f32; 2],
    ) -> Option<([f32; 2], Sight, Vec3A, f32)> {
        let w = spherical.sample(u);
        let (u, v, distance) = self.along(reference, w)?;
        let wi = w.as_vec3a();
        let sight = Sight { wi, distance, cos: -wi.dot(self.ng) };
        Some(([u, v], sight, self.point([u, v]), (1.0 / spherical.solid_angle()) as f32))
    }

    /// How the point with these weights is seen, and the point.
    #[inline(always)]
    fn sight(&self, reference: Vec3A, weights: [f32; 2]) -> Option<(Sight, Vec3A)> {
        let p = self.point(weights);
        Some((Sight::new(reference, p, self.ng)?, p))
    }

    /// The point with these weights, to half a unit in the last place of its coordinates and 6 u of the edges.
    #[inline(always)]
    fn point(&self, [u, v]: [f32; 2]) -> Vec3A {
        let [a, b, c] = self.p;
        a + ((b - a) * u + (c - a) * v)
    }

    /// Whether it emits to the side on which the reference point lies. In its plane, as far as rounding can tell, nothing is
    /// seen of it: its solid angle there would be 0 or 2π by chance.
    #[inline(always)]
    fn is_seen(&self, reference: Vec3A) -> bool {
        let height = self.ng.dot(reference - self.p[0]);
        self.emitter.emits(height > 0.0) && height.abs() > in_plane(reference, self.p[0], self.ng) + self.error
    }

    /// Density over solid angle of [`sample`](Self::sample) for its point `p`.
    #[inline]
    pub fn pdf(&self, reference: Vec3A, p: Vec3A, ng: Vec3A) -> f32 {
        let Some(sight) = Sight::new(reference, p, ng).filter(|_| self.is_seen(reference)) else { return 0.0 };
        let plain = self.pdf_plain(reference, &sight);
        if self.cells().is_none() { plain } else { self.pdf_mixed(plain, &sight, self.weights(p)) }
    }

    /// Density of [`sample_plain`](Self::sample_plain).
    #[inline]
    fn pdf_plain(&self, reference: Vec3A, sight: &Sight) -> f32 {
        match self.spherical(reference) {
            Some(spherical) => (1.0 / spherical.solid_angle()) as f32,
            None => sight.solid_angle_pdf(1.0 / self.area),
        }
    }

    /// The density with that of the cells, where there are any.
    #[inline]
    fn pdf_mixed(&self, plain: f32, sight: &Sight, weights: [f32; 2]) -> f32 {
        match self.cells() {
            None => plain,
            Some(cells) => {
                let by_cell = sight.solid_angle_pdf(cells.density(weights) / self.area);
                (1.0 - BY_CELL) * plain + BY_CELL * by_cell
            }
        }
    }

    #[inline]
    fn cells(&self) -> Option<&Cells> {
        self.picture.as_ref()?.cells.as_ref()
    }

    /// Weights of the second and third vertex at a point of the triangle.
    #[inline]
    fn weights(&self, p: Vec3A) -> [f32; 2] {
        let [a, b, c] = self.p.map(|p| p.as_dvec3());
        let (e1, e2, s) = (b - a, c - a, p.as_dvec3() - a);
        let (d11, d12, d22) = (e1.dot(e1), e1.dot(e2), e2.dot(e2));
        let inverse = 1.0 / (d11 * d22 - d12 * d12);
        let (s1, s2) = (s.dot(e1), s.dot(e2));
        [((d22 * s1 - d12 * s2) * inverse) as f32, ((d11 * s2 - d12 * s1) * inverse) as f32]
    }

    /// Flux \[W\]; of what the triangle shows the mean, once [`divide`](Self::divide) has looked.
    pub fn power(&self) -> Spectrum {
        if let Some(picture) = &self.picture {
            return self.emitter.flux(self.area, picture.mean);
        }
        let colors = self.attributes.as_ref().and_then(|a| a.colors);
        let color = colors.map_or(Vec4::ONE, |[a, b, c]| (a + b + c) / 3.0);
        self.emitter.power(self.area, color)
    }

    /// Its box and the intensity L A along its normal; the flux of a side is π L A.
    pub(super) fn bounds(&self, flux: f64) -> LightBounds {
        let [a, b, c] = self.p;
        let both = self.emitter.emits(false);
        let sides = if both { 2.0 } else { 1.0 };
        LightBounds::flat(a.min(b).min(c), a.max(b).max(c), self.ng, flux / (sides * f64::from(PI)), both)
    }

    /// Its surface.
    pub fn primitive(&self) -> Primitive {
        let attributes = self.attributes.as_deref().copied().unwrap_or_default();
        Primitive::Triangle(Box::new(Triangle::new(self.p, attributes, self.flip)))
    }

    /// The triangle on the sphere about `reference`, where it is sampled by solid angle.
    #[inline]
    fn spherical(&self, reference: Vec3A) -> Option<SphericalTriangle> {
        if self.is_near(reference) { SphericalTriangle::new(&self.p, reference) } else { None }
    }

    #[inline]
    fn is_near(&self, reference: Vec3A) -> bool {
        reference.distance_squared(self.centroid) < self.near2
    }

    /// Weights of the second and third vertex where direction `w` from `reference` meets the triangle, and the
    /// distance. Rounding beyond an edge is brought back.
    #[inline]
    fn along(&self, reference: Vec3A, w: DVec3) -> Option<(f32, f32, f32)> {
        let [a, b, c] = self.p.map(|p| p.as_dvec3());
        let (e1, e2, s) = (b - a, c - a, reference.as_dvec3() - a);
        let (h, q) = (w.cross(e2), s.cross(e1));
        let inverse = 1.0 / e1.dot(h);
        let (u, v, t) = (s.dot(h) * inverse, w.dot(q) * inverse, e2.dot(q) * inverse);
        let u = u.clamp(0.0, 1.0);
        (t > 0.0 && t.is_finite()).then_some((u as f32, v.clamp(0.0, 1.0 - u) as f32, t as f32))
    }

    /// Texture coordinates and colour at the weights of the second and third vertex.
    #[inline]
    fn appearance(&self, [u, v]: [f32; 2]) -> ([Vec2; 2], Vec4) {
        self.attributes.as_ref().map_or(([Vec2::ZERO; 2], Vec4::ONE), |a| {
            let uv = a.uv.map(|set| set.map_or(Vec2::ZERO, |uv| interpolate(uv, u, v)));
            (uv, a.colors.map_or(Vec4::ONE, |colors| interpolate(colors, u, v)))
        })
    }
}
