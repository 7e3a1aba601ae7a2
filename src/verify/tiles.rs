//! Estimates of parts of an image that are honest about what they have not seen.

use super::measure::REPLICATES;
use super::replicated::{Area, Replicated};
use crate::stats::{Moments, two_sided_t};

/// Tiles along the longer side of an image: large enough for a tile to see most kinds of paths, small enough to show
/// faults of opposite sign that the image's mean hides.
const ACROSS: usize = 4;

/// Events that a mean may have missed or met too often without its spread telling: with k expected, none come with
/// probability exp(−k), and a normal law with the variance of ten more makes that exp(−k²/20), likelier up to k = 20.
const UNSEEN: f64 = 10.0;

/// Standard error that rare events of this size leave on a mean of so many numbers, even where all that were seen
/// agree: roulette at full throughput ends one path in a thousand.
pub fn unseen(size: f64, numbers: f64) -> f64 {
    UNSEEN.sqrt() * size / numbers
}

/// A number with its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub mean: f64,
    /// Its standard error.
    pub se: f64,
    /// Degrees of freedom of the standard error: independent replicates − 1.
    pub dof: f64,
}

impl Estimate {
    /// Of independent replicates.
    pub fn of(moments: &Moments) -> Self {
        Self { mean: moments.mean(), se: moments.standard_error(), dof: moments.n() as f64 - 1.0 }
    }

    /// The difference to another, independent one; degrees of freedom by Welch and Satterthwaite.
    pub fn minus(self, other: Self) -> Self {
        let [va, vb] = [self.se * self.se, other.se * other.se];
        let parts = va * va / self.dof + vb * vb / other.dof;
        let dof = if parts > 0.0 { (va + vb).powi(2) / parts } else { f64::INFINITY };
        Self { mean: self.mean - other.mean, se: (va + vb).sqrt(), dof }
    }

    /// The difference to an exact number.
    pub fn minus_exact(self, exact: f64) -> Self {
        Self { mean: self.mean - exact, ..self }
    }

    /// p-value of the hypothesis that it estimates 0, where arithmetic may be wrong by `rounding`.
    pub fn p_of_zero(self, rounding: f64) -> f64 {
        match (self.mean.abs() - rounding).max(0.0) {
            0.0 => 1.0,
            off => two_sided_t(off / self.se, self.dof),
        }
    }
}

/// Squares that cover an image of so many pixels, at most 4 × 4.
pub fn tiles([w, h]: [usize; 2]) -> Vec<Area> {
    let side = w.max(h).div_ceil(ACROSS).max(1);
    let steps = |to: usize| (0..to).step_by(side);
    let tile = |x: usize, y: usize| [x, y, (x + side).min(w), (y + side).min(h)];
    steps(h).flat_map(|y| steps(w).map(move |x| tile(x, y))).collect()
}

/// A channel of an image by [`tiles`]. A tile sees few of the rare events, perhaps none, and then does not know its own
/// error: it is taken as if it had seen some more of the largest that any tile has seen (at least of the size
/// `least`, as it changes a sample, of which a pixel has so many), which costs tiles without rare events half of their power.
pub fn estimates(image: &Replicated, channel: usize, least: f64, samples: f64) -> Vec<Estimate> {
    let tiles = tiles(image.size);
    let means: Vec<Vec<f64>> = tiles.iter().map(|&tile| image.means(tile, channel)).collect();
    let moments: Vec<Moments> = means.iter().map(|means| means.iter().copied().collect()).collect();
    let event = |(means, m): (&Vec<f64>, &Moments)| means.iter().map(|x| (x - m.mean()).abs()).fold(0.0, f64::max);
    let largest = means.iter().zip(&moments).map(event).fold(0.0, f64::max);
    let estimate = |(m, [x0, y0, x1, y1]): (&Moments, &Area)| {
        let in_tile = ((x1 - x0) * (y1 - y0)) as f64 * samples;
        let plain = Estimate::of(m);
        Estimate { se: plain.se.hypot(unseen(largest.max(least / in_tile), REPLICATES as f64)), ..plain }
    };
    moments.iter().zip(&tiles).map(estimate).collect()
}

/// p of the smallest of independent p-values (Šidák), and how many there are.
pub fn worst(p: impl IntoIterator<Item = f64>) -> (f64, usize) {
    let (least, n) = p.into_iter().fold((1.0, 0), |(least, n), p| (f64::min(least, p), n + 1));
    // 1 − (1 − p)^n without cancellation.
    let p = if least < 1.0 { -(n as f64 * (-least).ln_1p()).exp_m1() } else { 1.0 };
    (p, n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let image = Replicated { size: [5, 3], images: vec![(0..15).map(|i| [f64::from(i); 3]).collect()] };
        let sum = |area: Area| image.means(area, 1)[0] * ((area[2] - area[0]) * (area[3] - area[1])) as f64;
        let tiles = tiles(image.size);
        assert_eq!(tiles.len(), 6);
        assert!((tiles.into_iter().map(sum).sum::<f64>() - 105.0).abs() < 1e-12);
    }

    #[test]
    fn the_worst_of_many_counts_all_of_them() {
        let (p, n) = worst([0.5, 1e-9, 0.2]);
        assert!(n == 3 && (p / 3e-9 - 1.0).abs() < 1e-6, "{p}");
        assert_eq!(worst([]), (1.0, 0));
    }

    #[test]
    fn missed_events_are_no_error() {
        // Two tiles; 20 events of size 1 were expected in the mean of 64, one tile met them and the other none.
        let replicate = |i: usize| vec![[f64::from(u8::from(i < 20)); 3], [0.0; 3]];
        let image = Replicated { size: [2, 1], images: (0..64).map(replicate).collect() };
        for estimate in estimates(&image, 0, 0.0, 1.0) {
            let off = Estimate { mean: estimate.mean - 5.0 / 64.0, ..estimate };
            assert!(off.p_of_zero(0.0) > 1e-4, "{estimate:?}");
        }
    }
}
