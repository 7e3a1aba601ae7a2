//! What a run of random scenes knows of itself beside its checks: which scenes took unusually long, and how many another
//! renderer was asked about.

use super::mitsuba;
use crate::verify::report::count;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Times the median of all scenes, from which on one counts as slow. Images take as many rays in all scenes and a
/// thread of their own, so that half of all differ by less than two from the median, however busy the machine is.
const SLOW: f64 = 10.0;

/// Fewest scenes with a median to compare with.
const FEWEST: usize = 8;

/// Collects what tasks say, on whatever threads they run; copies share what they hold.
#[derive(Clone, Debug, Default)]
pub struct Tally(Arc<Mutex<Vec<Entry>>>);

/// What is known of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Entry {
    /// Number of the scene.
    pub index: u64,
    /// How long its first looks took, without what was looked at again.
    pub time: Duration,
    /// Mitsuba rendered it.
    pub compared: bool,
}

impl Tally {
    /// Takes a scene in.
    pub(super) fn add(&self, entry: Entry) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(entry);
    }

    /// What is to be said when all scenes were looked at, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut entries = self.0.lock().unwrap_or_else(PoisonError::into_inner).clone();
        entries.sort_by_key(|entry| entry.index);
        let mut notes = times(&entries);
        let compared = entries.iter().filter(|entry| entry.compared).count();
        notes.push(match mitsuba::python() {
            None => format!("Mitsuba was not asked: {} names no Python that has it", mitsuba::VARIABLE),
            Some(_) => format!("Mitsuba rendered {} of {} scenes", count(compared), count(entries.len())),
        });
        notes
    }
}

/// Median and longest time, and every scene that is slow.
fn times(entries: &[Entry]) -> Vec<String> {
    let mut times: Vec<Duration> = entries.iter().map(|entry| entry.time).collect();
    times.sort();
    if times.len() < FEWEST {
        return Vec::new();
    }
    let [median, longest] = [times[times.len() / 2], times[times.len() - 1]].map(|time| time.as_secs_f64());
    let mut notes = vec![format!("a scene's first look took {median:.2} s in the median and at most {longest:.2} s")];
    let factor = |entry: &Entry| entry.time.as_secs_f64() / median;
    notes.extend(entries.iter().filter(|entry| factor(entry) > SLOW).map(|entry| {
        format!(
            "scene {:05} is slow: {:.2} s, {:.0} times the median",
            entry.index,
            entry.time.as_secs_f64(),
            factor(entry)
        )
    }));
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_scenes_are_named() {
        let entry = |index: u64| Entry {
            index,
            time: Duration::from_millis(if index == 5 { 2500 } else { 100 + 10 * index }),
            compared: false,
        };
        let notes = times(&(0..12).map(entry).collect::<Vec<_>>());
        assert_eq!(notes.len(), 2, "{notes:?}");
        assert!(notes[0].contains("0.17 s in the median and at most 2.50 s"), "{notes:?}");
        assert!(notes[1].contains("scene 00005 is slow: 2.50 s, 15 times"), "{notes:?}");
        assert!(times(&[entry(5)]).is_empty(), "one scene alone is not slow");
    }
}
