//! `radianza render SCENE`.

use super::args::{self, Replay};
use super::pick::Pick;
use super::progress::{Report, speed};
use super::settings::{self, Choices};
use super::{Failure, environment, interrupt, meter};
use radianza::bvh::Quality;
use radianza::desc::{self, Filter, Integrator, SamplerKind, Strategy, Tonemap};
use radianza::film::exr::write_exr;
use radianza::film::file::check_writable;
use radianza::film::png::write_png;
use radianza::film::{Group, Header, Invalid, Origin, develop};
use radianza::render::{self, Output, Settings};
use radianza::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Bad samples that are listed one by one.
const LISTED: usize = 10;

/// Render a scene. What is given here counts before what the scene's [render] says, and that before the defaults.
#[derive(clap::Args, Debug)]
pub(crate) struct Arguments {
    /// The scene: .toml, .gltf, .glb, .obj or .ply
    scene: PathBuf,
    #[command(flatten)]
    pick: Pick,
    /// The image; out/NAME.exr without
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The image for screens; the EXR's name with .png without
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,
    /// Samples per pixel [128], rounded up to whole replicates
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) spp: Option<u32>,
    /// Stop after the pass that ends past this time (60s, 2m, 1h30m); without --spp, go on until then
    #[arg(long, value_name = "TIME", value_parser = args::duration)]
    pub(super) time: Option<Duration>,
    /// Width and height in pixels [the camera's, else 1280x720]
    #[arg(long, value_name = "WxH", value_parser = args::size)]
    pub(super) size: Option<[u32; 2]>,
    /// Pixels to render, upper ends excluded: the EXR's data window, all of the PNG
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = args::crop)]
    pub(super) crop: Option<[u32; 4]>,
    /// The camera [the first]
    #[arg(long, value_name = "NAME|INDEX")]
    pub(super) camera: Option<String>,
    /// Which part of the rendering equation is solved [path]
    #[arg(long)]
    pub(super) integrator: Option<Integrator>,
    /// How the hemisphere is sampled [mis]; all are unbiased
    #[arg(long)]
    pub(super) strategy: Option<Strategy>,
    /// Where the numbers come from [lattice]
    #[arg(long)]
    pub(super) sampler: Option<SamplerKind>,
    /// Seed of the sampler [0]
    #[arg(long, value_name = "N")]
    pub(super) seed: Option<u64>,
    /// Samples per independent replicate, a power of two [spp/4, at most 64]: the error comes from their spread
    #[arg(long, value_name = "N", value_parser = power_of_two)]
    pub(super) replicate: Option<u32>,
    /// Most reflections and refractions of a path [none]; a limit makes the image biased
    #[arg(long, value_name = "N")]
    pub(super) max_depth: Option<u32>,
    /// Pixel filter [blackman-harris]
    #[arg(long)]
    pub(super) filter: Option<Filter>,
    /// Light from infinity: an equirectangular EXR or HDR image in place of the scene's environment
    #[arg(long, value_name = "FILE")]
    env: Option<PathBuf>,
    /// Layers of the EXR [all but transport]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = args::layers())]
    pub(super) layers: Option<Vec<&'static Group>>,
    /// Exposure of the PNG in stops [0]
    #[arg(long, value_name = "STOPS", value_parser = args::finite, allow_negative_numbers = true)]
    pub(super) exposure: Option<f64>,
    /// Tone curve of the PNG [agx]
    #[arg(long)]
    pub(super) tonemap: Option<Tonemap>,
    /// How long hierarchies may take to build, for how fast they are traced: preview, default or best. The image is the same
    /// but where a ray meets two surfaces at once [default]
    #[arg(long, value_name = "QUALITY", value_parser = args::quality, default_value = "default", hide_default_value = true)]
    bvh: Quality,
    /// Threads; 0: all cores. Changes nothing in the image
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) threads: usize,
    /// Print every vertex of one sample's path, and render nothing
    #[arg(long, value_name = "X,Y,INDEX")]
    replay: Option<Replay>,
    /// No progress, notes or summary
    #[arg(short, long)]
    quiet: bool,
}

fn power_of_two(text: &str) -> Result<u32, String> {
    let n = text.parse().ok().filter(|n: &u32| n.is_power_of_two() && *n <= 1 << 20);
    n.ok_or_else(|| format!("`{text}` is no power of two up to 1048576"))
}

