//! The numbers stay below one and are functions of their place. Uniformity, independence and nets are rows of the battery.

use proptest::prelude::*;
use radianza::sampler::{Kind, Sampler};

const KINDS: [Kind; 3] = [Kind::Independent, Kind::Sobol, Kind::Lattice];

/// Sizes of replicates that take both ways of computing a Sobol point.
const REPLICATES: [u32; 2] = [64, 1024];

/// The pair at `dimension` of one sample.
fn pair(kind: Kind, seed: u64, pixel: [u32; 2], index: u64, replicate: u32, dimension: u32) -> [f32; 2] {
    let mut sampler = Sampler::new(kind, seed, pixel, index, replicate);
    sampler.skip_to(dimension);
    sampler.next_2d()
}

#[test]
fn number_never_reaches_one() {
    for kind in KINDS {
        for replicate in REPLICATES {
            for index in 0..20_000 {
                let mut s = Sampler::new(kind, 0, [0, 0], index, replicate);
                for _ in 0..20 {
                    assert!((0.0..1.0).contains(&s.next_1d()));
                }
            }
        }
    }
}

proptest! {
    #[test]
    fn a_sample_is_a_function_of_its_place(seed in any::<u64>(), pixel in any::<[u32; 2]>(), index in any::<u64>(),
                                           log in 0u32..32, dimension in any::<u32>()) {
        for kind in KINDS {
            let u = pair(kind, seed, pixel, index, 1 << log, dimension);
            prop_assert!(u.iter().all(|x| (0.0..1.0).contains(x)));
            prop_assert_eq!(u, pair(kind, seed, pixel, index, 1 << log, dimension));
        }
    }
}
