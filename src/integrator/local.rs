//! Local illumination: emitted and direct light, L = Le + ∫ f Le |cos| dω, without recursion.

use super::{Event, Method, Observer, Walk, direct_light, first_surface, sees_lights, strategy};
use crate::bsdf::{Pdf, Scratch};
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::{Shading, Vertex};
use crate::spectrum::Spectrum;

/// L = Le + ∫ f Le |cos| dω.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let (mut sample, mut walk) = (PixelSample::default(), Walk::new(method, ray, sampler));
    let (mut vertex, mut scratch) = (Vertex::NOWHERE, Scratch::new());
    let event = walk.advance(method, sampler, &mut vertex, watch);
    sample.radiance = walk.emission(method, event, &vertex, watch);
    let Event::Surface = event else { return sample };
    let interface = method.scene.media.interface(&walk.media, &vertex);
    walk.choose_lane(method, &interface, sampler);
    let shading = walk.shade(method, sampler, &vertex, &interface, &mut scratch);
    watch.vertex(0, ray, &vertex, Some(&shading), walk.beta);
    first_surface(&mut sample, ray, &shading);
    if method.max_depth > 0 {
        sample.radiance += reflected(method, &walk, &shading, sampler, watch, |_| true);
    }
    sample
}

/// β ∫ f Le |cos| dω at the vertex that `walk` has met, by lights and by directions as far as `keep` wants how they were
/// drawn.
pub(super) fn reflected<O: Observer>(
    method: &Method,
    walk: &Walk,
    shading: &Shading,
    sampler: &mut Sampler,
    watch: &mut O,
    keep: impl Fn(Pdf) -> bool,
) -> Spectrum {
    let mut sum = Spectrum::ZERO;
    if shading.bsdf.is_empty() {
        return sum;
    }
    let u = walk.numbers(sampler);

    // By light.
    if sees_lights(shading, method.scene) {
        sum += direct_light(method, walk, shading, &u, watch);
    }

    // By direction, as far as the first surface.
    if let Some(next) = strategy::sample(method, shading, &u).filter(|next| keep(next.pdf)) {
        let (mut walk, mut end) = (walk.clone(), Vertex::NOWHERE);
        walk.scatter(shading, &next, &mut ());
        let event = walk.advance(method, sampler, &mut end, watch);
        sum += walk.emission(method, event, &end, watch);
    }
    sum
}
