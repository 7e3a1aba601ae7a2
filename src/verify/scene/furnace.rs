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
use super::view::{Budget, TILE, View, camera_name};
use super::white::Dress;
use super::{Subject, unique, white};
use crate::camera::Camera;
use crate::desc::{self, Strategy};
use crate::film::Film;
use crate::scene::Scene;
use crate::verify::measure::REPLICATES;
use crate::verify::tiles::{Estimate, unseen, worst};
use crate::verify::{Exhibit, Findings, Picture, Task, Topic};
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

/// Degrees of freedom of a pixel's standard error.
const DOF: f64 = REPLICATES as f64 - 1.0;

/// Fewest pixels of a material that are judged together.
const FEWEST: usize = 8;

/// As written; made white; and made flat as well, which tells what shading normals take from what the lobes do.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    if subject.desc.objects.is_empty() {
        return Vec::new();
    }
    let task = |dress: Dress| {
        let subject = subject.clone();
        Task::new(TOPIC, name(dress), move |trial, found| {
            Furnace { desc: &subject.desc, dress, budget: Budget::of(trial, RAYS), vanishes: false }.burn(true, found);
        })
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

/// A scene to be looked at in a uniform environment.
pub(in crate::verify) struct Furnace<'a> {
    pub desc: &'a desc::Scene,
    pub dress: Dress,
    pub budget: Budget,
    /// Every material scatters all that it receives, and nothing else takes light away.
    pub vanishes: bool,
}

