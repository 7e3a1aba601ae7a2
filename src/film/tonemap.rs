//! Tone curves: radiance → display code.

use super::agx::Agx;
use crate::desc::Tonemap;

/// Decades of radiance that [`Tonemap::Log`] shows, and the decade above 1 where they end: 10⁻³ is black, 10 is white.
const LOG_DECADES: (f64, f64) = (4.0, 1.0);

/// Luminance that [`Tonemap::Reinhard`] maps to white.
const REINHARD_WHITE: f64 = 4.0;

/// How radiance is shown. Deterministic, no dithering.
///
/// | curve | what it does to x = radiance × 2^exposure |
/// | --- | --- |
/// | linear | clip at 1, then the sRGB curve |
/// | log | code = (log₁₀ x + 3)/4 per channel, no sRGB curve: equal ratios of radiance are equal steps |
/// | reinhard | Y (1 + Y/4²)/(1 + Y) on luminance, hue kept, clip, sRGB curve (Reinhard et al. 2002, eq. 4) |
/// | agx | AgX: log₂ encoding between inset primaries and a sigmoid (Sobotka) |
#[derive(Clone, Debug)]
pub struct Display {
    curve: Tonemap,
    scale: f64,
    agx: Agx,
}

impl Display {
    /// This curve after `exposure` stops.
    pub fn new(curve: Tonemap, exposure: f32) -> Self {
        Self { curve, scale: f64::from(exposure).exp2(), agx: Agx::new() }
    }

    /// Display code of linear BT.709 radiance. Numbers that are not finite are shown as 0 or 255.
    pub fn code(&self, rgb: [f32; 3]) -> [u8; 3] {
        // max also turns NaN into 0.
        let x = rgb.map(|x| (f64::from(x) * self.scale).clamp(0.0, 1e30).max(0.0));
        let code = match self.curve {
            Tonemap::Linear => x.map(srgb),
            Tonemap::Log => x.map(|x| (x.max(1e-30).log10() - LOG_DECADES.1) / LOG_DECADES.0 + 1.0),
            Tonemap::Reinhard => {
                let y = 0.212_672_9 * x[0] + 0.715_152_2 * x[1] + 0.072_175 * x[2];
                let factor = (1.0 + y / REINHARD_WHITE.powi(2)) / (1.0 + y);
                x.map(|x| srgb(x * factor))
            }
            Tonemap::Agx => self.agx.linear(x).map(srgb),
        };
        code.map(|v| (255.0 * v.clamp(0.0, 1.0)).round() as u8)
    }
}

/// The sRGB curve (IEC 61966-2-1), linear → code, both in [0, 1].
fn srgb(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVES: [Tonemap; 4] = [Tonemap::Linear, Tonemap::Log, Tonemap::Reinhard, Tonemap::Agx];

    #[test]
    fn known_codes() {
        let code = |curve, exposure, x| Display::new(curve, exposure).code([x; 3]);
        // sRGB: 18 % grey is 118, half is 188.
        assert_eq!(code(Tonemap::Linear, 0.0, 0.18), [118; 3]);
        assert_eq!(code(Tonemap::Linear, -1.0, 1.0), [188; 3]);
        // Four decades on 255 steps.
        assert_eq!([1e-3, 1e-1, 1.0, 10.0].map(|x| code(Tonemap::Log, 0.0, x)[0]), [0, 128, 191, 255]);
        // White is white, and 1 keeps (1 + 1/16)/2.
        assert_eq!(code(Tonemap::Reinhard, 0.0, 4.0), [255; 3]);
        assert_eq!(code(Tonemap::Reinhard, 0.0, 1.0), [(255.0 * srgb(17.0 / 32.0)).round() as u8; 3]);
    }

    #[test]
    fn curves_rise_and_forgive() {
        for curve in CURVES {
            let display = Display::new(curve, 0.0);
            let ramp: Vec<u8> = (0..200).map(|i| display.code([1e-5 * 1.1f32.powi(i); 3])[1]).collect();
            assert!(ramp.is_sorted(), "{curve:?} {ramp:?}");
            assert!(ramp[0] <= 2 && ramp[199] >= 254, "{curve:?} {ramp:?}");
            assert_eq!(display.code([f32::NAN, -1.0, f32::NEG_INFINITY]), [display.code([0.0; 3])[0]; 3], "{curve:?}");
            assert_eq!(display.code([f32::INFINITY; 3]), [255; 3], "{curve:?}");
        }
    }
}
