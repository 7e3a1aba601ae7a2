//! Ray casting: nothing scatters (ρ = 0), so L = Le of the first surface. Surfaces that carry a pre-assigned colour
//! (glTF's unlit materials) emit it.

use super::{Classes, Drawn, Method, Observer, emitted, environment, first_surface};
use crate::bsdf::Bsdf;
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::spectrum::Spectrum;

/// L = Le.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let (mut sample, mut scratch) = (PixelSample::default(), Bsdf::new());
    watch.ray();
    match method.scene.intersect(ray, &mut || sampler.next_1d()) {
        None => {
            sample.radiance = environment(method, ray, Drawn::Camera);
            watch.escaped(0, ray, Spectrum::ONE);
        }
        Some(vertex) => {
            sample.radiance = emitted(method, &vertex, Drawn::Camera);
            let shading = method.scene.shade(&vertex, &mut scratch);
            watch.vertex(0, ray, &vertex, Some(&shading), Spectrum::ONE);
            first_surface(&mut sample, ray, &vertex, &shading);
        }
    }
    watch.light(sample.radiance, &Classes::default());
    sample
}
