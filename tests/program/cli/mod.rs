//! The binary from outside: arguments, exit codes, files, words.

mod conformance;
mod hostile;
mod isa;
mod pick;
mod verify;

use assert_cmd::Command;
use radianza::film::exr::{read_exr, write_exr};
use radianza::film::{Header, Image};
use std::io::BufRead;
use std::path::Path;
use tempfile::TempDir;

/// Runs the binary in `folder`: exit code, stdout, stderr. No panic and none of the words that render farms take for a
/// crash, whatever the arguments.
fn radianza(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("radianza").unwrap().current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let (out, err) = (text(output.stdout), text(output.stderr));
    for word in ["Error:", "Warning", "Exception:", "panicked"] {
        assert!(!out.contains(word) && !err.contains(word), "{arguments:?}\n{out}\n{err}");
    }
    (output.status.code().unwrap_or(-1), out, err)
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// A white triangle in front of a camera named `front`; whatever `more` says beside that.
fn triangle(folder: &Path, name: &str, more: &str) {
    let positions = "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA";
    let scene = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
        "nodes": [{{"mesh": 0}}, {{"camera": 0, "name": "front", "translation": [0, 0, 3]}}],
        "cameras": [{{"type": "perspective", "name": "front", "perspective": {{"yfov": 0.8, "znear": 0.1}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "buffers": [{{"byteLength": 36, "uri": "data:application/octet-stream;base64,{positions}"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [-1, -1, 0], "max": [1, 1, 0]}}]{more}}}"#
    );
    std::fs::write(folder.join(name), scene).unwrap();
}

fn header(path: &Path) -> Header {
    serde_json::from_str(&read_exr(path).unwrap().header).unwrap()
}

/// An image whose pixels are `value` plus a pattern of ±`noise`, with standard errors of `stderr` where that is not 0.
fn image(size: [u32; 2], value: f32, noise: f32, stderr: f32) -> Image {
    let n = (size[0] * size[1]) as usize;
    let mut image = Image { size, window: [0, 0, size[0], size[1]], ..Image::default() };
    let pixel = |i: usize| value + if i.is_multiple_of(2) { noise } else { -noise };
    image.insert_rgb(Image::BEAUTY, (0..n).map(|i| [pixel(i); 3]));
    if stderr > 0.0 {
        image.insert_rgb("stderr", (0..n).map(|_| [stderr; 3]));
    }
    image
}

#[test]
fn help_names_commands_options_and_exit_codes() {
    let folder = folder();
    let (code, out, err) = radianza(folder.path(), &["--help"]);
    assert_eq!((code, err.as_str()), (0, ""));
    for word in ["render", "info", "export", "compare", "verify", "Exit codes", "75"] {
        assert!(out.contains(word), "{word} in\n{out}");
    }
    let (code, out, _) = radianza(folder.path(), &["render", "--help"]);
    assert_eq!(code, 0);
    for word in
        ["--spp", "--strategy", "mis", "sobol", "lattice", "agx", "blackman-harris", "transport", "--replay", "whitted"]
    {
        assert!(out.contains(word), "{word} in\n{out}");
    }
    assert_eq!(radianza(folder.path(), &["--version"]).0, 0);
}

#[test]
fn wrong_usage_is_2() {
    let folder = folder();
    let wrong: &[&[&str]] = &[
        &[],
        &["paint"],
        &["render"],
        &["render", "a.toml", "--spp", "0"],
        &["render", "a.toml", "--spp", "many"],
        &["render", "a.toml", "--size", "0x0"],
        &["render", "a.toml", "--size", "10"],
        &["render", "a.toml", "--crop", "5,5,5,9"],
        &["render", "a.toml", "--time", "soon"],
        &["render", "a.toml", "--replicate", "3"],
        &["render", "a.toml", "--layers", "beauty,ugly"],
        &["render", "a.toml", "--integrator", "magic"],
        &["render", "a.toml", "--exposure", "nan"],
        &["render", "a.toml", "--replay", "1,2"],
        &["render", "a.toml", "b.toml"],
        &["info"],
        &["info", "--schema", "a.toml"],
        &["compare", "a.exr"],
    ];
    for arguments in wrong {
        let (code, out, err) = radianza(folder.path(), arguments);
        assert_eq!((code, out.as_str()), (2, ""), "{arguments:?}\n{err}");
        assert!(err.starts_with("radianza: ") || arguments.is_empty(), "{arguments:?}\n{err}");
    }
}

#[test]
fn missing_files_are_4_and_strange_ones_5() {
    let folder = folder();
    std::fs::write(folder.path().join("a.docx"), "no scene").unwrap();
    for (arguments, expected) in [
        (["render", "none.toml"], 4),
        (["info", "none.glb"], 4),
        (["render", "."], 5),
        (["render", "a.docx"], 5),
        (["info", "a.docx"], 5),
    ] {
        let (code, _, err) = radianza(folder.path(), &arguments);
        assert_eq!(code, expected, "{arguments:?}\n{err}");
        assert!(err.contains(arguments[1]), "{err}");
    }
}

#[test]
fn compare_measures_and_judges() {
    let folder = folder();
    let write = |name: &str, image: &Image| write_exr(&folder.path().join(name), image).unwrap();
    write("a.exr", &image([40, 30], 0.5, 0.125, 0.1));
    write("b.exr", &image([40, 30], 0.5, 0.0, 0.0));
    write("c.exr", &image([40, 30], 0.51, 0.0, 0.1));
    write("small.exr", &image([30, 40], 0.5, 0.0, 0.0));

    // ±1/8 about 1/2: RMSE 1/8, relMSE 1/64/0.26, no bias.
    let (code, out, err) = radianza(folder.path(), &["compare", "a.exr", "b.exr", "--png", "d.png"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("RMSE        1.250000e-1") && out.contains("relMSE      6.009615e-2"), "{out}");
    assert!(out.contains("B has no standard error") && out.contains("|z| > 3     0.000 %"), "{out}");
    assert_eq!(::image::open(folder.path().join("d.png")).unwrap().width(), 40);

    // A bias of 0.01 with se 0.1 √2/√1200: z = 2.45.
    let (_, out, _) = radianza(folder.path(), &["compare", "c.exr", "a.exr"]);
    assert!(out.contains("+2.45"), "{out}");

    // The limit decides the exit code.
    assert_eq!(radianza(folder.path(), &["compare", "a.exr", "b.exr", "--max-relmse", "0.07"]).0, 0);
    let (code, _, err) = radianza(folder.path(), &["compare", "a.exr", "b.exr", "--max-relmse", "0.05"]);
    assert_eq!(code, 1);
    assert!(err.contains("larger than 5e-2"), "{err}");

    // What does not fit is usage, and says why.
    let (code, _, err) = radianza(folder.path(), &["compare", "a.exr", "small.exr"]);
    assert_eq!(code, 2);
    assert!(err.contains("[40, 30]") && err.contains("[30, 40]"), "{err}");
    let (code, _, err) = radianza(folder.path(), &["compare", "a.exr", "b.exr", "--layer", "SD"]);
    assert_eq!(code, 2);
    assert!(err.contains("`SD`") && err.contains("beauty"), "{err}");
}

#[test]
fn compare_does_not_pass_what_is_no_number() {
    let folder = folder();
    let mut bad = image([4, 4], 0.5, 0.0, 0.0);
    bad.layers.get_mut(Image::BEAUTY).unwrap().get_mut("G").unwrap()[5] = f32::NAN;
    write_exr(&folder.path().join("bad.exr"), &bad).unwrap();
    write_exr(&folder.path().join("good.exr"), &image([4, 4], 0.5, 0.0, 0.0)).unwrap();
    for pair in [["bad.exr", "good.exr"], ["good.exr", "bad.exr"]] {
        let (code, out, _) = radianza(folder.path(), &["compare", pair[0], pair[1], "--max-relmse", "1"]);
        assert_eq!(code, 1);
        assert!(out.contains("not finite  1"), "{out}");
    }
}

#[test]
fn compare_tells_damaged_from_missing() {
    let folder = folder();
    write_exr(&folder.path().join("a.exr"), &image([8, 8], 0.5, 0.1, 0.1)).unwrap();
    let whole = std::fs::read(folder.path().join("a.exr")).unwrap();
    std::fs::write(folder.path().join("half.exr"), &whole[..whole.len() / 2]).unwrap();
    std::fs::write(folder.path().join("text.exr"), "not an image").unwrap();
    for (name, expected) in [("half.exr", 3), ("text.exr", 3), ("none.exr", 4)] {
        let (code, _, err) = radianza(folder.path(), &["compare", "a.exr", name]);
        assert_eq!(code, expected, "{err}");
        assert!(err.contains(name), "{err}");
    }
    let (code, _, err) = radianza(folder.path(), &["compare", "a.exr", "a.exr", "--png", "a.exr/x.png"]);
    assert_eq!(code, 6, "{err}");
}

#[test]
fn render_writes_what_it_says() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let small = ["render", "tri.gltf", "--size", "24x16", "--spp", "10", "--max-depth", "3", "--seed", "7"];
    let (code, out, err) = radianza(folder.path(), &small);
    assert_eq!((code, out.as_str()), (0, ""), "{err}");
    for word in ["note: the image is biased: max-depth 3", "24×16", "wrote out/tri.exr and out/tri.png"] {
        assert!(err.contains(word), "{word} in\n{err}");
    }

    // The image, its layers, and all that it takes to render it again.
    let path = folder.path().join("out/tri.exr");
    let image = read_exr(&path).unwrap();
    let layers: Vec<&str> = image.layers.keys().map(String::as_str).collect();
    assert_eq!(layers, ["albedo", "beauty", "depth", "normal", "samples", "stderr"]);
    assert_eq!((image.size, image.window), ([24, 16], [0, 0, 24, 16]));
    let header = header(&path);
    assert_eq!((header.samples, header.replicate, header.seed, header.max_depth), ([0, 10], 2, 7, Some(3)));
    assert_eq!((header.scene.name.as_str(), header.camera.1.as_str(), header.biased.len()), ("tri", "front", 1));
    assert_eq!(header.scene.sha256.len(), 64);
    let png = ::image::open(folder.path().join("out/tri.png")).unwrap();
    assert_eq!((png.width(), png.height()), (24, 16));

    // The triangle is in the middle, three metres away, and faces the camera.
    let at = 8 * 24 + 12;
    assert!((image.layers["depth"]["Z"][at] - 3.0).abs() < 0.1);
    assert!(image.layers["normal"]["Z"][at] > 0.99 && image.layers["beauty"]["A"][at] == 1.0);
    assert_eq!(image.layers["beauty"]["A"][0], 0.0);
}

#[test]
fn render_is_the_same_for_any_threads() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let render = |threads: &str, name: &str| {
        let options = ["--size", "50x70", "--spp", "8", "--layers", "beauty,stderr,transport", "-q", "-o", name];
        let arguments = [&["render", "tri.gltf", "--threads", threads][..], &options].concat();
        let (code, out, err) = radianza(folder.path(), &arguments);
        assert_eq!((code, out.as_str(), err.as_str()), (0, "", ""));
        std::fs::read(folder.path().join(name)).unwrap()
    };
    let one = render("1", "1.exr");
    assert!(one == render("2", "2.exr") && one == render("7", "7.exr"));
    assert!(folder.path().join("7.png").exists());

    // Equal images compare as equal, and that equal seeds are no evidence is said.
    let (code, out, _) = radianza(folder.path(), &["compare", "1.exr", "7.exr", "--max-relmse", "0"]);
    assert_eq!(code, 0);
    assert!(out.contains("same seed"), "{out}");
}

#[test]
fn render_takes_windows_layers_and_whole_replicates() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let options = ["--size", "24x16", "--crop", "4,2,20,10", "--spp", "5", "--replicate", "4", "--layers", "depth"];
    let outputs = ["-o", "new/folder/a.exr", "--png", "other/b.png", "--camera", "front"];
    let (code, _, err) = radianza(folder.path(), &[&["render", "tri.gltf"][..], &options, &outputs].concat());
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("5 samples per pixel become 8"), "{err}");
    let image = read_exr(&folder.path().join("new/folder/a.exr")).unwrap();
    assert_eq!((image.size, image.window), ([24, 16], [4, 2, 20, 10]));
    assert_eq!(image.layers.keys().collect::<Vec<_>>(), ["depth"]);
    assert_eq!(::image::open(folder.path().join("other/b.png")).unwrap().width(), 16);

    // What does not fit the scene is usage.
    for wrong in [["--crop", "4,2,20,17"], ["--camera", "back"], ["--camera", "1"]] {
        let (code, _, err) = radianza(folder.path(), &["render", "tri.gltf", "--size", "24x16", wrong[0], wrong[1]]);
        assert_eq!(code, 2, "{err}");
    }
}

