//! Whitted's ray tracing (1980): a tree of perfect reflections and refractions, with local illumination by the rest
//! of each surface. It sums the paths whose reflections are all perfect but the one next to the light.

use super::local::reflected;
use super::scatter::Scattered;
use super::{Drawn, Event, Method, Observer, Walk, first_surface};
use crate::bsdf::{Bsdf, Transport};
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::Vertex;

/// A branch whose throughput falls below this plays roulette for its life, so that trees end without bias.
const THRESHOLD: f32 = 0.05;

/// L = Le + ∫ (f − f_perfect) Le |cos| dω + Σ_perfect k L.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let mut sample = PixelSample::default();
    let (mut vertex, mut scratch) = (Vertex::NOWHERE, Bsdf::new());
    // Every branch with numbers of its own.
    let (mut branches, mut forks) = (vec![(Walk::new(method, ray, sampler), sampler.clone())], 0);
    while let Some((mut walk, mut sampler)) = branches.pop() {
        let event = walk.advance(method, &sampler, &mut vertex, watch);
        sample.radiance += walk.emission(method, event, &vertex, watch);
        let Event::Surface = event else { continue };

        let interface = walk.interface(method, &vertex, &mut sampler);
        let shading = method.scene.shade(&vertex, &interface, walk.lane, &mut scratch);
        watch.vertex(walk.depth, &walk.ray, &vertex, Some(&shading), walk.beta);
        if walk.depth == 0 {
            first_surface(&mut sample, &walk.ray, &shading);
        }
        if walk.depth >= method.max_depth {
            continue;
        }

        // The smooth lobes, and what perfect ones send into a surface with a bent normal: local light.
        if shading.bsdf.has_smooth() || shading.is_bent() {
            let smooth = |drawn| matches!(drawn, Drawn::Smooth { .. });
            sample.radiance += reflected(method, &walk, &shading, &mut sampler, watch, smooth);
        }

        // The perfect ones: a branch each.
        for next in shading.bsdf.deltas(shading.wo, Transport::Radiance) {
            let wi = shading.frame.to_world(next.wi).normalize();
            if !shading.agrees(wi, next.wi) {
                continue;
            }
            let (mut walk, mut sampler) = (walk.clone(), sampler.fork(forks));
            forks += 1;
            let (ray, weight, specular) = (shading.leave(wi), next.weight, next.specular);
            let next =
                Scattered { ray, weight, specular, eta: next.eta, drawn: Drawn::Delta, straight: false, stray: None };
            walk.scatter(&shading, &next, &mut ());
            let survival = (walk.beta.max_element() / THRESHOLD).min(0.999);
            if !walk.beta.is_black() && walk.plays(&mut sampler, survival) {
                branches.push((walk, sampler));
            }
        }
    }
    sample
}
