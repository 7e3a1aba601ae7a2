//! Whitted's ray tracing (1980): a tree of perfect reflections and refractions, with local illumination by the rest
//! of each surface. It sums the paths whose reflections are all perfect but the one next to the light.

use super::local::reflected;
use super::{Classes, Drawn, Method, Observer, Sides, emitted, environment, first_surface, medium, strategy};
use crate::bsdf::{Bsdf, Transport};
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::Departure;
use crate::spectrum::Spectrum;

/// A branch whose weight falls below this plays roulette for its life, so that trees end without bias.
const FAINT: f32 = 0.05;

/// L = Le + ∫ (f − f_perfect) Le |cos| dω + Σ_perfect k L.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let scene = method.scene;
    let (mut sample, mut scratch) = (PixelSample::default(), Bsdf::new());
    let mut branches =
        vec![(*ray, Departure::NOWHERE, Drawn::Camera, Spectrum::ONE, Classes::default(), method.inside.clone(), None)];
    while let Some((ray, leaving, drawn, mut beta, classes, mut inside, mut lane)) = branches.pop() {
        watch.ray();
        let depth = classes.reflections();
        let met = scene.intersect_from(&ray, leaving, &mut inside, &mut || sampler.next_1d());
        beta *= medium::on_the_way(method, &ray, met.as_ref(), &inside);
        let Some(vertex) = met else {
            let light = beta * environment(method, &ray, drawn);
            sample.radiance += light;
            watch.light(light, &classes);
            watch.escaped(depth, &ray, beta);
            continue;
        };
        let light = beta * emitted(method, &vertex, drawn);
        sample.radiance += light;
        watch.light(light, &classes);
        let interface = scene.media.interface(&inside, &vertex);
        medium::choose_lane(method, &interface, &mut lane, &mut beta, sampler);
        let shading = scene.shade(&vertex, &interface, lane, &mut scratch);
        let sides = Sides { here: &inside, across: interface.across.as_ref() };
        watch.vertex(depth, &ray, &vertex, Some(&shading), beta);
        if depth == 0 {
            first_surface(&mut sample, &ray, &vertex, &shading);
        }
        if depth >= method.max_depth {
            continue;
        }

        // The smooth lobes, and what perfect ones send into a surface with a bent normal: local light.
        if shading.bsdf.has_smooth() || shading.is_bent() {
            let smooth = |drawn| matches!(drawn, Drawn::Smooth { .. });
            let local = reflected(method, &vertex, &shading, sides, sampler, watch, beta, classes, smooth);
            sample.radiance += beta * local;
        }

        // The perfect ones: a branch each.
        for next in shading.bsdf.deltas(shading.wo, Transport::Radiance) {
            let wi = shading.frame.to_world(next.wi).normalize();
            if !shading.agrees(&vertex, wi, next.wi) {
                continue;
            }
            let mut beta = beta * next.weight;
            let survival = strategy::survival(beta.max_element(), FAINT);
            if beta.is_black() || sampler.next_1d() >= survival {
                continue;
            }
            beta *= 1.0 / survival;
            let (ray, inside) = (shading.leave(&vertex, wi), sides.towards(&vertex, wi).clone());
            let classes = classes.reflected(next.weight, next.specular);
            branches.push((ray, vertex.departure, Drawn::Delta, beta, classes, inside, lane));
        }
    }
    sample
}
