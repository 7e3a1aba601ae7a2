//! Metals by name.

use crate::desc::Fresnel;

/// Symbol, η and κ for R, G, B.
const METALS: [(&str, [f32; 3], [f32; 3]); 6] = [
    ("Ag", [0.155_265, 0.116_723, 0.138_381], [4.828_34, 3.122_25, 2.147_05]),
    ("Al", [1.657_460, 0.880_369, 0.521_229], [9.223_87, 6.269_52, 4.837_00]),
    ("Au", [0.143_119, 0.374_957, 1.442_479], [3.983_16, 2.385_72, 1.603_22]),
    ("Cr", [4.369_683, 2.916_702, 1.654_701], [5.206_43, 4.231_36, 3.754_95]),
    ("Cu", [0.200_438, 0.924_033, 1.102_212], [3.912_95, 2.452_85, 2.142_19]),
    ("W", [4.370_703, 3.300_297, 2.998_267], [3.500_68, 2.604_87, 2.273_19]),
];

/// The index of refraction of a metal.
pub(super) fn fresnel(symbol: &str) -> Option<Fresnel> {
    METALS.iter().find(|(name, ..)| *name == symbol).map(|(_, eta, k)| Fresnel::Complex { eta: *eta, k: *k })
}

/// The symbols that are known.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    METALS.iter().map(|(name, ..)| *name)
}
