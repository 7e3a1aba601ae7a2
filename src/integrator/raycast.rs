//! Ray casting: nothing scatters (ρ = 0), so L = Le of the first surface. Surfaces that carry a pre-assigned colour
//! (glTF's unlit materials) emit it.

use super::{Event, Method, Observer, Walk, first_surface};
use crate::bsdf::Scratch;
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::Vertex;

/// L = Le.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let (mut sample, mut walk) = (PixelSample::default(), Walk::new(method, ray, sampler));
    let (mut vertex, mut scratch) = (Vertex::NOWHERE, Scratch::new());
    let event = walk.advance(method, sampler, &mut vertex, watch);
    sample.radiance = walk.emission(method, event, &vertex, watch);
    if event == Event::Surface {
        let interface = method.scene.media.interface(&walk.media, &vertex);
        // The first surface as the second lane sees it: nothing scatters, and no lane is chosen.
        let shading = method.scene.shade(&vertex, &interface, Some(1), || [0.5; 2], &mut scratch);
        watch.vertex(0, ray, &vertex, Some(&shading), walk.beta);
        first_surface(&mut sample, ray, &shading);
    }
    sample
}
