//! `radianza export SCENE -o FILE`.

use super::pick::Pick;
use super::settings::{SPP, camera, resolution};
use super::{Failure, args, environment};
use radianza::desc::export::{ExportError, Target, View, export, write_toml};
use radianza::desc::{self, Filter, Integrator};
use std::path::PathBuf;

/// Write a scene for another renderer, or in our own format. What is given here counts before what the scene's [render]
/// says, and that before the defaults. What another renderer cannot say is approximated or left out, and a note names it;
/// our own format says everything, and its image is the same to the bit.
#[derive(clap::Args, Debug)]
pub(crate) struct Arguments {
    /// The scene: .toml, .gltf, .glb, .obj or .ply
    scene: PathBuf,
    #[command(flatten)]
    pick: Pick,
    /// The file: .toml for our own format, .xml for Mitsuba 3, .pbrt for pbrt-v4. Its meshes and images go into the folder
    /// NAME-toml, NAME-mitsuba or NAME-pbrt beside it
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Samples per pixel [128]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    spp: Option<u32>,
    /// Width and height in pixels [the camera's, else 1280x720]
    #[arg(long, value_name = "WxH", value_parser = args::size)]
    size: Option<[u32; 2]>,
    /// The camera [the first]
    #[arg(long, value_name = "NAME|INDEX")]
    camera: Option<String>,
    /// Which part of the rendering equation is solved [path]
    #[arg(long)]
    integrator: Option<Integrator>,
    /// Most reflections and refractions of a path [none]
    #[arg(long, value_name = "N")]
    max_depth: Option<u32>,
    /// Pixel filter [blackman-harris]; box is the same everywhere
    #[arg(long)]
    filter: Option<Filter>,
    /// Light from infinity: an equirectangular EXR or HDR image in place of the scene's environment
    #[arg(long, value_name = "FILE")]
    env: Option<PathBuf>,
    /// No notes or summary
    #[arg(short, long)]
    quiet: bool,
}

/// Writes the files.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = &arguments.output;
    let own = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let target = Target::of(path);
    if target.is_none() && !own {
        let message = format!(
            "`{}` is no name of a scene; expected .toml (our own format), .xml (Mitsuba 3) or .pbrt (pbrt-v4)",
            path.display()
        );
        return Err(Failure::Usage(message));
    }
    let mut scene = desc::load_with(&arguments.scene, &arguments.pick.options())?;
    if let Some(path) = &arguments.env {
        environment::replace(&mut scene, path)?;
    }
    let camera = camera(arguments.camera.as_deref(), &scene.cameras)?;
    let written = match target {
        Some(target) => export(&scene, &view(arguments, &scene, camera), target, path),
        None => write_toml(&chosen(arguments, scene.clone(), camera), path),
    };
    let written = written.map_err(|e| match e {
        ExportError::Scene(e) => Failure::Scene(e),
        ExportError::Output(path, e) => Failure::Output(path, e),
    })?;
    if !arguments.quiet {
        scene.notes.iter().for_each(|text| eprintln!("note: {text}"));
        let name = target.map_or("toml", Target::name);
        written.notes.iter().for_each(|text| eprintln!("note: {name}: {text}"));
        eprintln!("wrote {} and {} files beside it", path.display(), written.files);
    }
    Ok(())
}

/// What another renderer is to render of the scene.
fn view(arguments: &Arguments, scene: &desc::Scene, camera: usize) -> View {
    let file = &scene.render;
    View {
        camera,
        size: arguments.size.unwrap_or_else(|| resolution(&scene.cameras[camera])),
        spp: arguments.spp.or(file.spp).unwrap_or(SPP),
        max_depth: arguments.max_depth.or(file.max_depth),
        integrator: arguments.integrator.or(file.integrator).unwrap_or_default(),
        filter: arguments.filter.or(file.filter).unwrap_or_default(),
    }
}

/// The scene with what the command line says of its camera and settings; the chosen camera comes first.
fn chosen(arguments: &Arguments, mut scene: desc::Scene, camera: usize) -> desc::Scene {
    scene.cameras[..=camera].rotate_right(1);
    scene.cameras[0].resolution = arguments.size.or(scene.cameras[0].resolution);
    let render = &mut scene.render;
    render.spp = arguments.spp.or(render.spp);
    render.max_depth = arguments.max_depth.or(render.max_depth);
    render.integrator = arguments.integrator.or(render.integrator);
    render.filter = arguments.filter.or(render.filter);
    scene
}
