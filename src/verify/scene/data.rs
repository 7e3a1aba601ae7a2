//! Numbers of the file: finite, unit and in range.

use super::surfaces::meshes;
use super::{Subject, count, unique};
use crate::desc::parameter::Role;
use crate::desc::{self, Light, Mesh, Model, Pixels};
use crate::verify::{Findings, Task, Topic};

const TOPIC: Topic = Topic {
    id: "data",
    title: "every number is finite and every index in range; vectors are unit and reflectances between 0 and 1",
    source: "glTF 2.0, sections 3.7.2 and 3.9; a reflectance above 1 creates energy, a negative emission takes it",
};

/// Largest deviation of a unit vector's length that is not worth a word.
const UNIT: f32 = 1e-3;

/// Most reader's notes that are repeated.
const NOTES: usize = 40;

/// One task for the file.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    let subject = subject.clone();
    vec![Task::new(TOPIC, "the file", move |_, found| judge(&subject.desc, found))]
}

/// What is wrong with data: what readers never let pass, and what the renderer survives.
#[derive(Default)]
struct Faults {
    broken: Vec<String>,
    odd: Vec<String>,
}

fn judge(scene: &desc::Scene, found: &mut Findings) {
    let mut faults = Faults::default();
    for placed in meshes(scene) {
        mesh(&placed.name, placed.mesh, &mut faults);
    }
    scene.objects.iter().filter(|o| !o.to_world.is_finite()).for_each(|o| {
        faults.broken.push(format!("the matrix of `{}` is not finite", o.name));
    });
    let names = unique(scene.materials.iter().map(|m| &*m.name), "material");
    for (material, name) in scene.materials.iter().zip(&names) {
        model(name, &material.model, &mut faults);
        if let Some(e) = &material.emission {
            emission(&format!("emission of `{name}`"), e.radiance.factor, &mut faults);
        }
    }
    for object in &scene.objects {
        if let Some(e) = &object.emission {
            emission(&format!("emission of `{}`", object.name), e.radiance.factor, &mut faults);
        }
    }
    scene.images.iter().for_each(|i| image(i, &mut faults));
    scene.lights.iter().enumerate().for_each(|(i, l)| light(i, l, &mut faults));
    if let Some(e) = &scene.environment {
        emission("environment", e.radiance, &mut faults);
    }

    found.checks.holds("numbers are finite, indices in range, lists as long as they must be", faults.broken.is_empty());
    let notes = scene.notes.iter().take(NOTES).map(|note| format!("reader: {note}"));
    if faults.broken.is_empty() && faults.odd.is_empty() {
        found.words.push("every number is in its range".into());
    }
    found.words.extend(faults.broken.into_iter().chain(faults.odd).chain(notes));
}

/// How many of a list are `bad`, and which is the first.
fn tally<T>(list: &[T], bad: impl Fn(&T) -> bool) -> Option<(usize, usize)> {
    let first = list.iter().position(&bad)?;
    Some((list[first..].iter().filter(|x| bad(x)).count(), first))
}

fn mesh(name: &str, mesh: &Mesh, faults: &mut Faults) {
    let vertices = mesh.positions.len();
    let of = |what: &str, text: &str, (n, first): (usize, usize)| {
        format!("`{name}`: {} {text} (first: vertex {first})", count(n, what))
    };

    // What readers promise.
    let out = tally(&mesh.indices, |t| t.iter().any(|i| *i as usize >= vertices));
    let lengths = [mesh.normals.len(), mesh.tangents.len(), mesh.uv[0].len(), mesh.uv[1].len(), mesh.colors.len()];
    let broken = [
        tally(&mesh.positions, |p| !p.is_finite()).map(|t| of("position", "not finite", t)),
        tally(&mesh.normals, |n| !n.is_finite()).map(|t| of("normal", "not finite", t)),
        tally(&mesh.tangents, |t| !t.is_finite()).map(|t| of("tangent", "not finite", t)),
        tally(&mesh.uv[0], |uv| !uv.is_finite()).map(|t| of("texture coordinate", "not finite", t)),
        tally(&mesh.uv[1], |uv| !uv.is_finite()).map(|t| of("second texture coordinate", "not finite", t)),
        tally(&mesh.colors, |c| !c.is_finite()).map(|t| of("colour", "not finite", t)),
        out.map(|(n, first)| format!("`{name}`: {} out of range (first: {first})", count(n, "triangle"))),
        lengths
            .iter()
            .any(|l| *l != 0 && *l != vertices)
            .then(|| format!("`{name}`: attributes of lengths {lengths:?} for {vertices} vertices")),
    ];
    faults.broken.extend(broken.into_iter().flatten());

    // What shading survives.
    let not_unit = |length: f32| (length - 1.0).abs() > UNIT;
    let odd = [
        tally(&mesh.normals, |n| n.is_finite() && not_unit(n.length())).map(|t| of("normal", "not of unit length", t)),
        tally(&mesh.tangents, |t| t.is_finite() && not_unit(t.truncate().length()))
            .map(|t| of("tangent", "not of unit length", t)),
        tally(&mesh.tangents, |t| t.is_finite() && t.w.abs() != 1.0)
            .map(|t| of("tangent", "with a handedness other than ±1", t)),
        tally(&mesh.colors, |c| c.is_finite() && (c.min_element() < 0.0 || c.truncate().max_element() > 1.0))
            .map(|t| of("colour", "outside [0, 1]", t)),
    ];
    faults.odd.extend(odd.into_iter().flatten());
}

