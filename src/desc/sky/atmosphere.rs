//! The scattering of sunlight in a clear atmosphere. Lengths in km.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Radius of the planet, and of the top of its atmosphere.
const GROUND: f64 = 6360.0;
const TOP: f64 = 6460.0;

/// Scattering of air at sea level \[1/km\], which falls to 1/e in 8 km.
const AIR: DVec3 = DVec3::new(5.802e-3, 13.558e-3, 33.1e-3);
const AIR_SCALE: f64 = 8.0;

/// Share of haze's extinction that is scattering, the height in which it falls to 1/e, and Henyey and Greenstein's g.
const HAZE_ALBEDO: f64 = 0.9;
const HAZE_SCALE: f64 = 1.2;
const HAZE_G: f64 = 0.8;

/// Absorption of ozone where it is densest, in 25 km, over 15 km to either side \[1/km\].
const OZONE: DVec3 = DVec3::new(0.650e-3, 1.881e-3, 0.085e-3);

/// The observer stands this high.
const EYE: f64 = 0.01;

/// Tables over height and cosine of the sun's zenith angle.
const HEIGHTS: usize = 32;
const COSINES: usize = 128;

/// Air, haze and ground, with what is known of them for all directions.
pub(super) struct Atmosphere {
    /// Extinction of haze at sea level \[1/km\].
    haze: f64,
    ground: DVec3,
    /// Transmittance to the sun, for each height by cosine, from the horizon up.
    to_sun: Vec<DVec3>,
    /// Radiance scattered more than once, per scattering coefficient.
    multiple: Vec<DVec3>,
}

/// What a point of the atmosphere does.
struct Medium {
    air: DVec3,
    haze: f64,
    extinction: DVec3,
}

impl Atmosphere {
    /// Turbidity T = (τ_air + τ_haze)/τ_air at 550 nm (McCartney 1976).
    pub(super) fn new(turbidity: f64, ground: DVec3) -> Self {
        let haze = (turbidity - 1.0) * AIR.y * AIR_SCALE / HAZE_SCALE;
        let mut new = Self { haze, ground, to_sun: Vec::new(), multiple: Vec::new() };
        let cells = || (0..HEIGHTS).flat_map(|i| (0..COSINES).map(move |j| (i, j)));
        new.to_sun = cells().map(|(i, j)| new.march_to_sun(height(i), cosine(height(i), j))).collect();
        new.multiple = cells().map(|(i, j)| new.scattered_often(height(i), cosine_all(j))).collect();
        new
    }

    fn medium(&self, h: f64) -> Medium {
        let air = AIR * (-h / AIR_SCALE).exp();
        let haze = self.haze * (-h / HAZE_SCALE).exp();
        let ozone = OZONE * (1.0 - (h - 25.0).abs() / 15.0).max(0.0);
        Medium { air, haze: HAZE_ALBEDO * haze, extinction: air + DVec3::splat(haze) + ozone }
    }

    /// Share of sunlight that arrives at height `h`, the cosine of the sun's zenith angle being `mu`; 0 in the shadow of
    /// the planet.
    pub(super) fn transmittance(&self, h: f64, mu: f64) -> DVec3 {
        let low = horizon(h);
        if mu < low {
            return DVec3::ZERO;
        }
        let x = (h / (TOP - GROUND)).clamp(0.0, 1.0).sqrt() * (HEIGHTS - 1) as f64;
        let y = ((mu - low) / (1.0 - low)).clamp(0.0, 1.0).sqrt() * (COSINES - 1) as f64;
        bilinear(&self.to_sun, x, y)
    }

    fn march_to_sun(&self, h: f64, mu: f64) -> DVec3 {
        const STEPS: u32 = 64;
        let length = to_top(GROUND + h, mu);
        let step = length / f64::from(STEPS);
        let depth = |i: u32| self.medium(along(GROUND + h, mu, (f64::from(i) + 0.5) * step) - GROUND).extinction * step;
        let depth: DVec3 = (0..STEPS).map(depth).sum();
        (-depth).exp()
    }

    /// Ψ = L₂/(1 − f) (Hillaire 2020, equations 5 to 10): what arrives after two scatterings from all around, and the
    /// share f of isotropic light that another one sends back, in a geometric series.
    fn scattered_often(&self, h: f64, mu_sun: f64) -> DVec3 {
        const DIRECTIONS: u32 = 64;
        let r = GROUND + h;
        let (mut second, mut returned) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..DIRECTIONS {
            // Fibonacci's sphere.
            let mu = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(DIRECTIONS);
            let phi = TAU * (f64::from(i) * 0.618_033_988_749_895).fract();
            let towards = mu * mu_sun + ((1.0 - mu * mu) * (1.0 - mu_sun * mu_sun)).max(0.0).sqrt() * phi.cos();
            let isotropic = |m: &Medium, sun: DVec3| (m.air + DVec3::splat(m.haze)) * (sun / (4.0 * PI));
            let (light, left, end) = self.march(r, mu, mu_sun, towards, 20, |m, sun, _| isotropic(m, sun));
            second += light;
            if let Some(mu_ground) = end {
                let sun = self.transmittance(0.0, mu_ground);
                second += left * self.ground / PI * sun * mu_ground.max(0.0);
            }
            let (all, ..) = self.march(r, mu, mu_sun, towards, 20, |m, _, _| isotropic(m, DVec3::splat(4.0 * PI)));
            returned += all;
        }
        let count = f64::from(DIRECTIONS);
        (second / count) / (DVec3::ONE - returned / count)
    }