/// Renders, and writes the images.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    // Read the scene and decide.
    let options = arguments.pick.options();
    let mut scene = desc::load_with(&arguments.scene, &options)?;
    let hash = Origin::new(&scene.name, &desc::files::read(&arguments.scene)?);
    let environment = arguments.env.as_deref().map(|path| environment::replace(&mut scene, path)).transpose()?;
    let Choices { settings, layers, display, biased, notes } = settings::choose(arguments, &scene)?;
    let camera = (settings.camera, scene.cameras[settings.camera].name.clone());
    if !arguments.quiet {
        scene.notes.iter().chain(&notes).for_each(|text| eprintln!("note: {text}"));
        biased.iter().for_each(|text| eprintln!("note: the image is biased: {text}"));
    }

    // One path in words, if that is the question.
    if let Some(Replay { pixel, index }) = arguments.replay {
        return replay(&Scene::compile_with(&scene, arguments.bvh)?, &settings, pixel, index);
    }

    // Render; know before that the result can be kept.
    let stop = interrupt::after_the_pass();
    let [exr, png] = outputs(arguments);
    for path in [&exr, &png] {
        check_writable(path).map_err(|e| Failure::Output(path.clone(), e))?;
    }
    let compiled = Scene::compile_with(&scene, arguments.bvh)?;
    let metadata = std::mem::take(&mut scene.metadata);
    drop(scene);
    let report = Report::new(arguments.quiet, settings.time);
    let output = render::render(&compiled, &settings, &stop, &|p| report.update(p))?;
    report.finish();
    name_bad_samples(&output);
    let forgotten = compiled.forgotten_interiors();
    if forgotten > 0 {
        let most = radianza::medium::MOST_NESTED;
        eprintln!(
            "note: {forgotten} times a path was in more than {most} interiors at once and forgot the last: the image is wrong there"
        );
    }
    if output.samples_per_pixel == 0 {
        return Err(Failure::Nothing);
    }

    // Write what it has, and say what that is.
    let mut image = develop(&output.film, &layers);
    image.header = Header {
        software: concat!("radianza ", env!("CARGO_PKG_VERSION")).into(),
        scene: hash,
        environment,
        at: options.at,
        variant: options.variant,
        camera,
        size: settings.size,
        crop: settings.crop,
        samples: [0, output.samples_per_pixel.into()],
        replicate: settings.replicate,
        integrator: settings.integrator,
        strategy: settings.strategy,
        sampler: settings.sampler,
        seed: settings.seed,
        max_depth: settings.max_depth,
        filter: settings.filter,
        metadata,
        biased,
        non_finite: output.bad_count,
    }
    .to_json();
    write_exr(&exr, &image).map_err(|e| Failure::Output(exr.clone(), e))?;
    write_png(&png, &develop(&output.film, &[Group::BEAUTY]), &display).map_err(|e| Failure::Output(png.clone(), e))?;
    if !arguments.quiet {
        summary(&settings, &output, &[exr, png]);
    }
    if stop.load(Ordering::Relaxed) && output.interrupted {
        let asked = settings.time.map_or(format!("{} samples per pixel", settings.spp), |_| "the time".into());
        return Err(Failure::Interrupted { taken: output.samples_per_pixel, asked });
    }
    Ok(())
}

fn replay(scene: &Scene, settings: &Settings, pixel: [u32; 2], index: u64) -> Result<(), Failure> {
    let [w, h] = settings.size;
    if pixel[0] >= w || pixel[1] >= h {
        return Err(Failure::Usage(format!("pixel {pixel:?} does not lie in the image of {w}×{h} pixels")));
    }
    print!("{}", render::replay(scene, settings, pixel, index)?);
    Ok(())
}

/// EXR and PNG: as asked for, else `out/NAME.exr`, and the PNG beside the EXR.
fn outputs(arguments: &Arguments) -> [PathBuf; 2] {
    let name = arguments.scene.file_stem().unwrap_or_default().to_string_lossy();
    let exr = arguments.output.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}.exr")));
    let png = arguments.png.clone().unwrap_or_else(|| exr.with_extension("png"));
    [exr, png]
}

/// Says where samples were not numbers, however quiet: the image counts them as 0.
fn name_bad_samples(output: &Output) {
    if output.bad_count == 0 {
        return;
    }
    eprintln!(
        "note: {} samples hold what is not finite or negative, which counts as 0; look at them with",
        output.bad_count
    );
    for bad in output.bad.iter().take(LISTED) {
        let ([x, y], Invalid { layer, value }) = (bad.pixel, bad.invalid);
        eprintln!("note:     --replay {x},{y},{}    {layer} {value:?}", bad.index);
    }
}

fn summary(settings: &Settings, output: &Output, files: &[PathBuf]) {
    let ([w, h], spp) = (settings.size, output.samples_per_pixel);
    let [x0, y0, x1, y1] = settings.crop;
    let samples = u64::from(x1 - x0) * u64::from(y1 - y0) * u64::from(spp);
    let time = meter::time(output.elapsed.as_secs_f64());
    eprintln!("{w}×{h} pixels, {spp} samples each, in {time}: {}", speed(samples, output.rays, output.elapsed));
    let error = output.film.relative_error();
    if error.is_finite() {
        let replicates = spp / settings.replicate;
        eprintln!("mean relative standard error {:.3} %, from {replicates} replicates", 100.0 * error);
    } else {
        eprintln!("note: a single replicate: the image has no standard error");
    }
    let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
    eprintln!("wrote {}", names.join(" and "));
}
