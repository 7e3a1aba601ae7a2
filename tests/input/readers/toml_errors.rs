//! Every mistake is named, with line and column, and with what would have been right.

use super::{EVERYTHING, folder, png};
use radianza::desc::toml::{parse, read};
use radianza::desc::{Error, ErrorKind};
use std::path::Path;

/// The error of a text.
fn error(text: &str) -> Error {
    match parse(text, Path::new("scene.toml")) {
        Ok(_) => panic!("should be refused:\n{text}"),
        Err(e) => e,
    }
}

/// Checks place and message of many texts' errors.
fn check(cases: &[(&str, &str, &str)]) {
    for (text, place, message) in cases {
        let e = error(text);
        assert_eq!(e.file, Path::new("scene.toml"));
        assert_eq!(e.kind, ErrorKind::Invalid, "{e}");
        assert!(e.message.contains(message), "{text}\n-> {e}\nshould say: {message}");
        assert_eq!(&e.place, place, "{text}\n-> {e}");
    }
}

#[test]
fn unknown_words() {
    check(&[
        ("naem = 'x'", "1:1", "unknown key `naem`; did you mean `name`?"),
        ("\n\n  [camear]\n", "3:4", "unknown key `camear`; did you mean `camera`?"),
        ("[camera]\npositon = [1, 2, 3]", "2:1", "unknown key `positon`; did you mean `position`?"),
        ("[camera]\nheight = 1", "2:1", "unknown key `height`; expected one of `name`, `position`"),
        ("[camera]\ntype = 'ortographic'", "2:8", "unknown type `ortographic`; did you mean `orthographic`?"),
        ("[material.a]\ntype = 'wood'", "2:8", "unknown type `wood`; expected one of `diffuse`, `mirror`"),
        ("[material.a]\ntype = 'mirror'\nroughness = 0.1", "3:1", "unknown key `roughness`; expected one of"),
        ("[[shape]]\ntype = 'spere'", "2:8", "did you mean `sphere`?"),
        ("[[shape]]\ntype = 'sphere'\nmaterial = 'x'", "3:12", "unknown material `x`; there is none"),
        (
            "[material.white]\ntype = 'absorb'\n[[shape]]\ntype = 'sphere'\nmaterial = 'wihte'",
            "5:12",
            "unknown material `wihte`; did you mean `white`?",
        ),
        (
            "[texture.tiles]\ntype = 'checker'\n[material.a]\ntype = 'diffuse'\nreflectance = 'tilse'",
            "5:15",
            "unknown texture `tilse`; did you mean `tiles`?",
        ),
        ("[group.g]\n[[instance]]\ngroup = 'h'", "3:9", "unknown group `h`; did you mean `g`?"),
        ("[material.a]\ntype = 'conductor'\nmetal = 'Xx'", "3:9", "unknown metal `Xx`; expected one of `Ag`"),
        ("[render]\nsppp = 1", "2:1", "unknown key `sppp`; did you mean `spp`?"),
        ("[render]\nintegrator = 'paht'", "2:14", "`integrator`: unknown value `paht`; did you mean `path`?"),
        ("[expect]\nlayers = { DX = 1 }", "2:12", "unknown layer `DX`; did you mean `D`?"),
        (
            "[texture.t]\ntype = 'image'\nfile = 'x.png'\nfilter = 'cubic'",
            "4:10",
            "unknown value `cubic`; expected one of",
        ),
        ("[material.a]\ntype = 'absorb'\nemission_sides = 'fornt'", "3:18", "did you mean `front`?"),
    ]);
}

