//! Two images of one thing: do they differ by more than chance?
//!
//! Tested are the means of the images, by Welch's t, and the worst of their tiles. Single pixels are not: where light comes by
//! rare events, most pixels have seen too few to know their own error.
//!
//! ```
//! use radianza::stats::Family;
//! use radianza::verify::agreement::{Estimated, agreement};
//!
//! // 16 × 16 pixels with standard errors of 1 %, from 32 independent replicates.
//! let (mean, se) = (vec![[0.5; 3]; 256], vec![[0.005; 3]; 256]);
//! let ours = Estimated::new([16, 16], &mean, &se, 32);
//! let brighter: Vec<[f64; 3]> = mean.iter().map(|rgb| rgb.map(|x| 1.02 * x)).collect();
//! let theirs = Estimated::new([16, 16], &brighter, &se, 32);
//!
//! let mut checks = Family::new("two renderers");
//! agreement(&mut checks, "the same image", &ours, &ours);
//! assert!(checks.passes());
//! agreement(&mut checks, "2 % brighter", &theirs, &ours);
//! assert!(!checks.passes());
//! ```

use super::expect::ROUNDING;
use super::replicated::Replicated;
use super::tiles::{Estimate, estimates, tiles, worst};
use super::{Exhibit, picture};
use crate::film::Film;
use crate::stats::{Evidence, Family};

/// An image with its errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimated {
    /// Width and height.
    pub size: [usize; 2],
    /// Mean of all pixels, RGB.
    pub mean: [Estimate; 3],
    /// Means of tiles, for each channel, as [`tiles`] has them.
    pub tiles: [Vec<Estimate>; 3],
    /// Pixels, row by row, RGB.
    pub pixels: Vec<[Estimate; 3]>,
}

impl Estimated {
    /// From means and standard errors of pixels, RGB, row by row, that are independent of each other and come from so
    /// many `replicates` each. A tile that has seen fewer rare events than others does not know its error: the root
    /// mean square of all tiles' stands in.
    ///
    /// # Panics
    /// If there are not width × height of each.
    pub fn new(size: [usize; 2], mean: &[[f64; 3]], se: &[[f64; 3]], replicates: u32) -> Self {
        assert!(mean.len() == size[0] * size[1] && se.len() == mean.len(), "{size:?} pixels");
        let dof = f64::from(replicates.max(2)) - 1.0;
        let pixels: Vec<[Estimate; 3]> = mean
            .iter()
            .zip(se)
            .map(|(mean, se)| [0, 1, 2].map(|c| Estimate { mean: mean[c], se: se[c], dof }))
            .collect();
        let average = |[x0, y0, x1, y1]: [usize; 4], c: usize| {
            let n = ((x1 - x0) * (y1 - y0)) as f64;
            let area = (y0..y1).flat_map(|y| (x0..x1).map(move |x| y * size[0] + x));
            let (sum, squares) = area.fold((0.0, 0.0), |(sum, squares), i| {
                let pixel: Estimate = pixels[i][c];
                (sum + pixel.mean, squares + pixel.se * pixel.se)
            });
            Estimate { mean: sum / n, se: squares.sqrt() / n, dof }
        };
        let of_tiles = |c| {
            let plain: Vec<Estimate> = tiles(size).into_iter().map(|tile| average(tile, c)).collect();
            let pooled = (plain.iter().map(|tile| tile.se * tile.se).sum::<f64>() / plain.len() as f64).sqrt();
            plain.into_iter().map(|tile| Estimate { se: tile.se.max(pooled), ..tile }).collect()
        };
        let mean = [0, 1, 2].map(|c| average([0, 0, size[0], size[1]], c));
        Self { size, mean, tiles: [0, 1, 2].map(of_tiles), pixels }
    }
}

impl From<&Film> for Estimated {
    fn from(film: &Film) -> Self {
        let [x0, y0, x1, y1] = film.crop();
        let size = [(x1 - x0) as usize, (y1 - y0) as usize];
        let means: Vec<_> = film.pixels().map(|[x, y]| film.mean(x, y)).collect();
        // What is known from one replicate alone is not known.
        let errors: Vec<_> = film.pixels().map(|[x, y]| film.stderr(x, y).unwrap_or([f64::INFINITY; 3])).collect();
        let replicates = film.pixels().map(|[x, y]| film.replicates(x, y)).min().unwrap_or(0);
        Self::new(size, &means, &errors, replicates)
    }
}

impl From<&Replicated> for Estimated {
    fn from(image: &Replicated) -> Self {
        Self {
            size: image.size,
            mean: [0, 1, 2].map(|c| Estimate::of(&image.moments(image.whole(), c))),
            tiles: [0, 1, 2].map(|c| estimates(image, c, 0.0, 1.0)),
            pixels: image.pixels().iter().map(|rgb| [0, 1, 2].map(|c| Estimate::of(&rgb[c]))).collect(),
        }
    }
}