/// The parameters of a model.
fn model(name: &str, model: &Model, faults: &mut Faults) {
    model.clone().visit(&mut |mut parameter| {
        let (what, bounds) = (parameter.name, parameter.bounds);
        // Of a weight that is out of bounds its mixture tells.
        let values = parameter.value.factors().iter().filter(|_| parameter.role != Role::Weight);
        faults.odd.extend(
            values
                .filter(|x| !bounds.contain(**x))
                .map(|x| format!("`{name}`: {what} is {x}, expected {}", bounds.in_words())),
        );
    });
    mixtures(name, model, faults);
}

/// The weights of mixtures.
fn mixtures(name: &str, model: &Model, faults: &mut Faults) {
    if let Model::Mix(parts) = model {
        let sum: f32 = parts.iter().map(|(weight, _)| weight).sum();
        if sum.is_nan() || sum > 1.0 + 1e-5 || parts.iter().any(|(weight, _)| *weight < 0.0) {
            let weights: Vec<f32> = parts.iter().map(|(weight, _)| *weight).collect();
            faults.broken.push(format!("`{name}`: mixture weights {weights:?}, expected ≥ 0 with a sum ≤ 1"));
        }
        parts.iter().for_each(|(_, part)| mixtures(name, part, faults));
    }
}

fn emission(what: &str, rgb: [f32; 3], faults: &mut Faults) {
    if rgb.iter().any(|x| !x.is_finite()) {
        faults.broken.push(format!("{what}: {rgb:?} is not finite"));
    } else if rgb.iter().any(|x| *x < 0.0) {
        faults.odd.push(format!("{what}: {rgb:?} is negative, and counts as 0"));
    }
}

fn light(index: usize, light: &Light, faults: &mut Faults) {
    let (rgb, place) = match light {
        Light::Point { position, intensity, .. } => (intensity, position),
        Light::Spot { position, intensity, .. } => (intensity, position),
        Light::Profile { position, intensity, .. } => (intensity, position),
        Light::Directional { direction, irradiance } | Light::Sun { direction, irradiance, .. } => {
            (irradiance, direction)
        }
    };
    emission(&format!("light {index}"), *rgb, faults);
    if !place.is_finite() {
        faults.broken.push(format!("light {index}: {place} is not finite"));
    }
}

/// Pixels of float images: 8-bit ones are always in range.
fn image(image: &desc::Image, faults: &mut Faults) {
    let Pixels::Rgba32F(pixels) = &image.pixels else { return };
    let place = |i: usize| format!("({}, {})", i % image.size[0] as usize, i / image.size[0] as usize);
    let say = |n: usize, text: &str, first: usize| {
        format!("image `{}`: {} {text} (first: {})", image.name, count(n, "pixel"), place(first))
    };
    if let Some((n, first)) = tally(pixels, |p| p.iter().any(|x| !x.is_finite())) {
        faults.broken.push(say(n, "not finite", first));
    }
    if let Some((n, first)) = tally(pixels, |p| p[..3].iter().any(|x| *x < 0.0)) {
        faults.odd.push(say(n, "negative, and count as 0", first));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn meshes_are_looked_through() {
        let mut faults = Faults::default();
        let bent = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            indices: vec![[0, 1, 2], [0, 1, 3]],
            normals: vec![Vec3::Z, Vec3::Z * 2.0, Vec3::NAN],
            ..Mesh::default()
        };
        mesh("bent", &bent, &mut faults);
        assert_eq!(
            faults.broken,
            ["`bent`: 1 normal not finite (first: vertex 2)", "`bent`: 1 triangle out of range (first: 1)"]
        );
        assert_eq!(faults.odd, ["`bent`: 1 normal not of unit length (first: vertex 1)"]);
    }
}
