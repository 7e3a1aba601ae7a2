//! Light from infinity: uniform, or an equirectangular image.

use super::LightSample;
use crate::bsdf::Pdf;
use crate::desc;
use crate::math::sqr;
use crate::spectrum::Spectrum;
use crate::warp::{Table2, UNIFORM_SPHERE_PDF, uniform_sphere};
use glam::{Mat3, Vec3, Vec3A};
use std::f32::consts::{FRAC_1_PI, PI};
use std::f64::consts as f64s;

/// Radiance that arrives from all around.
///
/// An image is taken as it is stored, every texel a constant radiance over its part of the sphere: column c of W spans
/// longitudes 2πc/W … 2π(c + 1)/W, row r of H the polar angles πr/H … π(r + 1)/H from +y. Texels are drawn with
/// probability proportional to luminance × solid angle, the solid angle ΔΩ = (2π/W)(cos θᵣ − cos θᵣ₊₁) being exact at
/// the poles too, and directions uniformly over the texel's solid angle; so Lₑ and density have the same steps, and
/// Lₑ/pdf of a grey image is constant. Bilinear look-ups would need a density that follows them.
#[derive(Clone, Debug)]
pub struct Environment {
    radiance: Spectrum,
    texels: Option<Texels>,
    to_world: Mat3,
}

/// An image of the sphere of directions.
#[derive(Clone, Debug)]
pub struct Texels {
    size: [usize; 2],
    /// Radiance, row by row, the environment's factor included.
    radiance: Vec<[f32; 3]>,
    /// cos θ at the upper edge of each row, and −1.
    cos_theta: Vec<f64>,
    /// 1/(W H ΔΩ) of each row: from density over the unit square to density over solid angle.
    row_density: Vec<f32>,
    /// Luminance × solid angle; `None` where all is black.
    table: Option<Table2>,
}

impl Environment {
    /// As written, with the image that it names, if any.
    pub fn new(environment: &desc::Environment, image: Option<&desc::Image>) -> Self {
        Self {
            radiance: Spectrum::from_rgb(environment.radiance),
            texels: image.map(|image| Texels::new(image, environment.radiance)),
            to_world: environment.to_world,
        }
    }

    /// Whether it has no image: the same radiance from everywhere.
    pub fn is_uniform(&self) -> bool {
        self.texels.is_none()
    }

    /// Lₑ \[W·sr⁻¹·m⁻²\] that arrives from the unit vector `wi`.
    #[inline]
    pub fn le(&self, wi: Vec3A) -> Spectrum {
        match &self.texels {
            None => self.radiance,
            Some(texels) => texels.radiance_at(texels.find(self.to_local(wi))),
        }
    }

    /// Density over solid angle with which [`sample`](Self::sample) draws `wi`.
    #[inline]
    pub fn pdf(&self, wi: Vec3A) -> f32 {
        match &self.texels {
            None => UNIFORM_SPHERE_PDF,
            Some(texels) => texels.pdf_at(texels.find(self.to_local(wi))),
        }
    }

    /// [`le`](Self::le) and [`pdf`](Self::pdf) of the same direction.
    #[inline]
    pub fn le_and_pdf(&self, wi: Vec3A) -> (Spectrum, f32) {
        match &self.texels {
            None => (self.radiance, UNIFORM_SPHERE_PDF),
            Some(texels) => {
                let texel = texels.find(self.to_local(wi));
                (texels.radiance_at(texel), texels.pdf_at(texel))
            }
        }
    }

    /// Draws a direction from which light arrives.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Option<LightSample> {
        let (local, le, pdf) = match &self.texels {
            None => (uniform_sphere(u), self.radiance, UNIFORM_SPHERE_PDF),
            Some(texels) => texels.sample(u)?,
        };
        let wi = (self.to_world * local).into();
        let pdf = Pdf::SolidAngle(pdf);
        (!le.is_black()).then_some(LightSample::from_infinity(wi, le, pdf))
    }

    /// ∫ Lₑ dω over the sphere \[W/m²\].
    pub fn fluence(&self) -> Spectrum {
        match &self.texels {
            None => self.radiance * (4.0 * PI),
            Some(texels) => texels.integral(),
        }
    }

    /// Φ = π R² ∫ Lₑ dω: what enters a sphere of radius R.
    pub fn power(&self, scene_radius: f32) -> Spectrum {
        self.fluence() * (PI * sqr(scene_radius))
    }

    #[inline]
    fn to_local(&self, wi: Vec3A) -> Vec3 {
        // The transpose of a rotation is its inverse.
        self.to_world.transpose_mul_vec3(wi.into())
    }
}