/// Checks that `a` and `b`, made with independent numbers, estimate one image: the mean of each channel and the worst
/// tile. Gives something to look at where they hardly do.
pub fn agreement(checks: &mut Family, name: &str, a: &Estimated, b: &Estimated) -> Option<Exhibit> {
    if a.size != b.size {
        checks.holds(format!("{name}: {:?} and {:?} are the same size", a.size, b.size), false);
        return None;
    }
    let zip = |a: &[Estimate], b: &[Estimate]| a.iter().zip(b).map(|(a, b)| a.minus(*b)).collect();
    let difference = Estimated {
        size: a.size,
        mean: [0, 1, 2].map(|c| a.mean[c].minus(b.mean[c])),
        tiles: [0, 1, 2].map(|c| zip(&a.tiles[c], &b.tiles[c])),
        pixels: a.pixels.iter().zip(&b.pixels).map(|(a, b)| [0, 1, 2].map(|c| a[c].minus(b[c]))).collect(),
    };
    judge(checks, name, b, &difference)
}

/// Tests replicates that were made with common random numbers, each of `a` with those of one of `b`: the error is that
/// of their differences, which is small where the estimators are alike, and 0 where they are the same.
pub fn paired(checks: &mut Family, name: &str, a: &Replicated, b: &Replicated) -> Option<Exhibit> {
    if a.size != b.size || a.images.len() != b.images.len() {
        checks.holds(format!("{name}: {:?} and {:?} are the same size", a.size, b.size), false);
        return None;
    }
    let minus = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|c| a[c] - b[c]);
    let image = |(a, b): (&Vec<[f64; 3]>, &Vec<[f64; 3]>)| a.iter().zip(b).map(minus).collect();
    let difference = Replicated { size: a.size, images: a.images.iter().zip(&b.images).map(image).collect() };
    judge(checks, name, &b.into(), &(&difference).into())
}

/// Checks that `difference` is nothing, in a mean of what `of` is.
fn judge(checks: &mut Family, name: &str, of: &Estimated, difference: &Estimated) -> Option<Exhibit> {
    let first = checks.checks().len();
    let grey = of.mean[0] == of.mean[1] && of.mean[1] == of.mean[2];
    for c in if grey { 1..2 } else { 0..3 } {
        let (exact, Estimate { mean, se, dof }) = (of.mean[c].mean, difference.mean[c]);
        let name = format!("{name}: mean{}", if grey { "" } else { [" R", " G", " B"][c] });
        if exact == 0.0 {
            checks.holds(format!("{name} is nothing"), mean == 0.0);
        } else {
            checks.push(name, Evidence::Z { exact, estimate: exact + mean, se, dof, rounding: ROUNDING * exact.abs() });
        }
    }
    let each = (0..3).flat_map(|c| difference.tiles[c].iter().zip(&of.tiles[c]));
    let (p, n) = worst(each.map(|(difference, of)| difference.p_of_zero(ROUNDING * of.mean.abs())));
    checks.p(format!("{name}: worst of {} tiles", n / 3), p);
    let suspect = checks.checks()[first..].iter().any(|check| check.p() < picture::SUSPECT);
    suspect.then(|| picture::of_difference(name, difference))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::{Kind, Sampler};

    /// 64 replicates of 8 × 8 pixels of noise about 1, with a fault of opposite signs in two halves.
    fn noisy(seed: u64, fault: f64) -> Replicated {
        let image = |index| {
            let mut u = Sampler::new(Kind::Independent, seed, [0, 0], index, 1);
            let sign = |i: usize| if i < 32 { fault } else { -fault };
            (0..64).map(|i| [1.0 + sign(i) + 0.1 * (f64::from(u.next_1d()) - 0.5); 3]).collect()
        };
        Replicated { size: [8, 8], images: (0..64).map(image).collect() }
    }

    #[test]
    fn tiles_find_what_means_hide() {
        let mut same = Family::new("same");
        assert!(agreement(&mut same, "noise", &(&noisy(1, 0.0)).into(), &(&noisy(2, 0.0)).into()).is_none());
        paired(&mut same, "itself", &noisy(1, 0.0), &noisy(1, 0.0));
        same.assert();
        let mut other = Family::new("other");
        let shown = agreement(&mut other, "noise", &(&noisy(1, 0.02)).into(), &(&noisy(2, 0.0)).into());
        assert!(shown.is_some());
        assert_eq!(other.failures().map(|c| &*c.name).collect::<Vec<_>>(), ["noise: worst of 16 tiles"]);
    }

    #[test]
    fn images_of_two_sizes_do_not_agree() {
        let [a, b] = [[4, 4], [8, 2]].map(|size| Estimated::new(size, &[[1.0; 3]; 16], &[[0.1; 3]; 16], 8));
        let mut checks = Family::new("sizes");
        assert!(agreement(&mut checks, "", &a, &b).is_none() && !checks.passes());
    }
}
