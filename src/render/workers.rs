//! Workers in a rayon pool that come when there is work and leave when there is none.

use rayon::Scope;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Does all jobs: every thread of the pool that is free takes the `next` and does its `work`, which says how many workers that
/// have left are wanted again. No worker waits for another, so that renders may be nested in other work of the pool.
pub(super) fn run<J: Send>(next: &(impl Fn() -> Option<J> + Sync), work: &(impl Fn(&J) -> usize + Sync)) {
    let threads = rayon::current_num_threads();
    let busy = (0..threads).map(|_| AtomicBool::new(false)).collect();
    let workers = Workers { next, work, busy, turned_away: AtomicUsize::new(0) };
    rayon::scope(|scope| (0..threads).for_each(|_| workers.spawn(scope)));
}

struct Workers<'a, N, W> {
    next: &'a N,
    work: &'a W,
    /// Threads that are in a job.
    busy: Vec<AtomicBool>,
    /// Workers that came on a thread that was.
    turned_away: AtomicUsize,
}

impl<J: Send, N: Fn() -> Option<J> + Sync, W: Fn(&J) -> usize + Sync> Workers<'_, N, W> {
    fn spawn<'s>(&'s self, scope: &Scope<'s>) {
        scope.spawn(|scope| {
            // A job may wait for others of the pool, and its thread do what lies next: no second job inside of the first, which
            // may hold what that needs.
            let busy = rayon::current_thread_index().and_then(|thread| self.busy.get(thread));
            if busy.is_some_and(|busy| busy.swap(true, Ordering::Relaxed)) {
                self.turned_away.fetch_add(1, Ordering::Relaxed);
                return;
            }
            while let Some(job) = (self.next)() {
                let wanted = (self.work)(&job) + self.turned_away.swap(0, Ordering::Relaxed);
                (0..wanted).for_each(|_| self.spawn(scope));
            }
            if let Some(busy) = busy {
                busy.store(false, Ordering::Relaxed);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_jobs_are_done_once_and_never_inside_of_another() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
        let (next, inside) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let done: Vec<AtomicUsize> = (0..200).map(|_| AtomicUsize::new(0)).collect();
        let threads: Vec<AtomicBool> = (0..4).map(|_| AtomicBool::new(false)).collect();
        let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|job| *job < done.len());
        let work = |job: &usize| {
            let thread = &threads[rayon::current_thread_index().unwrap()];
            inside.fetch_add(usize::from(thread.swap(true, Ordering::Relaxed)), Ordering::Relaxed);
            // Work that the pool shares, during which a thread does what lies next.
            rayon::join(
                || std::hint::black_box((0..20_000u64).sum::<u64>()),
                || done[*job].fetch_add(1, Ordering::Relaxed),
            );
            thread.store(false, Ordering::Relaxed);
            0
        };
        pool.install(|| run(&take, &work));
        assert!(done.iter().all(|n| n.load(Ordering::Relaxed) == 1));
        assert_eq!(inside.into_inner(), 0);
    }

    #[test]
    fn workers_that_left_come_back_when_they_are_wanted() {
        // A job at a time is known; whoever does it wants another worker for the next.
        let (known, taken, left) = (AtomicUsize::new(1), AtomicUsize::new(0), AtomicUsize::new(0));
        let take = || {
            let job = taken.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |n| {
                (n < known.load(Ordering::SeqCst)).then_some(n + 1)
            });
            left.fetch_add(usize::from(job.is_err()), Ordering::SeqCst);
            job.ok()
        };
        let work = |job: &usize| {
            if *job < 50 {
                known.fetch_add(1, Ordering::SeqCst);
            }
            left.swap(0, Ordering::SeqCst)
        };
        run(&take, &work);
        assert_eq!(taken.into_inner(), 51);
    }
}
