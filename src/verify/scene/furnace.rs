//! The open white furnace: the scene alone in a uniform environment of radiance 1. What only scatters cannot be brighter
//! than its surroundings,
//!
//! ```text
//! L(x, ω) = ∫ f L |cos θ| dωi ≤ max L = 1
//! ```
//!
//! and with everything made lossless the scene vanishes (L = 1), but for what shading normals that disagree with the
//! surface take away.

use super::one_sided::{at_most, worst_p};
use super::view::{TILE, View, camera_name};
use super::white::Dress;
use super::{Subject, unique, white};
use crate::camera::Camera;
use crate::desc::{self, Strategy};
use crate::film::Film;
use crate::scene::Scene;
use crate::verify::measure::REPLICATES;
use crate::verify::tiles::unseen;
use crate::verify::{Exhibit, Findings, Picture, Task, Topic, Trial};
use glam::Vec2;
use std::collections::BTreeMap;

const TOPIC: Topic = Topic {
    id: "furnace",
    title: "nothing is brighter than the uniform environment that it stands in",
    source: "conservation of energy: L = ∫ f L |cos θ| dω ≤ 1",
};

/// Rays of an image.
const RAYS: [u64; 2] = [4_000_000, 60_000_000];

/// Relative error of f32 along a path, and of the tables that multiple scattering is read from.
const ROUNDING: f64 = 1e-3;

/// Fewest pixels of a material that are judged together.
const FEWEST: usize = 8;

/// As written; made white; and made flat as well, which tells what shading normals take from what the lobes do.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    if subject.desc.objects.is_empty() {
        return Vec::new();
    }
    let task = |dress: Dress| {
        let subject = subject.clone();
        Task::new(TOPIC, name(dress), move |trial, found| burn(&subject.desc, dress, trial, found))
    };
    [Dress::Written, Dress::White, Dress::Flat].map(task).into()
}

fn name(dress: Dress) -> &'static str {
    match dress {
        Dress::Written => "as written",
        Dress::White => "made white",
        Dress::Flat => "made white and flat",
    }
}

fn burn(desc: &desc::Scene, dress: Dress, trial: &Trial, found: &mut Findings) {
    let furnace = white::furnace(desc, dress);
    let scene = match Scene::compile(&furnace) {
        Ok(scene) => scene,
        Err(e) => {
            found.words.push(format!("no furnace: {e}"));
            return found.checks.holds("the scene without its lights is traced", false);
        }
    };
    let names = unique(desc.materials.iter().map(|m| &*m.name), "material");
    drop(furnace);

    // The author's own camera, and the one that sees everything, which stands last.
    let last = scene.cameras.len() - 1;
    let mut cameras = vec![(last, "the whole scene".to_owned())];
    if last > 0 {
        cameras.push((0, camera_name(&scene, 0)));
    }
    for (camera, view) in cameras {
        let look = View {
            camera,
            rays: trial.work(RAYS[0], RAYS[1]),
            seed: trial.seed ^ (camera as u64) << 40,
            strategy: Strategy::Mis,
        };
        let output = look.settings(&scene).and_then(|s| View::render(&scene, &s));
        match output {
            Ok(output) => {
                let image = Image { names: &names, desc, seen: seen(&scene, camera, &output.film), film: &output.film };
                image.judge(&view, dress, found);
            }
            Err(e) => {
                found.words.push(format!("{view}: no image: {e}"));
                found.checks.holds(format!("{view}: an image is made"), false);
            }
        }
    }
}

/// What stands behind the middle of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    material: usize,
    front: bool,
}

/// What stands behind the middle of each pixel, row by row.
fn seen(scene: &Scene, camera: usize, film: &Film) -> Vec<Option<Seen>> {
    let camera = Camera::new(&scene.cameras[camera], film.size());
    let one = |[x, y]: [u32; 2]| {
        let ray = camera.ray(Vec2::new(x as f32 + 0.5, y as f32 + 0.5), [0.5; 2]);
        let vertex = scene.intersect(&ray, &mut || 0.5)?;
        Some(Seen { material: vertex.material as usize, front: vertex.front })
    };
    film.pixels().map(one).collect()
}

/// A furnace's image.
struct Image<'a> {
    names: &'a [String],
    desc: &'a desc::Scene,
    film: &'a Film,
    seen: Vec<Option<Seen>>,
}

/// Mean and standard error of several pixels.
fn pooled<'a>(pixels: impl Iterator<Item = &'a (f64, f64)>) -> (f64, f64) {
    let (n, sum, se2) = pixels.fold((0.0, 0.0, 0.0), |(n, sum, se2), (m, se)| (n + 1.0, sum + m, se2 + se * se));
    (sum / n, se2.sqrt() / n)
}

