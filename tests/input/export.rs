//! `radianza export`, from outside: what the files hold, what is refused, and what Mitsuba makes of them.

use crate::common::repo;
use assert_cmd::Command;
use quick_xml::Reader;
use quick_xml::events::Event;
use radianza::film::exr::read_exr;
use std::path::Path;

/// Runs the binary in `folder`: exit code and stderr.
fn radianza(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let output = Command::cargo_bin("radianza").unwrap().current_dir(folder).args(arguments).output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(!err.contains("panicked"), "{arguments:?}\n{err}");
    (output.status.code().unwrap_or(-1), err)
}

/// Exports a scene of the repository: the file's text and the notes.
fn export(folder: &Path, scene: &str, file: &str, more: &[&str]) -> (String, String) {
    let scene = repo(scene);
    let arguments = [&["export", scene.to_str().unwrap(), "-o", file], more].concat();
    let (code, err) = radianza(folder, &arguments);
    assert_eq!(code, 0, "{arguments:?}\n{err}");
    (std::fs::read_to_string(folder.join(file)).unwrap(), err)
}

/// Tag and type of every element, in order; fails where the document is not well-formed.
fn elements(xml: &str) -> Vec<(String, String)> {
    let mut reader = Reader::from_str(xml);
    let mut found = Vec::new();
    loop {
        match reader.read_event().unwrap_or_else(|e| panic!("{e}\n{xml}")) {
            Event::Start(e) | Event::Empty(e) => {
                let kind = e.try_get_attribute("type").unwrap().map(|a| a.value.to_string()).unwrap_or_default();
                found.push((e.name().as_ref().to_string(), kind));
            }
            Event::Eof => return found,
            _ => {}
        }
    }
}

fn count(xml: &str, tag: &str, kind: &str) -> usize {
    elements(xml).iter().filter(|(t, k)| t == tag && (kind.is_empty() || k == kind)).count()
}

#[test]
fn a_small_scene_becomes_this() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("a.toml"),
        r#"
        name = "A -- <small> scene"
        [camera]
        position = [0, 0, 4]
        target = [0, 0, 0]
        view_angle = 40
        resolution = [8, 4]
        [material.red]
        type = "diffuse"
        reflectance = [0.5, 0.25, 0]
        [[shape]]
        type = "sphere"
        radius = 0.5
        center = [1, 2, 3]
        material = "red"
        [[shape]]
        type = "quad"
        corner = [0, 0, 0]
        edge_u = [1, 0, 0]
        edge_v = [0, 1, 0]
        reversed = true
        emission = [1, 2, 3]
        "#,
    )
    .unwrap();
    let arguments = ["export", "a.toml", "-o", "out/b.xml", "--filter", "box", "--max-depth", "2", "--spp", "3"];
    let (code, err) = radianza(folder.path(), &arguments);
    assert_eq!((code, err.as_str()), (0, "wrote out/b.xml and 1 files beside it\n"));
    let text = std::fs::read_to_string(folder.path().join("out/b.xml")).unwrap();
    assert!(text.contains("<!-- A - - <small> scene, written by radianza"), "{text}");
    for part in [
        r#"<scene version="3.0.0">"#,
        r#"<integer name="max_depth" value="3"/>"#,
        r#"<string name="fov_axis" value="y"/>"#,
        r#"<integer name="width" value="8"/>"#,
        r#"<rfilter type="box"/>"#,
        r#"<integer name="sample_count" value="3"/>"#,
        r#"<rgb name="reflectance" value="0.5, 0.25, 0"/>"#,
        r#"<matrix value="1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1"/>"#,
        r#"<rgb name="radiance" value="1, 2, 3"/>"#,
        r#"<string name="filename" value="b-mitsuba/mesh-0.ply"/>"#,
        r#"<boolean name="face_normals" value="true"/>"#,
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    // Reversed: the vertices of its two triangles run the other way.
    let ply = std::fs::read(folder.path().join("out/b-mitsuba/mesh-0.ply")).unwrap();
    let faces: Vec<u8> = [[0u32, 2, 1], [0, 3, 2]]
        .iter()
        .flat_map(|t| [3].into_iter().chain(t.iter().flat_map(|i| i.to_le_bytes())))
        .collect();
    assert!(ply.ends_with(&faces));

    // The same again is the same file.
    assert_eq!(radianza(folder.path(), &arguments).0, 0);
    assert_eq!(std::fs::read_to_string(folder.path().join("out/b.xml")).unwrap(), text);
}

