//! Whitted's ray tracing (1980): a tree of perfect reflections and refractions, with local illumination by the rest
//! of each surface. It sums the paths whose reflections are all perfect but the one next to the light.

use super::local::reflected;
use super::{Event, Method, Observer, Walk, first_surface};
use crate::bsdf::{Pdf, Scratch};
use crate::film::PixelSample;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::{DirectionSample, Vertex};

/// A branch whose throughput falls below this plays roulette for its life, so that trees end without bias.
const THRESHOLD: f32 = 0.05;

/// From this many reflections on a branch goes on as one path, which chooses among the perfect directions, and with at most this
/// probability. Where nothing is lost, branches whose chances of survival sum to 1 are a critical branching process:
/// sure to end, but infinitely large in the mean.
const PATH_DEPTH: u32 = 8;
const PATH_SURVIVAL: f32 = 0.95;

/// L = Le + ∫ (f − f_perfect) Le |cos| dω + Σ_perfect k L.
pub fn estimate<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    let mut sample = PixelSample::default();
    let (mut vertex, mut scratch) = (Vertex::NOWHERE, Scratch::new());
    // Every branch with numbers of its own.
    let (mut branches, mut forks) = (vec![(Walk::new(method, ray, sampler), sampler.clone())], 0);
    while let Some((mut walk, mut sampler)) = branches.pop() {
        let event = walk.advance(method, &sampler, &mut vertex, watch);
        sample.radiance += walk.emission(method, event, &vertex, watch);
        let Event::Surface = event else { continue };

        let interface = method.scene.media.interface(&walk.media, &vertex);
        walk.choose_lane(method, &interface, &mut sampler);
        let shading = walk.shade(method, &mut sampler, &vertex, &interface, &mut scratch);
        watch.vertex(walk.depth, &walk.ray, &vertex, Some(&shading), walk.beta);
        if walk.depth == 0 {
            first_surface(&mut sample, &walk.ray, &shading);
        }
        if walk.depth >= method.max_depth {
            continue;
        }

        // The smooth lobes: local light.
        if shading.bsdf.has_smooth() {
            let smooth = |pdf| matches!(pdf, Pdf::SolidAngle(_));
            sample.radiance += reflected(method, &walk, &shading, &mut sampler, watch, smooth);
        }

        // The perfect ones: a branch each, or one in proportion to what each sends on.
        let mut perfect = shading.deltas();
        let is_path = walk.depth >= PATH_DEPTH;
        if is_path {
            sampler = sampler.fork(forks);
            forks += 1;
            let one = choose(&perfect, sampler.next_1d());
            perfect.clear();
            perfect.extend(one);
        }
        for next in perfect {
            let (mut walk, mut sampler) = (walk.clone(), sampler.fork(forks));
            forks += 1;
            walk.scatter(&shading, &next, &mut ());
            let survival = walk.beta.max_element() / THRESHOLD;
            let survival = survival.min(if is_path { PATH_SURVIVAL } else { 1.0 });
            if survival > 0.0 && walk.plays(&mut sampler, survival) {
                branches.push((walk, sampler));
            }
        }
    }
    sample
}

/// One of the directions, with probability p in proportion to its weight, which is divided by p.
fn choose(directions: &[DirectionSample], u: f32) -> Option<DirectionSample> {
    let sum: f32 = directions.iter().map(|next| next.weight.max_element()).sum();
    let mut rest = u * sum;
    // Rounding may leave a rest behind the last.
    let mut last = None;
    for next in directions {
        let weight = next.weight.max_element();
        if weight > 0.0 {
            let k = sum / weight;
            last = Some(DirectionSample { weight: next.weight * k, specular: next.specular * k, ..*next });
            if rest < weight {
                break;
            }
            rest -= weight;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{Integrator, Strategy};
    use crate::integrator::RayCount;
    use crate::sampler::Kind;
    use crate::warp::uniform_sphere;

    /// A glass ball in a box of perfect mirrors, without a light: nothing is ever lost.
    const CLOSED: &str = r#"
        [camera]
        position = [0, 0, 0]
        target = [0, 0, -1]
        [material.mirror]
        type = "mirror"
        [material.glass]
        type = "dielectric"
        ior = 1.5
        [[shape]]
        type = "box"
        min = [-1, -1, -1]
        max = [1, 1, 1]
        reversed = true
        material = "mirror"
        [[shape]]
        type = "sphere"
        center = [0.1, 0.2, -0.4]
        radius = 0.4
        material = "glass"
    "#;

    #[test]
    fn trees_in_closed_lossless_glass_are_of_finite_size() {
        let desc = crate::desc::toml::parse(CLOSED, std::path::Path::new("closed.toml")).expect("a scene");
        let scene = crate::scene::Scene::compile(&desc).expect("a scene");
        let method = Method {
            scene: &scene,
            integrator: Integrator::Whitted,
            strategy: Strategy::Mis,
            max_depth: u32::MAX,
            media: scene.media_near(glam::Vec3A::ZERO),
            solver: crate::integrator::Solver::None,
        };
        let mut count = RayCount::default();
        let n = 2000;
        for i in 0..n {
            let mut u = Sampler::new(Kind::Independent, 1, [0, 0], i, 1);
            let ray = Ray::new([0.0; 3], uniform_sphere(u.next_2d()));
            estimate(&method, &ray, &mut u, &mut count);
        }
        // At most 1/THRESHOLD branches at each of PATH_DEPTH vertices, each then a path of 1/(1 − PATH_SURVIVAL) rays in the mean.
        let bound = 20.0 * (8.0 + 20.0);
        assert!((count.0 as f64) < bound * n as f64, "{} rays a tree", count.0 as f64 / n as f64);
    }
}