impl Furnace<'_> {
    /// Images by the author's own camera and, where all of it is to be `framed`, by one that sees everything.
    pub(in crate::verify) fn burn(&self, framed: bool, found: &mut Findings) {
        let furnace = white::furnace(self.desc, self.dress);
        let scene = match Scene::compile(&furnace) {
            Ok(scene) => scene,
            Err(e) => {
                found.words.push(format!("no furnace: {e}"));
                return found.checks.holds("the scene without its lights is traced", false);
            }
        };
        drop(furnace);

        // The one that sees everything stands last.
        let last = scene.cameras.len() - 1;
        if framed {
            self.look(&scene, last, "the whole scene", found);
        }
        if last > 0 {
            self.look(&scene, 0, &camera_name(&scene, 0), found);
        }
    }

    fn look(&self, scene: &Scene, camera: usize, view: &str, found: &mut Findings) {
        let budget = Budget { seed: self.budget.seed ^ (camera as u64) << 40, ..self.budget };
        let look = View { camera, budget, strategy: Strategy::Mis };
        let output = look.settings(scene).and_then(|s| View::render(scene, &s));
        match output {
            Ok(output) => {
                found.checks.holds(format!("{view}: every sample is finite and not negative"), output.bad_count == 0);
                let names = unique(self.desc.materials.iter().map(|m| &*m.name), "material");
                let seen = seen(scene, camera, &output.film);
                let image = Image { names: &names, desc: self.desc, seen, film: &output.film };
                image.judge(view, self.dress, found);
                if self.vanishes {
                    image.vanishes(view, found);
                }
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

/// Mean and standard error of a channel.
type Value = (f64, f64);

/// Names of the channels in messages; one alone where all are the same.
const CHANNELS: [&str; 3] = [" R", " G", " B"];

/// Mean and standard error of several pixels.
fn pooled<'a>(pixels: impl Iterator<Item = &'a Value>) -> Value {
    let (n, sum, se2) = pixels.fold((0.0, 0.0, 0.0), |(n, sum, se2), (m, se)| (n + 1.0, sum + m, se2 + se * se));
    (sum / n, se2.sqrt() / n)
}

/// Standard errors by which a pixel exceeds the limit.
fn excess((mean, se): &Value) -> f64 {
    (mean - 1.0 - ROUNDING) / se.max(1e-9)
}

impl Image<'_> {
    /// Each channel is tested by itself. The brightest channel of a pixel would be chosen by the noise that is tested, and
    /// the mean of maxima exceeds the maximum of means where channels have noise of their own, as under thin films.
    fn judge(&self, view: &str, dress: Dress, found: &mut Findings) {
        found.guarded = true;
        if self.seen.iter().all(Option::is_none) {
            found.words.push(format!("{view}: nothing is seen"));
            return;
        }
        let channels = self.channels();
        let named = |c: usize| if channels.len() == 1 { "" } else { CHANNELS[c] };
        for (c, values) in channels.iter().enumerate() {
            self.limit(&format!("{view}{}", named(c)), values, found);
        }
        for (material, members) in self.by_material() {
            let name = self.name(material);
            let means = channels.iter().map(|values| pooled(members.iter().map(|i| &values[*i])));
            let means: Vec<Value> = means.collect();
            for (c, (mean, se)) in means.iter().enumerate() {
                let evidence = at_most(1.0, *mean, *se, DOF, ROUNDING);
                found.checks.push(format!("{view}{}: {name} ≤ 1", named(c)), evidence);
            }
            found.words.extend(self.loss(view, dress, material, &means));
        }
        found.words.extend(self.worst_pixel(view, &channels));
        found.exhibits.push(self.picture(view, &channels));
    }

    /// Mean and standard error of each pixel, by channel; one channel where all three are the same.
    fn channels(&self) -> Vec<Vec<Value>> {
        let pixel = |[x, y]: [u32; 2]| {
            let error = self.film.stderr(x, y).unwrap_or([f64::INFINITY; 3]);
            // Roulette ends one path in a thousand and makes the others brighter for it: a pixel that lost none knows
            // nothing of that.
            let rare = unseen(1.0, self.film.samples(x, y) as f64);
            let mean = self.film.mean(x, y);
            [0, 1, 2].map(|c| (mean[c], error[c].hypot(rare)))
        };
        let pixels: Vec<[Value; 3]> = self.film.pixels().map(pixel).collect();
        let grey = pixels.iter().all(|[r, g, b]| r == g && g == b);
        (0..if grey { 1 } else { 3 }).map(|c| pixels.iter().map(|rgb| rgb[c]).collect()).collect()
    }

    /// Pixel by pixel, and in tiles.
    fn limit(&self, what: &str, values: &[Value], found: &mut Findings) {
        let name = |n: usize, parts: &str| format!("{what}: the brightest of {n} {parts} ≤ 1");
        let of = |values: &[Value]| worst_p(values.iter().copied(), 1.0 + ROUNDING, DOF);
        found.checks.p(name(values.len(), "pixels"), of(values));
        let tiles = self.tiles(values);
        found.checks.p(name(tiles.len(), "tiles"), of(&tiles));
    }

    /// A channel in tiles.
    fn tiles(&self, values: &[Value]) -> Vec<Value> {
        let mut tiles: BTreeMap<[u32; 2], Vec<&Value>> = BTreeMap::new();
        for ([x, y], value) in self.film.pixels().zip(values) {
            tiles.entry([x / TILE, y / TILE]).or_default().push(value);
        }
        tiles.into_values().map(|tile| pooled(tile.into_iter())).collect()
    }

    /// Nothing is darker than the environment either.
    fn vanishes(&self, view: &str, found: &mut Findings) {
        for values in self.channels() {
            let off = |(mean, se): Value| Estimate { mean: mean - 1.0, se, dof: DOF }.p_of_zero(ROUNDING);
            let (p, n) = worst(self.tiles(&values).into_iter().map(off));
            found.checks.p(format!("{view}: the worst of {n} tiles is 1"), p);
        }
    }

    /// Numbers of the pixels that see each material, where these are enough to be judged together.
    fn by_material(&self) -> BTreeMap<usize, Vec<usize>> {
        let mut by_material: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (i, seen) in self.seen.iter().enumerate() {
            seen.iter().for_each(|s| by_material.entry(s.material).or_default().push(i));
        }
        by_material.retain(|_, members| members.len() >= FEWEST);
        by_material
    }

    /// What a lossless material has lost in its brightest channel, in words.
    fn loss(&self, view: &str, dress: Dress, material: usize, means: &[Value]) -> Option<String> {
        let (mean, se) = means.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let scatters = self.desc.materials.get(material).is_some_and(|m| white::lossless(m).is_some());
        let lost = 1.0 - mean;
        if dress == Dress::Written || !scatters || lost <= 5.0 * se + ROUNDING {
            return None;
        }
        let why = match dress {
            Dress::Flat => "black or enclosed surroundings, for shading normals are the triangles'",
            _ => "shading normals, beside what is lost when also made flat",
        };
        let (percent, name) = (100.0 * lost, self.name(material));
        let dress = self::name(dress);
        Some(format!("{view}: {dress}, {name} is {mean:.4} ± {se:.4}: {percent:.1} % are lost to {why}"))
    }

    /// The worst pixel in words.
    fn worst_pixel(&self, view: &str, channels: &[Vec<Value>]) -> Option<String> {
        let all = channels.iter().flat_map(|values| values.iter().enumerate());
        let (i, (mean, se)) = all.max_by(|a, b| excess(a.1).total_cmp(&excess(b.1))).filter(|v| excess(v.1) > 6.0)?;
        let width = self.film.size()[0];
        let [x, y] = [i as u32 % width, i as u32 / width];
        let count = (0..channels[0].len()).filter(|i| bright(channels, *i)).count();
        let what = match self.seen[i] {
            None => "beside everything".to_owned(),
            Some(Seen { material, front: true }) => format!("where {} is seen", self.name(material)),
            Some(Seen { material, front: false }) => {
                format!("where the back of {} is seen: refracting surfaces must be closed", self.name(material))
            }
        };
        Some(format!(
            "{view}: energy comes out of nothing: pixel ({x}, {y}) is {mean:.4} ± {se:.4} {what}; {count} such pixels"
        ))
    }

    fn name(&self, material: usize) -> String {
        self.names.get(material).map_or(format!("material {material}"), |name| format!("`{name}`"))
    }

    /// The image, 1 as middle grey, and too bright pixels red.
    fn picture(&self, view: &str, channels: &[Vec<Value>]) -> Exhibit {
        let pixel = |(i, [x, y]): (usize, [u32; 2])| match bright(channels, i) {
            true => [1.0, 0.0, 0.0],
            false => self.film.mean(x, y).map(|v| 0.5 * v as f32),
        };
        let pixels = self.film.pixels().enumerate().map(pixel).collect();
        let title = format!("{view} in a furnace: the environment is middle grey, what is brighter is red");
        Exhibit::Picture(Picture { title, size: self.film.size(), pixels })
    }
}

/// Some channel of a pixel is far above the limit.
fn bright(channels: &[Vec<Value>], pixel: usize) -> bool {
    channels.iter().any(|values| excess(&values[pixel]) > 6.0)
}