#[test]
fn shapes_and_emitters_are_all_there() {
    let folder = tempfile::tempdir().unwrap();
    for (scene, shapes, emitters, sensors) in
        [("cornell-box", 8, 1, 1), ("veach-mis", 11, 5, 1), ("glass-caustics", 7, 2, 1)]
    {
        let (xml, _) = export(folder.path(), &format!("scenes/{scene}.toml"), &format!("{scene}.xml"), &[]);
        assert_eq!(count(&xml, "shape", ""), shapes, "{scene}\n{xml}");
        assert_eq!([count(&xml, "emitter", ""), count(&xml, "sensor", "")], [emitters, sensors], "{scene}");
    }
    // Four instances of each of the six parts of a chair.
    let (xml, _) = export(folder.path(), "scenes/interior.toml", "interior.xml", &[]);
    assert_eq!([count(&xml, "shape", "shapegroup"), count(&xml, "shape", "instance")], [6, 24], "{xml}");
    assert!(count(&xml, "bsdf", "normalmap") == 1 && count(&xml, "texture", "bitmap") >= 5, "{xml}");
    assert!(folder.path().join("interior-mitsuba/image-0.png").exists());
}

/// Directives of a pbrt file that begin with this.
fn lines(text: &str, start: &str) -> usize {
    text.lines().filter(|line| line.starts_with(start)).count()
}

#[test]
fn pbrt_gets_the_same_scene() {
    let folder = tempfile::tempdir().unwrap();
    let options = ["--filter", "box", "--size", "30x20", "--max-depth", "4"];
    let (text, err) = export(folder.path(), "scenes/interior.toml", "a.pbrt", &options);
    assert!(text.starts_with("# interior, written by radianza"), "{text}");
    for part in [
        // The shorter side is the height.
        "Camera \"perspective\" \"float fov\" [ 48 ]",
        "\"integer xresolution\" [ 30 ] \"integer yresolution\" [ 20 ]",
        "PixelFilter \"box\" \"float xradius\" [ 0.5 ]",
        "Integrator \"volpath\" \"integer maxdepth\" [ 4 ]",
        "\"string filename\" [ \"a.exr\" ]",
        // Two repeats of the planks, of a v that counts upwards: 1 − (2 − 2 v) is looked up from the top.
        "\"float vscale\" [ 2 ] \"float vdelta\" [ -1 ]",
        "\"string normalmap\" [ \"a-pbrt/image-2.exr\" ]",
        "\"bool remaproughness\" [ false ] \"float roughness\" [ 0.25 ]",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    assert_eq!([lines(&text, "ObjectBegin"), lines(&text, "ObjectInstance"), lines(&text, "Area")], [6, 24, 2]);
    assert_eq!(lines(&text, "AttributeBegin"), lines(&text, "AttributeEnd"));
    assert_eq!(lines(&text, "ReverseOrientation"), 1);
    assert!(err.contains("note: pbrt: ") && text.contains("# note: "), "{err}");

    // v counts upwards there.
    let ply = std::fs::read(folder.path().join("a-pbrt/mesh-0.ply")).unwrap();
    let start = ply.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let number = |i: usize| f32::from_le_bytes(ply[start + 4 * i..][..4].try_into().unwrap());
    assert_eq!([number(3), number(4)], [0.0, 1.0]);

    let (text, _) = export(folder.path(), "scenes/verify/l2-two-sided.toml", "b.pbrt", &[]);
    assert!(text.contains("\"bool twosided\" [ true ]"), "{text}");
    let (text, _) = export(folder.path(), "scenes/outdoor.toml", "c.pbrt", &[]);
    assert!(text.contains("LightSource \"infinite\" \"string filename\" [ \"c-pbrt/image-"), "{text}");
    let (text, _) = export(folder.path(), "scenes/verify/v1-slab.toml", "d.pbrt", &[]);
    assert!(text.contains("\"rgb sigma_a\"") && lines(&text, "MediumInterface") == 1, "{text}");
}

#[test]
fn every_scene_is_written_for_both() {
    let folder = tempfile::tempdir().unwrap();
    let mut scenes = Vec::new();
    for below in ["scenes", "scenes/materials", "scenes/verify"] {
        let entries = std::fs::read_dir(repo(below)).unwrap();
        scenes.extend(entries.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e != "rs")));
    }
    scenes.retain(|path| path.is_file());
    scenes.sort();
    assert!(scenes.len() > 50);
    for scene in scenes {
        let scene = scene.to_str().unwrap();
        let (code, err) = radianza(folder.path(), &["export", scene, "-o", "a.xml", "-q"]);
        assert!(code == 0 || code == 5 && err.contains("equirectangular"), "{scene}\n{err}");
        if code == 0 {
            elements(&std::fs::read_to_string(folder.path().join("a.xml")).unwrap());
        }
        assert_eq!(radianza(folder.path(), &["export", scene, "-o", "a.pbrt", "-q"]), (0, String::new()), "{scene}");
    }
}

