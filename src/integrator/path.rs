//! The path tracer: equation (2), recursion and all, by one random path a sample.

use super::{Event, Method, Observer, Walk, direct_light, first_surface, sees_lights, strategy};
use crate::bsdf::Scratch;
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::Vertex;

/// L(x, ω) = Le + ∫ f L |cos| dω with the integral split in two: light that arrives straight from a light, drawn by
/// the light sampler and met by chance, and light that arrives reflected, by recursion.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let (mut sample, mut walk) = (PixelSample::default(), Walk::new(method, ray, sampler));
    let (mut vertex, mut scratch) = (Vertex::NOWHERE, Scratch::new());
    loop {
        let u = walk.numbers(sampler);

        // Le
        let event = walk.advance(method, sampler, &mut vertex, watch);
        sample.radiance += walk.emission(method, event, &vertex, watch);
        let Event::Surface = event else { break };

        let interface = method.scene.media.interface(&walk.media, &vertex);
        walk.choose_lane(method, &interface, sampler);
        let shading = walk.shade(method, sampler, &vertex, &interface, &mut scratch);
        watch.vertex(walk.depth, &walk.ray, &vertex, Some(&shading), walk.beta);
        if walk.depth == 0 {
            first_surface(&mut sample, &walk.ray, &shading);
        }
        if walk.depth == method.max_depth || shading.bsdf.is_empty() {
            break;
        }

        // ∫ by light
        if sees_lights(&shading, method.scene) {
            sample.radiance += direct_light(method, &walk, &shading, &u, watch);
        }

        // ∫ by BSDF
        let Some(next) = strategy::sample(method, &shading, &u) else { break };
        walk.scatter(&shading, &next, watch);

        // Roulette
        if !walk.survives(sampler) {
            break;
        }
    }
    sample
}