    /// Radiance of the sky over the sun's irradiance above the atmosphere \[1/sr\], where the view ray rises by the sine
    /// `mu` and the sun by `mu_sun`, with the cosine `towards` between them.
    pub(super) fn radiance(&self, mu: f64, mu_sun: f64, towards: f64) -> DVec3 {
        let air_phase = 3.0 / (16.0 * PI) * (1.0 + towards * towards);
        let haze_phase =
            (1.0 - HAZE_G * HAZE_G) / (4.0 * PI * (1.0 + HAZE_G * HAZE_G - 2.0 * HAZE_G * towards).powf(1.5));
        let source = |m: &Medium, sun: DVec3, at: (f64, f64)| {
            let once = (m.air * air_phase + DVec3::splat(m.haze * haze_phase)) * sun;
            once + (m.air + DVec3::splat(m.haze)) * self.often(at)
        };
        self.march(GROUND + EYE, mu, mu_sun, towards, 40, source).0
    }

    fn often(&self, (h, mu_sun): (f64, f64)) -> DVec3 {
        let x = (h / (TOP - GROUND)).clamp(0.0, 1.0).sqrt() * (HEIGHTS - 1) as f64;
        let y = (0.5 + 0.5 * mu_sun).clamp(0.0, 1.0) * (COSINES - 1) as f64;
        bilinear(&self.multiple, x, y)
    }

    /// ∫ T σ S dt from radius `r` along a ray, of a source that is given the medium, the sun's transmittance, and height
    /// and sun's cosine; the ray's own transmittance; the sun's cosine on the ground, if it ends there.
    fn march(
        &self,
        r: f64,
        mu: f64,
        mu_sun: f64,
        towards: f64,
        steps: u32,
        source: impl Fn(&Medium, DVec3, (f64, f64)) -> DVec3,
    ) -> (DVec3, DVec3, Option<f64>) {
        let ground = to_ground(r, mu);
        let length = ground.unwrap_or_else(|| to_top(r, mu));
        let sun_at = |t: f64| {
            let radius = along(r, mu, t);
            (radius - GROUND, ((r * mu_sun + t * towards) / radius).clamp(-1.0, 1.0))
        };
        let (mut sum, mut left) = (DVec3::ZERO, DVec3::ONE);
        // Steps grow with the distance: the air is densest here.
        let place = |i: u32| length * (f64::from(i) / f64::from(steps)).powi(2);
        for i in 0..steps {
            let (from, to) = (place(i), place(i + 1));
            let at = sun_at(0.5 * (from + to));
            let m = self.medium(at.0);
            let inside = (-m.extinction * (to - from)).exp();
            let emitted = source(&m, self.transmittance(at.0, at.1), at);
            // ∫ e^(−σt) S dt over the step.
            let share = (DVec3::ONE - inside) / m.extinction.max(DVec3::splat(1e-12));
            sum += left * emitted * share;
            left *= inside;
        }
        (sum, left, ground.map(|t| sun_at(t).1))
    }
}

fn height(i: usize) -> f64 {
    (TOP - GROUND) * (i as f64 / (HEIGHTS - 1) as f64).powi(2)
}

/// Cosines from the horizon up, dense at the horizon.
fn cosine(h: f64, j: usize) -> f64 {
    let low = horizon(h);
    low + (1.0 - low) * (j as f64 / (COSINES - 1) as f64).powi(2)
}

fn cosine_all(j: usize) -> f64 {
    2.0 * j as f64 / (COSINES - 1) as f64 - 1.0
}

/// Cosine of the zenith angle of the horizon.
fn horizon(h: f64) -> f64 {
    let sin = GROUND / (GROUND + h.max(0.0));
    -(1.0 - sin * sin).max(0.0).sqrt()
}

/// Radius at distance `t`.
fn along(r: f64, mu: f64, t: f64) -> f64 {
    (r * r + t * t + 2.0 * r * t * mu).sqrt()
}

fn to_top(r: f64, mu: f64) -> f64 {
    (-r * mu + (r * r * (mu * mu - 1.0) + TOP * TOP).max(0.0).sqrt()).max(0.0)
}

fn to_ground(r: f64, mu: f64) -> Option<f64> {
    let discriminant = r * r * (mu * mu - 1.0) + GROUND * GROUND;
    (mu < 0.0 && discriminant > 0.0).then(|| (-r * mu - discriminant.sqrt()).max(0.0))
}

fn bilinear(table: &[DVec3], x: f64, y: f64) -> DVec3 {
    let (i, j) = ((x as usize).min(HEIGHTS - 2), (y as usize).min(COSINES - 2));
    let (s, t) = (x - i as f64, y - j as f64);
    let row = |i: usize| table[i * COSINES + j].lerp(table[i * COSINES + j + 1], t);
    row(i).lerp(row(i + 1), s)
}