#[test]
fn what_cannot_be_said_is_noted_in_the_file_and_on_stderr() {
    let folder = tempfile::tempdir().unwrap();
    let (xml, err) = export(folder.path(), "scenes/materials/iridescence.glb", "a.xml", &[]);
    assert!(err.contains("note: Mitsuba: material `") && err.contains("iridescent film is left out"), "{err}");
    assert!(xml.contains("iridescent film is left out"), "{xml}");
    let (_, err) = export(folder.path(), "scenes/cornell-box.toml", "b.xml", &["--filter", "box"]);
    assert!(!err.contains("note"), "{err}");
    let (_, err) = export(folder.path(), "scenes/cornell-box.toml", "b.xml", &["--quiet"]);
    assert_eq!(err, "");
}

/// A scene written in our own format renders to the same numbers.
#[test]
fn the_own_format_says_everything() {
    let folder = tempfile::tempdir().unwrap();
    let render = |scene: &str, image: &str| {
        let arguments = ["render", scene, "-o", image, "--size", "24x16", "--spp", "8", "--layers", "beauty,stderr"];
        assert_eq!(radianza(folder.path(), &arguments).0, 0, "{scene}");
        read_exr(&folder.path().join(image)).unwrap().layers
    };
    for scene in [
        "scenes/cornell-box.toml",
        "scenes/interior.toml",
        "scenes/outdoor.toml",
        "scenes/veach-mis.toml",
        "scenes/materials/anisotropy.glb",
        "scenes/materials/dispersion.glb",
        "scenes/materials/lights-punctual.glb",
        "scenes/materials/texture-transform.glb",
        "scenes/verify/l1-ies.toml",
        "scenes/verify/f1-nested.toml",
    ] {
        let (text, err) = export(folder.path(), scene, "own/a.toml", &[]);
        assert!(err.contains("wrote own/a.toml"), "{err}");
        assert!(render(repo(scene).to_str().unwrap(), "a.exr") == render("own/a.toml", "b.exr"), "{scene}\n{text}");
    }
}

