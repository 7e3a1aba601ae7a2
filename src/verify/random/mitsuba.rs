//! Mitsuba 3 as an oracle that shares no line with this crate.
//!
//! The environment variable `RADIANZA_MITSUBA` names a Python that has it. Scenes that [`export`] says without a note are
//! rendered by both.

use crate::desc::export::{ExportError, Target, View, export};
use crate::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use crate::render::Settings;
use crate::verify::Findings;
use crate::verify::agreement::agreement;
use crate::verify::replicated::{Replicated, renders};
use crate::verify::scene::Subject;
use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

/// Names the Python.
const VARIABLE: &str = "RADIANZA_MITSUBA";

/// Independent images.
const PARTS: usize = 64;

/// Pixels across and down.
const SIDE: u32 = 16;

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

/// Checks that Mitsuba makes the same image, where it has the same models.
pub(super) fn compare(python: &OsString, subject: &Subject, rays: u64, seed: u64, found: &mut Findings) {
    let rays_of_a_path = 8;
    let samples = (rays / (rays_of_a_path * u64::from(SIDE * SIDE) * PARTS as u64)).clamp(1, 1 << 16);
    let samples = (samples as u32).next_power_of_two();
    match theirs(python, &subject.desc, samples, seed) {
        Ok(None) => {}
        Ok(Some(theirs)) => match renders(&subject.scene, &settings(samples, seed)) {
            Ok(ours) => {
                let (theirs, ours) = ((&theirs).into(), (&ours.beauty).into());
                found.exhibits.extend(agreement(&mut found.checks, "Mitsuba against Mis", &theirs, &ours));
            }
            Err(e) => found.checks.holds(format!("an image is made: {e}"), false),
        },
        Err(e) => found.checks.holds(format!("Mitsuba renders it: {e}"), false),
    }
}

/// Mitsuba's image in independent parts; nothing where it cannot say the scene exactly.
fn theirs(python: &OsString, desc: &desc::Scene, spp: u32, seed: u64) -> Result<Option<Replicated>, String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let path = folder.path().join("scene.xml");
    let size = [SIDE; 2];
    let view = View { camera: 0, size, spp, max_depth: None, integrator: Integrator::Path, filter: Filter::Box };
    match export(desc, &view, Target::Mitsuba, &path) {
        Ok(written) if written.notes.is_empty() => {}
        Ok(_) | Err(ExportError::Scene(_)) => return Ok(None),
        Err(e) => return Err(e.to_string()),
    }
    render(python, &path, seed).map(Some)
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

fn settings(spp: u32, seed: u64) -> Settings {
    Settings {
        size: [SIDE; 2],
        crop: [0, 0, SIDE, SIDE],
        camera: 0,
        spp,
        time: None,
        replicate: spp,
        integrator: Integrator::Path,
        strategy: Strategy::Mis,
        sampler: SamplerKind::Lattice,
        seed: seed >> 11,
        max_depth: None,
        filter: Filter::Box,
        transport: false,
        threads: 0,
        tile: u32::MAX,
    }
}