#[test]
fn wrong_types_and_lengths() {
    check(&[
        ("name = 3", "1:8", "`name`: found 3, expected a string"),
        ("camera = 1", "1:10", "`camera`: found 1, expected a table or an array of tables"),
        (
            "[camera]\nposition = 'here'",
            "2:12",
            "`position`: found the string \"here\", expected an array of 3 finite numbers",
        ),
        ("[camera]\nposition = [1, 2]", "2:12", "found an array of 2 values, expected an array of 3 finite numbers"),
        ("[camera]\nposition = [1, 2, true]", "2:19", "found true, expected a finite number"),
        ("[camera]\nposition = [1, 2, nan]", "2:19", "found nan, expected a finite number"),
        ("[camera]\nposition = [1, 2, 1e39]", "2:19", "found 1e39, expected a finite number"),
        (
            "[material.a]\ntype = 'diffuse'\nreflectance = true",
            "3:15",
            "`reflectance`: found true, expected a number in [0, 1], [r, g, b]",
        ),
        ("[material.a]\ntype = 'diffuse'\nreflectance = '#12345'", "3:15", "found the string \"#12345\""),
        (
            "[[shape]]\ntype = 'mesh'\npositions = [[0, 0, 0], [1, 0]]",
            "3:25",
            "`positions`: found an array of 2 values",
        ),
        (
            "[[shape]]\ntype = 'mesh'\npositions = [[0, 0, 0]]\nindices = [[0, 1, -1]]",
            "4:19",
            "`indices`: found -1, expected a whole number ≥ 0",
        ),
        ("material = []", "1:12", "`material`: found an array of 0 values, expected tables by name"),
        ("[render]\nspp = 'a'", "2:7", "`spp`: found the string \"a\", expected a whole number ≥ 1"),
        ("[render]\nspp = -1", "2:7", "`spp`: found -1, expected a whole number ≥ 1"),
        (
            "[[shape]]\ntype = 'box'\nscale = 'big'",
            "3:9",
            "`scale`: found the string \"big\", expected a finite number or an array of 3 finite numbers",
        ),
        (
            "[[shape]]\ntype = 'box'\nmatrix = [[1, 0, 0, 0]]",
            "3:10",
            "`matrix`: found an array of 1 value, expected an array of 4 rows (or 3) of 4 numbers",
        ),
    ]);
}

#[test]
fn missing_keys() {
    check(&[
        ("[camera]\ntarget = [0, 0, 0]", "1:1", "missing key `position`; expected an array of 3 finite numbers"),
        ("[material.a]\nreflectance = 1", "1:1", "missing key `type`; expected one of `diffuse`"),
        ("[material.a]\ntype = 'diffuse'", "1:1", "missing key `reflectance`"),
        ("[[shape]]\ntype = 'sphere'", "1:1", "missing key `material`; a shape that does not emit needs one"),
        ("[[shape]]\ntype = 'box'\nmin = [0, 0, 0]\nemission = 1", "1:1", "missing key `max`"),
        ("[[light]]\ntype = 'directional'\ndirection = [0, 1, 0]", "1:1", "missing key `irradiance`"),
        ("[environment]\nstrength = 1", "1:1", "`environment` needs one of `radiance` and `file`"),
        ("[[light]]\ntype = 'point'\nposition = [0, 1, 0]", "3:12", "needs one of `intensity` and `power`"),
        (
            "[[light]]\ntype = 'spot'\nposition = [0, 1, 0]\nintensity = 1",
            "3:12",
            "needs one of `direction` and `target`",
        ),
        (
            "[material.a]\ntype = 'conductor'",
            "1:11",
            "a conductor needs one of `metal`, `eta` with `k`, and `reflectance`",
        ),
        (
            "[[shape]]\ntype = 'quad'\nemission = 1",
            "1:1",
            "a quad needs `corner`, `edge_u` and `edge_v`, or `vertices`",
        ),
        ("[expect]\nspp = 4", "1:1", "nothing is expected; give `radiance` or `layers`"),
        ("[texture.a]\nwrap = 'clamp'", "1:1", "missing key `file`; expected a string"),
    ]);
}