#[test]
fn the_command_line_is_written_too() {
    let folder = tempfile::tempdir().unwrap();
    let options = ["--size", "30x20", "--spp", "7", "--integrator", "local", "--filter", "box", "--max-depth", "3"];
    let (text, _) = export(folder.path(), "scenes/cornell-box.toml", "a.toml", &options);
    let lines = ["resolution = [30, 20]", "spp = 7", "integrator = \"local\"", "max_depth = 3", "filter = \"box\""];
    for line in lines {
        assert!(text.lines().any(|l| l == line), "{line} in\n{text}");
    }
}

#[test]
fn what_is_wrong_has_its_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let cornell = repo("scenes/cornell-box.toml");
    let cornell = cornell.to_str().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    let panorama = repo("scenes/verify/f2-sphere-rho-05.toml");
    let panorama = panorama.to_str().unwrap();
    for (arguments, expected, word) in [
        (&["export", cornell, "-o", "a.blend"][..], 2, ".xml"),
        (&["export", cornell, "-o", "a"], 2, ".xml"),
        (&["export", cornell], 2, "--output"),
        (&["export", cornell, "-o", "a.xml", "--camera", "none"], 2, "camera"),
        (&["export", "none.toml", "-o", "a.xml"], 4, "none.toml"),
        (&["export", panorama, "-o", "a.xml"], 5, "equirectangular"),
        (&["export", cornell, "-o", "file/a.xml"], 6, "cannot be written"),
    ] {
        let (code, err) = radianza(folder.path(), arguments);
        assert_eq!(code, expected, "{arguments:?}\n{err}");
        assert!(err.contains(word), "{arguments:?}\n{err}");
    }
    assert!(!folder.path().join("a.xml").exists());
}

/// Renders `a.xml` in `seeds` independent parts; prints the channels' means of each.
const SCRIPT: &str = "
import sys, numpy as np, mitsuba as mi
mi.set_variant('scalar_rgb')
scene = mi.load_file(sys.argv[1])
for seed in range(int(sys.argv[2])):
    print(*np.array(mi.render(scene, seed=seed + 1), dtype=np.float64).mean(axis=(0, 1)))
";

/// Mitsuba agrees on the whole image where the models are the same: z of the means of its parts and of our pixels, whose
/// standard errors are known. What its shading normals and single scattering lack is allowed for by `model`, relative.
#[test]
fn mitsuba_sees_the_same() {
    let Some(python) = std::env::var_os("RADIANZA_MITSUBA") else {
        return crate::skip::skip("RADIANZA_MITSUBA names no Python with mitsuba");
    };
    let folder = tempfile::tempdir().unwrap();
    for (scene, model) in [
        ("scenes/cornell-box.toml", 0.0),
        ("scenes/veach-mis.toml", 1e-3),
        ("scenes/materials/emissive-strength.glb", 5e-3),
        ("scenes/verify/l2-instances.toml", 0.0),
        ("scenes/verify/l2-mixture.toml", 1e-3),
        ("scenes/verify/v1-slab.toml", 0.0),
    ] {
        const PARTS: usize = 8;
        let common = ["--size", "64x64", "--filter", "box"];
        export(folder.path(), scene, "a.xml", &[&common[..], &["--spp", "32"]].concat());
        let path = repo(scene);
        let arguments = [&["render", path.to_str().unwrap(), "-o", "a.exr", "--spp", "256"][..], &common].concat();
        assert_eq!(radianza(folder.path(), &arguments).0, 0);
        let image = read_exr(&folder.path().join("a.exr")).unwrap();
        let [ours, errors] = ["beauty", "stderr"].map(|layer| image.rgb(layer).unwrap());

        let output = std::process::Command::new(&python)
            .args(["-c", SCRIPT, "a.xml", &PARTS.to_string()])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        let rows: Vec<Vec<f64>> = out
            .lines()
            .map(|line| {
                line.split_whitespace().map(|x| x.parse().unwrap_or_else(|_| panic!("{line}\n{err}"))).collect()
            })
            .collect();
        assert_eq!(rows.len(), PARTS, "{scene}\n{out}\n{err}");

        for c in 0..3 {
            let n = ours[c].len() as f64;
            let mean = ours[c].iter().map(|x| f64::from(*x)).sum::<f64>() / n;
            let own = errors[c].iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt() / n;
            let theirs = rows.iter().map(|r| r[c]).sum::<f64>() / PARTS as f64;
            let spread = rows.iter().map(|r| (r[c] - theirs).powi(2)).sum::<f64>() / (PARTS * (PARTS - 1)) as f64;
            let se = (own * own + spread + (model * mean).powi(2)).sqrt();
            let z = (theirs - mean) / se;
            println!("{scene} {c}: {mean:.5} here, {theirs:.5} there, z {z:+.2}");
            // Seven degrees of freedom: |t| beyond 6 has a probability below 1e-3; eighteen comparisons.
            assert!(z.abs() < 6.0, "{scene}, channel {c}: {mean} here, {theirs} there, z {z}");
        }
    }
}

