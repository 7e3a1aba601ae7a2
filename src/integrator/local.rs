//! Local illumination: emitted and direct light, L = Le + ∫ f Le |cos| dω, without recursion.

use super::{
    Classes, Drawn, Method, Observer, Sides, direct_light, emitted, environment, first_surface, medium,
    scatter::{self, Scattered},
    sees_lights,
};
use crate::bsdf::Bsdf;
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::{Departure, Shading, Vertex};
use crate::spectrum::Spectrum;

/// L = Le + ∫ f Le |cos| dω.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let (mut sample, mut scratch) = (PixelSample::default(), Bsdf::new());
    let none = Classes::default();
    let (mut inside, mut lane) = (method.inside.clone(), None);
    watch.ray();
    let met = method.scene.intersect_from(ray, Departure::NOWHERE, &mut inside, &mut || sampler.next_1d());
    let mut beta = medium::on_the_way(method, ray, met.as_ref(), &inside);
    let Some(vertex) = met else {
        sample.radiance = beta * environment(method, ray, Drawn::Camera);
        watch.light(sample.radiance, &none);
        watch.escaped(0, ray, beta);
        return sample;
    };
    sample.radiance = beta * emitted(method, &vertex, Drawn::Camera);
    watch.light(sample.radiance, &none);
    let interface = method.scene.media.interface(&inside, &vertex);
    medium::choose_lane(method, &interface, &mut lane, &mut beta, sampler);
    let shading = method.scene.shade(&vertex, &interface, lane, &mut scratch);
    watch.vertex(0, ray, &vertex, Some(&shading), beta);
    first_surface(&mut sample, ray, &vertex, &shading);
    if method.max_depth > 0 {
        let sides = Sides { here: &inside, across: interface.across.as_ref() };
        sample.radiance += beta * reflected(method, &vertex, &shading, sides, sampler, watch, beta, none, |_| true);
    }
    sample
}

/// ∫ f Le |cos| dω at a vertex, by lights and by directions as far as `keep` wants how they were drawn; `watch` hears
/// of β times that.
pub(super) fn reflected<O: Observer>(
    method: &Method,
    vertex: &Vertex,
    shading: &Shading,
    sides: Sides,
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

    let next = scatter::draw(method, vertex, shading, choose_lobe, u_bsdf, sampler);

    // By light.
    if sees_lights(shading, scene) {
        let stray = next.and_then(|next| next.stray);
        let (all, specular, _) = direct_light(method, vertex, shading, sides, stray, 0, choose_light, u_light, watch);
        sum += all;
        watch.light(beta * all, &classes.reflected(all, specular));
    }

    // By direction, as far as the first surface.
    let Some(Scattered { ray, drawn, weight, specular, .. }) = next.filter(|next| keep(next.drawn)) else { return sum };
    let mut inside = sides.towards(vertex, ray.d).clone();
    watch.ray();
    let met = scene.intersect_from(&ray, vertex.departure, &mut inside, &mut || sampler.next_1d());
    let le = match &met {
        Some(end) => emitted(method, end, drawn),
        None => environment(method, &ray, drawn),
    };
    let light = weight * le * medium::on_the_way(method, &ray, met.as_ref(), &inside);
    watch.light(beta * light, &classes.reflected(weight, specular));
    sum + light
}