#[test]
fn numbers_out_of_range() {
    let diffuse = |value: &str| format!("[material.a]\ntype = 'diffuse'\nreflectance = {value}");
    let e = error(&diffuse("1.5"));
    assert_eq!(
        (e.place.as_str(), e.message.as_str()),
        ("3:15", "`reflectance`: found 1.5, expected a number in [0, 1]")
    );
    let e = error(&diffuse("[0.5, -0.1, 0.5]"));
    assert_eq!(
        (e.place.as_str(), e.message.as_str()),
        ("3:21", "`reflectance`: found -0.1, expected a number in [0, 1]")
    );
    check(&[
        ("[[shape]]\ntype = 'sphere'\nradius = 0", "3:10", "`radius`: found 0, expected a number > 0"),
        (
            "[camera]\nresolution = [0, 10]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]",
            "2:15",
            "`resolution`: found 0, expected a whole number from 1 to 65536",
        ),
        (
            "[camera]\nresolution = [10, 65537]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]",
            "2:19",
            "found 65537, expected a whole number from 1 to 65536",
        ),
        (
            "[camera]\nfocus_distance = 0.0\nposition = [0, 0, 1]\ntarget = [0, 0, 0]",
            "2:18",
            "found 0.0, expected a number > 0",
        ),
        (
            "[camera]\nview_angle = 180\nposition = [0, 0, 1]\ntarget = [0, 0, 0]",
            "2:14",
            "found 180, expected an angle between 0 and 180 degrees",
        ),
        (
            "[camera]\nlens_radius = -1\nposition = [0, 0, 1]\ntarget = [0, 0, 0]",
            "2:15",
            "found -1, expected a number ≥ 0",
        ),
        (
            "[[light]]\ntype = 'point'\nintensity = [1, -2, 3]\nposition = [0, 0, 0]",
            "3:17",
            "`intensity`: found -2, expected a number ≥ 0",
        ),
        (
            "[[light]]\ntype = 'spot'\nposition = [0, 0, 0]\ntarget = [0, 1, 0]\nintensity = 1\ninner_angle = 50",
            "3:12",
            "`inner_angle` is 50 and `outer_angle` 45, expected inner ≤ outer",
        ),
        ("[material.a]\ntype = 'dielectric'\nior = 0", "3:7", "`ior`: found 0, expected a number > 0"),
        ("[material.a]\ntype = 'metallic-roughness'\nior = 0.9", "3:7", "`ior` is 0.9, expected at least 1"),
        (
            "[material.a]\ntype = 'conductor'\nmetal = 'Au'\nroughness = 2",
            "4:13",
            "`roughness`: found 2, expected a number in [0, 1]",
        ),
        (
            "[material.a]\ntype = 'absorb'\n[material.b]\ntype = 'mix'\nparts = [{ material = 'a', weight = 0.7 }, { material = 'a', weight = 0.4 }]",
            "5:9",
            "the weights sum to 1.1",
        ),
        (
            "[material.a]\ntype = 'diffuse'\nreflectance = { texture = 't', uv_set = 2 }\n[texture.t]\ntype = 'checker'",
            "3:27",
            "`uv_set` is 2, expected 0 or 1",
        ),
        ("[expect]\nradiance = -1", "2:12", "`radiance`: found -1, expected a number ≥ 0"),
        ("[expect]\nradiance = 1\nregion = [3, 0, 3, 5]", "3:10", "`region` is [3, 0, 3, 5]"),
        ("[render]\nspp = 0", "2:7", "`spp`: found 0, expected a whole number ≥ 1"),
    ]);
}

