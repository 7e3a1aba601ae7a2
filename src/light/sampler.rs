//! Which light is asked.

use super::tree::{LightBounds, LightTree};
use super::{Alias, Light, LightSampleContext};
use crate::math::sqr;
use std::f32::consts::PI;

/// Share of the choice by power that is spread evenly over all lights that shine: a weak lamp beside a strong sky is
/// still asked now and then, which bounds the variance that it can cause where it is near.
const EVEN: f64 = 0.01;

/// From this many lights with a place the tree chooses.
const MANY: usize = 3;

/// Share of the choice by power beside the tree: whatever rounding does to a bound, no light that shines is lost.
const BY_POWER: f32 = 0.01;

/// Least share of the lights at infinity, and of the others, where both may send something: who of them is hidden is
/// not known.
const LEAST: f32 = 0.25;

/// The light sampler: chooses one of all lights, by power where they are few, by what each can send to the receiver where they are
/// many.
#[derive(Clone, Debug, Default)]
pub struct LightSampler {
    /// By power; `None` where nothing shines.
    alias: Option<Alias>,
    /// Where there are many.
    many: Option<Box<Many>>,
}

/// The lights with a place in a tree, those at infinity beside it.
#[derive(Clone, Debug)]
struct Many {
    tree: LightTree,
    /// Of all lights, by irradiance, those with a place having none; `None` where nothing is at infinity.
    infinite: Option<Alias>,
    /// Irradiance from infinity in units of the tree's importance.
    irradiance: f32,
}

impl LightSampler {
    /// Among lights of these luminous `fluxes` (0: never chosen) in a scene of this radius.
    pub fn new(lights: &[Light], fluxes: &[f64], radius: f32) -> Self {
        let total: f64 = fluxes.iter().sum();
        let shining = fluxes.iter().filter(|&&flux| flux > 0.0).count() as f64;
        let share = |&flux: &f64| if flux > 0.0 { (1.0 - EVEN) * flux / total + EVEN / shining } else { 0.0 };
        let alias = Alias::new(&fluxes.iter().map(share).collect::<Vec<_>>());
        let many = if lights.len() < MANY { None } else { Many::new(lights, fluxes, radius).map(Box::new) };
        Self { alias, many }
    }

    /// Chooses among these lights by power alone, however many they are: what the tree is measured against.
    pub fn by_power(self) -> Self {
        Self { many: None, ..self }
    }

    /// Whether nothing shines.
    pub fn is_empty(&self) -> bool {
        self.alias.is_none()
    }

    /// A light and its probability, at `uc`; `None` where no light reaches the receiver. A way down a deep tree, and a
    /// choice among a hundred thousand, take more than the 24 bits of `uc`: the others are hashed from `u`, which places
    /// the point on the light.
    #[inline(always)]
    pub fn choose(&self, receiver: &LightSampleContext, uc: f32, u: [f32; 2]) -> Option<(u32, f32)> {
        let alias = self.alias.as_ref()?;
        match &self.many {
            None => {
                let index = alias.choose(if alias.is_wide() { finer(uc, u) } else { f64::from(uc) });
                Some((index as u32, alias.probability(index)))
            }
            Some(many) => self.choose_of(many, alias, receiver, uc, u),
        }
    }

    #[inline(never)]
    fn choose_of(
        &self,
        many: &Many,
        alias: &Alias,
        receiver: &LightSampleContext,
        uc: f32,
        u: [f32; 2],
    ) -> Option<(u32, f32)> {
        let fine = finer(uc, u);
        let by_power = f64::from(BY_POWER);
        if fine < by_power {
            let index = alias.choose(fine / by_power) as u32;
            return Some((index, self.probability(receiver, index)));
        }
        let (index, probability) = many.choose(receiver, (fine - by_power) / (1.0 - by_power))?;
        Some((index, BY_POWER * alias.probability(index as usize) + (1.0 - BY_POWER) * probability))
    }

    /// Probability with which [`choose`](Self::choose) gives the light.
    #[inline]
    pub fn probability(&self, receiver: &LightSampleContext, light: u32) -> f32 {
        let Some(alias) = &self.alias else { return 0.0 };
        let by_power = alias.probability(light as usize);
        match &self.many {
            None => by_power,
            Some(many) => BY_POWER * by_power + (1.0 - BY_POWER) * many.probability(receiver, light),
        }
    }
}

impl Many {
    /// `None` where fewer than [`MANY`] have a place.
    fn new(lights: &[Light], fluxes: &[f64], radius: f32) -> Option<Self> {
        let bounds = |(light, &flux): (&Light, &f64)| if flux > 0.0 { light.bounds(flux) } else { None };
        let bounds: Vec<Option<LightBounds>> = lights.iter().zip(fluxes).map(bounds).collect();
        if bounds.iter().flatten().count() < MANY {
            return None;
        }

        // In units of all intensity over the squared radius of the scene.
        let area = f64::from(sqr(radius));
        let scale = area / bounds.iter().flatten().map(|b| b.intensity).sum::<f64>();
        let irradiance = |(light, &flux): (&Light, &f64)| match light {
            Light::Directional(_) | Light::Sun(_) => flux / (f64::from(PI) * area),
            Light::Environment(_) => flux / (4.0 * f64::from(PI) * area),
            Light::Triangle(_) | Light::Quadric(_) | Light::Point(_) | Light::Spot(_) | Light::Profile(_) => 0.0,
        };
        let irradiances: Vec<f64> = lights.iter().zip(fluxes).map(irradiance).collect();
        let irradiance = (irradiances.iter().sum::<f64>() * scale).min(1e30) as f32;
        Some(Self { tree: LightTree::new(&bounds, scale)?, infinite: Alias::new(&irradiances), irradiance })
    }

    /// Share of the lights at infinity.
    #[inline]
    fn infinite_share(&self, receiver: &LightSampleContext) -> f32 {
        if self.infinite.is_none() {
            return 0.0;
        }
        let placed = self.tree.importance(receiver);
        if placed > 0.0 { LEAST + (1.0 - 2.0 * LEAST) * (self.irradiance / (self.irradiance + placed)) } else { 1.0 }
    }

    #[inline]
    fn choose(&self, receiver: &LightSampleContext, u: f64) -> Option<(u32, f32)> {
        let share = self.infinite_share(receiver);
        let at = f64::from(share);
        if u < at {
            let alias = self.infinite.as_ref()?;
            let index = alias.choose(u / at);
            return Some((index as u32, share * alias.probability(index)));
        }
        let (light, probability) = self.tree.choose(receiver, (u - at) / (1.0 - at))?;
        Some((light, (1.0 - share) * probability))
    }

    #[inline]
    fn probability(&self, receiver: &LightSampleContext, light: u32) -> f32 {
        let share = self.infinite_share(receiver);
        let infinite = self.infinite.as_ref().map_or(0.0, |alias| alias.probability(light as usize));
        if infinite > 0.0 { share * infinite } else { (1.0 - share) * self.tree.probability(receiver, light) }
    }
}

/// `uc` with 29 bits more.
#[inline]
fn finer(uc: f32, u: [f32; 2]) -> f64 {
    f64::from(uc) + f64::from(scrambled(u)) * 2f64.powi(-56)
}

/// 32 bits that depend on all bits of both numbers (the finaliser of MurmurHash3, 64 bits).
#[inline]
fn scrambled(u: [f32; 2]) -> u32 {
    let mut h = u64::from(u[0].to_bits()) << 32 | u64::from(u[1].to_bits());
    h = (h ^ (h >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    h = (h ^ (h >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    (h >> 32) as u32
}
