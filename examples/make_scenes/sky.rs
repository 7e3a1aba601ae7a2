//! Equirectangular skies as Radiance HDR files. Column 0.5 of the width looks along −z, the upper edge is +y, columns
//! grow towards +x.

use super::Result;
use glam::DVec3;
use image::Rgb;
use image::codecs::hdr::HdrEncoder;
use std::f64::consts::PI;

/// Where the sun stands and how bright it is.
pub(super) struct Sun {
    /// Angle from the zenith \[rad\].
    zenith: f64,
    /// Longitude from −z towards +x \[rad\].
    longitude: f64,
    /// Haze: 2 is clear, 10 hazy.
    turbidity: f64,
    /// Linear RGB irradiance across its direction, in the unit of the sky.
    irradiance: [f64; 3],
    /// Half-angle of the disk that it is spread over \[rad\]; the real 0.27° would fall between the texels.
    radius: f64,
}

impl Sun {
    /// A clear afternoon. The unit is 10⁴ cd/m²; the sun gives 65 klx.
    pub(super) const AFTERNOON: Self =
        Self { zenith: 0.96, longitude: 0.9, turbidity: 3.0, irradiance: [7.4, 6.4, 4.9], radius: 0.035 };

    fn direction(&self) -> DVec3 {
        direction(self.zenith, self.longitude)
    }
}

/// The sky of Preetham, Shirley & Smits 1999 ("A Practical Analytic Model for Daylight", appendix) with a sun and a
/// brown ground.
pub(super) fn daylight(width: u32, height: u32, sun: &Sun) -> Result<Vec<u8>> {
    let sky = Sky::new(sun);
    let disk = 2.0 * PI * (1.0 - sun.radius.cos());
    const SUB: u32 = 8;
    let texel = |x: u32, y: u32| {
        let mut sum = [0.0; 3];
        for k in 0..SUB * SUB {
            let (i, j) = ((k % SUB) as f64 + 0.5, (k / SUB) as f64 + 0.5);
            let zenith = PI * (y as f64 + j / SUB as f64) / height as f64;
            let longitude = 2.0 * PI * ((x as f64 + i / SUB as f64) / width as f64 - 0.5);
            let rgb = if zenith < 0.5 * PI { sky.radiance(zenith, longitude) } else { [0.13, 0.115, 0.09] };
            let towards_sun = direction(zenith, longitude).dot(sun.direction()) > sun.radius.cos();
            let share = if towards_sun { 1.0 / disk } else { 0.0 };
            (0..3).for_each(|c| sum[c] += rgb[c] + share * sun.irradiance[c]);
        }
        sum.map(|c| (c / (SUB * SUB) as f64) as f32)
    };
    encode(width, height, texel)
}

/// A sky of radiance `others` but for one texel (column and row).
pub(super) fn one_texel(size: [u32; 2], at: [u32; 2], radiance: f32, others: f32) -> Result<Vec<u8>> {
    encode(size[0], size[1], |x, y| [if [x, y] == at { radiance } else { others }; 3])
}

fn encode(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 3]) -> Result<Vec<u8>> {
    let pixels: Vec<Rgb<f32>> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| Rgb(texel(x, y))).collect();
    let mut file = Vec::new();
    HdrEncoder::new(&mut file).encode(&pixels, width as usize, height as usize)?;
    Ok(file)
}

fn direction(zenith: f64, longitude: f64) -> DVec3 {
    DVec3::new(zenith.sin() * longitude.sin(), zenith.cos(), -zenith.sin() * longitude.cos())
}

/// Perez's distribution for Y, x and y, scaled to the zenith.
struct Sky {
    sun: DVec3,
    coefficients: [[f64; 5]; 3],
    /// Zenith value over the distribution's value there.
    scale: [f64; 3],
}

impl Sky {
    fn new(sun: &Sun) -> Self {
        let (t, s) = (sun.turbidity, sun.zenith);
        let linear = |table: [[f64; 2]; 5]| table.map(|[a, b]| a * t + b);
        let coefficients = [
            linear([[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]]),
            linear([[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]]),
            linear([[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]]),
        ];
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * s);
        let luminance = (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
        let cubic = |table: [[f64; 4]; 3]| {
            let powers = [s * s * s, s * s, s, 1.0];
            let row = |r: [f64; 4]| r.iter().zip(powers).map(|(a, b)| a * b).sum::<f64>();
            t * t * row(table[0]) + t * row(table[1]) + row(table[2])
        };
        let x = cubic([
            [0.00166, -0.00375, 0.00209, 0.0],
            [-0.02903, 0.06377, -0.03202, 0.00394],
            [0.11693, -0.21196, 0.06052, 0.25886],
        ]);
        let y = cubic([
            [0.00275, -0.00610, 0.00317, 0.0],
            [-0.04214, 0.08970, -0.04153, 0.00516],
            [0.15346, -0.26756, 0.06670, 0.26688],
        ]);
        // kcd/m² to 10⁴ cd/m².
        let zenith = [0.1 * luminance, x, y];
        let scale = [0, 1, 2].map(|i| zenith[i] / perez(&coefficients[i], 0.0, s));
        Self { sun: sun.direction(), coefficients, scale }
    }

    /// Linear BT.709 RGB of a direction above the horizon.
    fn radiance(&self, zenith: f64, longitude: f64) -> [f64; 3] {
        let gamma = direction(zenith, longitude).dot(self.sun).clamp(-1.0, 1.0).acos();
        // The model has a pole at the horizon.
        let zenith = zenith.min(0.5 * PI - 0.02);
        let [big_y, x, y] = [0, 1, 2].map(|i| self.scale[i] * perez(&self.coefficients[i], zenith, gamma));
        let (big_x, big_z) = (x / y * big_y, (1.0 - x - y) / y * big_y);
        let rgb = [
            3.2406 * big_x - 1.5372 * big_y - 0.4986 * big_z,
            -0.9689 * big_x + 1.8758 * big_y + 0.0415 * big_z,
            0.0557 * big_x - 0.2040 * big_y + 1.0570 * big_z,
        ];
        rgb.map(|c| c.max(0.0))
    }
}

/// (1 + A e^(B/cos θ)) (1 + C e^(Dγ) + E cos²γ).
fn perez([a, b, c, d, e]: &[f64; 5], zenith: f64, gamma: f64) -> f64 {
    (1.0 + a * (b / zenith.cos()).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
}
