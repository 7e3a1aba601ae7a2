//! The path tracer: equation (2), recursion and all, by one random path a sample.

use super::{
    Classes, Drawn, Method, Observer, Sides, direct_light, emitted, environment, first_surface, medium, scatter,
    sees_lights, strategy,
};
use crate::bsdf::Bsdf;
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::{Departure, Vertex};
use crate::spectrum::Spectrum;

/// Throughput below which roulette is played, η² of refractions kept out; the survivors are held there. What a game at
/// greater throughput saves it costs in variance: on the Cornell box error times seconds is least, and flat, from 1/2 to
/// 1/6, and 40 % greater where the game is played from the start.
const FAINT: f32 = 1.0 / 3.0;

/// From this many reflections on it is played at any throughput, for paths that nothing is lost of.
const LONG: u32 = 8;

/// L(x, ω) = Le + ∫ f L |cos| dω with the integral split in two: light that arrives straight from a light, drawn by
/// the light sampler and met by chance, and light that arrives reflected, by recursion.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let scene = method.scene;
    let mut sample = PixelSample::default();
    let (mut ray, mut leaving, mut drawn) =
        (Ray { o: ray.o, d: ray.d, t_max: ray.t_max }, Departure::NOWHERE, Drawn::Camera);
    let (mut beta, mut eta_scale) = (Spectrum::ONE, 1.0);
    let (mut inside, mut lane) = (method.inside.clone(), None);
    let mut classes = Classes::default();
    let (mut scratch, mut vertex) = (Bsdf::new(), Vertex::NOWHERE);

    for depth in 0.. {
        // Numbers of the next vertex, which do not wait for it: they are there when it is.
        let [choose_light, choose_lobe] = sampler.next_2d();
        let (u_light, u_bsdf) = (sampler.next_2d(), sampler.next_2d());

        watch.ray();
        let met = scene.meet(&ray, leaving, &mut inside, &mut || sampler.next_1d(), &mut vertex);
        beta *= medium::on_the_way(method, &ray, met.then_some(&vertex), &inside);
        if !met {
            let light = beta * environment(method, &ray, drawn);
            sample.radiance += light;
            watch.light(light, &classes);
            watch.escaped(depth, &ray, beta);
            break;
        }
        let vertex = &vertex;

        // Le
        let light = beta * emitted(method, vertex, drawn);
        sample.radiance += light;
        watch.light(light, &classes);

        let interface = scene.media.interface(&inside, vertex);
        medium::choose_lane(method, &interface, &mut lane, &mut beta, sampler);
        let shading = scene.shade(vertex, &interface, lane, &mut scratch);
        let sides = Sides { here: &inside, across: interface.across.as_ref() };
        watch.vertex(depth, &ray, vertex, Some(&shading), beta);
        if depth == 0 {
            first_surface(&mut sample, &ray, vertex, &shading);
        }
        if depth == method.max_depth || shading.bsdf.is_empty() {
            break;
        }
        let next = scatter::draw(method, vertex, &shading, choose_lobe, u_bsdf, sampler);

        // ∫ by light
        if sees_lights(&shading, scene) {
            let stray = next.and_then(|next| next.stray);
            let sheets = method.max_depth - depth - 1;
            let (all, specular, sheets) =
                direct_light(method, vertex, &shading, sides, stray, sheets, choose_light, u_light, watch);
            let light = beta * all;
            sample.radiance += light;
            if O::CLASSES {
                // Each sheet on the way is a specular transmission.
                let classes = (0..sheets).fold(classes.reflected(all, specular), |c, _| c.reflected(all, all));
                watch.light(light, &classes);
            }
        }

        // ∫ by BSDF
        let Some(next) = next else { break };
        beta *= next.weight;
        eta_scale *= next.eta * next.eta;
        // Light sampling looks through thin sheets. What passes one straight on meets lights as if it were not there: as
        // the direction was drawn, or the light would count twice.
        if !next.straight {
            drawn = next.drawn;
        }
        (ray, leaving) = (next.ray, vertex.departure);
        if let Some(changed) = sides.changed(vertex, ray.d).cloned() {
            inside = changed;
        }
        watch.drawn(next.drawn, beta);
        if O::CLASSES {
            classes = classes.reflected(next.weight, next.specular);
        }

        // Roulette
        if beta.is_black() {
            break;
        }
        let throughput = beta.max_element() * eta_scale;
        if throughput < FAINT || depth >= LONG {
            let survival = strategy::survival(throughput, FAINT);
            if sampler.next_1d() >= survival {
                break;
            }
            beta *= 1.0 / survival;
        }
    }
    sample
}
