//! Emissive sphere, disk or cylinder.

use super::area::Sight;
use super::grid::Grid;
use super::tree::LightBounds;
use super::{Emitter, LightSample};
use crate::bsdf::Pdf;
use crate::math::{Frame, UNIT_ROUNDOFF};
use crate::shape::{PlacedQuadric, Quadric, QuadricPoint};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use crate::warp::{to_unit, uniform_cone, uniform_cone_pdf};
use glam::{DVec3, Vec2, Vec3A, Vec4};
use std::f64::consts::PI;

/// Share of the draws that goes by cells, where there are any; the others know how a sphere is seen.
const BY_CELL: f32 = 0.75;

/// A quadric that emits. Spheres seen from outside are sampled uniformly over the cone that they fill; everything else
/// (disks, cylinders, ellipsoids, spheres from inside) uniformly over the object's area; and all of them by how brightly their
/// parts shine, where some are much brighter than others.
#[derive(Clone, Debug)]
pub struct QuadricLight {
    /// The surface.
    pub shape: PlacedQuadric,
    /// How it emits.
    pub emitter: Emitter,
    /// Centre and radius, if it is a sphere in the world.
    sphere: Option<(DVec3, f64)>,
    /// What the surface shows, where that changes: once [`divide`](Self::divide) has looked.
    picture: Option<Box<Picture>>,
}

/// What a quadric shows.
#[derive(Clone, Debug)]
struct Picture {
    /// Mean Lₑ of a side that emits, of what is there.
    mean: Spectrum,
    /// Where parts are much brighter than that.
    grid: Option<Grid>,
}

/// A sphere from outside.
struct Cap {
    /// Unit vector to the centre.
    axis: DVec3,
    /// Distance of the centre.
    distance: f64,
    /// (d − r)(d + r): square of the distance to the horizon.
    tangent2: f64,
    /// 1 − cos θmax of the cone that it fills.
    one_minus_cos: f32,
}

impl QuadricLight {
    /// An emissive shape.
    pub fn new(shape: PlacedQuadric, emitter: Emitter) -> Self {
        Self { sphere: shape.as_sphere(), shape, emitter, picture: None }
    }

    /// Whether emission or coverage change over the surface.
    pub fn is_pictured(&self) -> bool {
        !self.emitter.is_uniform(false)
    }

    /// Finds the mean of what the surface shows, and its bright parts, in at most `lookups` look-ups.
    pub fn divide(&mut self, textures: &Textures, lookups: usize) {
        if !self.is_pictured() {
            return;
        }
        let le = |at: [f32; 2]| {
            let point = self.shape.quadric.sample_area(at);
            let uv = [self.shape.quadric.chart(&point).uv, Vec2::ZERO];
            (self.emitter.mean_le(&uv, Vec4::ONE, 1.0, textures), self.shape.area_scale(point.n))
        };
        let steps = self.emitter.steps(&[[Vec2::ZERO; 2], [Vec2::X; 2], [Vec2::Y; 2]], textures).unwrap_or(1.0);
        let (mean, grid) = Grid::new(le, steps, lookups.max(1));
        self.picture = Some(Box::new(Picture { mean, grid }));
    }

    /// Draws a point of the surface.
    pub fn sample(&self, reference: Vec3A, u: [f32; 2], textures: &Textures) -> Option<LightSample> {
        let point = match self.grid() {
            None => self.draw_plain(reference, u),
            Some(grid) if u[0] < BY_CELL => {
                self.shape.quadric.sample_area(grid.sample([to_unit(u[0] / BY_CELL), u[1]]))
            }
            Some(_) => self.draw_plain(reference, [to_unit((u[0] - BY_CELL) / (1.0 - BY_CELL)), u[1]]),
        };
        let surface = self.shape.surface_at(&point, self.picture.is_some());
        let sight = Sight::new(reference, surface.p, surface.ng)?;
        let pdf = self.density(reference, surface.p, surface.ng, &sight, || point);
        let le = self.emitter.mean_le(&surface.uv, Vec4::ONE, sight.cos, textures);
        (!le.is_black() && pdf > 0.0 && pdf.is_finite()).then_some(LightSample {
            wi: sight.wi,
            distance: sight.distance,
            p: surface.p,
            // It has no neighbours that lie on.
            margin: 0.0,
            le,
            pdf: Pdf::SolidAngle(pdf),
        })
    }

