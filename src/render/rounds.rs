//! Rounds: one replicate of the pixels that a schedule asks for, tile by tile. Work → merge in order → decide what comes next.

use super::plan::{Plan, Replicates};
use super::schedule::{Next, Pixels, Schedule};
use super::{BadSample, Tile};
use crate::film::{Film, Splats};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Most bad samples that are listed one by one.
const LISTED: usize = 100;

/// Rounds with splats that may be under way beside the oldest: each holds the sums of all its pixels.
const SPLATTED_AHEAD: usize = 1;

/// All rounds of a render. Workers take jobs and put tiles; no call waits for another worker's work.
pub(super) struct Rounds<'a> {
    schedule: &'a Schedule,
    tiles: usize,
    splatted: bool,
    state: Mutex<State>,
}

/// A tile in a round.
pub(super) struct Job {
    round: u32,
    /// Number of the tile.
    pub(super) tile: usize,
    /// What its round does.
    pub(super) plan: Arc<Plan>,
}

struct State {
    film: Film,
    /// Of every tile: how many rounds are in the film, and later ones that have ended.
    tiles: Vec<(u32, Vec<(u32, Tile)>)>,
    /// Rounds in the film, all tiles of them.
    complete: u32,
    /// Rounds under way, from number `complete` on.
    open: VecDeque<Open>,
    /// The next tile of the youngest of them.
    next_tile: usize,
    /// What was decided and has not begun.
    decided: VecDeque<Next>,
    /// Replicates that pixels have begun.
    begun: Replicates,
    /// No round begins any more.
    ended: bool,
    /// Workers that found nothing to do while there may yet be something.
    idle: usize,
    relative_error: f64,
    bad: Vec<BadSample>,
    bad_count: u64,
}

/// A round that is under way.
struct Open {
    plan: Arc<Plan>,
    /// Tiles that have ended, and those that are in the film.
    ended: usize,
    merged: usize,
}

/// What became of a tile.
pub(super) struct Put {
    /// The film's relative error after the last complete round.
    pub(super) relative_error: f64,
    /// Workers that left for want of work, for which there is some now.
    pub(super) wanted: usize,
}

/// What rounds have made.
pub(super) struct Done {
    pub(super) film: Film,
    /// Complete rounds.
    pub(super) rounds: u32,
    /// The first bad samples, and how many there were.
    pub(super) bad: Vec<BadSample>,
    pub(super) bad_count: u64,
}

impl<'a> Rounds<'a> {
    /// Rounds over an empty film that is covered by so many tiles. `splatted`: whether paths bring light to other pixels than
    /// their own.
    pub(super) fn new(film: Film, tiles: usize, schedule: &'a Schedule, splatted: bool) -> Self {
        let first = match schedule {
            Schedule::Fixed(_) => VecDeque::new(),
            Schedule::Adaptive { lag, decide } => (0..=*lag).map(|round| decide(round, &film)).collect(),
        };
        let state = State {
            film,
            tiles: (0..tiles).map(|_| (0, Vec::new())).collect(),
            complete: 0,
            open: VecDeque::new(),
            next_tile: 0,
            decided: first,
            begun: Replicates::Same(0),
            ended: false,
            idle: 0,
            relative_error: f64::NAN,
            bad: Vec::new(),
            bad_count: 0,
        };
        Self { schedule, tiles, splatted, state: Mutex::new(state) }
    }

    /// The next tile: of the youngest round, or of one that begins, if `may_begin` allows its number. `None`: there is nothing
    /// to do now, or never again.
    pub(super) fn take(&self, may_begin: impl Fn(u32) -> bool) -> Option<Job> {
        let state = &mut *self.lock();
        while state.open.is_empty() || state.next_tile == self.tiles {
            if !self.begin(state, &may_begin) {
                state.idle += usize::from(!state.ended);
                return None;
            }
        }
        let (tile, plan) = (state.next_tile, Arc::clone(&state.open.back()?.plan));
        state.next_tile += 1;
        Some(Job { round: state.complete + state.open.len() as u32 - 1, tile, plan })
    }

    /// Whether a round begins.
    fn begin(&self, state: &mut State, may_begin: impl Fn(u32) -> bool) -> bool {
        let round = state.complete + state.open.len() as u32;
        if !self.can_begin(state) {
            return false;
        }
        let next = match self.schedule {
            Schedule::Fixed(rounds) if round < *rounds => Next::Sample(Pixels::All),
            Schedule::Fixed(_) => Next::Stop,
            Schedule::Adaptive { .. } => state.decided.pop_front().unwrap_or(Next::Stop),
        };
        let pixels = match next {
            Next::Sample(pixels) if self.tiles > 0 && may_begin(round) => pixels,
            _ => {
                state.ended = true;
                return false;
            }
        };
        let [x0, y0, x1, y1] = state.film.crop();
        // What the paths of any pixel may add to is a replicate of all pixels.
        let pixels = if self.splatted { Pixels::All } else { pixels };
        let replicates = state.begun.advance(pixels, (x1 - x0) as usize * (y1 - y0) as usize);
        let splats = self.splatted.then(|| Splats::new(&state.film));
        state.open.push_back(Open { plan: Arc::new(Plan { replicates, splats }), ended: 0, merged: 0 });
        state.next_tile = 0;
        true
    }

