//! Four lanes of spectral quantity. Today they carry linear RGB (ITU-R BT.709 primaries, D65 white); the fourth lane
//! repeats green so that every lane always holds a valid number.

pub mod observer;

use glam::Vec4;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

/// Wavelength \[nm\] that stands for each lane where physics needs one: the dominant wavelengths of BT.709's primaries
/// against D65.
pub const WAVELENGTHS: [f64; 4] = [611.4, 549.1, 464.2, 549.1];

/// A radiance, reflectance or weight in four lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spectrum(pub Vec4);

impl Spectrum {
    /// All lanes 0.
    pub const ZERO: Self = Self(Vec4::ZERO);
    /// All lanes 1.
    pub const ONE: Self = Self(Vec4::ONE);

    /// One value for all lanes.
    #[inline]
    pub const fn splat(x: f32) -> Self {
        Self(Vec4::splat(x))
    }

    /// Linear BT.709 RGB to lanes.
    #[inline]
    pub const fn from_rgb(rgb: [f32; 3]) -> Self {
        Self(Vec4::new(rgb[0], rgb[1], rgb[2], rgb[1]))
    }

    /// Lanes to linear BT.709 RGB.
    #[inline]
    pub const fn to_rgb(self) -> [f32; 3] {
        let [r, g, b, _] = self.0.to_array();
        [r, g, b]
    }

    /// These lanes where the wavelength is that of lane `lane`, 0 elsewhere.
    #[inline]
    pub fn only(self, lane: usize) -> Self {
        let own = WAVELENGTHS.map(|lambda| if lambda == WAVELENGTHS[lane] { 1.0 } else { 0.0 });
        Self(self.0 * Vec4::from_array(own))
    }

    /// Luminance Y of BT.709: relative, or in the unit of the lanes.
    #[inline]
    pub fn luminance(self) -> f32 {
        self.0.dot(Vec4::new(0.212_672_9, 0.715_152_2, 0.072_175, 0.0))
    }

    /// Largest lane.
    #[inline]
    pub fn max_element(self) -> f32 {
        self.0.max_element()
    }

    /// Every lane is 0.
    #[inline]
    pub fn is_black(self) -> bool {
        self.0 == Vec4::ZERO
    }

    /// No lane is NaN or infinite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// `f` of every lane.
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let [a, b, c, d] = self.0.to_array();
        Self(Vec4::new(f(a), f(b), f(c), f(d)))
    }

    /// `self / other` lane by lane, 0 where `other` is 0.
    #[inline]
    pub fn div_or_zero(self, other: Self) -> Self {
        let zero = other.0.cmpeq(Vec4::ZERO);
        Self(Vec4::select(zero, Vec4::ZERO, self.0 / Vec4::select(zero, Vec4::ONE, other.0)))
    }

    /// (1 − t) a + t b.
    #[inline]
    pub fn lerp(a: Self, b: Self, t: f32) -> Self {
        Self(a.0 + (b.0 - a.0) * t)
    }

    /// Smaller of the two, lane by lane.
    #[inline]
    pub fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    /// Larger of the two, lane by lane.
    #[inline]
    pub fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
}

impl Add for Spectrum {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0)
    }
}
impl Sub for Spectrum {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0)
    }
}
impl Mul for Spectrum {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0)
    }
}
impl Mul<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn mul(self, k: f32) -> Self {
        Self(self.0 * k)
    }
}
impl Div<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn div(self, k: f32) -> Self {
        Self(self.0 / k)
    }
}
impl AddAssign for Spectrum {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        self.0 += o.0;
    }
}
impl MulAssign for Spectrum {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        self.0 *= o.0;
    }
}
impl MulAssign<f32> for Spectrum {
    #[inline]
    fn mul_assign(&mut self, k: f32) {
        self.0 *= k;
    }
}
impl Sum for Spectrum {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ZERO, Add::add)
    }
}
