//! `type = "mix"`: several materials at once.

use super::build::Builder;
use super::interior::InteriorTable;
use super::keys::keys;
use super::material::MaterialKind;
use super::number::Fraction;
use super::read::{At, Fault};
use super::writer::Names;
use crate::desc::{Interior, Model};
use std::ops::Range;

keys! {
    /// Several materials at once, f = Σ weight f; what the weights lack to 1 is absorbed.
    struct Mix {
        /// [{ material = "name", weight = 0.5 }, …]; the weights sum to at most 1.
        parts: At<Vec<MixPart>>,
        ..interior: InteriorTable,
    }
}

keys! {
    /// One of the materials of a mixture. Only how it scatters counts, not its emission, opacity or normal map.
    struct MixPart {
        /// Name of the material.
        material: Option<At<String>>,
        /// In place of a name: the keys of a material of its own, { type = "mirror", … }.
        model: Option<At<MaterialKind>>,
        /// Its weight in [0, 1].
        weight: Fraction,
    }
}

impl Mix {
    /// The scattering model.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Model, Fault> {
        let sum: f64 = self.parts.value.iter().map(|p| f64::from(p.weight.0)).sum();
        // The written decimals are rounded, so that 0.7 + 0.2 + 0.1 may be an ulp above 1.
        if sum > 1.0 + 1e-6 {
            return Err(Fault::new(&self.parts.at, format!("the weights sum to {}, expected at most 1", sum as f32)));
        }
        b.enter_mixture(&self.parts.at)?;
        let parts = self.parts.value.iter().map(|part| Ok((part.weight.0, part.build(&self.parts.at, b)?)));
        let parts = parts.collect::<Result<_, Fault>>()?;
        b.leave_mixture();
        Ok(Model::Mix(parts))
    }

    /// The inverse of [`Self::build`]; `interior` is that of the material.
    pub(super) fn of(parts: &[(f32, Model)], interior: &Interior, names: &Names) -> Self {
        let part = |(weight, model): &(f32, Model)| MixPart {
            material: None,
            model: Some(At::nowhere(MaterialKind::of(model, &Interior::default(), names))),
            weight: Fraction(*weight),
        };
        let parts = At::nowhere(parts.iter().map(part).collect());
        Self { parts, interior: InteriorTable::of(interior) }
    }
}

impl MixPart {
    fn build(&self, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Model, Fault> {
        match (&self.material, &self.model) {
            (Some(name), None) => b.model(name),
            (None, Some(At { at, value })) => {
                if value.interior()? != Interior::default() {
                    let message = "it has an absorption, priority or dispersion, which a mixture cannot honour";
                    return Err(Fault::new(at, format!("`model`: {message}")));
                }
                value.build(at, b)
            }
            _ => Err(Fault::new(at, "a part needs one of `material` and `model`")),
        }
    }
}