/// Radiance × coverage where the target emits whatever its mask lets through; the surface's own alpha where it does not.
#[test]
fn what_emits_through_holes_emits_by_its_coverage() {
    let folder = tempfile::tempdir().unwrap();
    let image = image::RgbaImage::from_fn(2, 1, |x, _| image::Rgba([255, 0, 255, if x == 0 { 64 } else { 255 }]));
    image.save(folder.path().join("lamp.png")).unwrap();
    std::fs::write(
        folder.path().join("a.toml"),
        r#"
        [texture.lamp]
        type = "image"
        file = "lamp.png"
        [material.half]
        type = "absorb"
        opacity = 0.5
        [material.cut]
        type = "absorb"
        opacity = { texture = "lamp", channel = "a" }
        opacity_cutoff = 0.5
        emission = [4, 2, 1]
        [[shape]]
        type = "sphere"
        material = "half"
        emission = [4, 2, 1]
        emission_sides = "both"
        [[shape]]
        type = "quad"
        corner = [2, 0, 0]
        edge_u = [1, 0, 0]
        edge_v = [0, 1, 0]
        material = "cut"
        "#,
    )
    .unwrap();
    for file in ["a.xml", "a.pbrt"] {
        let (code, err) = radianza(folder.path(), &["export", "a.toml", "-o", file]);
        assert_eq!(code, 0, "{err}");
    }
    let xml = std::fs::read_to_string(folder.path().join("a.xml")).unwrap();
    assert!(xml.contains(r#"name="radiance" value="2, 1, 0.5""#), "{xml}");
    assert!(xml.contains("dimmed by them twice"), "{xml}");
    assert_eq!((count(&xml, "emitter", "area"), count(&xml, "bsdf", "null")), (3, 1));
    let file = xml.split("\"a-mitsuba/").find_map(|s| s.split('"').next().filter(|f| f.ends_with(".exr")));
    let image = read_exr(&folder.path().join("a-mitsuba").join(file.expect("a picture of the lamp"))).unwrap();
    let [r, g, b] = image.rgb(radianza::film::Image::BEAUTY).expect("colours");
    assert_eq!((r, g, b), (&[0.0, 4.0][..], &[0.0, 2.0][..], &[0.0, 1.0][..]));
    let pbrt = std::fs::read_to_string(folder.path().join("a.pbrt")).unwrap();
    assert!(pbrt.contains("\"rgb L\" [ 4 2 1 ]") && pbrt.contains("\"float alpha\" [ 0.5 ]"), "{pbrt}");
}

/// Without what it needs, a test says that it was skipped though the harness captures what passing tests print.
#[test]
fn skipped_tests_are_seen() {
    let output = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "export::mitsuba_sees_the_same"])
        .env_remove("RADIANZA_MITSUBA")
        .output()
        .unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && err.contains("skipped: export::mitsuba_sees_the_same: RADIANZA_MITSUBA"),
        "{err}"
    );
}
