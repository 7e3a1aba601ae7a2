//! Emissive sphere, disk or cylinder.

use super::area::Sight;
use super::tree::LightBounds;
use super::{Emitter, LightSample};
use crate::bsdf::Pdf;
use crate::math::{Frame, UNIT_ROUNDOFF};
use crate::shape::{PlacedQuadric, Quadric};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use crate::warp::{uniform_cone, uniform_cone_pdf};
use glam::{DVec3, Vec3A, Vec4};
use std::f64::consts::PI;

/// A quadric that emits. Spheres seen from outside are sampled uniformly over the cone that they fill; everything else
/// (disks, cylinders, ellipsoids, spheres from inside) uniformly over the object's area.
#[derive(Clone, Debug)]
pub struct QuadricLight {
    /// The surface.
    pub shape: PlacedQuadric,
    /// How it emits.
    pub emitter: Emitter,
    /// Centre and radius, if it is a sphere in the world.
    sphere: Option<(DVec3, f64)>,
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
        Self { sphere: shape.as_sphere(), shape, emitter }
    }

    /// Draws a point of the surface.
    pub fn sample(&self, reference: Vec3A, u: [f32; 2], textures: &Textures) -> Option<LightSample> {
        let (point, cone_pdf) = match self.cap(reference) {
            // The nearer of the two points in which a direction of the cone meets the sphere:
            // t = (d − r)(d + r) / (d cos θ + √(r² − d² sin² θ)), which cancels nothing.
            Some((cap, r)) => {
                let local = uniform_cone(u, cap.one_minus_cos);
                let w = Frame::from_z(cap.axis.as_vec3a()).to_world(local).as_dvec3();
                let sin2 = local.truncate().as_dvec2().length_squared();
                let half_chord = (r * r - cap.distance * cap.distance * sin2).max(0.0).sqrt();
                let t = cap.tangent2 / (cap.distance * f64::from(local.z) + half_chord);
                (self.shape.point_at(reference.as_dvec3() + w * t), Some(uniform_cone_pdf(cap.one_minus_cos)))
            }
            None => (self.shape.quadric.sample_area(u), None),
        };

        let surface = self.shape.surface_at(&point, !self.emitter.is_uniform(false));
        let mut sight = Sight::new(reference, surface.p, surface.ng)?;
        if cone_pdf.is_none() {
            sight = sight.off_plane(reference, surface.p, surface.ng)?;
        }
        let area_pdf = || (1.0 / (self.shape.quadric.area() * self.shape.area_scale(point.n))) as f32;
        let pdf = cone_pdf.unwrap_or_else(|| sight.solid_angle_pdf(area_pdf()));
        let le = self.emitter.mean_le(&surface.uv, Vec4::ONE, sight.cos, textures);
        (!le.is_black() && pdf > 0.0 && pdf.is_finite()).then(|| LightSample {
            wi: sight.wi,
            distance: sight.distance,
            p: surface.p,
            margin: sight.margin(surface.p_error.dot(surface.ng.abs())),
            le,
            pdf: Pdf::SolidAngle(pdf),
        })
    }

    /// Density over solid angle of [`sample`](Self::sample) for its point `p` with normal `ng`.
    pub fn pdf(&self, reference: Vec3A, p: Vec3A, ng: Vec3A) -> f32 {
        match self.cap(reference) {
            Some((cap, _)) => {
                // The far side is never drawn.
                let outward = if self.shape.reversed { -ng } else { ng };
                if outward.dot(p - reference) < 0.0 { uniform_cone_pdf(cap.one_minus_cos) } else { 0.0 }
            }
            None => {
                let area = self.shape.quadric.area() * self.shape.area_scale_world(ng.as_dvec3());
                let sight = Sight::new(reference, p, ng).and_then(|sight| sight.off_plane(reference, p, ng));
                sight.map_or(0.0, |sight| sight.solid_angle_pdf((1.0 / area) as f32))
            }
        }
    }

    /// Flux \[W\]; `mean` is the average of a texture.
    pub fn power(&self, mean: &impl Fn(usize) -> Vec4) -> Spectrum {
        self.emitter.power(self.shape.area() as f32, Vec4::ONE, mean)
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
