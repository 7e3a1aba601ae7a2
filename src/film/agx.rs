//! AgX, Troy Sobotka's picture formation, rebuilt from its description: bright colours go to white the way film does it,
//! instead of clipping to the display's corners.

use glam::{DMat3, DVec3};

/// CIE xy of BT.709's primaries and of D65.
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
const WHITE: [f64; 2] = [0.3127, 0.3290];
/// Primaries of the curve's space are this many times as far from white as BT.709's, which brings colours nearer to grey.
const INSET: f64 = 1.0 / 0.8;
/// Stops below and above middle grey that are encoded.
const STOPS: (f64, f64) = (-10.0, 6.5);
const GREY: f64 = 0.18;
/// Display exponent of the curve's output.
const GAMMA: f64 = 2.2;
/// Slope of the sigmoid at middle grey, and the power of its toe and shoulder.
const SLOPE: f64 = 2.4;
const POWER: f64 = 1.5;

/// The transform with its matrices.
#[derive(Clone, Debug)]
pub(super) struct Agx {
    inset: DMat3,
    outset: DMat3,
}

impl Agx {
    /// The matrices follow from the two sets of primaries: inset = M(outer)⁻¹ M(709), M: RGB → XYZ.
    pub(super) fn new() -> Self {
        let outer = PRIMARIES.map(|p| [0, 1].map(|i| WHITE[i] + INSET * (p[i] - WHITE[i])));
        let inset = rgb_to_xyz(outer).inverse() * rgb_to_xyz(PRIMARIES);
        Self { inset, outset: inset.inverse() }
    }

    /// Linear BT.709 radiance → linear BT.709 display light, both with 1 as reference.
    pub(super) fn linear(&self, rgb: [f64; 3]) -> [f64; 3] {
        let curved = (self.inset * DVec3::from(rgb)).map(|x| sigmoid(encode(x)));
        (self.outset * curved).map(|code| code.max(0.0).powf(GAMMA)).to_array()
    }
}

/// log₂ of x over middle grey, [`STOPS`] mapped to [0, 1].
fn encode(x: f64) -> f64 {
    let stops = (x.max(1e-10) / GREY).log2();
    ((stops - STOPS.0) / (STOPS.1 - STOPS.0)).clamp(0.0, 1.0)
}

/// A curve through (0, 0), middle grey and (1, 1) with [`SLOPE`] at middle grey. Each side is, from that pivot,
///
/// ```text
/// y(t) = m t / (1 + (m t/s)^p)^(1/p),    s = m a / ((m a/b)^p − 1)^(1/p)
/// ```
///
/// with slope m, power p, and the scale s for which the far corner, a along and b up, is met: y(a) = b.
fn sigmoid(x: f64) -> f64 {
    let (px, py) = (-STOPS.0 / (STOPS.1 - STOPS.0), GREY.powf(1.0 / GAMMA));
    let side = |t: f64, a: f64, b: f64| {
        let s = SLOPE * a / ((SLOPE * a / b).powf(POWER) - 1.0).powf(1.0 / POWER);
        SLOPE * t / (1.0 + (SLOPE * t / s).powf(POWER)).powf(1.0 / POWER)
    };
    if x >= px { py + side(x - px, 1.0 - px, 1.0 - py) } else { py - side(px - x, px, py) }
}

fn rgb_to_xyz(primaries: [[f64; 2]; 3]) -> DMat3 {
    let xyz = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let m = DMat3::from_cols(xyz(primaries[0]), xyz(primaries[1]), xyz(primaries[2]));
    m * DMat3::from_diagonal(m.inverse() * xyz(WHITE))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curve_meets_its_points() {
        for (x, y) in [(0.0, 0.0), (10.0 / 16.5, GREY.powf(1.0 / GAMMA)), (1.0, 1.0)] {
            assert!((sigmoid(x) - y).abs() < 1e-12, "{x}: {} {y}", sigmoid(x));
        }
        let d = 1e-6;
        let slope = (sigmoid(10.0 / 16.5 + d) - sigmoid(10.0 / 16.5 - d)) / (2.0 * d);
        assert!((slope - SLOPE).abs() < 1e-3, "{slope}");
    }

    #[test]
    fn greys_stay_grey_and_middle_grey_stays() {
        let agx = Agx::new();
        for x in [1e-4, 0.02, GREY, 1.0, 12.0] {
            let [r, g, b] = agx.linear([x; 3]);
            assert!((r - g).abs() < 1e-9 && (b - g).abs() < 1e-9, "{r} {g} {b}");
        }
        assert!((agx.linear([GREY; 3])[1] - GREY).abs() < 1e-9);
    }

    #[test]
    fn bright_colours_turn_white() {
        let agx = Agx::new();
        let saturation = |x: f64| {
            let [r, g, _] = agx.linear([x, 0.02 * x, 0.02 * x]);
            (r - g) / r
        };
        assert!(saturation(0.2) > saturation(4.0) && saturation(4.0) > saturation(100.0));
    }
}
