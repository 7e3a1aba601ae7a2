//! Passes over the image, one replicate of every pixel each, whose tiles end in any order.

use super::{BadSample, Tile};
use crate::film::Film;
use std::sync::{Mutex, PoisonError};

/// Most bad samples that are listed one by one.
const LISTED: usize = 100;

/// What all workers add to.
pub(super) struct Passes(Mutex<Sums>);

struct Sums {
    film: Film,
    /// Of every tile: how many passes are in the film, and later ones that ended first.
    tiles: Vec<(u32, Vec<(u32, Tile)>)>,
    /// Of every pass: how many of its tiles are in the film.
    complete: Vec<usize>,
    relative_error: f64,
    bad: Vec<BadSample>,
    bad_count: u64,
}

impl Passes {
    /// An empty film that is covered by so many tiles.
    pub(super) fn new(film: Film, tiles: usize) -> Self {
        Self(Mutex::new(Sums {
            film,
            tiles: (0..tiles).map(|_| (0, Vec::new())).collect(),
            complete: Vec::new(),
            relative_error: f64::NAN,
            bad: Vec::new(),
            bad_count: 0,
        }))
    }

    /// Adds a tile of a pass, as soon as all earlier passes of that tile are there: sums of f64 are the same only in the
    /// same order. Returns the film's relative error after the last complete pass.
    pub(super) fn add(&self, pass: u32, tile: usize, done: Tile) -> f64 {
        let mut sums = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        sums.tiles[tile].1.push((pass, done));
        loop {
            let (next, early) = &mut sums.tiles[tile];
            let Some(i) = early.iter().position(|(pass, _)| pass == next) else { break };
            let (pass, done) = early.swap_remove(i);
            *next += 1;
            sums.put(pass as usize, done);
        }
        sums.relative_error
    }

    /// The film, the first bad samples, and how many there were.
    pub(super) fn finish(self) -> (Film, Vec<BadSample>, u64) {
        let Sums { film, mut bad, bad_count, .. } = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        first_bad(&mut bad);
        (film, bad, bad_count)
    }
}

impl Sums {
    fn put(&mut self, pass: usize, tile: Tile) {
        self.film.add(&tile.sums);
        self.bad_count += tile.bad.len() as u64;
        self.bad.extend(tile.bad);
        if self.bad.len() > 4 * LISTED {
            first_bad(&mut self.bad);
        }
        if pass >= self.complete.len() {
            self.complete.resize(pass + 1, 0);
        }
        self.complete[pass] += 1;
        if self.complete[pass] == self.tiles.len() {
            self.relative_error = self.film.relative_error();
        }
    }
}

/// Keeps the first bad samples by index and place, whichever worker met them when.
fn first_bad(bad: &mut Vec<BadSample>) {
    bad.sort_by_key(|b| (b.index, b.pixel[1], b.pixel[0]));
    bad.truncate(LISTED);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Layers, PixelSample, Replicate};
    use crate::spectrum::Spectrum;

    #[test]
    fn tiles_that_end_early_wait_for_those_before() {
        let tile = |radiance: f32, x: u32| {
            let mut sums = Replicate::new(&Layers::held(false), [x, 0, x + 1, 1]);
            let sample = PixelSample { radiance: Spectrum::splat(radiance), ..PixelSample::default() };
            sums.add([x, 0], &sample, &[Spectrum::ZERO; 7]);
            Tile { sums, samples: 1, rays: 0, bad: Vec::new() }
        };
        // 1e16 + 1 − 1 is not 1 − 1 + 1e16 in f64, so that the order shows.
        let radiance = |pass: u32, tile: usize| [1e17f32, 1.0, 3.0, 7.0][(pass as usize + tile) % 4];
        let film = |order: &[(u32, usize)]| {
            let passes = Passes::new(Film::new([2, 1], [0, 0, 2, 1], &Layers::held(false)), 2);
            let errors: Vec<f64> =
                order.iter().map(|&(p, t)| passes.add(p, t, tile(radiance(p, t), t as u32))).collect();
            (passes.finish().0, errors)
        };
        let (straight, errors) = film(&[(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1), (3, 0), (3, 1)]);
        assert!(errors[2].is_nan() && errors[3].is_finite());
        for order in [
            [(1, 0), (0, 1), (3, 0), (2, 0), (1, 1), (0, 0), (2, 1), (3, 1)],
            [(3, 1), (2, 1), (1, 1), (0, 1), (3, 0), (2, 0), (1, 0), (0, 0)],
        ] {
            assert_eq!(film(&order).0, straight);
        }
    }
}
