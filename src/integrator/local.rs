//! Local illumination: emitted and direct light, L = Le + ∫ f Le |cos| dω, without recursion.

use super::{
    Classes, Drawn, Method, Observer, direct_light, emitted, environment, first_surface, sees_lights, strategy,
};
use crate::bsdf::Bsdf;
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::{Shading, Vertex};
use crate::spectrum::Spectrum;

/// L = Le + ∫ f Le |cos| dω.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let (mut sample, mut scratch) = (PixelSample::default(), Bsdf::new());
    let none = Classes::default();
    watch.ray();
    let Some(vertex) = method.scene.intersect(ray, &mut || sampler.next_1d()) else {
        sample.radiance = environment(method, ray, Drawn::Camera);
        watch.light(sample.radiance, &none);
        watch.escaped(0, ray, Spectrum::ONE);
        return sample;
    };
    sample.radiance = emitted(method, &vertex, Drawn::Camera);
    watch.light(sample.radiance, &none);
    let shading = method.scene.shade(&vertex, &mut scratch);
    watch.vertex(0, ray, &vertex, Some(&shading), Spectrum::ONE);
    first_surface(&mut sample, ray, &vertex, &shading);
    if method.max_depth > 0 {
        sample.radiance += reflected(method, &vertex, &shading, sampler, watch, Spectrum::ONE, none, |_| true);
    }
    sample
}

/// ∫ f Le |cos| dω at a vertex, by lights and by directions as far as `keep` wants how they were drawn; `watch` hears
/// of β times that.
pub(super) fn reflected<O: Observer>(
    method: &Method,
    vertex: &Vertex,
    shading: &Shading,
    sampler: &mut Sampler,
    watch: &mut O,
    beta: Spectrum,
    classes: Classes,
    keep: impl Fn(Drawn) -> bool,
) -> Spectrum {
    let scene = method.scene;
    let mut sum = Spectrum::ZERO;
    if shading.bsdf.is_empty() {
        return sum;
    }
    let [choose_light, choose_lobe] = sampler.next_2d();
    let (u_light, u_bsdf) = (sampler.next_2d(), sampler.next_2d());

    // By light.
    if sees_lights(shading.bsdf, scene) {
        let (all, specular) = direct_light(method, vertex, shading, choose_light, u_light, watch);
        sum += all;
        watch.light(beta * all, &classes.reflected(all, specular));
    }

    // By direction, as far as the first surface.
    let Some(next) = strategy::sample(method, shading.bsdf, shading.wo, choose_lobe, u_bsdf) else { return sum };
    let Some(ray) = shading.leave(vertex, next.wi) else { return sum };
    let drawn = Drawn::new(next.pdf, shading.receiver(vertex));
    if !keep(drawn) {
        return sum;
    }
    watch.ray();
    let le = match scene.intersect(&ray, &mut || sampler.next_1d()) {
        Some(end) => emitted(method, &end, drawn),
        None => environment(method, &ray, drawn),
    };
    let light = next.weight * le;
    watch.light(beta * light, &classes.reflected(next.weight, next.specular));
    sum + light
}
