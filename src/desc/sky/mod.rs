//! A clear sky and its sun, computed.
//!
//! Single scattering is integrated along each view ray through a spherical atmosphere of air, haze and ozone (Nishita et al.
//! 1993; constants of Bruneton & Neyret 2008 and Bruneton 2017, at 680, 550 and 440 nm, which stand for red, green and
//! blue); light scattered more often is Hillaire's isotropic series (2020, "A Scalable and Production Ready Sky and
//! Atmosphere Rendering Technique", section 5.5), the ground's reflection included. Three wavelengths are no spectrum:
//! colours are plausible, not colorimetric. The sun is a disk without limb darkening.

mod atmosphere;
mod sun;

pub use sun::{Instant, sun_position};

use super::{Image, Pixels};
use atmosphere::Atmosphere;
use glam::{DVec3, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Total solar irradiance above the atmosphere at the mean distance \[W/m²\] (Kopp & Lean 2011).
const SOLAR: f64 = 1361.0;

/// Solar spectral irradiance at 680, 550 and 440 nm \[W·m⁻²·nm⁻¹\] (Bruneton 2017): the sun's colour.
const COLOR: DVec3 = DVec3::new(1.474, 1.8504, 1.91198);

/// Mean angular diameter of the sun \[degrees\].
pub const SUN_DIAMETER: f32 = 0.533;

/// What decides the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Of the sun above the horizon \[rad\].
    pub elevation: f64,
    /// Of the sun, clockwise from north as seen from above \[rad\]; north is −z, east +x.
    pub azimuth: f64,
    /// Optical thickness of air and haze over that of air: 1 is air alone, 2 to 3 a clear day, 6 haze.
    pub turbidity: f64,
    /// Linear RGB albedo of the ground all around.
    pub ground: [f32; 3],
}

/// What stands in the sky.
#[derive(Clone, Debug)]
pub struct Daylight {
    /// Equirectangular radiance without the sun \[W·sr⁻¹·m⁻²\]; below the horizon the ground in this light.
    pub image: Image,
    /// Towards the sun, unit.
    pub to_sun: Vec3,
    /// Linear RGB irradiance from the sun's disk on what faces it \[W/m²\]; 0 where it is below the horizon.
    pub irradiance: [f32; 3],
}

/// Columns and rows of the image.
const SIZE: [usize; 2] = [1024, 512];

impl Sky {
    /// Computes it, with lanes in which a white of luminance 1361 W/m² shines above the atmosphere.
    pub fn compute(&self) -> Daylight {
        let luminance = COLOR.dot(DVec3::new(0.2126, 0.7152, 0.0722));
        let solar = COLOR * (SOLAR / luminance);
        let ground = DVec3::from(self.ground.map(f64::from));
        let atmosphere = Atmosphere::new(self.turbidity, ground);
        let (sin, cos) = self.elevation.sin_cos();

        // The sky is symmetric about the sun's meridian: half of its columns are enough.
        let [width, height] = SIZE;
        let half: Vec<DVec3> = (0..height / 2)
            .flat_map(|row| (0..width / 2).map(move |column| (row, column)))
            .map(|(row, column)| {
                let elevation = FRAC_PI_2 - PI * (row as f64 + 0.5) / height as f64;
                let from_sun = TAU * (column as f64 + 0.5) / width as f64;
                let towards = sin * elevation.sin() + cos * elevation.cos() * from_sun.cos();
                solar * atmosphere.radiance(elevation.sin(), sin, towards)
            })
            .collect();

        // The ground below it, in the light of both.
        let direct = solar * atmosphere.transmittance(0.0, sin);
        let rows = |row: usize| {
            let top = PI * row as f64 / height as f64;
            let bottom = PI * (row as f64 + 1.0) / height as f64;
            // ∫ cos θ dω over a texel.
            0.5 * (bottom.sin().powi(2) - top.sin().powi(2)) * TAU / width as f64
        };
        let diffuse: DVec3 = half.iter().enumerate().map(|(i, &l)| l * (2.0 * rows(i / (width / 2)))).sum();
        let below = ground / PI * (direct * sin.max(0.0) + diffuse);

        let turn = self.azimuth.rem_euclid(TAU) / TAU * width as f64;
        let pixel = |i: usize| {
            let (row, column) = (i / width, i % width);
            if row >= height / 2 {
                return rgba(below);
            }
            // Columns from the sun's own, either way; the middle of the image looks north.
            let from_sun = (column as f64 + 0.5 - width as f64 / 2.0 - turn).rem_euclid(width as f64);
            let from_sun = from_sun.min(width as f64 - from_sun);
            // Linear between the two columns nearest.
            let at = (from_sun - 0.5).clamp(0.0, (width / 2 - 1) as f64);
            let (low, share) = (at as usize, at.fract());
            let entry = |column: usize| half[row * (width / 2) + column.min(width / 2 - 1)];
            rgba(entry(low).lerp(entry(low + 1), share))
        };
        let pixels = (0..width * height).map(pixel).collect();
        let image = Image { name: "sky".into(), size: SIZE.map(|n| n as u32), pixels: Pixels::Rgba32F(pixels) };
        let to_sun = DVec3::new(cos * self.azimuth.sin(), sin, -cos * self.azimuth.cos()).as_vec3().normalize();
        let irradiance = if sin > 0.0 { direct.as_vec3().to_array() } else { [0.0; 3] };
        Daylight { image, to_sun, irradiance }
    }
}

