//! Rows F, L, T, V and C2: the crate's scenes that carry their exact answer. The row is the beginning of the file's name;
//! the formula stands in the file's header. A new file in `scenes/verify/` is a new task.

use crate::scene::Scene;
use crate::verify::expect::{Effort, checks};
use crate::verify::{Findings, Task, Topic, Trial, scenes};

/// The rows, as the table of closed forms has them.
const ROWS: &[Topic] = &[
    row("F1", "open white furnace: L = L0, the object vanishes", "second law of thermodynamics"),
    row(
        "F2",
        "closed furnace: L = Le/(1 − ρ); after k bounces Le (1 − ρ^(k+1))/(1 − ρ)",
        "Neumann series of Kajiya 1986",
    ),
    row(
        "F3",
        "closed furnace of a mixture: DD : DS : SD : SS = p_d² : p_d p_s : p_s p_d : p_s²",
        "Neumann series by lobes",
    ),
    row("L1", "point light: E = I cos θ/r²", "Lambert 1760"),
    row("L2", "polygonal light: E = (L/2) Σ Θ_i (Γ_i·n)", "Lambert 1760; Arvo 1995"),
    row("L3", "disk light on the axis: E = π L R²/(R² + h²)", "Lambert 1760"),
    row("L4", "sphere light: E = π L (R/d)² cos θ", "Lambert 1760"),
    row("L5", "uniform environment: E = π L0; half of it behind a half-space", "∫ cos θ dω = π"),
    row("L6", "environment with one bright texel: E = L ΔΩ cos θ + the rest", "integral of n·ω over a texel"),
    row("T1", "diffuse to diffuse, integrating sphere: E = Φ/(4πR²)/(1 − ρ)", "Goebel 1967"),
    row("T2", "specular to diffuse: E = r × that of the mirrored light", "method of images"),
    row("T3", "diffuse to specular: r × the floor's radiance", "method of images"),
    row("T4", "specular to specular: slab T = (1 − F)/(1 + F), R = 2F/(1 + F); mirrors Le/(1 − r)", "Stokes 1862"),
    row("T5", "Fresnel, Snell, total reflection", "Fresnel 1823"),
    row("T6", "L/n² is invariant along refracted rays", "Straubel 1902"),
    row("I1", "an image of many periods a pixel: L = the mean of its texels", "∫ L over a pixel"),
    row("C2", "radiance along a ray in vacuum does not depend on the distance", "L(x → y) = L(y ← x)"),
    row("V1", "homogeneous absorbing medium: exp(−σ_a d), between interfaces and nested", "Beer 1852; Stokes 1862"),
    UNKNOWN,
];

/// For files whose name begins with no row.
const UNKNOWN: Topic = row("scene", "a scene that carries its exact answer", "its own header");

const fn row(id: &'static str, title: &'static str, source: &'static str) -> Topic {
    Topic { id, title, source }
}

/// Showcase scenes and the rows that they are.
const SHOWN: [(&str, &str); 4] =
    [("transport-dd", "T1"), ("transport-sd", "T2"), ("transport-ds", "T3"), ("transport-ss", "T4")];

fn topic(stem: &str) -> Topic {
    let shown = SHOWN.iter().find(|(name, _)| *name == stem).map(|(_, id)| *id);
    let id = shown.unwrap_or(stem.split('-').next().unwrap_or(stem));
    ROWS.iter().copied().find(|topic| topic.id.eq_ignore_ascii_case(id)).unwrap_or(UNKNOWN)
}

/// A task a file.
pub(super) fn tasks() -> Vec<Task> {
    let task = |name: &'static str| {
        let stem = name.rsplit('/').next().unwrap_or(name).trim_end_matches(".toml");
        let topic = topic(stem);
        Task::new(topic, stem, move |trial, found| run(name, topic.id, trial, found))
    };
    scenes::names().filter(|name| name.starts_with("verify/") || name.starts_with("transport-")).map(task).collect()
}

fn run(name: &str, row: &str, trial: &Trial, found: &mut Findings) {
    let desc = match scenes::load(name) {
        Ok(desc) => desc,
        Err(e) => return found.checks.holds(format!("can be read: {e}"), false),
    };
    let scene = match Scene::compile(&desc) {
        Ok(scene) => scene,
        Err(e) => return found.checks.holds(format!("can be compiled: {e}"), false),
    };
    found.checks.holds("an answer is given", !desc.expect.is_empty());
    let aim = trial.aim(1.0, 0.5) * if row.starts_with('F') { 1e-3 } else { 5e-3 };
    let effort = Effort { aim, own: trial.work(9e5, 1.2e7), others: trial.work(4e4, 7e5) };
    checks(&desc, &scene, effort, trial, found);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_belongs_to_a_row() {
        let tasks = tasks();
        assert!(tasks.len() >= 40, "only {} scenes found", tasks.len());
        for task in tasks {
            assert_ne!(task.topic, UNKNOWN, "{}", task.subject);
        }
    }
}
