//! All lights of a scene, and the choice of one.

use super::{Alias, Light, LightSample};
use crate::bsdf::Pdf;
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use glam::{Vec2, Vec3, Vec4};
use std::cell::OnceCell;

/// Share of the choice that is spread evenly over all lights that shine: a weak lamp beside a strong sky is still
/// asked now and then, which bounds the variance that it can cause where it is near.
const EVEN: f64 = 0.01;

/// The lights of a scene, chosen with probability by power.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    lights: Vec<Light>,
    powers: Vec<Spectrum>,
    environments: Vec<u32>,
    /// `None` where nothing shines.
    alias: Option<Alias>,
}

impl Lights {
    /// Lights of a scene within the sphere of this centre and radius. A light has probability 0 only where its radiance
    /// is 0 everywhere; the others share in proportion to the luminance of their flux, and a little evenly.
    pub fn new(lights: Vec<Light>, (_center, radius): (Vec3, f32), textures: &Textures) -> Self {
        // A scene of one point, or of none, is still lit from infinity.
        let radius = if radius.is_finite() { radius.clamp(1e-12, 1e15) } else { 1.0 };
        let means: Vec<OnceCell<Vec4>> = vec![OnceCell::new(); textures.len()];
        let mean = |texture: usize| *means[texture].get_or_init(|| textures.mean(texture));
        let powers: Vec<Spectrum> = lights.iter().map(|light| light.power(radius, &mean)).collect();
        let is_environment = |i: &u32| matches!(lights[*i as usize], Light::Environment(_));
        let environments = (0..lights.len() as u32).filter(is_environment).collect();
        // A power that overflowed is a great one.
        let weight = |p: &Spectrum| {
            let y = f64::from(p.luminance());
            if p.is_black() { 0.0 } else { y.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) }
        };
        let weights: Vec<f64> = powers.iter().map(weight).collect();
        let total: f64 = weights.iter().sum();
        let shining = weights.iter().filter(|&&w| w > 0.0).count() as f64;
        let share = |&w: &f64| if w > 0.0 { (1.0 - EVEN) * w / total + EVEN / shining } else { 0.0 };
        let alias = Alias::new(&weights.iter().map(share).collect::<Vec<_>>());
        Self { lights, powers, environments, alias }
    }

    /// Draws light that arrives at `p`: `uc` chooses the light, `u` the point on it. The density (or probability)
    /// includes that of the choice.
    #[inline]
    pub fn sample(&self, p: Vec3, uc: f32, u: [f32; 2], textures: &Textures) -> Option<(u32, LightSample)> {
        let alias = self.alias.as_ref()?;
        let index = alias.choose(uc);
        let choice = alias.probability(index);
        let light = &self.lights[index];
        let mut sample = light.sample(p, u, textures)?;
        sample.pdf = match sample.pdf {
            Pdf::SolidAngle(pdf) => Pdf::SolidAngle(pdf * choice),
            Pdf::Discrete(probability) => Pdf::Discrete(probability * choice),
        };
        // Several environments are one: a direction meets all of them.
        if self.environments.len() > 1 && matches!(light, Light::Environment(_)) {
            sample.le = self.environment_le(sample.wi);
            sample.pdf = Pdf::SolidAngle(self.environment_pdf(sample.wi));
        }
        Some((index as u32, sample))
    }

    /// Density over solid angle with which [`sample`](Self::sample) at `reference` draws the point `p`, with geometric
    /// normal `ng`, of area light number `light`.
    #[inline]
    pub fn pdf_hit(&self, light: u32, reference: Vec3, p: Vec3, ng: Vec3) -> f32 {
        self.choice(light) * self.lights[light as usize].pdf(reference, p, ng)
    }

    /// Probability with which this light is chosen.
    #[inline]
    pub fn choice(&self, light: u32) -> f32 {
        self.alias.as_ref().map_or(0.0, |alias| alias.probability(light as usize))
    }

    /// Radiance that area light number `light` emits at a point of it, at the cosine `cos` to its normal.
    #[inline]
    pub fn le(&self, light: u32, uv: &[Vec2; 2], color: Vec4, cos: f32, textures: &Textures) -> Spectrum {
        self.lights[light as usize].le(uv, color, cos, textures)
    }

    /// Radiance that arrives along a ray that met nothing, from the unit vector `wi`.
    #[inline]
    pub fn environment_le(&self, wi: Vec3) -> Spectrum {
        self.environments().map(|(_, environment)| environment.le(wi)).sum()
    }

    /// Density over solid angle with which [`sample`](Self::sample) draws `wi` from the environments.
    #[inline]
    pub fn environment_pdf(&self, wi: Vec3) -> f32 {
        self.environments().map(|(i, environment)| self.choice(i) * environment.pdf(wi)).sum()
    }

    /// Whether there is nothing to sample.
    pub fn is_empty(&self) -> bool {
        self.alias.is_none()
    }

    /// The lights, in the order in which they are numbered.
    pub fn all(&self) -> &[Light] {
        &self.lights
    }

    /// Flux of one light \[W\].
    pub fn power(&self, light: u32) -> Spectrum {
        self.powers[light as usize]
    }

    /// Flux of all lights \[W\].
    pub fn total_power(&self) -> Spectrum {
        self.powers.iter().copied().sum()
    }

    #[inline]
    fn environments(&self) -> impl Iterator<Item = (u32, &super::Environment)> {
        self.environments.iter().filter_map(|&i| match &self.lights[i as usize] {
            Light::Environment(environment) => Some((i, &**environment)),
            _ => None,
        })
    }
}
