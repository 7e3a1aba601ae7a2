//! `verify::scene`: healthy files pass, and each defect is found.

use radianza::desc;
use radianza::scene::Scene;
use radianza::verify::{self, Report, Size};
use std::path::Path;
use std::sync::Arc;

fn verify(scene: desc::Scene) -> Report {
    let compiled = Scene::compile(&scene).unwrap_or_else(|e| panic!("{e}"));
    let tasks = verify::scene::tasks(&Arc::new(scene), &Arc::new(compiled));
    verify::run(&tasks, Size::Default, 1, 1e-4, &|_| {})
}

fn text(report: &Report) -> String {
    let mut text = String::new();
    for section in &report.sections {
        text += &format!(
            "{}/{}: {} checks, {:.1} s\n",
            section.topic.id,
            section.subject,
            section.checks.len(),
            section.time.as_secs_f64()
        );
        section.words.iter().for_each(|w| text += &format!("    {w}\n"));
        for check in &section.checks {
            if check.p() < report.share() {
                text += &format!("    FAIL {} {:?}\n", check.name, check.evidence);
            }
        }
    }
    text
}

#[test]
fn look_at_files() {
    let Ok(files) = std::env::var("LOOK") else { return };
    for file in files.split(':') {
        println!("==== {file}");
        let start = std::time::Instant::now();
        match desc::load(Path::new(file)) {
            Ok(scene) => {
                let report = verify(scene);
                println!(
                    "{}{} checks, passes {}, {:.1} s",
                    text(&report),
                    report.checks().count(),
                    report.passes(),
                    start.elapsed().as_secs_f64()
                );
            }
            Err(e) => println!("not read: {e}"),
        }
    }
}
