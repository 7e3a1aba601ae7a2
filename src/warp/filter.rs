//! Profiles of pixel filters. Drawing the offset with a density proportional to the filter makes the pixel the plain mean
//! of its samples (Ernst, Stamminger & Greiner 2006, "Filter Importance Sampling").

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
