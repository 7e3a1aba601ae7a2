//! C3: splats.
//!
//! Points of the film, uniform, go by a ray into the scene and from there back by projection onto the film, as light that a path
//! from a lamp brings to the camera does. Each carries g(x) over its density, so that a pixel gathers ∫ h(x − centre) g(x) dx. For
//! g that is linear in either coordinate, and h even and normalised, that is g(centre): light in a neighbour's pixel shifts it.

use crate::camera::{Camera, SIZE, Specimen, specimens};
use crate::desc::{Filter, Lens};
use crate::film::{Film, Layers, PixelSample, Replicate, Splats};
use crate::sampler::{Kind, Sampler, hash};
use crate::spectrum::Spectrum;
use crate::verify::agreement::{Estimated, agreement};
use crate::verify::measure::REPLICATES;
use crate::verify::replicated::Replicated;
use crate::verify::{Findings, Task, Topic, Trial};
use clap::ValueEnum;
use glam::{Vec2, vec2};

const C3: Topic = Topic {
    id: "C3",
    title: "light that a path brings to a point of the film is in the pixels whose filter is there, with its error",
    source: "Veach 1997, section 4.1: the measurement equation, I = ∫ h L",
};

/// Pixels that are looked at: their filters lie inside of the film.
const CROP: [u32; 4] = [2, 2, SIZE[0] - 2, SIZE[1] - 2];

/// Radiance that the pixel's own path brings.
const OWN: f32 = 0.5;

const NO_CLASS: [Spectrum; 7] = [Spectrum::ZERO; 7];

/// A task for each camera whose film points are found again to a small part of a pixel, with a filter each in turn.
pub(super) fn tasks() -> Vec<Task> {
    let wide = |camera: &Camera| {
        let pixel = camera.pixel_solid_angle(20, 15).sqrt();
        pixel == 0.0 || pixel > 1e-3
    };
    let cameras = specimens().into_iter().filter(|specimen| wide(&specimen.camera));
    cameras
        .zip(Filter::value_variants().iter().cycle())
        .map(|(Specimen { name, written, camera }, &filter)| {
            Task::new(C3, format!("{name}, {filter:?}"), move |trial, found| {
                check(&camera, written.lens, filter, trial, found);
            })
        })
        .collect()
}

/// What a film point carries, and what a pixel shows: (1, x/width, y/height).
fn pattern(at: Vec2) -> [f32; 3] {
    [1.0, at.x / SIZE[0] as f32, at.y / SIZE[1] as f32]
}

fn check(camera: &Camera, lens: Option<Lens>, filter: Filter, trial: &Trial, found: &mut Findings) {
    let layers = Layers::held(false);
    let mut film = Film::new(SIZE, CROP, &layers);
    let mut images = Vec::new();
    let (mut lost, mut invalid) = (0, 0);
    for replicate in 0..REPLICATES {
        let splats = Splats::new(&film);
        let points = trial.work(512u32, 8_192).next_power_of_two();
        // One sample of each pixel, and its share of the paths: area of the film over their number.
        let density = points as f32 / (SIZE[0] * SIZE[1]) as f32;
        for i in 0..points {
            let seed = hash(&[trial.seed, replicate]);
            let mut u = Sampler::new(Kind::Lattice, seed, [0, 0], i.into(), points);
            let at = Vec2::from(u.next_2d()) * vec2(SIZE[0] as f32, SIZE[1] as f32);
            match there_and_back(camera, lens, at, &mut u) {
                Some(back) => {
                    let radiance = Spectrum::from_rgb(pattern(at).map(|g| g / density));
                    invalid += usize::from(splats.add(filter, back, radiance, &NO_CLASS).is_some());
                }
                None => lost += 1,
            }
        }
        let mut sums = Replicate::new(&layers, CROP);
        let own = PixelSample { radiance: Spectrum::splat(OWN), ..PixelSample::default() };
        for pixel in film.pixels() {
            invalid += usize::from(sums.pixel(pixel).add(&own, &NO_CLASS).is_some());
        }
        sums.add_splats(&splats);
        let mut one = Film::new(SIZE, CROP, &layers);
        one.add(&sums);
        film.add(&sums);
        images.push(film.pixels().map(|[x, y]| one.mean(x, y)).collect());
    }
    found.checks.holds("every point is seen and counts", lost == 0 && invalid == 0);

    // The means are those of the pattern.
    let exact: Vec<[f64; 3]> = film
        .pixels()
        .map(|[x, y]| pattern(vec2(x as f32 + 0.5, y as f32 + 0.5)).map(|g| f64::from(g) + f64::from(OWN)))
        .collect();
    let size = [(CROP[2] - CROP[0]) as usize, (CROP[3] - CROP[1]) as usize];
    let replicated = Replicated { size, images };
    let exact = Estimated::new(size, &exact, &vec![[0.0; 3]; exact.len()], REPLICATES as u32);
    found.exhibits.extend(agreement(&mut found.checks, "∫ h g", &Estimated::from(&replicated), &exact));

    // The film's mean and error are those of the replicates.
    let (mut mean, mut error) = (0f64, 0f64);
    for ([x, y], moments) in film.pixels().zip(replicated.pixels()) {
        let stderr = film.stderr(x, y).unwrap_or([f64::NAN; 3]);
        for c in 0..3 {
            mean = mean.max((film.mean(x, y)[c] / moments[c].mean() - 1.0).abs());
            error = error.max((stderr[c] / moments[c].standard_error() - 1.0).abs());
        }
    }
    found.checks.bound("mean of the film = mean of the replicates, relative", mean, 1e-12);
    // A difference of squares, of which the spread may be a thousandth.
    found.checks.bound("error of the film = error of the replicates, relative", error, 1e-6);
}

/// Where a point on the ray of a film point is seen.
fn there_and_back(camera: &Camera, lens: Option<Lens>, at: Vec2, u: &mut Sampler) -> Option<Vec2> {
    let eye = camera.ray(at, [0.5; 2]).o;
    let ray = camera.ray(at, u.next_2d());
    // Where there is a lens, rays of a film point agree in the plane of focus only.
    let t = match lens {
        Some(lens) => (lens.focus_distance - (ray.o - eye).dot(camera.axis())) / ray.d.dot(camera.axis()),
        None => 1.0 + 9.0 * u.next_1d(),
    };
    camera.project(ray.at(t))
}