#[test]
fn replay_prints_one_path() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let replay = |at: &str| radianza(folder.path(), &["render", "tri.gltf", "--size", "24x16", "--replay", at]);
    let (code, out, _) = replay("12,8,3");
    assert_eq!(code, 0);
    assert!(out.lines().count() >= 2, "{out}");
    assert_eq!(replay("12,8,3").1, out);
    assert_eq!(replay("24,8,3").0, 2);
    assert!(!folder.path().join("out").exists());
}

#[test]
fn info_counts() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let (code, out, err) = radianza(folder.path(), &["info", "tri.gltf"]);
    assert_eq!((code, err.as_str()), (0, ""));
    for word in ["1 triangles", "`front`", "note: "] {
        assert!(out.contains(word), "{word} in\n{out}");
    }
    let (code, out, _) = radianza(folder.path(), &["info", "--schema"]);
    assert_eq!(code, 0);
    assert!(serde_json::from_str::<serde_json::Value>(&out).unwrap()["properties"].is_object(), "{out}");
}

#[test]
fn an_output_that_cannot_be_written_is_known_before() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    std::fs::create_dir(folder.path().join("folder.exr")).unwrap();
    let start = std::time::Instant::now();
    for output in ["tri.gltf/a.exr", "folder.exr", "/proc/a.exr"] {
        // Hours of samples, if it were found only after rendering.
        let (code, _, err) = radianza(folder.path(), &["render", "tri.gltf", "--spp", "1000000", "-o", output]);
        assert_eq!(code, 6, "{err}");
        assert!(err.contains(output), "{err}");
    }
    assert!(start.elapsed().as_secs() < 60);
}

