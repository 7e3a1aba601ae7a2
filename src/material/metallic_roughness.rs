//! glTF 2.0's metallic-roughness model (appendix B) with KHR_materials_ior, _specular, _transmission,
//! _diffuse_transmission and _iridescence.
//!
//! The specification's mixture is kept, its energy is not: `fresnel_mix` as written reflects more than it receives at
//! grazing angles, so the diffuse base is coupled to the coat by [`CoupledDiffuse`]. With m metalness, t transmission
//! and c base colour, f is the sum of
//!
//! * GGX with Schlick's F of the mixture (1 − m) dielectric + m metal, F₀ = c for the metal;
//! * (1 − m)(1 − t)(1 − d) c under the dielectric coat, diffuse; and of diffuse transmission d the same to the other side,
//!   (1 − m)(1 − t) d with its own colour for c;
//! * (1 − m) t c through the dielectric coat, unbent: thin walls; or, with a volume, the exact refracting interface in
//!   place of (1 − m) t of the coat and the base, tinted by c.
//!
//! Under a film of KHR_materials_iridescence, F is Airy's sum over a base of index (1 + √F₀)/(1 − √F₀), of the dielectric
//! and of the metal, and not Schlick's; the refracting interface of a volume shares out between reflection and refraction as
//! the film does.

use super::classic::Dielectric;
use super::iridescence::{Covering, filmed_energy};
use super::param::{self, Point};
use super::roughness::{Microsurface, alpha_bounds};
use crate::bsdf::{
    Coat, CoupledDiffuse, FilmedEnergy, Fresnel, Lobe, Mirror, RoughReflection, RoughThin, ThinTransmission,
    multiple_scattering,
};
use crate::desc;
use crate::spectrum::Spectrum;
use std::sync::Arc;

/// The model, with what is resolved ahead of hits.
#[derive(Clone, Debug)]
pub(super) struct MetallicRoughness {
    desc: desc::MetallicRoughness,
    micro: Microsurface,
    /// ((n − 1)/(n + 1))².
    f0: f32,
    /// The interface of a volume.
    interface: Option<Dielectric>,
    /// Its energies under a film, where it is rough somewhere.
    filmed: Option<Arc<FilmedEnergy>>,
}

impl MetallicRoughness {
    pub(super) fn new(desc: &desc::MetallicRoughness) -> Self {
        let roughness = match &desc.layers.anisotropy {
            Some(a) => desc::Roughness::Stretched { roughness: desc.roughness, strength: a.strength },
            None => desc::Roughness::Perceptual(desc.roughness),
        };
        let n = desc.ior;
        // An index of 0 stands for infinity.
        let f0 = if n > 0.0 { normal_reflectance(n) } else { 1.0 };
        let interface = desc.refracts().then(|| Dielectric::new(n, roughness, desc.base_color));
        let micro = Microsurface::new(roughness);
        if desc.iridescence.is_some() {
            micro.prepare_series();
        }
        let filmed = desc.iridescence.as_ref().filter(|_| interface.is_some() && n >= 1.0).and_then(|film| {
            let bounds = alpha_bounds(&roughness)?;
            Some(Arc::new(filmed_energy(film, n, bounds)))
        });
        Self { desc: desc.clone(), micro, f0, interface, filmed }
    }

    pub(super) fn is_constant(&self) -> bool {
        let d = &self.desc;
        let transmission = d.transmission.as_ref().map(|t| &t.factor);
        [Some(&d.metallic), Some(&d.roughness), Some(&d.specular), transmission]
            .into_iter()
            .flatten()
            .all(|p| p.texture.is_none())
            && self.micro.is_constant()
            && d.diffuse_transmission
                .as_ref()
                .is_none_or(|t| t.factor.texture.is_none() && param::is_constant(&t.color))
            && param::is_constant(&d.base_color)
            && param::is_constant(&d.specular_color)
            && d.iridescence.as_ref().is_none_or(Covering::is_constant)
    }

