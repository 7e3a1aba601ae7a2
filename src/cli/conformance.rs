//! `radianza info SCENE --conformance`.

use super::Failure;
use radianza::desc;
use radianza::scene::Scene;
use radianza::verify::scene::{Conformance, conformance};
use serde_json::{Value, json};
use std::path::Path;

/// Prints what becomes of the extensions of a file, and what its materials send on at most.
pub(crate) fn print(path: &Path, scene: &desc::Scene, compiled: &Scene, as_json: bool) -> Result<(), Failure> {
    let materials = conformance(scene, compiled);
    if as_json {
        println!("{:#}", report(path, scene, &materials));
        return Ok(());
    }
    println!("scene      {} ({})", scene.name, path.display());
    println!("extensions {}", scene.extensions.len());
    for used in &scene.extensions {
        let required = if used.required { ", required" } else { "" };
        println!("  {:<12} {}{required}: {}", used.word(), used.name, used.sentence());
    }
    println!("materials  {}; the largest share of light that each sends on", materials.len());
    for Conformance { material, most } in &materials {
        match most {
            Some(most) => println!("  {:.4} ± {:.4} {material} ({})", most.value, most.se, most.at),
            None => println!("  nothing         {material}"),
        }
    }
    scene.notes.iter().for_each(|text| println!("note: {text}"));
    Ok(())
}

/// Extensions and materials of a file as JSON.
fn report(path: &Path, scene: &desc::Scene, materials: &[Conformance]) -> Value {
    let extension = |used: &desc::gltf::Use| json!({ "name": used.name, "required": used.required, "status": used.word(), "meaning": used.sentence() });
    let material = |c: &Conformance| match &c.most {
        Some(most) => {
            json!({ "name": c.material, "largest_albedo": most.value, "standard_error": most.se, "at": most.at })
        }
        None => json!({ "name": c.material, "largest_albedo": 0.0, "standard_error": 0.0, "at": null }),
    };
    json!({
        "scene": scene.name,
        "file": path.to_string_lossy(),
        "extensions": scene.extensions.iter().map(extension).collect::<Vec<_>>(),
        "materials": materials.iter().map(material).collect::<Vec<_>>(),
        "metadata": scene.metadata,
        "notes": scene.notes,
    })
}