#[test]
fn contradictions() {
    check(&[
        ("[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 1]", "2:12", "`position` is also the `target`"),
        ("[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nup = [0, 0, 2]", "4:6", "`up` is the direction of view"),
        (
            "[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nup = [0, 0, 0]",
            "4:6",
            "found [0, 0, 0], expected a direction",
        ),
        (
            "[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nview_angle = 40\nhorizontal_view_angle = 50",
            "5:25",
            "`view_angle` is given too",
        ),
        ("[render]\nmax-depth = 1\nmax_depth = 2", "3:1", "`max_depth` is given twice"),
        (
            "[camera]\nlens-radius = 1\nlens_radius = 2\nposition = [0, 0, 1]\ntarget = [0, 0, 0]",
            "3:1",
            "`lens_radius` is given twice",
        ),
        ("[render]\nspp = 1\nspp = 2", "3:1", "is not TOML: duplicate key"),
        ("name = ", "1:8", "is not TOML: "),
        ("[[shape]]\ntype = 'sphere'\nemission = 1\nscale = [1, 0, 1]", "4:9", "cannot be inverted"),
        (
            "[[shape]]\ntype = 'sphere'\nemission = 1\nscale = 2\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]",
            "1:1",
            "gives its place twice",
        ),
        (
            "[[shape]]\ntype = 'sphere'\nemission = 1\ntransform = [{ scale = 2, translate = [1, 2, 3] }]",
            "4:13",
            "exactly one of `translate`",
        ),
        (
            "[[shape]]\ntype = 'sphere'\nemission = 1\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]",
            "4:10",
            "its last row is",
        ),
        ("[[shape]]\ntype = 'box'\nemission = 1\nmin = [0, 0, 0]\nmax = [1, 0, 1]", "4:7", "`min` is not below `max`"),
        ("[[shape]]\ntype = 'cylinder'\nemission = 1\nto = [0, 0, 0]", "4:6", "expected a direction"),
        ("[material.a]\ntype = 'absorb'\nopacity_cutoff = 0.5", "1:11", "`opacity_cutoff` is given without `opacity`"),
        ("[material.a]\ntype = 'dielectric'\nroughness = 0.1\nalpha = 0.1", "4:9", "`roughness` is given too"),
        (
            "[material.a]\ntype = 'dielectric'\nabsorption = 1\nattenuation_distance = 1",
            "3:14",
            "`attenuation_color` or `attenuation_distance` is given too",
        ),
        (
            "[material.a]\ntype = 'dielectric'\nattenuation_color = 0.5",
            "3:21",
            "`attenuation_color` is given without `attenuation_distance`",
        ),
        ("[material.a]\ntype = 'dielectric'\nior = 1.5\ncauchy = [1.5, 0.01]", "4:10", "`ior` or `abbe` is given too"),
        ("[material.a]\ntype = 'dielectric'\ncauchy = [0.5, 0]", "3:10", "is 0.5, expected at least 1"),
        (
            "[material.a]\ntype = 'mix'\nparts = [{ material = 'b', weight = 1 }]\n[material.b]\ntype = 'dielectric'\npriority = 1",
            "3:23",
            "`b` has an absorption, priority or dispersion, which a mixture cannot honour",
        ),
        ("[environment]\nradiance = 1\nfile = 'x.exr'", "1:1", "needs one of `radiance` and `file`"),
        (
            "[material.a]\ntype = 'mix'\nparts = [{ material = 'a', weight = 1 }]",
            "3:23",
            "the material `a` contains itself",
        ),
        (
            "[material.a]\ntype = 'absorb'\nemission = 1\n[material.b]\ntype = 'mix'\nparts = [{ material = 'a', weight = 1 }]",
            "6:23",
            "`a` has an emission",
        ),
        (
            "[group.a]\ninstance = [{ group = 'b' }]\n[group.b]\ninstance = [{ group = 'a' }]",
            "4:23",
            "the group `a` contains itself",
        ),
    ]);
}

