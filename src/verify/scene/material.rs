//! Every material of a file, as compiled: does it scatter by its density, both ways alike, and no more than it
//! receives?
//!
//! A material is looked at where its textures are extreme ([`super::places`]). Beside it stands the same material made
//! white ([`super::white`]): what that loses is no absorption by colour, but energy that the model itself drops.

use super::places::{Place, places};
use super::white::lossless;
use super::worn::{Worn, parameters};
use super::{Subject, count, unique};
use crate::desc;
use crate::material::Material;
use crate::stats::{Evidence, Moments};
use crate::texture::Textures;
use crate::verify::scattering::{Claims, Integrals, at_cosine, density, draws, energy, reciprocity, sampled};
use crate::verify::{Curve, Exhibit, Findings, Task, Topic, Trial};

const TOPIC: Topic = Topic {
    id: "material",
    title: "f is reciprocal, its draws follow their density, and ∫ f |cos θ| dω ≤ 1",
    source: "conservation of energy; Helmholtz; Pearson's χ²",
};

/// Most materials of the default size.
const MATERIALS: usize = 40;

/// Places of all materials together, by size.
const PLACES: [usize; 2] = [90, 900];

/// Most places of a material, by size.
const PLACES_OF_ONE: [usize; 2] = [6, 30];

/// Cosines of the angles to the normal, at a material's first place and at the others.
pub(super) const COSINES: [&[f64]; 2] = [&[0.97, 0.7, 0.4, 0.15, 0.05, 0.01], &[0.7, 0.15, 0.02]];

/// Cosines at which draws are counted in bins, at a material's first place.
const COUNTED: [f64; 2] = [0.7, 0.15];

/// Relative error of tables in energy, and of f32 in f.
const CLAIMS: Claims = Claims { lossless: false, reciprocal: true, two_sided: false, granted: 1e-3, rounding: 1e-2 };

/// A task for each material that something wears, equal ones once.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    let all = &subject.desc.materials;
    let names = unique(all.iter().map(|m| &*m.name), "material");
    let mut worn = vec![false; all.len()];
    subject.desc.objects.iter().for_each(|o| worn[o.material] = true);
    let scatters = |m: &desc::Material| m.model != desc::Model::Absorb;
    let equal = |a: &desc::Material, b: &desc::Material| a.model == b.model;

    // Materials that scatter alike are one.
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, material) in all.iter().enumerate().filter(|(i, m)| worn[*i] && scatters(m)) {
        match groups.iter_mut().find(|group| equal(&all[group[0]], material)) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    let left_out: Vec<String> = names
        .iter()
        .zip(all)
        .zip(&worn)
        .filter(|((_, m), worn)| !**worn || !scatters(m))
        .map(|((name, _), worn)| format!("`{name}` {}", if *worn { "scatters nothing" } else { "is worn by nothing" }))
        .collect();
    let n = groups.len();

    // Of many materials a task takes several, and in the default size the first of them.
    let chunk = n.div_ceil(MATERIALS).max(1);
    let task = |(number, chunk): (usize, &[Vec<usize>])| {
        let (subject, chunk, names) = (subject.clone(), chunk.to_vec(), names.clone());
        let left_out = if number == 0 { left_out.clone() } else { Vec::new() };
        Task::new(TOPIC, names[chunk[0][0]].clone(), move |trial, found| {
            let most = trial.pick(PLACES[0], PLACES[1]) / n;
            let most = most.clamp(1, trial.pick(PLACES_OF_ONE[0], PLACES_OF_ONE[1]));
            let examined = trial.pick(1, chunk.len());
            for group in &chunk[..examined] {
                let (index, name) = (group[0], &*names[group[0]]);
                let prefix = if examined > 1 { format!("{name}, ") } else { String::new() };
                Exam { subject: &subject, index, name, prefix: &prefix, most }.sit(trial, found);
                if group.len() > 1 {
                    let same = list(group[1..].iter().map(|i| &*names[*i]));
                    found.words.push(format!("`{name}`: the same holds of {same}, which scatter alike"));
                }
            }
            if examined < chunk.len() {
                let others = list(chunk[examined..].iter().map(|group| &*names[group[0]]));
                found.words.push(format!("left out of this size: {others}"));
            }
            if !left_out.is_empty() {
                found.words.push(format!("nothing to examine: {}", left_out.join(", ")));
            }
        })
    };
    groups.chunks(chunk).enumerate().map(task).collect()
}

