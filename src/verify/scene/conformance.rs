//! How each material of a file behaves beside the law that none sends on more than it receives: its largest albedo.
//!
//! The measurement of the topic `material`, cheaper and without a verdict: a number with its error for every
//! material of the file, worn or not.

use super::material::{Albedo, COSINES, albedo, in_words};
use super::places::places;
use super::unique;
use super::worn::Worn;
use crate::desc::{self, Model};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::verify::scattering::{Integrals, at_cosine, sampled};
use crate::verify::{Size, Trial};
use rayon::prelude::*;

/// Places of all materials together.
const PLACES: usize = 120;

/// Most places of a material.
const PLACES_OF_ONE: usize = 6;

/// Most lattice points of each replicate for an albedo.
const POINTS: u64 = 1 << 8;

/// A material, and what it sends on at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Conformance {
    /// Its name, which no other material of the file has.
    pub material: String,
    /// The largest directional albedo, over angles, places and lanes; `None` where it scatters nothing.
    pub most: Option<Albedo>,
}

/// Looks at every material of a scene: `desc` as written, `scene` compiled from it.
pub fn conformance(desc: &desc::Scene, scene: &Scene) -> Vec<Conformance> {
    let names = unique(desc.materials.iter().map(|m| &*m.name), "material");
    let places = (PLACES / desc.materials.len().max(1)).clamp(1, PLACES_OF_ONE);
    let one = |(index, material): (usize, String)| {
        let scatters = desc.materials[index].model != Model::Absorb;
        Conformance { material, most: scatters.then(|| most(desc, scene, index, places)).flatten() }
    };
    names.into_par_iter().enumerate().map(one).collect()
}

/// The largest albedo of a material over some places, from above and, where it refracts, from below.
fn most(desc: &desc::Scene, scene: &Scene, index: usize, places_of_one: usize) -> Option<Albedo> {
    let written = &desc.materials[index];
    let sides: &[f64] = if written.model.refracts() { &[1.0, -1.0] } else { &[1.0] };
    let mut found = Vec::new();
    for (number, place) in places(desc, written, index).iter().take(places_of_one).enumerate() {
        let worn = Worn { material: &scene.materials[index], textures: &scene.textures, place };
        let angles = COSINES[usize::from(number > 0)];
        for (k, mu) in sides.iter().flat_map(|side| angles.iter().map(move |mu| side * mu)).enumerate() {
            let wo = at_cosine(mu);
            let trial = Trial { seed: hash(&[index as u64, number as u64, k as u64]), size: Size::Default };
            let sampled = sampled(&trial, &worn.lobes(), wo, &Integrals::WHITE, 2e-3, POINTS);
            let at = in_words(written, &scene.textures, place, mu);
            found.extend(sampled.all.iter().map(|lane| albedo(lane, &at)));
        }
    }
    found.into_iter().max_by(|a, b| a.value.total_cmp(&b.value))
}
