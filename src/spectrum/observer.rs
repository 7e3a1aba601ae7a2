//! From spectra to lanes: what a reflectance that changes with the wavelength is in linear BT.709 RGB under D65.

use std::sync::LazyLock;

/// First wavelength of the tables \[nm\], and their step.
const FIRST: f64 = 380.0;
const STEP: f64 = 10.0;

/// x̄, ȳ, z̄ of the standard observer of 2° (CIE 1931), and the relative power of D65 (CIE 015:2018), every 10 nm.
const TABLE: [[f64; 4]; 41] = [
    [0.001368, 3.9e-05, 0.00645, 49.9755],
    [0.004243, 0.00012, 0.02005, 54.6482],
    [0.01431, 0.000396, 0.06785, 82.7549],
    [0.04351, 0.00121, 0.2074, 91.486],
    [0.13438, 0.004, 0.6456, 93.4318],
    [0.2839, 0.0116, 1.3856, 86.6823],
    [0.34828, 0.023, 1.74706, 104.865],
    [0.3362, 0.038, 1.77211, 117.008],
    [0.2908, 0.06, 1.6692, 117.812],
    [0.19536, 0.09098, 1.28764, 114.861],
    [0.09564, 0.13902, 0.81295, 115.923],
    [0.03201, 0.20802, 0.46518, 108.811],
    [0.0049, 0.323, 0.272, 109.354],
    [0.0093, 0.503, 0.1582, 107.802],
    [0.06327, 0.71, 0.07825, 104.79],
    [0.1655, 0.862, 0.04216, 107.689],
    [0.2904, 0.954, 0.0203, 104.405],
    [0.43345, 0.99495, 0.00875, 104.046],
    [0.5945, 0.995, 0.0039, 100.0],
    [0.7621, 0.952, 0.0021, 96.3342],
    [0.9163, 0.87, 0.00165, 95.788],
    [1.0263, 0.757, 0.0011, 88.6856],
    [1.0622, 0.631, 0.0008, 90.0062],
    [1.0026, 0.503, 0.00034, 89.5991],
    [0.85445, 0.381, 0.00019, 87.6987],
    [0.6424, 0.265, 5e-05, 83.2886],
    [0.4479, 0.175, 2e-05, 83.6992],
    [0.2835, 0.107, 0.0, 80.0268],
    [0.1649, 0.061, 0.0, 80.2146],
    [0.0874, 0.032, 0.0, 82.2778],
    [0.04677, 0.017, 0.0, 78.2842],
    [0.0227, 0.00821, 0.0, 69.7213],
    [0.011359, 0.004102, 0.0, 71.6091],
    [0.00579, 0.002091, 0.0, 74.349],
    [0.002899, 0.001047, 0.0, 61.604],
    [0.00144, 0.00052, 0.0, 69.8856],
    [0.00069, 0.000249, 0.0, 75.087],
    [0.000332, 0.00012, 0.0, 63.5927],
    [0.000166, 6e-05, 0.0, 46.4182],
    [8.3e-05, 3e-05, 0.0, 66.8054],
    [4.2e-05, 1.5e-05, 0.0, 63.3828],
];

/// XYZ to linear BT.709.
const BT709: [[f64; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266_0, 1.876_010_8, 0.041_556_0],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

/// Wavelengths \[nm\] every nanometre with the weight of each in R, G and B; the weights of a lane sum to 1, so that a
/// reflectance that is the same everywhere is that number in every lane.
///
/// ```text
/// R_lane = Σ w_lane(λ) R(λ),    w_lane ∝ D65(λ) Σ_j M_lane,j c̄_j(λ)
/// ```
///
/// Some weights are negative: BT.709 has no lamp for a pure colour.
pub static LANES: LazyLock<Vec<(f64, [f64; 3])>> = LazyLock::new(|| {
    let n = (TABLE.len() - 1) * STEP as usize;
    let mut lanes: Vec<_> = (0..=n).map(|i| (FIRST + i as f64, lanes_at(i as f64 / STEP))).collect();
    for k in 0..3 {
        let sum: f64 = lanes.iter().map(|(_, w)| w[k]).sum();
        lanes.iter_mut().for_each(|(_, w)| w[k] /= sum);
    }
    lanes
});

/// Power of D65 seen by each lane, `at` steps behind the first wavelength.
fn lanes_at(at: f64) -> [f64; 3] {
    let i = (at as usize).min(TABLE.len() - 2);
    let t = at - i as f64;
    let [x, y, z, power]: [f64; 4] = std::array::from_fn(|k| TABLE[i][k] * (1.0 - t) + TABLE[i + 1][k] * t);
    BT709.map(|row| power * (row[0] * x + row[1] * y + row[2] * z))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// D65 is the white of BT.709: x = 0.3127, y = 0.3290 (ITU-R BT.709-6, 1.4).
    #[test]
    fn the_table_has_its_white() {
        let sum = |k: usize| TABLE.iter().map(|row| row[k] * row[3]).sum::<f64>();
        let all = sum(0) + sum(1) + sum(2);
        let (x, y) = (sum(0) / all, sum(1) / all);
        assert!((x - 0.3127).abs() < 2e-4 && (y - 0.3290).abs() < 2e-4, "{x} {y}");
        // And so lanes that are not yet normalised are alike.
        let lanes: [f64; 3] = std::array::from_fn(|k| (0..TABLE.len()).map(|i| lanes_at(i as f64)[k]).sum());
        assert!(lanes.iter().all(|l| (l / lanes[1] - 1.0).abs() < 2e-3), "{lanes:?}");
    }

    #[test]
    fn colours_are_seen_as_such() {
        let of = |from: f64, to: f64| -> [f64; 3] {
            std::array::from_fn(|k| LANES.iter().filter(|(l, _)| (from..to).contains(l)).map(|(_, w)| w[k]).sum())
        };
        let [red, green, blue] = [of(600.0, 780.0), of(500.0, 580.0), of(400.0, 480.0)];
        assert!(red[0] > 0.5 && red[0] > 3.0 * red[1].abs().max(red[2].abs()), "{red:?}");
        assert!(green[1] > 0.5 && green[1] > green[0].max(green[2]), "{green:?}");
        assert!(blue[2] > 0.5 && blue[2] > 3.0 * blue[0].abs().max(blue[1].abs()), "{blue:?}");
    }
}
