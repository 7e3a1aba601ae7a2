//! Mitsuba 3 as an oracle that shares no line with this crate.
//!
//! The environment variable `RADIANZA_MITSUBA` names a Python that has it. Of each scene, what [`export`] says without a
//! note is rendered by both: edits that leave fewer notes are kept until there is none.

use super::prune::prune;
use super::shrink::candidates;
use super::{SIDE, settings, simpler};
use crate::desc::export::{ExportError, Target, View, Written, export};
use crate::desc::{self, Filter, Integrator, Shape};
use crate::verify::Findings;
use crate::verify::agreement::agreement;
use crate::verify::replicated::{Replicated, renders};
use crate::verify::scene::Subject;
use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

/// Names the Python.
pub(super) const VARIABLE: &str = "RADIANZA_MITSUBA";

/// Independent images.
const PARTS: usize = 64;

/// Prints the pixels of each part, RGB, row by row, a part a line.
const SCRIPT: &str = "
import sys, numpy as np, mitsuba as mi
mi.set_variant('scalar_rgb')
scene = mi.load_file(sys.argv[1])
for seed in range(int(sys.argv[2])):
    print(*np.array(mi.render(scene, seed=seed + int(sys.argv[3])), dtype=np.float64).ravel())
";

/// The Python to ask, where there is one.
pub(super) fn python() -> Option<OsString> {
    std::env::var_os(VARIABLE)
}

/// Checks that Mitsuba makes the same image of a scene that it can say exactly.
pub(super) fn compare(python: &OsString, subject: &Subject, rays: u64, seed: u64, found: &mut Findings) {
    let rays_of_a_path = 8;
    let samples = (rays / (rays_of_a_path * u64::from(SIDE * SIDE) * PARTS as u64)).clamp(1, 1 << 16);
    let samples = (samples as u32).next_power_of_two();
    match theirs(python, &subject.desc, samples, seed) {
        Ok(theirs) => match renders(&subject.scene, &settings(samples, seed)) {
            Ok(ours) if is_dark(&ours.beauty) => {}
            Ok(ours) => {
                let (theirs, ours) = ((&theirs).into(), (&ours.beauty).into());
                found.exhibits.extend(agreement(&mut found.checks, "Mitsuba against Mis", &theirs, &ours));
            }
            Err(e) => found.checks.holds(format!("an image is made: {e}"), false),
        },
        Err(e) => found.checks.holds(format!("Mitsuba renders it: {e}"), false),
    }
}

/// Next to nothing is seen, where lights are of the order of 1: Mitsuba, whose rays begin a fixed part of their coordinates off a
/// surface, lets some light through the edges of closed boxes, a hundred-thousandth of what is inside.
fn is_dark(image: &Replicated) -> bool {
    (0..3).all(|channel| image.moments(image.whole(), channel).mean() < 1e-3)
}

/// What Mitsuba can say exactly of a scene; nothing where no light is left of it.
pub(super) fn sayable(desc: &desc::Scene) -> Option<desc::Scene> {
    let mut scene = desc.clone();
    let mut left = notes(&scene);
    while left > 0 {
        // Single things last to first: the largest stand first.
        let edits = simpler::plainer(&scene).into_iter().chain(candidates(&scene).into_iter().rev());
        let fewer = edits.map(|edited| prune(&edited)).find_map(|edited| {
            let notes = notes(&edited);
            (notes < left).then_some((edited, notes))
        });
        (scene, left) = fewer?;
    }
    let shines = |o: &desc::Object| o.emission.is_some() || scene.materials[o.material].emission.is_some();
    let is_lit = scene.environment.is_some() || !scene.lights.is_empty() || scene.objects.iter().any(shines);
    is_lit.then_some(scene)
}

/// How many things of a scene Mitsuba cannot say exactly: what notes name, and interpolated normals, whose leaked light it
/// drops.
fn notes(desc: &desc::Scene) -> usize {
    let Ok(folder) = tempfile::tempdir() else { return usize::MAX };
    let smooth = |shape: &&Shape| matches!(shape, Shape::Mesh(mesh) if !mesh.normals.is_empty());
    let smooth = desc.shapes.iter().filter(smooth).count();
    written(desc, &folder.path().join("scene.xml"), 1).map_or(usize::MAX, |written| written.notes.len() + smooth)
}

/// Writes the scene for Mitsuba.
fn written(desc: &desc::Scene, path: &Path, spp: u32) -> Result<Written, ExportError> {
    let size = [SIDE; 2];
    let view = View { camera: 0, size, spp, max_depth: None, integrator: Integrator::Path, filter: Filter::Box };
    export(desc, &view, Target::Mitsuba, path)
}

/// Mitsuba's image in independent parts.
fn theirs(python: &OsString, desc: &desc::Scene, spp: u32, seed: u64) -> Result<Replicated, String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let path = folder.path().join("scene.xml");
    written(desc, &path, spp).map_err(|e| e.to_string())?;
    render(python, &path, seed)
}

fn render(python: &OsString, path: &Path, seed: u64) -> Result<Replicated, String> {
    // Mitsuba counts seeds in 32 bits.
    let first = (seed >> 40).to_string();
    let output = Command::new(python).args(["-c", SCRIPT]).arg(path).args([&PARTS.to_string(), &first]).output();
    let output = output.map_err(|e| e.to_string())?;
    let part = |line: &str| {
        let numbers: Option<Vec<f64>> = line.split_whitespace().map(|x| x.parse().ok()).collect();
        let pixels: Vec<[f64; 3]> = numbers?.as_chunks().0.to_vec();
        (pixels.len() == (SIDE * SIDE) as usize).then_some(pixels)
    };
    let images: Option<Vec<_>> = String::from_utf8_lossy(&output.stdout).lines().map(part).collect();
    match images.filter(|images| images.len() == PARTS) {
        Some(images) => Ok(Replicated { size: [SIDE as usize; 2], images }),
        None => Err(String::from_utf8_lossy(&output.stderr).trim().to_owned()),
    }
}