    /// Whether anything is known of the next round, and it may be under way beside those that are.
    fn can_begin(&self, state: &State) -> bool {
        let decided = matches!(self.schedule, Schedule::Fixed(_)) || !state.decided.is_empty();
        decided && !state.ended && !(self.splatted && state.open.len() > SPLATTED_AHEAD)
    }

    /// Takes the tile that a job has made. It enters the film in the order of rounds, since sums of f64 are the same only in
    /// the same order: as soon as the tile's earlier rounds are there; or, where a decision looks at the film or a round has
    /// splats, once its round is whole.
    pub(super) fn put(&self, job: &Job, done: Tile) -> Put {
        let state = &mut *self.lock();
        state.tiles[job.tile].1.push((job.round, done));
        let place = (job.round - state.complete) as usize;
        state.open[place].ended += 1;
        if self.splatted || matches!(self.schedule, Schedule::Adaptive { .. }) {
            while state.open.front().is_some_and(|round| round.ended == self.tiles) {
                (0..self.tiles).for_each(|tile| state.merge(tile, state.complete));
                self.complete(state);
            }
        } else {
            state.merge(job.tile, u32::MAX);
            while state.open.front().is_some_and(|round| round.merged == self.tiles) {
                self.complete(state);
            }
        }
        let work = !state.open.is_empty() && state.next_tile < self.tiles || self.can_begin(state);
        Put { relative_error: state.relative_error, wanted: if work { std::mem::take(&mut state.idle) } else { 0 } }
    }

    /// The oldest round is in the film, and no later one where anybody looks: decides what it decides.
    fn complete(&self, state: &mut State) {
        state.open.pop_front();
        state.complete += 1;
        state.relative_error = state.film.relative_error();
        if let Schedule::Adaptive { lag, decide } = self.schedule
            && !state.ended
            && state.decided.back() != Some(&Next::Stop)
        {
            let next = decide(state.complete + lag, &state.film);
            state.decided.push_back(next);
        }
    }