impl Image<'_> {
    fn judge(&self, view: &str, dress: Dress, found: &mut Findings) {
        found.guarded = true;
        if self.seen.iter().all(Option::is_none) {
            found.words.push(format!("{view}: nothing is seen"));
            return;
        }
        let dof = REPLICATES as f64 - 1.0;
        let [width, _] = self.film.size();
        let pixels: Vec<[u32; 2]> = self.film.pixels().collect();
        let error = |x: u32, y: u32| self.film.stderr(x, y).unwrap_or([f64::INFINITY; 3]);

        // Pixel by pixel, and in tiles: each in its brightest channel.
        let brightest = |&[x, y]: &[u32; 2]| {
            let lanes = self.film.mean(x, y).into_iter().zip(error(x, y));
            let (mean, se) = lanes.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0.0));
            // Roulette ends one path in a thousand and makes the others brighter for it: a pixel that lost none knows
            // nothing of that.
            (mean, se.hypot(unseen(1.0, self.film.samples(x, y) as f64)))
        };
        let values: Vec<(f64, f64)> = pixels.iter().map(brightest).collect();
        let limit = 1.0 + ROUNDING;
        let name = |n: usize, what: &str| format!("{view}: the brightest of {n} {what} ≤ 1");
        found.checks.p(name(values.len(), "pixels"), worst_p(values.iter().copied(), limit, dof));
        let mut tiles: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (i, [x, y]) in pixels.iter().enumerate() {
            tiles.entry([x / TILE, y / TILE]).or_default().push(i);
        }
        let of_tiles: Vec<(f64, f64)> = tiles.values().map(|t| pooled(t.iter().map(|i| &values[*i]))).collect();
        found.checks.p(name(of_tiles.len(), "tiles"), worst_p(of_tiles.iter().copied(), limit, dof));

        // Material by material.
        let mut by_material: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (i, seen) in self.seen.iter().enumerate() {
            seen.iter().for_each(|s| by_material.entry(s.material).or_default().push(i));
        }
        for (material, members) in by_material.iter().filter(|(_, members)| members.len() >= FEWEST) {
            let (mean, se) = pooled(members.iter().map(|i| &values[*i]));
            let name = self.name(*material);
            found.checks.push(format!("{view}: {name} ≤ 1"), at_most(1.0, mean, se, dof, ROUNDING));
            let lost = 1.0 - mean;
            let scatters = self.desc.materials.get(*material).is_some_and(|m| white::lossless(m).is_some());
            if dress != Dress::Written && scatters && lost > 5.0 * se + ROUNDING {
                let why = match dress {
                    Dress::Flat => "black or enclosed surroundings, for shading normals are the triangles'",
                    _ => "shading normals, beside what is lost when also made flat",
                };
                let percent = 100.0 * lost;
                found.words.push(format!(
                    "{view}: {}, {name} is {mean:.4} ± {se:.4}: {percent:.1} % are lost to {why}",
                    self::name(dress)
                ));
            }
        }

        // The worst pixel in words.
        let excess = |(mean, se): &(f64, f64)| (mean - limit) / se.max(1e-9);
        let worst = values.iter().enumerate().max_by(|a, b| excess(a.1).total_cmp(&excess(b.1)));
        if let Some((i, (mean, se))) = worst.filter(|(_, v)| excess(v) > 6.0) {
            let [x, y] = [i as u32 % width, i as u32 / width];
            let count = values.iter().filter(|v| excess(v) > 6.0).count();
            let what = match self.seen[i] {
                None => "beside everything".to_owned(),
                Some(Seen { material, front: true }) => format!("where {} is seen", self.name(material)),
                Some(Seen { material, front: false }) => {
                    format!("where the back of {} is seen: refracting surfaces must be closed", self.name(material))
                }
            };
            found.words.push(format!(
                "{view}: energy comes out of nothing: pixel ({x}, {y}) is {mean:.4} ± {se:.4} {what}; {count} such pixels"
            ));
        }
        found.exhibits.push(self.picture(view, &values, excess));
    }

    fn name(&self, material: usize) -> String {
        self.names.get(material).map_or(format!("material {material}"), |name| format!("`{name}`"))
    }

    /// The image, 1 as middle grey, and too bright pixels red.
    fn picture(&self, view: &str, values: &[(f64, f64)], excess: impl Fn(&(f64, f64)) -> f64) -> Exhibit {
        let pixel = |([x, y], value): ([u32; 2], &(f64, f64))| match excess(value) {
            e if e > 6.0 => [1.0, 0.0, 0.0],
            _ => self.film.mean(x, y).map(|v| 0.5 * v as f32),
        };
        let pixels = self.film.pixels().zip(values).map(pixel).collect();
        let title = format!("{view} in a furnace: the environment is middle grey, what is brighter is red");
        Exhibit::Picture(Picture { title, size: self.film.size(), pixels })
    }
}
