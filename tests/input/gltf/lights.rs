//! EXT_lights_ies and EXT_lights_image_based.

use super::document::Document;
use radianza::desc::{Light, Pixels};
use radianza::glam::{Mat3, Vec3};
use serde_json::json;

const PROFILE: &str = "IESNA:LM-63-1995\nTILT=NONE\n1 1 2 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5 3\n";

fn with_profile() -> Document {
    let mut d = Document::triangle();
    let uri = format!("data:application/x-ies-lm-63,{}", PROFILE.replace('\n', "%0A").replace(' ', "%20"));
    let view = d.view(PROFILE.as_bytes());
    let lights = json!([{ "uri": uri }, { "bufferView": view, "mimeType": "application/x-ies-lm-63" }]);
    d.set("/extensions/EXT_lights_ies/lights", lights);
    let light = json!({ "light": 1, "multiplier": 4, "color": [1, 0.5, 0] });
    d.set("/nodes/0/extensions/EXT_lights_ies", light).set("/nodes/0/scale", json!([2, 2, 2]));
    d.set("/nodes/0/rotation", json!([0, 0.5f32.sqrt(), 0, 0.5f32.sqrt()]));
    d.set("/extensionsRequired", json!(["EXT_lights_ies"]));
    d
}

#[test]
fn profiles_light_from_their_nodes() {
    let mut d = with_profile();
    for light in [0, 1] {
        let scene = d.set("/nodes/0/extensions/EXT_lights_ies/light", json!(light)).read().unwrap();
        let [Light::Profile { to_world, intensity, profile, .. }] = &scene.lights[..] else { panic!() };
        assert_eq!((*intensity, &profile.candela[..]), ([4.0, 2.0, 0.0], &[10.0, 6.0][..]));
        assert!(
            (*to_world * Vec3::NEG_Z).abs_diff_eq(Vec3::NEG_X, 1e-6) && (to_world.determinant() - 1.0).abs() < 1e-6
        );
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    }
}

#[test]
fn bad_profiles_are_refused() {
    let node = "/nodes/0/extensions/EXT_lights_ies";
    with_profile().set(&format!("{node}/light"), json!(2)).fails(&format!("{node}/light"), "refers to light profile 2");
    with_profile().set(&format!("{node}/light"), json!("x")).fails(&format!("{node}/light"), "expected an index");
    with_profile().set(&format!("{node}/color"), json!([1])).fails(&format!("{node}/color"), "three numbers");
    let lights = "/extensions/EXT_lights_ies/lights/1";
    with_profile().set(lights, json!({})).fails(lights, "expected one");
    let text = json!({ "uri": "data:,TILT=NONE%0A1%20x" });
    with_profile().set(lights, text).fails(&format!("{lights}/uri"), "line 2: `x` is no number");
}

fn with_cube() -> Document {
    let mut d = Document::triangle();
    for i in 0..6u8 {
        d.texture([1, 1], &[[40 * i, 0, 0, if i == 5 { 51 } else { 255 }]]);
    }
    let light = json!({ "intensity": 3, "rotation": [0, 0.5f32.sqrt(), 0, 0.5f32.sqrt()], "specularImageSize": 1,
        "specularImages": [[0, 1, 2, 3, 4, 5]], "irradianceCoefficients": [] });
    d.set("/extensions/EXT_lights_image_based/lights", json!([light]));
    d.set("/scenes/0/extensions/EXT_lights_image_based/light", json!(0));
    d.set("/extensionsUsed", json!(["EXT_lights_image_based"]));
    d
}

/// The faces stand where they belong: the middle of the panorama is −z, +x right of it, +y above.
#[test]
fn cube_maps_surround_the_scene() {
    let scene = with_cube().read().unwrap();
    let environment = scene.environment.as_ref().unwrap();
    assert_eq!(environment.radiance, [3.0; 3]);
    assert!(environment.to_world.abs_diff_eq(Mat3::from_rotation_y(std::f32::consts::FRAC_PI_2), 1e-6));
    let image = &scene.images[environment.image.unwrap()];
    let Pixels::Rgba32F(pixels) = &image.pixels else { panic!() };
    assert_eq!(image.size, [4, 2]);
    // The middle columns see some of −z, five times as bright as its code by its alpha; the outer ones +z.
    let row: Vec<f32> = (0..4).map(|i| pixels[i][0]).collect();
    assert!(row[1] > 0.3 && row[2] > 0.3 && row[0] < 0.15 && row[3] < 0.15, "{row:?}");
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn bad_cubes_are_refused() {
    let light = "/extensions/EXT_lights_image_based/lights/0";
    let faces = format!("{light}/specularImages/0");
    with_cube().set(&faces, json!([0, 1])).fails(&faces, "six images");
    with_cube().set(&format!("{faces}/3"), json!(99)).fails(&format!("{faces}/3"), "refers to image 99");
    with_cube().set(&format!("{light}/rotation"), json!([0, 0, 0, 0])).fails(&format!("{light}/rotation"), "unit");
    let mut d = with_cube();
    d.texture([2, 2], &[[0; 4]; 4]);
    d.set(&format!("{faces}/0"), json!(6)).fails(&faces, "six squares");
}
