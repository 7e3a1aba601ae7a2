//! Ray casting: nothing scatters (ρ = 0), so L = Le of the first surface. Surfaces that carry a pre-assigned colour
//! (glTF's unlit materials) emit it.

use super::{Classes, Drawn, Method, Observer, emitted, environment, first_surface, medium};
use crate::bsdf::Bsdf;
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::Departure;

/// L = Le.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let (mut sample, mut scratch) = (PixelSample::default(), Bsdf::new());
    let mut inside = method.inside.clone();
    watch.ray();
    let met = method.scene.intersect_from(ray, Departure::NOWHERE, &mut inside, &mut || sampler.next_1d());
    let beta = medium::on_the_way(method, ray, met.as_ref(), &inside);
    match met {
        None => {
            sample.radiance = beta * environment(method, ray, Drawn::Camera);
            watch.escaped(0, ray, beta);
        }
        Some(vertex) => {
            sample.radiance = beta * emitted(method, &vertex, Drawn::Camera);
            let interface = method.scene.media.interface(&inside, &vertex);
            let shading = method.scene.shade(&vertex, &interface, Some(1), &mut scratch);
            watch.vertex(0, ray, &vertex, Some(&shading), beta);
            first_surface(&mut sample, ray, &vertex, &shading);
        }
    }
    watch.light(sample.radiance, &Classes::default());
    sample
}
