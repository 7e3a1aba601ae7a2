//! Unit interval → offset in a pixel filter. Drawing the offset with a density proportional to the filter makes the
//! pixel the plain mean of its samples (Ernst, Stamminger & Greiner 2006, "Filter Importance Sampling").

use super::to_unit;

/// Offset in (−`radius`, `radius`) with the density of the tent (triangle) function.
#[inline]
pub fn tent(u: f32, radius: f32) -> f32 {
    if u < 0.5 { radius * ((2.0 * u).sqrt() - 1.0) } else { radius * (1.0 - (2.0 - 2.0 * u).sqrt()) }
}

/// Density of [`tent`].
#[inline]
pub fn tent_pdf(x: f32, radius: f32) -> f32 {
    (1.0 - (x / radius).abs()).max(0.0) / radius
}

/// Inverse of [`tent`].
pub fn tent_inverse(x: f32, radius: f32) -> f32 {
    let t = (x / radius).clamp(-1.0, 1.0);
    to_unit(if t < 0.0 { 0.5 * (1.0 + t) * (1.0 + t) } else { 1.0 - 0.5 * (1.0 - t) * (1.0 - t) })
}

/// exp(−x²/2σ²), not normalised.
pub fn gaussian(x: f64, sigma: f64) -> f64 {
    (-0.5 * (x / sigma).powi(2)).exp()
}

/// The four-term Blackman–Harris window of this radius, not normalised (Harris 1978, "On the Use of Windows for
/// Harmonic Analysis with the Discrete Fourier Transform"); 0 outside.
pub fn blackman_harris(x: f64, radius: f64) -> f64 {
    if x.abs() >= radius {
        return 0.0;
    }
    let t = std::f64::consts::PI * (x / radius + 1.0);
    0.35875 - 0.48829 * t.cos() + 0.14128 * (2.0 * t).cos() - 0.01168 * (3.0 * t).cos()
}

/// Inverse distribution function of a density on an interval, tabulated and linear between nodes: one look-up a draw,
/// and the law drawn is exactly [`Quantiles::pdf`]. The nodes stand at u = 2t² (mirrored about ½) for equal steps of t,
/// close together at the tails, where a step of probability covers much of the interval.
#[derive(Clone, Debug)]
pub struct Quantiles {
    x: Vec<f32>,
}

impl Quantiles {
    /// Number of steps.
    const STEPS: usize = 1024;

    /// Of a density on [−radius, radius], not necessarily normalised, positive inside.
    pub fn new(density: impl Fn(f64) -> f64, radius: f64) -> Self {
        // Integrate by the midpoint rule, then walk to each quantile.
        let fine = 64 * Self::STEPS;
        let h = 2.0 * radius / fine as f64;
        let mass: Vec<f64> = (0..fine).map(|i| density((i as f64 + 0.5) * h - radius).max(0.0)).collect();
        let total: f64 = mass.iter().sum();
        let mut x = Vec::with_capacity(Self::STEPS + 1);
        x.push(-radius as f32);
        let (mut below, mut i) = (0.0, 0);
        for step in 1..Self::STEPS {
            let t = step as f64 / Self::STEPS as f64;
            let u = if t < 0.5 { 2.0 * t * t } else { 1.0 - 2.0 * (1.0 - t) * (1.0 - t) };
            let target = total * u;
            while i < fine && below + mass[i] < target {
                below += mass[i];
                i += 1;
            }
            let within = mass.get(i).map_or(0.0, |&m| (target - below) / m);
            x.push(((i as f64 + within) * h - radius) as f32);
        }
        x.push(radius as f32);
        Self { x }
    }

    /// The offset at probability `u`.
    #[inline]
    pub fn sample(&self, u: f32) -> f32 {
        let t = if u < 0.5 { (0.5 * u).sqrt() } else { 1.0 - (0.5 - 0.5 * u).sqrt() };
        let t = t * Self::STEPS as f32;
        let i = (t as usize).min(Self::STEPS - 1);
        self.x[i] + (t - i as f32) * (self.x[i + 1] - self.x[i])
    }

    /// Density of [`Quantiles::sample`]: du/dt · dt/dx; 0 outside.
    pub fn pdf(&self, x: f32) -> f32 {
        self.place(x).map_or(0.0, |(i, t)| 4.0 * t.min(1.0 - t) / (Self::STEPS as f32 * (self.x[i + 1] - self.x[i])))
    }

    /// Inverse of [`Quantiles::sample`].
    pub fn inverse(&self, x: f32) -> f32 {
        match self.place(x) {
            Some((_, t)) => to_unit(if t < 0.5 { 2.0 * t * t } else { 1.0 - 2.0 * (1.0 - t) * (1.0 - t) }),
            None if x < 0.0 => 0.0,
            None => super::ONE_MINUS_EPSILON,
        }
    }

    /// Step that holds `x`, and t there.
    fn place(&self, x: f32) -> Option<(usize, f32)> {
        let above = self.x.partition_point(|&q| q <= x);
        (above > 0 && above < self.x.len()).then(|| {
            let i = above - 1;
            let within = (x - self.x[i]) / (self.x[i + 1] - self.x[i]);
            (i, (i as f32 + within) / Self::STEPS as f32)
        })
    }
}
