//! KHR_materials_pbrSpecularGlossiness: a diffuse base under GGX with Schlick's Fresnel, F₀ the specular colour, F₉₀ = 1.
//!
//! The extension weighs the base by 1 − max(F₀) so that it does not reflect more than it receives; here
//! [`CoupledDiffuse`] does so, at every angle and lane by lane.

use super::param::{self, Point};
use super::roughness::Microsurface;
use crate::bsdf::{Coat, CoupledDiffuse, Fresnel, Lobe, Mirror, RoughReflection};
use crate::desc;

/// The model, with what is resolved ahead of hits.
#[derive(Clone, Debug)]
pub(super) struct SpecularGlossiness {
    desc: desc::SpecularGlossiness,
    micro: Microsurface,
}

impl SpecularGlossiness {
    pub(super) fn new(desc: &desc::SpecularGlossiness) -> Self {
        Self { desc: desc.clone(), micro: Microsurface::new(desc::Roughness::Glossiness(desc.glossiness)) }
    }

    pub(super) fn is_constant(&self) -> bool {
        param::is_constant(&self.desc.diffuse) && param::is_constant(&self.desc.specular) && self.micro.is_constant()
    }

    /// Hands the lobes and their factors to `push`.
    pub(super) fn lobes(&self, at: Point, mut push: impl FnMut(Lobe, f32)) {
        let base = param::share(&self.desc.diffuse, at);
        let f0 = param::share(&self.desc.specular, at);
        let (fresnel, micro) = (Fresnel::schlick(f0, 1.0), self.micro.at(at));
        match micro {
            None => push(Lobe::Mirror(Mirror { fresnel }), 1.0),
            Some(micro) => push(Lobe::RoughReflection(RoughReflection::new(micro, fresnel)), 1.0),
        }
        if !base.is_black() {
            let coat = Coat { f0, f90: 1.0, energy: micro.map(|m| *m.energy()) };
            push(Lobe::CoupledDiffuse(CoupledDiffuse::new(base, coat)), 1.0);
        }
    }
}