fn rgba(rgb: DVec3) -> [f32; 4] {
    rgb.as_vec3().max(Vec3::ZERO).extend(1.0).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noon(turbidity: f64) -> Daylight {
        Sky { elevation: 0.8, azimuth: 1.0, turbidity, ground: [0.2; 3] }.compute()
    }

    fn texel(day: &Daylight, w: Vec3) -> Vec3 {
        let Pixels::Rgba32F(pixels) = &day.image.pixels else { unreachable!() };
        let u = 0.5 + w.x.atan2(-w.z) / std::f32::consts::TAU;
        let v = w.y.clamp(-1.0, 1.0).acos() / std::f32::consts::PI;
        let at = [u * SIZE[0] as f32, v * SIZE[1] as f32].map(|x| x as usize);
        let [r, g, b, _] = pixels[at[1].min(SIZE[1] - 1) * SIZE[0] + at[0].min(SIZE[0] - 1)];
        Vec3::new(r, g, b)
    }

    /// Measured clear skies: direct normal 700 to 1000 W/m², diffuse horizontal a tenth to a fifth of the global.
    #[test]
    fn a_clear_noon_is_as_bright_as_measured() {
        let day = noon(2.5);
        let luminance = |rgb: Vec3| rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        let direct = luminance(day.irradiance.into());
        assert!((700.0..1100.0).contains(&direct), "direct {direct}");
        // The ground shows albedo/π of both together.
        let global = luminance(texel(&day, Vec3::NEG_Y)) * std::f32::consts::PI / 0.2;
        let diffuse = global - direct * day.to_sun.y;
        assert!((0.07..0.3).contains(&(diffuse / global)), "diffuse {diffuse} of {global}");
    }

    #[test]
    fn the_sky_is_blue_and_brightest_about_the_sun() {
        let day = noon(2.5);
        let away = Vec3::new(-day.to_sun.x, day.to_sun.y, -day.to_sun.z);
        let [zenith, near, far] = [Vec3::Y, (day.to_sun + 0.05 * Vec3::Y).normalize(), away].map(|w| texel(&day, w));
        assert!(zenith.z > 1.5 * zenith.x && far.z > 1.5 * far.x, "{zenith} {far}");
        assert!(near.y > 3.0 * far.y, "{near} {far}");
        // Less blue through haze.
        let haze = texel(&noon(8.0), away);
        assert!(haze.z / haze.x < far.z / far.x);
    }

    /// A low sun is red, one below the horizon lights only the sky.
    #[test]
    fn evening() {
        let at = |degrees: f64| Sky { elevation: degrees.to_radians(), azimuth: 0.0, turbidity: 2.0, ground: [0.0; 3] };
        let low = at(3.0).compute();
        assert!(low.irradiance[0] > 2.0 * low.irradiance[2] && low.to_sun.z < -0.99);
        let dusk = at(-4.0).compute();
        let glow = texel(&dusk, Vec3::new(0.0, 0.1, -1.0).normalize());
        assert_eq!(dusk.irradiance, [0.0; 3]);
        assert!(glow.x > 0.0 && glow.x < 10.0, "{glow}");
    }
}