#[test]
fn meshes() {
    let mesh = |rest: &str| {
        format!("[[shape]]\ntype = 'mesh'\nemission = 1\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n{rest}")
    };
    for (rest, place, message) in [
        ("indices = [[0, 1, 3]]", "5:11", "triangle 0 has the vertex 3; there are 3, numbered from 0"),
        ("normals = [[0, 0, 1]]", "4:13", "1 normals for 3 vertices; expected one each"),
        ("uv = [[0, 0]]", "4:13", "1 texture coordinates for 3 vertices"),
        ("indices = [[0, 1, 1]]", "1:1", "has no triangle with an area"),
        ("indices = []", "1:1", "has no triangle with an area"),
    ] {
        let e = error(&mesh(rest));
        assert!(e.message.contains(message), "{e}");
        if !message.contains("area") {
            assert_eq!(e.place, place, "{e}");
        }
    }
    let e = error("[[shape]]\ntype = 'mesh'\nemission = 1\npositions = [[0, 0, 0], [1, 0, 0]]");
    assert!(e.message.contains("2 vertices without `indices` are not triangles"), "{e}");
}

#[test]
fn files_that_are_missing_outside_or_wrong() {
    let files = folder(&[
        ("inner/bad.png", b"hello"),
        ("inner/bad.obj", b"v 0 0 0\nf 1 2 3\n"),
        ("inner/t.png", &png()),
        ("secret.png", &png()),
    ]);
    let path = files.path().join("inner/scene.toml");
    for (text, kind, place, message) in [
        ("[texture.t]\nfile = 'none.png'", ErrorKind::Missing, "2:8", "`none.png` cannot be read"),
        ("[texture.t]\nfile = '../secret.png'", ErrorKind::Invalid, "2:8", "lies outside the scene's folder"),
        ("[texture.t]\nfile = '/etc/hostname'", ErrorKind::Invalid, "2:8", "lies outside the scene's folder"),
        ("[texture.t]\nfile = 'bad.png'", ErrorKind::Invalid, "2:8", "`bad.png` is an unknown format; expected PNG"),
        ("[environment]\nfile = 'none.exr'", ErrorKind::Missing, "2:8", "`none.exr` cannot be read"),
        ("[[shape]]\ntype = 'file'\nfile = 'none.obj'", ErrorKind::Missing, "3:8", "`none.obj` cannot be read"),
        (
            "[[shape]]\ntype = 'file'\nfile = 'bad.obj'",
            ErrorKind::Invalid,
            "3:8",
            "`bad.obj`, 2: `2` names vertex 2; there are 1 so far",
        ),
        ("[[shape]]\ntype = 'file'\nfile = 't.png'", ErrorKind::Unsupported, "3:8", "extension `.png` is not known"),
    ] {
        let e = parse(text, &path).expect_err(text);
        assert_eq!((e.kind, e.place.as_str()), (kind, place), "{e}");
        assert!(e.message.contains(message), "{e}");
        assert_eq!(e.file, path);
    }
    let e = read(&files.path().join("nowhere.toml")).unwrap_err();
    assert_eq!(e.kind, ErrorKind::Missing);
    std::fs::write(&path, b"name = 'a'\nb = '\xff'").unwrap();
    let e = read(&path).unwrap_err();
    assert_eq!((e.place.as_str(), e.message.as_str()), ("2:1", "is not UTF-8 text"));
}

#[test]
fn columns_count_characters() {
    check(&[("[render]\nspp = 1\n[\"\u{e4}\u{f6}\"]\n", "3:2", "unknown key")]);
    check(&[("name = '\u{4e16}\u{754c}' x", "1:13", "is not TOML")]);
}

/// One key misspelt at a time: each is found where it stands.
#[test]
fn every_misspelt_key_is_found() {
    let mut seen = 0;
    for (i, line) in EVERYTHING.lines().enumerate() {
        let Some((key, value)) = line.split_once(" = ") else { continue };
        let changed = format!("{key}q = {value}");
        let text: Vec<_> =
            EVERYTHING.lines().enumerate().map(|(j, l)| if i == j { changed.as_str() } else { l }).collect();
        let e = error(&text.join("\n"));
        if e.message.starts_with("missing key `type`") {
            continue;
        }
        assert_eq!(e.place, format!("{}:1", i + 1), "{e}");
        assert!(e.message.starts_with(&format!("unknown key `{key}q`; ")), "{e}");
        seen += 1;
    }
    assert!(seen > 80, "{seen}");
}
