//! Metals by name.
//!
//! Measured indices of refraction η − iκ (evaporated films, room temperature), interpolated linearly to the dominant
//! wavelengths of the BT.709 primaries under D65: 611.4, 549.1 and 464.2 nm. An RGB renderer has three numbers for a
//! curve; at these three wavelengths they are the measured ones.
//!
//! Sources: Johnson and Christy 1972 (doi 10.1103/PhysRevB.6.4370) for Ag, Au, Cu; Johnson and Christy 1974
//! (doi 10.1103/PhysRevB.9.5056) for Cr, Fe, Ni, Ti; Rakić 1995 (doi 10.1364/AO.34.004755) for Al.

use crate::desc::Fresnel;

/// Symbol, η and κ for R, G, B.
const METALS: [(&str, [f32; 3], [f32; 3]); 8] = [
    ("Ag", [0.058, 0.060, 0.046], [4.106, 3.590, 2.795]),
    ("Al", [1.322, 1.011, 0.683], [7.311, 6.617, 5.625]),
    ("Au", [0.222, 0.428, 1.335], [3.208, 2.461, 1.872]),
    ("Cr", [3.178, 3.180, 2.449], [3.300, 3.330, 3.206]),
    ("Cu", [0.362, 1.015, 1.246], [3.127, 2.579, 2.453]),
    ("Fe", [2.890, 2.950, 2.643], [3.040, 2.930, 2.803]),
    ("Ni", [1.985, 1.920, 1.763], [3.985, 3.611, 3.042]),
    ("Ti", [2.659, 2.540, 2.303], [3.698, 3.430, 3.080]),
];

/// The index of refraction of a metal.
pub(super) fn fresnel(symbol: &str) -> Option<Fresnel> {
    METALS.iter().find(|(name, ..)| *name == symbol).map(|(_, eta, k)| Fresnel::Complex { eta: *eta, k: *k })
}

/// The symbols that are known.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    METALS.iter().map(|(name, ..)| *name)
}
