//! All lights of a scene, and the choice of one.

use super::{Light, LightSample, LightSampleContext, LightSampler};
use crate::bsdf::Pdf;
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use glam::{Vec2, Vec3, Vec3A, Vec4};

/// Most look-ups into the textures of emissive surfaces, all together.
const LOOKUPS: usize = 1 << 24;

/// The lights of a scene, one of which is asked at a time.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    lights: Vec<Light>,
    powers: Vec<Spectrum>,
    environments: Vec<u32>,
    choice: LightSampler,
}

impl Lights {
    /// Lights of a scene within the sphere of this centre and radius. A light has probability 0 only where its radiance
    /// is 0 everywhere; how the others share is the business of [`LightSampler`].
    pub fn new(mut lights: Vec<Light>, (_center, radius): (Vec3, f32), textures: &Textures) -> Self {
        // A scene of one point, or of none, is still lit from infinity.
        let radius = if radius.is_finite() { radius.clamp(1e-12, 1e15) } else { 1.0 };
        // Look at what surfaces show, for a time that does not grow with their number.
        let lookups = LOOKUPS / lights.iter().filter(|light| light.is_pictured()).count().max(1);
        lights.iter_mut().for_each(|light| light.divide(textures, lookups));

        let powers: Vec<Spectrum> = lights.iter().map(|light| light.power(radius)).collect();
        let is_environment = |i: &u32| lights[*i as usize].surrounds();
        let environments = (0..lights.len() as u32).filter(is_environment).collect();
        // A power that overflowed is a great one.
        let weight = |p: &Spectrum| {
            let y = f64::from(p.luminance());
            if p.is_black() { 0.0 } else { y.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) }
        };
        let fluxes: Vec<f64> = powers.iter().map(weight).collect();
        let choice = LightSampler::new(&lights, &fluxes, radius);
        Self { lights, powers, environments, choice }
    }

    /// These lights, one of which is chosen by power alone, however many they are: what the tree is measured against.
    pub fn by_power(self) -> Self {
        Self { choice: self.choice.by_power(), ..self }
    }

    /// Draws light that arrives at the receiver: `uc` chooses the light, `u` the point on it. The density (or
    /// probability) includes that of the choice.
    #[inline(always)]
    pub fn sample(
        &self,
        receiver: &LightSampleContext,
        uc: f32,
        u: [f32; 2],
        textures: &Textures,
    ) -> Option<(u32, LightSample)> {
        let (index, choice) = self.choose(receiver, uc, u)?;
        let light = &self.lights[index as usize];
        let mut sample = light.sample(receiver.p, u, textures)?;
        sample.pdf = match sample.pdf {
            Pdf::SolidAngle(pdf) => Pdf::SolidAngle(pdf * choice),
            Pdf::Discrete(probability) => Pdf::Discrete(probability * choice),
        };
        // Several environments, or a sun in the sky, are one: a direction meets all of them.
        if self.environments.len() > 1 && light.surrounds() {
            let (le, pdf) = self.environment_le_and_pdf(receiver, sample.wi);
            (sample.le, sample.pdf) = (le, Pdf::SolidAngle(pdf));
        }
        Some((index, sample))
    }

    /// Density over solid angle with which [`sample`](Self::sample) for the receiver draws the point `p`, with geometric
    /// normal `ng`, of area light number `light`.
    #[inline]
    pub fn pdf_hit(&self, light: u32, receiver: &LightSampleContext, p: Vec3A, ng: Vec3A) -> f32 {
        self.choice(light, receiver) * self.lights[light as usize].pdf(receiver.p, p, ng)
    }

    /// The light that [`sample`](Self::sample) asks for these numbers, and its probability; `None` where no light reaches
    /// the receiver.
    #[inline(always)]
    pub fn choose(&self, receiver: &LightSampleContext, uc: f32, u: [f32; 2]) -> Option<(u32, f32)> {
        self.choice.choose(receiver, uc, u)
    }

    /// Probability with which this light is chosen for the receiver.
    #[inline]
    pub fn choice(&self, light: u32, receiver: &LightSampleContext) -> f32 {
        self.choice.probability(receiver, light)
    }

    /// Radiance that area light number `light` emits at a point of it, at the cosine `cos` to its normal.
    #[inline]
    pub fn le(&self, light: u32, uv: &[Vec2; 2], color: Vec4, cos: f32, textures: &Textures) -> Spectrum {
        self.lights[light as usize].le(uv, color, cos, textures)
    }

    /// Radiance that arrives along a ray that met nothing, from the unit vector `wi`.
    #[inline]
    pub fn environment_le(&self, wi: Vec3A) -> Spectrum {
        self.environments().map(|(_, light)| light.le_from(wi)).sum()
    }

    /// Density over solid angle with which [`sample`](Self::sample) for the receiver draws `wi` from the environments.
    #[inline]
    pub fn environment_pdf(&self, receiver: &LightSampleContext, wi: Vec3A) -> f32 {
        self.environment_le_and_pdf(receiver, wi).1
    }

    /// [`environment_le`](Self::environment_le) and [`environment_pdf`](Self::environment_pdf) at once.
    #[inline(never)]
    pub fn environment_le_and_pdf(&self, receiver: &LightSampleContext, wi: Vec3A) -> (Spectrum, f32) {
        self.environments().fold((Spectrum::ZERO, 0.0), |(le, pdf), (i, light)| {
            let (own_le, own_pdf) = light.le_and_pdf_from(wi);
            // What a sun's disk does not cover need not be asked for its choice.
            let own_pdf = if own_pdf == 0.0 { 0.0 } else { self.choice(i, receiver) * own_pdf };
            (le + own_le, pdf + own_pdf)
        })
    }

    /// Whether there is nothing to sample.
    pub fn is_empty(&self) -> bool {
        self.choice.is_empty()
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
    fn environments(&self) -> impl Iterator<Item = (u32, &Light)> {
        self.environments.iter().map(|&i| (i, &self.lights[i as usize]))
    }
}