    /// A point over the cone that a sphere fills from outside, else over the area.
    fn draw_plain(&self, reference: Vec3A, u: [f32; 2]) -> QuadricPoint {
        match self.cap(reference) {
            // The nearer of the two points in which a direction of the cone meets the sphere:
            // t = (d − r)(d + r) / (d cos θ + √(r² − d² sin² θ)), which cancels nothing.
            Some((cap, r)) => {
                let local = uniform_cone(u, cap.one_minus_cos);
                let w = Frame::from_z(cap.axis.as_vec3a()).to_world(local).as_dvec3();
                let sin2 = local.truncate().as_dvec2().length_squared();
                let half_chord = (r * r - cap.distance * cap.distance * sin2).max(0.0).sqrt();
                let t = cap.tangent2 / (cap.distance * f64::from(local.z) + half_chord);
                self.shape.point_at(reference.as_dvec3() + w * t)
            }
            None => self.shape.quadric.sample_area(u),
        }
    }

    /// Density over solid angle of [`sample`](Self::sample) for its point `p` with normal `ng`.
    pub fn pdf(&self, reference: Vec3A, p: Vec3A, ng: Vec3A) -> f32 {
        let Some(sight) = Sight::new(reference, p, ng) else { return 0.0 };
        self.density(reference, p, ng, &sight, || self.shape.point_at(p.as_dvec3()))
    }

    /// Density over solid angle of the point `p` with normal `ng`, seen as `sight` says; `point` is it in the quadric's own
    /// space.
    #[inline]
    fn density(
        &self,
        reference: Vec3A,
        p: Vec3A,
        ng: Vec3A,
        sight: &Sight,
        point: impl FnOnce() -> QuadricPoint,
    ) -> f32 {
        let by_area = || match sight.is_off_plane(reference, p, ng) {
            true => {
                let area = self.shape.quadric.area() * self.shape.area_scale_world(ng.as_dvec3());
                sight.solid_angle_pdf((1.0 / area) as f32)
            }
            false => 0.0,
        };
        let plain = match self.cap(reference) {
            Some((cap, _)) => {
                // The far side is never drawn.
                let outward = if self.shape.reversed { -ng } else { ng };
                if outward.dot(p - reference) < 0.0 { uniform_cone_pdf(cap.one_minus_cos) } else { 0.0 }
            }
            None => by_area(),
        };
        match self.grid() {
            None => plain,
            Some(grid) => {
                let cells = grid.density(self.shape.quadric.area_coordinates(&point()));
                (1.0 - BY_CELL) * plain + BY_CELL * cells * by_area()
            }
        }
    }

    #[inline]
    fn grid(&self) -> Option<&Grid> {
        self.picture.as_ref()?.grid.as_ref()
    }

    /// Flux \[W\]; of what the surface shows the mean, once [`divide`](Self::divide) has looked.
    pub fn power(&self) -> Spectrum {
        let area = self.shape.area() as f32;
        self.picture.as_ref().map_or_else(|| self.emitter.power(area, Vec4::ONE), |p| self.emitter.flux(area, p.mean))
    }

    /// Its box, and the intensity along its normal if it is a disk, or the mean one.
    pub(super) fn bounds(&self, flux: f64) -> LightBounds {
        let (min, max) = self.shape.bounds();
        match self.shape.quadric {
            Quadric::Disk { .. } => {
                let both = self.emitter.emits(false);
                let sides = if both { 2.0 } else { 1.0 };
                let normal = self.shape.surface_at(&self.shape.quadric.sample_area([0.5; 2]), false).ng;
                LightBounds::flat(min, max, normal, flux / (sides * PI), both)
            }
            Quadric::Sphere { .. } | Quadric::Cylinder { .. } => LightBounds::round(min, max, flux / (4.0 * PI)),
        }
    }

    /// The sphere as seen from `reference`, with its radius; `None` from inside, from the surface as far as rounding can
    /// tell, and for what is no sphere.
    fn cap(&self, reference: Vec3A) -> Option<(Cap, f64)> {
        let (center, r) = self.sphere?;
        let rounding = 16.0 * f64::from(UNIT_ROUNDOFF) * (center.abs() + reference.abs().as_dvec3()).element_sum();
        let to = center - reference.as_dvec3();
        let distance = to.length();
        // sin θmax = r/d; 1 − cos θmax = sin²/(1 + cos) keeps its precision from afar.
        let tangent2 = (distance - r) * (distance + r);
        let (sin2, cos) = ((r / distance).powi(2), tangent2.max(0.0).sqrt() / distance);
        let one_minus_cos = (sin2 / (1.0 + cos)) as f32;
        (distance - r > rounding && one_minus_cos > 0.0)
            .then_some((Cap { axis: to / distance, distance, tangent2, one_minus_cos }, r))
    }
}
