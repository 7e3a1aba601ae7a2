//! `radianza info SCENE`.

use super::pick::Pick;
use super::{Failure, conformance};
use radianza::desc::{self, Camera, Fov, Projection};
use radianza::scene::Scene;
use std::path::PathBuf;

/// Say what a scene holds.
#[derive(clap::Args, Debug)]
pub(crate) struct Arguments {
    /// The scene: .toml, .gltf, .glb, .obj or .ply
    #[arg(required_unless_present = "schema")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    pick: Pick,
    /// Print the JSON Schema of .toml scenes, for editors to complete and check them
    #[arg(long, conflicts_with = "scene")]
    schema: bool,
    /// Say what becomes of each glTF extension that the file names (honoured, approximated, carried, ignored), and how
    /// much of the light each material sends on at most: above 1 it would create energy
    #[arg(long, conflicts_with = "schema")]
    conformance: bool,
    /// Print the conformance as JSON
    #[arg(long, requires = "conformance")]
    json: bool,
}

/// Prints it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(path) = &arguments.scene else {
        println!("{}", desc::toml::schema());
        return Ok(());
    };
    let options = arguments.pick.options();
    let scene = desc::load_with(path, &options)?;
    let compiled = Scene::compile(&scene)?;
    if arguments.conformance {
        return conformance::print(path, &scene, &compiled, arguments.json);
    }
    let info = compiled.info();
    println!("scene      {} ({})", scene.name, path.display());
    let [min, max] = [info.bounds.min, info.bounds.max];
    println!("bounds     {min} to {max} m");
    print!("surfaces   {} triangles", info.triangles);
    if info.stored_triangles != info.triangles {
        print!(" ({} stored, {} instances)", info.stored_triangles, info.instances);
    }
    println!(", {} spheres, disks and cylinders, {} objects", info.quadrics, scene.objects.len());
    let kind = |m: &desc::Material| format!("{} ({})", m.name, m.model.kind());
    println!("materials  {}", list(&scene.materials.iter().map(kind).collect::<Vec<_>>()));
    println!("textures   {} of {} images", info.textures, scene.images.len());
    println!("lights     {}", info.lights);
    if let Some(end) = scene.duration {
        let now = options.at.map_or("the pose that the nodes state".into(), |t| format!("{t} s"));
        println!("time       {now}, of animations of {end} s");
    }
    if !scene.variants.is_empty() {
        let now = options.variant.map_or("none".into(), |name| format!("`{name}`"));
        println!("variant    {now}, of {}", list(&scene.variants));
    }
    print!(
        "memory     {}",
        memory(&[("meshes", info.mesh_bytes), ("trees", info.bvh_bytes), ("images", info.texture_bytes)])
    );
    match (info.mesh_bytes + info.bvh_bytes).checked_div(info.stored_triangles) {
        Some(bytes) => println!(", {bytes} bytes a triangle"),
        None => println!(),
    }
    for (index, camera) in scene.cameras.iter().enumerate() {
        let name = if camera.name.is_empty() { String::new() } else { format!("`{}` ", camera.name) };
        println!("camera {index}   {name}{}", view(camera));
    }
    scene.notes.iter().for_each(|text| println!("note: {text}"));
    Ok(())
}

/// How many, and the first of their names.
fn list(names: &[String]) -> String {
    const SHOWN: usize = 20;
    let more = if names.len() > SHOWN { ", …" } else { "" };
    format!("{}: {}{more}", names.len(), names[..names.len().min(SHOWN)].join(", "))
}

fn memory(parts: &[(&str, usize)]) -> String {
    let mib = |bytes: usize| format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20));
    let parts_text: Vec<String> = parts.iter().map(|(name, bytes)| format!("{name} {}", mib(*bytes))).collect();
    format!("{} ({})", mib(parts.iter().map(|(_, bytes)| bytes).sum()), parts_text.join(", "))
}

fn view(camera: &Camera) -> String {
    let projection = match camera.projection {
        Projection::Perspective { fov: Fov::Horizontal(angle) } => format!("{:.2}° across", angle.to_degrees()),
        Projection::Perspective { fov: Fov::Vertical(angle) } => format!("{:.2}° upright", angle.to_degrees()),
        Projection::Orthographic { half_height } => format!("orthographic, {} m high", 2.0 * half_height),
        Projection::Equirectangular => "equirectangular".into(),
    };
    let size = camera.resolution.map_or(String::new(), |[w, h]| format!(", {w}×{h}"));
    let lens =
        camera.lens.map_or(String::new(), |l| format!(", lens {} m in focus at {} m", l.radius, l.focus_distance));
    format!("{projection}{size}{lens}")
}
