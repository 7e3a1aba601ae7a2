//! Skies, suns and measured profiles in TOML.

use radianza::desc::{Light, Scene, toml::parse, toml::read};
use radianza::glam::Vec3;
use std::path::Path;

fn sky(keys: &str) -> Result<Scene, String> {
    parse(&format!("[environment]\ntype = 'sky'\n{keys}"), Path::new("sky.toml")).map_err(|e| e.to_string())
}

/// By angles and by place and time; turned and scaled with its sun.
#[test]
fn skies_have_their_sun() {
    let scene = sky("elevation = 30\nazimuth = 0\nrotation = 90\nstrength = [2, 1, 0]").unwrap();
    let [Light::Sun { direction, irradiance, diameter }] = scene.lights[..] else { panic!("{:?}", scene.lights) };
    // North turned counter-clockwise by 90° is west.
    assert!((direction - Vec3::new(30f32.to_radians().cos(), -0.5, 0.0)).length() < 1e-5, "{direction}");
    assert!(irradiance[0] > 1000.0 && irradiance[2] == 0.0 && (diameter - 0.0093).abs() < 1e-4, "{irradiance:?}");
    assert_eq!(scene.environment.as_ref().map(|e| e.radiance), Some([2.0, 1.0, 0.0]));

    // Greenwich, the summer solstice of 2024, noon: 62° high in the south.
    let scene = sky("latitude = 51.48\ndate = '2024-06-20'\ntime = '12:02'\nturbidity = 3").unwrap();
    let [Light::Sun { direction, .. }] = scene.lights[..] else { panic!("{:?}", scene.lights) };
    assert!(
        (-direction.y).asin().to_degrees() > 61.8 && direction.z < -0.45 && direction.x.abs() < 0.01,
        "{direction}"
    );

    assert!(sky("elevation = 30\nsun = false").unwrap().lights.is_empty());
    assert!(sky("elevation = -5").unwrap().lights.is_empty());
}

#[test]
fn skies_say_what_they_lack() {
    for (keys, message) in [
        ("", "needs either `elevation` or `latitude`, `date` and `time`"),
        ("elevation = 10\nlatitude = 3", "needs either"),
        ("elevation = 91", "expected -90 to 90"),
        ("elevation = 10\nturbidity = 0.5", "expected 1 to 20"),
        ("latitude = 3\ndate = '2024-13-01'\ntime = '12:00'", "expected \"YYYY-MM-DD\""),
        ("latitude = 3\ndate = '2024-12-01'\ntime = '12:61'", "expected \"HH:MM\""),
        ("elevation = 10\nfile = 'x.hdr'", "unknown key `file`"),
    ] {
        let error = sky(keys).unwrap_err();
        assert!(error.contains(message), "{keys}: {error}");
    }
}

#[test]
fn profiles_are_read_from_the_scenes_folder() {
    let folder = tempfile::tempdir().unwrap();
    let ies = "IESNA:LM-63-2002\nTILT=NONE\n1 1 2 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5 3\n";
    std::fs::write(folder.path().join("a.ies"), ies).unwrap();
    std::fs::write(folder.path().join("bad.ies"), &ies[..40]).unwrap();
    let path = folder.path().join("scene.toml");
    let light = |file: &str| {
        let text = format!(
            "[[light]]\ntype = 'ies'\nfile = '{file}'\nposition = [0, 2, 0]\ntarget = [0, 0, 0]\nmultiplier = [1, 2, 3]\n"
        );
        std::fs::write(&path, text + "[[light]]\ntype = 'sun'\ndirection = [0, -2, 0]\nirradiance = 3\n").unwrap();
        read(&path)
    };
    let scene = light("a.ies").unwrap();
    let [Light::Profile { position, to_world, intensity, profile }, Light::Sun { direction, .. }] = &scene.lights[..]
    else {
        panic!("{:?}", scene.lights)
    };
    assert_eq!((*position, *intensity, &profile.candela[..]), (Vec3::Y * 2.0, [1.0, 2.0, 3.0], &[10.0, 6.0][..]));
    // Down, with the horizontal angle 0 towards +x.
    assert!((*to_world * Vec3::NEG_Z - Vec3::NEG_Y).length() < 1e-6 && (*to_world * Vec3::X - Vec3::X).length() < 1e-6);
    assert_eq!(*direction, Vec3::NEG_Y);
    let error = light("bad.ies").unwrap_err().to_string();
    assert!(error.contains("`bad.ies`, line 3: the file ends") && error.contains(":3:8"), "{error}");
}

#[test]
fn tilts_are_read_from_beside_the_profile() {
    let ies = "IESNA:LM-63-2002\nTILT=lamp.tlt\n1 1 2 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5 3\n";
    let text = "[[light]]\ntype = 'ies'\nfile = 'lamps/a.ies'\nposition = [0, 0, 0]\ndirection = [1, -1, 0]\n";
    let mut files = vec![("scene.toml", text.as_bytes()), ("lamps/a.ies", ies.as_bytes())];
    let gone = super::folder(&files);
    let error = read(&gone.path().join("scene.toml")).unwrap_err().to_string();
    assert!(error.contains(":3:8") && error.contains("line 2: the tilt's file `lamp.tlt`"), "{error}");
    files.push(("lamps/lamp.tlt", b"3\n2\n0 90\n1 0.5\n"));
    let folder = super::folder(&files);
    let scene = read(&folder.path().join("scene.toml")).unwrap();
    let [Light::Profile { position, to_world, intensity, profile }] = &scene.lights[..] else {
        panic!("{:?}", scene.lights)
    };
    // Tilted by 45°, halfway from 1 to 0.5.
    assert!((profile.tilt_factor(*to_world) - 0.75).abs() < 1e-6);
    // 5 cd at the axis, times the multiplier 2 and the tilt, at 2 m: 7.5/4 W/m².
    let light = radianza::light::ProfileLight::new(*position, *to_world, *intensity, profile.clone());
    let sample = light.sample(radianza::glam::Vec3A::new(1.0, -1.0, 0.0).normalize() * 2.0).unwrap();
    assert!((sample.le.0.x - 1.875).abs() < 1e-5, "{sample:?}");
}