#[test]
fn time_ends_a_render() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let (code, _, err) = radianza(folder.path(), &["render", "tri.gltf", "--size", "16x16", "--time", "0.2s"]);
    assert_eq!(code, 0, "{err}");
    let header = header(&folder.path().join("out/tri.exr"));
    assert!(header.samples[1] >= 4 && header.replicate == 4, "{header:?}");
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_a_valid_image() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    for signal in ["-INT", "-TERM"] {
        let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("radianza"))
            .current_dir(folder.path())
            .args(["render", "tri.gltf", "--size", "32x32", "--spp", "1000000000", "-o", "new/a.exr"])
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        // The first line of progress comes after the first pass.
        let mut lines = std::io::BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
        assert!(lines.any(|line| line.contains("Msamples/s")));
        let killed = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        assert!(killed.success());
        let rest: Vec<String> = lines.collect();
        assert_eq!(child.wait().unwrap().code(), Some(75), "{rest:?}");
        assert!(rest.iter().any(|line| line.contains("interrupted after")), "{rest:?}");
        let header = header(&folder.path().join("new/a.exr"));
        assert!(header.samples[1] > 0 && header.samples[1] < 1_000_000_000);
        assert!(header.samples[1].is_multiple_of(header.replicate.into()));
        std::fs::remove_dir_all(folder.path().join("new")).unwrap();
    }
}
