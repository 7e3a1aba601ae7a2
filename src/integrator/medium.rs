//! Attenuation along a ray, and the lane of a path that met a dispersive interface.

use super::Method;
use crate::math::Ray;
use crate::medium::MediumStack;
use crate::scene::Vertex;
use crate::spectrum::Spectrum;

/// Lanes of their own wavelength; the fourth has the second's.
const LANES: usize = 3;

/// Share of radiance that is left on the way along `ray` to where it ended, or from infinity.
#[inline]
pub(super) fn transmittance(method: &Method, ray: &Ray, end: Option<&Vertex>, media: &MediumStack) -> Spectrum {
    if media.is_empty() {
        return Spectrum::ONE;
    }
    let distance = end.map_or(f32::INFINITY, |vertex| (vertex.surface.p - ray.o).length());
    method.scene.media.transmittance(media, distance)
}

/// A lane for a path that meets its first dispersive interface, which bends every lane another way; and the factor by
/// which its throughput changes: 1/p in that lane.
///
/// The lane is chosen with probability pₗ = βₗ/Σβ: lane by lane the mean is that of the paths that the lane would have
/// taken by itself. Where β is grey, p = 1/3.
pub(super) fn choose_lane(beta: Spectrum, u: f32) -> (usize, Spectrum) {
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
        let sum: Spectrum = (0..n).map(|i| beta * choose_lane(beta, (i as f32 + 0.5) / n as f32).1).sum();
        assert!((sum.0 / n as f32 - beta.0).abs().max_element() < 1e-3, "{sum:?}");
        assert_eq!(choose_lane(Spectrum::ONE, 0.5), (1, Spectrum::from_rgb([0.0, 3.0, 0.0])));
        assert_eq!(choose_lane(Spectrum::ZERO, 0.5).1, Spectrum::ZERO);
        assert_eq!(choose_lane(Spectrum::ONE, 1.0).0, 2);
    }
}