    /// Hands the lobes and their factors to `push`.
    pub(super) fn lobes(&self, at: Point, mut push: impl FnMut(Lobe, f32)) {
        let d = &self.desc;
        let base = param::share(&d.base_color, at);
        let metallic = param::scalar(&d.metallic, at);
        let transmission = d.transmission.as_ref().map_or(0.0, |t| param::scalar(&t.factor, at));
        let specular = param::scalar(&d.specular, at);
        let f0_full = at.eta.map_or(self.f0, normal_reflectance);
        let f0_full = (param::color(&d.specular_color, at) * f0_full).min(Spectrum::ONE);
        let f0 = f0_full * specular;
        let micro = self.micro.at(at);
        let film = Covering::at(d.iridescence.as_ref(), at);

        // The refracting interface takes its share of everything that is not metal.
        let dielectric = match &self.interface {
            Some(interface) => {
                let lobe = match &film {
                    Some(film) if d.ior >= 1.0 => {
                        film.interface(at.eta.unwrap_or(d.ior), base, micro.zip(self.filmed.as_ref()))
                    }
                    _ => interface.lobe(at),
                };
                push(lobe, (1.0 - metallic) * transmission);
                (1.0 - metallic) * (1.0 - transmission)
            }
            None => 1.0 - metallic,
        };
        let (through, beneath) = if self.interface.is_some() { (0.0, 1.0) } else { (transmission, 1.0 - transmission) };

        // Fresnel terms and multiple scattering of the mixture are the mixtures of theirs: both are linear in f.
        let loss = micro.map_or(0.0, |m| m.energy().mean_loss());
        let f_ms = |f: &Fresnel| multiple_scattering(f.average(), loss);
        let (coat, metal) = match &film {
            None => (Fresnel::schlick(f0, specular), Fresnel::schlick(base, 1.0)),
            // What is not there is not summed.
            Some(film) => {
                let there = |share: f32| f32::from(share > 0.0);
                (film.over(f0_full, specular * there(dielectric)), film.over(base, there(metallic)))
            }
        };
        let mixed = coat.mixed(dielectric, &metal, metallic);
        let mixed_f_ms = f_ms(&coat) * dielectric + f_ms(&metal) * metallic;
        match micro {
            _ if dielectric * specular + metallic == 0.0 => (),
            None => push(Lobe::Mirror(Mirror { fresnel: mixed }), 1.0),
            Some(micro) => push(Lobe::RoughReflection(RoughReflection::with(micro, mixed, mixed_f_ms)), 1.0),
        }

        if dielectric * beneath > 0.0 {
            let under = Coat { f0, f90: specular, energy: micro.map(|m| *m.energy()) };
            let coupled = |color| match film {
                None => CoupledDiffuse::new(color, under),
                Some(_) => CoupledDiffuse::under(color, under, &coat),
            };
            let mut reflects = 1.0;
            if let Some(t) = &d.diffuse_transmission {
                let (share, color) = (param::scalar(&t.factor, at), param::share(&t.color, at));
                reflects -= share;
                if share > 0.0 && !color.is_black() {
                    // Beside a refracting interface the radiance behind is that of its index.
                    let eta = if self.interface.is_some() { at.eta.unwrap_or(d.ior) } else { 1.0 };
                    let lobe = Lobe::DiffuseTransmission { base: coupled(color), eta };
                    push(lobe, dielectric * beneath * share);
                }
            }
            if reflects > 0.0 && !base.is_black() {
                push(Lobe::CoupledDiffuse(coupled(base)), dielectric * beneath * reflects);
            }
        }
        if dielectric * through > 0.0 && !base.is_black() {
            let lobe = match micro {
                None => Lobe::ThinTransmission(ThinTransmission { fresnel: coat, tint: base }),
                Some(micro) => Lobe::RoughThin(RoughThin::new(micro, coat, base)),
            };
            push(lobe, dielectric * through);
        }
    }
}

/// ((n − 1)/(n + 1))² of a relative index.
fn normal_reflectance(n: f32) -> f32 {
    ((n - 1.0) / (n + 1.0)).powi(2)
}