    /// The film and what is known of it.
    pub(super) fn finish(self) -> Done {
        let State { film, complete, mut bad, bad_count, .. } =
            self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        first_bad(&mut bad);
        Done { film, rounds: complete, bad, bad_count }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Adds to the film what is there of a tile, up to round `last` and as long as none is missing.
    fn merge(&mut self, tile: usize, last: u32) {
        loop {
            let (next, early) = &mut self.tiles[tile];
            let Some(i) = early.iter().position(|(round, _)| round == next && *round <= last) else { break };
            let (round, mut done) = early.swap_remove(i);
            *next += 1;
            let open = &mut self.open[(round - self.complete) as usize];
            open.merged += 1;
            if let Some(splats) = &open.plan.splats {
                done.sums.add_splats(splats);
            }
            self.film.add(&done.sums);
            self.bad_count += done.bad.len() as u64;
            self.bad.extend(done.bad);
            if self.bad.len() > 4 * LISTED {
                first_bad(&mut self.bad);
            }
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
    use crate::desc::Filter;
    use crate::film::{Layers, PixelSample, Replicate};
    use crate::spectrum::Spectrum;
    use glam::Vec2;

    const NO_CLASS: [Spectrum; 7] = [Spectrum::ZERO; 7];

    /// Two pixels, a tile each.
    fn film() -> Film {
        Film::new([2, 1], [0, 0, 2, 1], &Layers::held(false))
    }

    /// 1e17 + 1 − 1 is not 1 − 1 + 1e17 in f64, so that the order shows.
    fn radiance(round: u32, tile: usize) -> f32 {
        [1e17, 1.0, 3.0, 7.0][(round as usize + tile) % 4]
    }

    /// What a job makes; with splats into the other pixel.
    fn tile(job: &Job) -> Tile {
        let x = job.tile as u32;
        let mut sums = Replicate::new(&Layers::held(false), [x, 0, x + 1, 1]);
        if job.plan.replicate(job.tile).is_some() {
            let radiance = Spectrum::splat(radiance(job.round, job.tile));
            sums.pixel([x, 0]).add(&PixelSample { radiance, ..PixelSample::default() }, &NO_CLASS);
        }
        if let Some(splats) = &job.plan.splats {
            let other = Vec2::new(1.5 - x as f32, 0.5);
            splats.add(Filter::Box, other, Spectrum::splat(0.1 + radiance(job.round, 1)), &NO_CLASS);
        }
        Tile { sums, samples: 1, rays: 0, bad: Vec::new() }
    }

    /// All rounds, with so many jobs under way, of which each time the `pick`th ends; and the errors that were told.
    fn run(schedule: &Schedule, splatted: bool, workers: usize, pick: impl Fn(usize) -> usize) -> (Film, Vec<f64>) {
        let rounds = Rounds::new(film(), 2, schedule, splatted);
        let (mut under_way, mut errors) = (Vec::new(), Vec::new());
        loop {
            while under_way.len() < workers
                && let Some(job) = rounds.take(|_| true)
            {
                under_way.push(job);
            }
            if under_way.is_empty() {
                return (rounds.finish().film, errors);
            }
            let job: Job = under_way.swap_remove(pick(errors.len()) % under_way.len());
            errors.push(rounds.put(&job, tile(&job)).relative_error);
        }
    }

    /// More of the brighter pixel, until it has four.
    fn adaptive(lag: u32) -> Schedule {
        let decide = |round: u32, film: &Film| match film.replicates(0, 0).max(film.replicates(1, 0)) {
            4.. => Next::Stop,
            _ if round % 3 == 2 => Next::Sample(Pixels::All),
            _ => {
                let brighter = film.mean(0, 0) > film.mean(1, 0);
                Next::Sample(Pixels::These(vec![brighter, !brighter]))
            }
        };
        Schedule::Adaptive { lag, decide: Box::new(decide) }
    }

    #[test]
    fn tiles_that_end_early_wait_for_those_before() {
        let (straight, errors) = run(&Schedule::Fixed(4), false, 1, |_| 0);
        assert!(errors.len() == 8 && errors[2].is_nan() && errors[3].is_finite());
        assert_eq!((straight.replicates(0, 0), straight.replicates(1, 0)), (4, 4));
        for workers in [2, 3, 8] {
            for step in [0, 1, 3, 5, 7] {
                assert_eq!(run(&Schedule::Fixed(4), false, workers, |n| n * step + step).0, straight);
            }
        }
    }

    #[test]
    fn a_replicate_with_splats_is_whole_before_it_is_squared() {
        let (straight, _) = run(&Schedule::Fixed(4), true, 1, |_| 0);
        for workers in [2, 3, 8] {
            for step in [0, 1, 3, 5] {
                assert_eq!(run(&Schedule::Fixed(4), true, workers, |n| n * step + step).0, straight);
            }
        }
        // S of each round is the pixel's own radiance and what the other pixel's path brought.
        let sums: Vec<f64> = (0..4).map(|r| f64::from(radiance(r, 1)) + f64::from(0.1 + radiance(r, 1))).collect();
        let mean = sums.iter().sum::<f64>() / 4.0;
        let variance = sums.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / 12.0;
        assert!((straight.mean(1, 0)[0] / mean - 1.0).abs() < 1e-12);
        assert!((straight.stderr(1, 0).unwrap()[0] / variance.sqrt() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn decisions_see_whole_rounds_alone() {
        for lag in [0, 1, 2] {
            for splatted in [false, true] {
                let (straight, _) = run(&adaptive(lag), splatted, 1, |_| 0);
                assert_eq!(straight.replicates(0, 0) == straight.replicates(1, 0), splatted, "lag {lag}");
                for workers in [2, 3, 8] {
                    for step in [0, 1, 3, 5] {
                        let (film, _) = run(&adaptive(lag), splatted, workers, |n| n * step + step);
                        assert_eq!(film, straight, "lag {lag}, {workers} workers");
                    }
                }
            }
        }
    }

    #[test]
    fn nobody_waits_while_the_next_round_is_known() {
        // With a lag of 1 both rounds are under way from the start; with none a worker leaves, and is called back.
        let jobs = |lag| {
            let schedule = adaptive(lag);
            let rounds = Rounds::new(film(), 2, &schedule, false);
            let jobs: Vec<Job> = std::iter::from_fn(|| rounds.take(|_| true)).collect();
            let wanted: Vec<usize> = jobs.iter().map(|job| rounds.put(job, tile(job)).wanted).collect();
            (jobs.len(), wanted)
        };
        assert_eq!(jobs(0), (2, vec![0, 1]));
        assert_eq!(jobs(1), (4, vec![0, 1, 0, 0]));
    }

    #[test]
    fn rounds_end_when_they_may_not_begin() {
        let rounds = Rounds::new(film(), 2, &Schedule::Fixed(9), false);
        while let Some(job) = rounds.take(|round| round < 2) {
            rounds.put(&job, tile(&job));
        }
        assert_eq!(rounds.finish().rounds, 2);
    }
}
