//! Where a path goes on at a vertex: a direction that the BSDF draws about the shading normal, made one that the surface allows.
//!
//! A bent shading normal n sends some of its light into the surface, below the horizon of the geometric normal g. A real
//! bump would meet its neighbour there and scatter again. Dropping that light leaves black fringes and up to half of the
//! energy; here the neighbour is of the material's own albedo ρ (of light along n), diffuse, and lies flat: what strays
//! leaves again by the cosine about g,
//!
//! ```text
//! f'(o, i)|cos θ| = f(o, i)|i·n|  +  ρ |i·g|/π ∫_below f(o, w)|w·n| dw
//! ```
//!
//! with the first term where i is on one side of both. So a lossless lobe stays lossless under every normal map, nothing is
//! created (the white furnace of row F1), dark paint stays dark, and the second term fades at the horizon. What is
//! transmitted strays to the other side likewise. Schüssler et al. (2017, "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing") make the
//! neighbour a second facet of the same or a mirroring material; theirs is reciprocal and loses what bounces more than twice.
//!
//! The integral is estimated by the very draw that the path makes, one for both samplers. For the weights of multiple
//! importance sampling any density will do that both compute alike: (1 − n·g)/2, what strays of Lambert's lobe, stands
//! for the share of all lobes.

use super::{Drawn, Method, Numbers, Walk, strategy};
use crate::bsdf::{Pdf, Sample, Transport};
use crate::math::{Frame, Ray, renormalize};
use crate::sampler::Sampler;
use crate::scene::Shading;
use crate::spectrum::Spectrum;
use crate::warp::cosine_hemisphere;
use glam::{Vec3, Vec3A};
use std::f32::consts::FRAC_1_PI;

/// The next direction of a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scattered {
    /// It leaves here.
    pub(super) ray: Ray,
    /// f |cos θ| / pdf.
    pub(super) weight: Spectrum,
    /// The part of it that specular lobes give.
    pub(super) specular: Spectrum,
    /// Relative index of refraction crossed.
    pub(super) eta: f32,
    /// How it was drawn.
    pub(super) drawn: Drawn,
    /// It passed a smooth thin sheet straight on, which light sampling looks through.
    pub(super) straight: bool,
    /// The draw had strayed.
    pub(super) stray: Option<Stray>,
}

/// Light that a bent shading normal sent below the horizon, an estimate of the integral above.
#[derive(Clone, Copy, Debug)]
pub struct Stray {
    weight: Spectrum,
    specular: Spectrum,
    /// Sign of i·g for the directions in which it leaves again.
    side: f32,
}

impl Stray {
    /// Its f' |cos θ| towards the world direction `wi`, and the part that specular lobes give.
    #[inline]
    pub(super) fn towards(&self, shading: &Shading, wi: Vec3A) -> (Spectrum, Spectrum) {
        let share = (wi.dot(shading.vertex.surface.ng) * self.side).max(0.0) * FRAC_1_PI;
        (self.weight * share, self.specular * share)
    }
}

/// Draws the next direction as the method's strategy says; `None` where the path ends.
#[inline(always)]
pub(super) fn draw(
    method: &Method,
    walk: &Walk,
    shading: &Shading,
    u: &Numbers,
    sampler: &mut Sampler,
) -> Option<Scattered> {
    let Sample { wi: local, mut weight, mut specular, pdf, eta } =
        strategy::sample(method, shading.bsdf, shading.wo, u.lobe_choice, u.lobe)?;
    let mut wi = renormalize(shading.frame.to_world(local));
    let (mut straight, mut stray) = (false, None);
    let from = shading.receiver();
    let drawn = if shading.agrees(wi, local) {
        match pdf {
            Pdf::SolidAngle(pdf) => Drawn::Smooth { pdf: pdf + shading.stray_pdf(wi), from },
            Pdf::Discrete(_) => {
                straight = eta == 1.0 && local == -shading.wo && shading.bsdf.straight(shading.wo).is_some();
                Drawn::Delta
            }
        }
    } else {
        // Into the surface, or out of it where light is transmitted: to the side where it belongs.
        let again = astray(walk, shading, local, wi, sampler)?;
        (weight, specular) = (weight * again.rho, specular * again.rho);
        stray = Some(Stray { weight, specular, side: 1f32.copysign(local.z) });
        wi = again.wi;
        Drawn::Smooth { pdf: again.pdf, from }
    };
    Some(Scattered { ray: shading.leave(wi), weight, specular, eta, drawn, straight, stray })
}

/// Where strayed light leaves: by the cosine.
struct Again {
    wi: Vec3A,
    pdf: f32,
    /// Albedo of the neighbour.
    rho: Spectrum,
}

/// How a draw that strayed, of direction `wi` (`local` in the frame), leaves again.
#[cold]
#[inline(never)]
fn astray(walk: &Walk, shading: &Shading, local: Vec3, wi: Vec3A, sampler: &mut Sampler) -> Option<Again> {
    let ng = shading.vertex.surface.ng;
    if local.z == 0.0 || ng.dot(wi) == 0.0 {
        return None;
    }
    let side = 1f32.copysign(local.z);
    let wi = Frame::from_z(ng).to_world(cosine_hemisphere(walk.leak_numbers(sampler))) * side;
    let local = shading.frame.to_local(wi);
    let pdf =
        if shading.agrees(wi, local) { shading.bsdf.eval(shading.wo, local, Transport::Radiance).pdf } else { 0.0 };
    let rho = shading.bsdf.albedo(Vec3::Z.copysign(shading.wo)).min(Spectrum::ONE);
    Some(Again { wi, pdf: pdf + shading.stray_pdf(wi), rho })
}
