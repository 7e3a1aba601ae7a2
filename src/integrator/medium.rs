//! What lies between and behind surfaces, as the estimators need it: attenuation on the way, the media at a vertex, and
//! the lane of a path that met a dispersive interface.

use super::Method;
use crate::math::Ray;
use crate::medium::Inside;
use crate::sampler::Sampler;
use crate::scene::{Interface, Vertex};
use crate::spectrum::Spectrum;
use glam::Vec3A;

/// Lanes of their own wavelength; the fourth has the second's.
const LANES: usize = 3;

/// The interiors on both sides of a vertex.
#[derive(Clone, Copy, Debug)]
pub struct Sides<'a> {
    /// Where the path came from.
    pub here: &'a Inside,
    /// On the other side, where they are others.
    pub across: Option<&'a Inside>,
}

impl<'a> Sides<'a> {
    /// Where the world direction `wi` leads from `vertex`.
    #[inline]
    pub fn towards(&self, vertex: &Vertex, wi: Vec3A) -> &'a Inside {
        self.changed(vertex, wi).unwrap_or(self.here)
    }

    /// The same, where it is not where the path came from.
    #[inline]
    pub fn changed(&self, vertex: &Vertex, wi: Vec3A) -> Option<&'a Inside> {
        self.across.filter(|_| (wi.dot(vertex.surface.ng) > 0.0) != vertex.front)
    }
}

/// Share of radiance that is left on the way along `ray` to where it ended, or from infinity.
#[inline]
pub(super) fn on_the_way(method: &Method, ray: &Ray, end: Option<&Vertex>, inside: &Inside) -> Spectrum {
    if inside.is_empty() {
        return Spectrum::ONE;
    }
    let distance = end.map_or(f32::INFINITY, |vertex| (vertex.surface.p - ray.o).length());
    method.scene.media.transmittance(inside, distance)
}

/// Lets a path that meets its first dispersive interface go on with one lane alone.
///
/// Such an interface bends every lane another way. The lane is chosen with probability p in proportion to its β and divided
/// by it: lane by lane the mean is that of the paths that the lane would have taken by itself. Where β is grey, p = 1/3.
#[inline(always)]
pub(super) fn choose_lane(
    method: &Method,
    interface: &Interface,
    lane: &mut Option<usize>,
    beta: &mut Spectrum,
    sampler: &mut Sampler,
) {
    if lane.is_none() && method.scene.media.disperses(interface) {
        let (chosen, factor) = choose(*beta, sampler.next_1d());
        *lane = Some(chosen);
        *beta *= factor;
    }
}

/// A lane with probability βₗ/Σβ, and 1/p in that lane.
fn choose(beta: Spectrum, u: f32) -> (usize, Spectrum) {
    let weights = beta.0.to_array().map(|x| x.max(0.0));
    let sum: f32 = weights[..LANES].iter().sum();
    let mut rest = u * sum;
    let mut chosen = LANES;
    for (lane, weight) in weights[..LANES].iter().enumerate() {
        // Rounding may leave a rest behind the last.
        if *weight > 0.0 {
            chosen = lane;
            if rest < *weight {
                break;
            }
            rest -= weight;
        }
    }
    if chosen == LANES { (0, Spectrum::ZERO) } else { (chosen, Spectrum::splat(sum / weights[chosen]).only(chosen)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_are_chosen_without_bias() {
        let beta = Spectrum::from_rgb([0.5, 0.0, 0.25]);
        let n = 3000;
        let sum: Spectrum = (0..n).map(|i| beta * choose(beta, (i as f32 + 0.5) / n as f32).1).sum();
        assert!((sum.0 / n as f32 - beta.0).abs().max_element() < 1e-3, "{sum:?}");
        assert_eq!(choose(Spectrum::ONE, 0.5), (1, Spectrum::from_rgb([0.0, 3.0, 0.0])));
        assert_eq!(choose(Spectrum::ZERO, 0.5).1, Spectrum::ZERO);
        assert_eq!(choose(Spectrum::ONE, 1.0).0, 2);
    }
}
