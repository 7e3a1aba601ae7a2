//! The family, for tests and verification: every kind of numbers, with sizes of replicates.

use super::{Kind, Sampler};

/// Numbers of a kind, in replicates of a size.
#[derive(Clone, Copy, Debug)]
pub struct Specimen {
    /// Name for reports.
    pub name: &'static str,
    /// Where the numbers come from.
    pub kind: Kind,
    /// Samples of an independent replicate.
    pub replicate: u32,
}

/// Every kind, with sizes of replicates on both sides of what bytes can count.
pub fn specimens() -> Vec<Specimen> {
    [
        ("independent", Kind::Independent, 64),
        ("Sobol, replicates of 4", Kind::Sobol, 4),
        ("Sobol, replicates of 64", Kind::Sobol, 64),
        ("Sobol, replicates of 512", Kind::Sobol, 512),
        ("lattice, replicates of 4", Kind::Lattice, 4),
        ("lattice, replicates of 64", Kind::Lattice, 64),
        ("lattice, replicates of 512", Kind::Lattice, 512),
    ]
    .map(|(name, kind, replicate)| Specimen { name, kind, replicate })
    .into()
}

impl Specimen {
    /// The numbers of sample `index` of `pixel`, from `dimension` on.
    pub fn at(&self, seed: u64, pixel: [u32; 2], index: u64, dimension: u32) -> Sampler {
        let mut sampler = Sampler::new(self.kind, seed, pixel, index, self.replicate);
        sampler.skip_to(dimension);
        sampler
    }
}
