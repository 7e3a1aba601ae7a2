//! A report with everything that one can hold.

use radianza::stats::{Moments, normal_quantile};
use radianza::verify::report::About;
use radianza::verify::{Curve, Exhibit, HeatMap, Picture, Report, Size, Task, Topic, run};

const ALBEDO: Topic = Topic {
    id: "A5",
    title: "directional albedo ∫ f |cos θ| dω ≤ 1 for every parameter and direction; = 1 where nothing absorbs",
    source: "Heitz, Hanika, d'Eon & Dachsbacher 2016, with multiple scattering between facets",
};
const DENSITY: Topic =
    Topic { id: "D1", title: "samples follow their density: χ² over bins", source: "Pearson 1900" };
const AGREE: Topic = Topic { id: "X1", title: "estimators of one integral agree <b>everywhere</b>", source: "" };

pub(crate) fn about() -> About {
    About {
        what: "furniture & <script>alert(1)</script>.glb".into(),
        command: "radianza verify 'furniture.glb' --seed 0 --alpha 0.0001 --thorough --only 'a very long pattern'"
            .into(),
    }
}

/// Two subjects fail: one by an estimate, one by a picture.
pub(crate) fn report() -> Report {
    let names = ["plastic α 0.1", "gold", "<script>alert(2)</script>", "silk"];
    let mut tasks: Vec<Task> = names.into_iter().map(albedo).collect();
    let nameless = "a-name-without-any-space-in-it-".repeat(6);
    tasks.extend((0..8).map(|i| density(&format!("lobe {i} {}", if i == 7 { &nameless } else { "" }))));
    tasks.push(Task::new(ALBEDO, "glass α 0.8", |_, found| {
        found.checks.estimate("cos θ 0.1", 1.0, 0.94, 0.001);
        found.words.push("`glass α 0.8`: reflects at most 0.94, loses 6 % at roughness 0.8, cos 0.1.".into());
    }));
    tasks.push(Task::new(AGREE, "uniform and light", |_, found| {
        found.checks.holds("no pixel is brighter than the environment", false);
        found.exhibits.push(picture());
    }));
    run(&tasks, Size::Default, 3, 1e-4, &|_| {})
}

fn albedo(name: &'static str) -> Task {
    Task::new(ALBEDO, name, move |_, found| {
        // Quantiles of the normal in place of chance.
        for i in 0..60 {
            let z = normal_quantile((f64::from(i) + 0.5) / 60.0);
            found.checks.estimate(format!("cos θ {:.2}", f64::from(i) / 60.0), 0.75, 0.75 + 1e-4 * z, 1e-4);
        }
        let same: Moments = [1.0, 1.0].into_iter().collect();
        found.checks.moments("constant", 1.0, &same);
        found.words.push(format!("`{name}`: reflects at most 0.75."));
        if name == "gold" || name == "silk" {
            found.exhibits.push(curve(name));
        }
    })
}

fn density(name: &str) -> Task {
    let title = format!("{name}: bins of equal solid angle");
    let with_map = name.starts_with("lobe 3");
    Task::new(DENSITY, name, move |_, found| {
        found.checks.p("χ²", 0.4);
        found.checks.bound("pdf of the sample is pdf of its direction", 3e-7, 1e-6);
        if with_map {
            let expected: Vec<f64> = (0..32 * 16).map(|i| 200.0 * (1.0 - f64::from(i / 32) / 16.0)).collect();
            let z = |i: usize| normal_quantile(((i * 197) as f64 * 0.618).fract().clamp(1e-3, 0.999));
            let observed = expected.iter().enumerate().map(|(i, e)| (e + z(i) * e.sqrt()).round()).collect();
            let axes = ["φ", "θ"];
            found.exhibits.push(Exhibit::HeatMap(HeatMap {
                title: title.clone(),
                axes,
                columns: 32,
                observed,
                expected,
            }));
        }
    })
}

fn curve(name: &str) -> Exhibit {
    let line = |alpha: f64| {
        let point = |i: i32| [f64::from(i) / 20.0, 1.0 - 0.3 * alpha * (1.0 - f64::from(i) / 20.0), 0.004];
        (format!("α {alpha}"), (0..=20).map(point).collect())
    };
    let lines = [0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0].into_iter().map(line).collect();
    Exhibit::Curve(Curve { title: format!("{name}: albedo"), axes: ["cos θ", "directional albedo"], lines })
}

fn picture() -> Exhibit {
    let [w, h] = [48, 32];
    let pixel = |i: u32| match (i % w, i / w) {
        (20..24, 10..14) => [1.0, 0.1, 0.1],
        (40, 20) => [f32::NAN; 3],
        (x, y) => [0.2 + 0.01 * x as f32, 0.5, 0.2 + 0.01 * y as f32],
    };
    Exhibit::Picture(Picture { title: "z of each pixel".into(), size: [w, h], pixels: (0..w * h).map(pixel).collect() })
}
