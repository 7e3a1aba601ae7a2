//! Numbers in [0, 1). A number is a pure function of (seed, pixel, index, dimension): nothing depends on which thread
//! takes a sample, in which order, or what was taken before.
//!
//! Sample `index` of a pixel belongs to replicate `index / replicate`. Replicates are independent of each other, so
//! the spread of their means is the error of the whole, for low-discrepancy points too.

mod hash;
mod independent;
mod lattice;
mod sobol;
mod specimens;

pub use hash::{hash, mix};
pub use independent::Independent;
pub use lattice::Lattice;
pub use sobol::{Sobol, owen_scramble, sobol_2d};
pub use specimens::{Specimen, specimens};

/// Where the numbers come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Independent pseudo-random numbers (PCG).
    Independent,
    /// Owen-scrambled Sobol points.
    Sobol,
    /// Rank-1 lattices, shifted and jittered.
    #[default]
    Lattice,
}

/// The numbers of one sample of one pixel, dimension after dimension.
#[derive(Clone, Debug)]
pub enum Sampler {
    /// Independent pseudo-random numbers (PCG).
    Independent(Independent),
    /// Owen-scrambled Sobol points.
    Sobol(Sobol),
    /// Rank-1 lattices, shifted and jittered.
    Lattice(Lattice),
}

impl Sampler {
    /// At dimension 0 of sample `index` of `pixel`. `replicate` is the number of samples of an independent replicate,
    /// a power of two (others are rounded up to one); [`Kind::Independent`] does not ask for it.
    #[inline]
    pub fn new(kind: Kind, seed: u64, pixel: [u32; 2], index: u64, replicate: u32) -> Self {
        match kind {
            Kind::Independent => Self::Independent(Independent::new(seed, pixel, index)),
            Kind::Sobol => Self::Sobol(Sobol::new(seed, pixel, index, replicate)),
            Kind::Lattice => Self::Lattice(Lattice::new(seed, pixel, index, replicate)),
        }
    }

    /// The number at this dimension; goes on to the next.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        match self {
            Self::Independent(s) => s.next_1d(),
            Self::Sobol(s) => s.next_1d(),
            Self::Lattice(s) => s.next_1d(),
        }
    }

    /// The pair at this dimension and the next, well spread together; goes on by two.
    #[inline(always)]
    pub fn next_2d(&mut self) -> [f32; 2] {
        match self {
            Self::Lattice(s) => s.next_2d(),
            other => other.next_2d_elsewhere(),
        }
    }

    /// Two numbers of any sampler but a lattice; outlined, so that lattices are computed in place.
    #[inline(never)]
    fn next_2d_elsewhere(&mut self) -> [f32; 2] {
        match self {
            Self::Independent(s) => s.next_2d(),
            Self::Sobol(s) => s.next_2d(),
            Self::Lattice(s) => s.next_2d(),
        }
    }

    /// Goes to `dimension`, forwards or backwards.
    #[inline]
    pub fn skip_to(&mut self, dimension: u32) {
        match self {
            Self::Independent(s) => s.skip_to(dimension),
            Self::Sobol(s) => s.skip_to(dimension),
            Self::Lattice(s) => s.skip_to(dimension),
        }
    }

    /// Numbers of a branch, at dimension 0: as well spread over the samples of a pixel as these, and independent of them
    /// and of every other branch's. For what needs an unknown count of numbers, such as the opacities along a ray, or
    /// the branches of a tree: it then shifts no dimension of what comes after it.
    #[inline(never)]
    pub fn fork(&self, branch: u32) -> Self {
        match self {
            Self::Independent(s) => Self::Independent(s.fork(branch)),
            Self::Sobol(s) => Self::Sobol(s.fork(branch)),
            Self::Lattice(s) => Self::Lattice(s.fork(branch)),
        }
    }

    /// The dimension that comes next.
    #[inline]
    pub fn dimension(&self) -> u32 {
        match self {
            Self::Independent(s) => s.dimension(),
            Self::Sobol(s) => s.dimension(),
            Self::Lattice(s) => s.dimension(),
        }
    }
}

/// The upper 24 bits as a multiple of 2⁻²⁴ in [0, 1).
#[inline]
fn unit(bits: u32) -> f32 {
    unit_24(bits >> 8)
}

/// A number below 2²⁴ as a multiple of 2⁻²⁴ in [0, 1).
#[inline]
fn unit_24(bits: u32) -> f32 {
    bits as f32 * (1.0 / (1 << 24) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_never_reached() {
        assert_eq!(unit(0), 0.0);
        assert_eq!(unit(u32::MAX), crate::warp::ONE_MINUS_EPSILON);
    }

    #[test]
    fn branches_have_numbers_of_their_own() {
        for kind in [Kind::Independent, Kind::Sobol, Kind::Lattice] {
            let mut trunk = Sampler::new(kind, 7, [3, 5], 70_000, 64);
            let first = |mut s: Sampler| s.next_1d();
            let mut numbers = vec![first(trunk.clone())];
            numbers.extend((0..50).map(|k| first(trunk.fork(k))));
            numbers.extend((0..50).map(|k| first(trunk.fork(3).fork(k))));
            // Wherever the trunk is.
            trunk.skip_to(40);
            assert_eq!(first(trunk.fork(2)), numbers[3]);
            assert_eq!(trunk.fork(2).dimension(), 0);
            numbers.sort_by(f32::total_cmp);
            assert!(numbers.windows(2).all(|pair| pair[0] != pair[1]), "{kind:?}");
        }
    }

    #[test]
    fn numbers_are_a_function_of_place_alone() {
        for kind in [Kind::Independent, Kind::Sobol, Kind::Lattice] {
            let at = |index| Sampler::new(kind, 7, [3, 5], index, 64);
            let mut straight = at(70_000);
            let numbers: Vec<f32> = (0..40).map(|_| straight.next_1d()).collect();
            for d in (0..40).rev() {
                let mut s = at(70_000);
                s.next_2d();
                s.skip_to(d);
                assert_eq!((s.dimension(), s.next_1d(), s.dimension()), (d, numbers[d as usize], d + 1));
            }
            assert_ne!(at(70_001).next_1d(), numbers[0]);
        }
    }
}
