//! Two images of one thing: how far apart, and whether chance explains it.

use super::Image;
use crate::stats;

/// Differences of A from B in one layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels left out because a channel of either is not finite.
    pub non_finite: usize,
    /// Image means of A and of B, RGB.
    pub mean: [[f64; 3]; 2],
    /// √ of the mean over pixels and channels of (a − b)².
    pub rmse: f64,
    /// Mean over pixels and channels of (a − b)²/(b² + 0.01).
    pub relmse: f64,
    /// z of the difference of the image means, and share of pixel channels with |z| > 3; where an error is known.
    pub evidence: Option<Evidence>,
}

/// What standard errors say about a difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// z of mean(A) − mean(B) with se² = Σ (se_a² + se_b²)/N² over N pixels, RGB.
    pub z: [f64; 3],
    /// Share of pixel channels with |z| > 3: about 0.3 % of equal images with many replicates, more with few.
    pub beyond_three: f64,
    /// Images whose error is known, of A and B; the other counts as exact.
    pub known: [bool; 2],
}

/// Why two images cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CompareError {
    /// Of different sizes, or of different windows of the same size.
    #[error("{a:?} and {b:?} are the windows of the two images (x0, y0, x1, y1), of {size_a:?} and {size_b:?} pixels")]
    Window {
        /// Window of A.
        a: [u32; 4],
        /// Window of B.
        b: [u32; 4],
        /// Size of A.
        size_a: [u32; 2],
        /// Size of B.
        size_b: [u32; 2],
    },
    /// A layer is missing.
    #[error("image {image} has no layer `{layer}` with R, G, B; it has {present}")]
    Layer {
        /// A or B.
        image: char,
        /// Asked for.
        layer: String,
        /// Layers that are there.
        present: String,
    },
}

/// Compares `layer` of A and B; B is the reference where it matters (relMSE).
pub fn compare(a: &Image, b: &Image, layer: &str) -> Result<Comparison, CompareError> {
    if a.size != b.size || a.window != b.window {
        return Err(CompareError::Window { a: a.window, b: b.window, size_a: a.size, size_b: b.size });
    }
    let ([x, y], errors) = ([rgb('A', a, layer)?, rgb('B', b, layer)?], [stderr(a, layer), stderr(b, layer)]);
    let known = errors.map(|e| e.is_some());
    let n = x[0].len();
    let (mut pixels, mut sums, mut squares, mut relative) = (0usize, [[0.0; 3]; 2], 0.0, 0.0);
    let (mut variance, mut beyond) = ([0.0; 3], 0usize);
    for i in 0..n {
        if (0..3).any(|c| !x[c][i].is_finite() || !y[c][i].is_finite()) {
            continue;
        }
        pixels += 1;
        for c in 0..3 {
            let (p, q) = (f64::from(x[c][i]), f64::from(y[c][i]));
            sums[0][c] += p;
            sums[1][c] += q;
            squares += (p - q).powi(2);
            relative += (p - q).powi(2) / (q * q + 0.01);
            let se2: f64 = errors.iter().flatten().map(|e| f64::from(e[c][i]).powi(2)).sum();
            variance[c] += se2;
            beyond += usize::from(stats::z(p, q, se2.sqrt()).abs() > 3.0);
        }
    }
    let (count, channels) = (pixels as f64, 3.0 * pixels as f64);
    let mean = sums.map(|rgb| rgb.map(|s| s / count));
    let z = [0, 1, 2].map(|c| stats::z(mean[0][c], mean[1][c], variance[c].sqrt() / count));
    let evidence = Evidence { z, beyond_three: beyond as f64 / channels, known };
    Ok(Comparison {
        pixels,
        non_finite: n - pixels,
        mean,
        rmse: (squares / channels).sqrt(),
        relmse: relative / channels,
        evidence: known.contains(&true).then_some(evidence),
    })
}

/// The difference A − B as RGB bytes: white where equal, red where A is brighter, blue where it is darker. Full colour
/// is a difference of luminance over (luminance of B + 0.01) of four times its root mean square, which is returned too.
pub fn difference_colors(a: &Image, b: &Image, layer: &str) -> Result<(Vec<u8>, f64), CompareError> {
    let luminance = |[r, g, b]: [&[f32]; 3]| -> Vec<f64> {
        let y = |i: usize| 0.212_672_9 * f64::from(r[i]) + 0.715_152_2 * f64::from(g[i]) + 0.072_175 * f64::from(b[i]);
        (0..r.len()).map(y).collect()
    };
    compare(a, b, layer)?;
    let (x, y) = (luminance(rgb('A', a, layer)?), luminance(rgb('B', b, layer)?));
    let relative: Vec<f64> = x.iter().zip(&y).map(|(x, y)| (x - y) / (y + 0.01)).collect();
    let finite = relative.iter().filter(|d| d.is_finite());
    let full = 4.0 * (finite.clone().map(|d| d * d).sum::<f64>() / finite.count().max(1) as f64).sqrt();
    let color = |d: &f64| {
        let t = if d.is_finite() && full > 0.0 { (d / full).clamp(-1.0, 1.0) } else { 0.0 };
        let fade = (255.0 * (1.0 - t.abs())).round() as u8;
        match d {
            _ if !d.is_finite() => [255, 255, 0],
            _ if t >= 0.0 => [255, fade, fade],
            _ => [fade, fade, 255],
        }
    };
    Ok((relative.iter().flat_map(color).collect(), full))
}

fn rgb<'a>(name: char, image: &'a Image, layer: &str) -> Result<[&'a [f32]; 3], CompareError> {
    image.rgb(layer).ok_or_else(|| {
        let present: Vec<&str> = image.layers.keys().map(String::as_str).collect();
        CompareError::Layer { image: name, layer: layer.into(), present: present.join(", ") }
    })
}

/// The standard errors that go with a layer.
fn stderr<'a>(image: &'a Image, layer: &str) -> Option<[&'a [f32]; 3]> {
    if layer == Image::BEAUTY { image.rgb("stderr") } else { image.rgb(&format!("stderr.{layer}")) }
}