impl Texels {
    /// Of an image times `factor`; images of 8 and 16 bits hold sRGB. What is negative or not finite counts as 0.
    fn new(image: &desc::Image, factor: [f32; 3]) -> Self {
        let size = image.size.map(|n| n as usize);
        let sane = |x: f32| if x.is_finite() { x.max(0.0) } else { 0.0 };
        let scaled = |rgb: [f32; 3]| [0, 1, 2].map(|i| sane(rgb[i] * factor[i]));
        let radiance: Vec<[f32; 3]> = match &image.pixels {
            desc::Pixels::Rgba32F(pixels) => pixels.iter().map(|&[r, g, b, _]| scaled([r, g, b])).collect(),
            desc::Pixels::Rgba8(pixels) => pixels
                .iter()
                .map(|&[r, g, b, _]| scaled([r, g, b].map(|c| srgb_to_linear(f32::from(c) / 255.0))))
                .collect(),
            desc::Pixels::Rgba16(pixels) => pixels
                .iter()
                .map(|&[r, g, b, _]| scaled([r, g, b].map(|c| srgb_to_linear(f32::from(c) / 65_535.0))))
                .collect(),
        };

        let height = size[1] as f64;
        let cos_theta = (0..=size[1]).map(|row| (f64s::PI * row as f64 / height).cos()).collect();
        let solid_angles: Vec<f64> = (0..size[1]).map(|row| solid_angle(size, row)).collect();
        let texels = (size[0] * size[1]) as f64;
        let row_density = solid_angles.iter().map(|omega| (1.0 / (texels * omega)) as f32).collect();
        let weight = |(i, rgb): (usize, &[f32; 3])| {
            let weight = Spectrum::from_rgb(*rgb).luminance() * solid_angles[i / size[0]] as f32;
            // What shines at all is drawn at times.
            if *rgb == [0.0; 3] { 0.0 } else { weight.clamp(f32::MIN_POSITIVE, f32::MAX) }
        };
        let weights: Vec<f32> = radiance.iter().enumerate().map(weight).collect();
        Self { size, radiance, cos_theta, row_density, table: Table2::new(&weights, size) }
    }

    /// Column and row that the local direction lies in. The polar angle comes from atan2, which is exact at the poles.
    #[inline]
    fn find(&self, w: Vec3) -> [usize; 2] {
        let u = 0.5 + 0.5 * FRAC_1_PI * w.x.atan2(-w.z);
        let v = FRAC_1_PI * w.x.hypot(w.z).atan2(w.y);
        let bin = |x: f32, n: usize| ((x * n as f32) as usize).min(n - 1);
        [bin(u, self.size[0]), bin(v, self.size[1])]
    }

    #[inline]
    fn radiance_at(&self, [column, row]: [usize; 2]) -> Spectrum {
        Spectrum::from_rgb(self.radiance[row * self.size[0] + column])
    }

    #[inline]
    fn pdf_at(&self, [column, row]: [usize; 2]) -> f32 {
        let centre = |i: usize, n: usize| (i as f32 + 0.5) / n as f32;
        let p = [centre(column, self.size[0]), centre(row, self.size[1])];
        self.table.as_ref().map_or(0.0, |table| table.pdf(p) * self.row_density[row])
    }

    /// A texel, and a direction uniform over its solid angle. Radiance and density are those of the texel drawn, even
    /// where rounding carries the direction over its edge.
    #[inline]
    fn sample(&self, u: [f32; 2]) -> Option<(Vec3, Spectrum, f32)> {
        let ([column, row], within, pdf) = self.table.as_ref()?.choose(u);
        let [x, y] = within.map(f64::from);
        let (cos_top, cos_bottom) = (self.cos_theta[row], self.cos_theta[row + 1]);
        let cos = cos_top + y * (cos_bottom - cos_top);
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let longitude = f64s::TAU * ((column as f64 + x) / self.size[0] as f64 - 0.5);
        let w = Vec3::new((sin * longitude.sin()) as f32, cos as f32, (-sin * longitude.cos()) as f32);
        Some((w, self.radiance_at([column, row]), pdf * self.row_density[row]))
    }

    /// Σ L ΔΩ.
    fn integral(&self) -> Spectrum {
        let mut sum = [0.0f64; 3];
        for (row, texels) in self.radiance.chunks_exact(self.size[0]).enumerate() {
            let omega = solid_angle(self.size, row);
            for texel in texels {
                (0..3).for_each(|i| sum[i] += f64::from(texel[i]) * omega);
            }
        }
        Spectrum::from_rgb(sum.map(|x| x as f32))
    }
}

/// ΔΩ = (2π/W)(cos θᵣ − cos θᵣ₊₁) = (2π/W) 2 sin θ̄ sin(π/2H), with θ̄ the row's middle: no cancellation at the poles.
fn solid_angle([width, height]: [usize; 2], row: usize) -> f64 {
    let step = f64s::PI / height as f64;
    f64s::TAU / width as f64 * 2.0 * (step * (row as f64 + 0.5)).sin() * (0.5 * step).sin()
}

/// IEC 61966-2-1.
fn srgb_to_linear(x: f32) -> f32 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}