/// "`a`, `b`".
fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// One material under test.
struct Exam<'a> {
    subject: &'a Subject,
    index: usize,
    name: &'a str,
    /// Before the names of checks, where there are several materials.
    prefix: &'a str,
    /// Most places.
    most: usize,
}

/// A directional albedo with where it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Albedo {
    /// Share of the light that is sent on, in one lane.
    pub value: f64,
    /// Its standard error.
    pub se: f64,
    /// Parameters and angle: `roughness 0.80, metal 1.00, cos 0.1`.
    pub at: String,
}

impl Exam<'_> {
    /// What is granted to tables: the atlas of two roughnesses is coarser.
    fn granted(&self) -> f64 {
        match &self.subject.desc.materials[self.index].model {
            desc::Model::MetallicRoughness(m) if m.layers.anisotropy.is_some() => 4e-3,
            _ => CLAIMS.granted,
        }
    }

    fn sit(&self, trial: &Trial, found: &mut Findings) {
        let desc = &self.subject.desc;
        let (written, textures) = (&desc.materials[self.index], &self.subject.scene.textures);
        let white = lossless(written).map(|m| Material::compile(&m));
        let mut all = places(desc, written, self.index);
        let left = all.len().saturating_sub(self.most);
        all.truncate(self.most);
        let two_sided = written.model.refracts();
        let claims = Claims { two_sided, ..CLAIMS };
        let (mut albedos, mut losses) = (Vec::new(), Vec::new());
        let mut lines = Vec::new();
        for (number, place) in all.iter().enumerate() {
            let place_name = if place.name.is_empty() { "anywhere" } else { &*place.name };
            let name = &format!("{}{place_name}", self.prefix);
            let worn = Worn { material: &self.subject.scene.materials[self.index], textures, place };
            let trial = &trial.part(name);
            reciprocity(found, trial, name, &worn.lobes(), &claims);
            for side in [1.0, -1.0].into_iter().take(if two_sided { 2 } else { 1 }) {
                let cosines = COSINES[usize::from(number > 0)];
                let curve = self.angles(found, trial, name, &worn, side, cosines, number == 0);
                let lost = white.as_ref().map(|w| self.loss(found, trial, name, w, textures, place, side, cosines));
                let below = if side < 0.0 { ", from below" } else { "" };
                for lane in 0..3 {
                    let line = |of: &[[Albedo; 3]]| {
                        let point = |(mu, a): (&f64, &[Albedo; 3])| [*mu, a[lane].value, a[lane].se];
                        cosines.iter().zip(of).rev().map(point).collect::<Vec<_>>()
                    };
                    lines.push((format!("{name}{below}, {}", ["red", "green", "blue"][lane]), line(&curve)));
                }
                albedos.extend(curve.into_iter().flatten());
                if let Some(white) = lost {
                    let points = cosines.iter().zip(&white).rev().map(|(mu, a)| [*mu, a.value, a.se]).collect();
                    lines.push((format!("{name}{below}, made white"), points));
                    losses.extend(white);
                }
            }
        }
        let axes = ["cos θ", "directional albedo"];
        found.exhibits.push(Exhibit::Curve(Curve { title: format!("albedo of `{}`", self.name), axes, lines }));
        found.words.extend(self.verdict(&albedos, &losses));
        if left > 0 {
            found.words.push(format!("`{}`: {} left out of this size", self.name, count(left, "place")));
        }
    }

    /// All that must hold at one place, angle by angle; returns albedos by lane.
    fn angles(
        &self,
        found: &mut Findings,
        trial: &Trial,
        name: &str,
        worn: &Worn,
        side: f64,
        cosines: &[f64],
        first: bool,
    ) -> Vec<[Albedo; 3]> {
        let mut curve = Vec::new();
        for &mu in cosines {
            let wo = at_cosine(side * mu);
            let (bsdf, at) = (worn.lobes(), format!("{name}, cos {}", side * mu));
            let trial = &trial.part(&at);
            draws(found, trial, &at, &bsdf, wo, CLAIMS.rounding);
            let sampled = sampled(trial, &bsdf, wo, &Integrals::WHITE, 2e-3, trial.work(1 << 10, 1 << 15));
            let counted = first && COUNTED.contains(&mu);
            if counted && bsdf.has_needle() {
                found.words.push(format!("`{}`: {at}: so stretched that χ² is left out", self.name));
            }
            if counted && !bsdf.has_needle() {
                let integrals = density(found, trial, &at, &bsdf, wo);
                energy(found, &at, &Claims { granted: self.granted(), ..CLAIMS }, &integrals, &sampled);
            } else {
                let brightest = (0..3).max_by(|a, b| sampled.all[*a].mean().total_cmp(&sampled.all[*b].mean()));
                let evidence = Evidence::at_most(1.0, &sampled.all[brightest.unwrap_or(0)], self.granted());
                found.checks.push(format!("{at}: albedo ≤ 1"), evidence);
            }
            let at = self.place(worn.place, side * mu);
            curve.push(sampled.all.each_ref().map(|m| albedo(m, &at)));
        }
        curve
    }

    /// What the material, made white, sends on at each angle: it must be all.
    fn loss(
        &self,
        found: &mut Findings,
        trial: &Trial,
        name: &str,
        white: &Material,
        textures: &Textures,
        place: &Place,
        side: f64,
        cosines: &[f64],
    ) -> Vec<Albedo> {
        let worn = Worn { material: white, textures, place };
        let one = |&mu: &f64| {
            let (wo, at) = (at_cosine(side * mu), format!("{name}, made white, cos {}", side * mu));
            let sampled =
                sampled(&trial.part(&at), &worn.lobes(), wo, &Integrals::WHITE, 2e-3, trial.work(1 << 10, 1 << 15));
            found.checks.replicated(format!("{at}: albedo = 1"), 1.0, &sampled.all[1], self.granted());
            albedo(&sampled.all[1], &self.place(place, side * mu))
        };
        cosines.iter().map(one).collect()
    }

    /// "roughness 0.80, cos 0.1".
    fn place(&self, place: &Place, mu: f64) -> String {
        in_words(&self.subject.desc.materials[self.index], &self.subject.scene.textures, place, mu)
    }

    /// "`gold`: reflects at most 0.94 (…)", and what it loses or creates.
    fn verdict(&self, albedos: &[Albedo], whites: &[Albedo]) -> Vec<String> {
        let name = self.name;
        let by = |a: &&Albedo, b: &&Albedo| a.value.total_cmp(&b.value);
        let Some((most, least)) = albedos.iter().max_by(by).zip(albedos.iter().min_by(by)) else { return Vec::new() };
        let text = |a: &Albedo| format!("{:.4} ± {:.4} ({})", a.value, a.se, a.at);
        let mut words = vec![format!("`{name}`: sends on at most {}, at least {}", text(most), text(least))];
        if most.value - 1.0 > 6.0 * most.se + self.granted() {
            words.push(format!("`{name}`: creates energy: {:.2} % at {}", 100.0 * (most.value - 1.0), most.at));
        }
        let Some(worst) = whites.iter().max_by(|a, b| (a.value - 1.0).abs().total_cmp(&(b.value - 1.0).abs())) else {
            return words;
        };
        let (off, se) = (100.0 * (worst.value - 1.0), 100.0 * worst.se);
        if off.abs() > 6.0 * se + 100.0 * self.granted() {
            let what = if off < 0.0 { "loses" } else { "creates" };
            words.push(format!("`{name}`: made white it {what} {:.2} ± {se:.2} % at {}", off.abs(), worst.at));
        } else {
            words.push(format!("`{name}`: made white it sends on all, within {:.2} ± {se:.2} %", off.abs()));
        }
        words
    }
}

/// "roughness 0.80, cos 0.1".
pub(super) fn in_words(material: &desc::Material, textures: &Textures, place: &Place, mu: f64) -> String {
    let parts = [place.name.clone(), parameters(material, textures, place), format!("cos {mu}")];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

pub(super) fn albedo(m: &Moments, at: &str) -> Albedo {
    Albedo { value: m.mean(), se: m.standard_error(), at: at.into() }
}
