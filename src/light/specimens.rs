//! The family, for tests and verification: every kind of light with points that see it in every way there is.

use super::{Emitter, Environment, Light, QuadricLight, TriangleLight};
use crate::desc::{self, ColorParam, Emission, Sides};
use crate::math::Transform;
use crate::shape::{PlacedQuadric, Quadric, TriangleAttributes};
use crate::texture::Textures;
use glam::{Mat3, Mat4, Quat, Vec3, Vec4};

/// A light, and points that it is sampled from.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Name for reports.
    pub name: &'static str,
    /// The light.
    pub light: Light,
    /// Reference points, each with what is particular about it.
    pub points: Vec<(&'static str, Vec3)>,
}

/// One specimen of every kind of light, sampling method and pose. Textures are not needed.
pub fn specimens() -> Vec<Specimen> {
    let mut all = triangles();
    all.extend(quadrics());
    all.extend(environments());
    all.extend(punctual());
    all
}

/// Emission of linear RGB (2, 3, 1).
fn emitter(sides: Sides) -> Emitter {
    Emitter::new(&Emission { radiance: ColorParam::constant([2.0, 3.0, 1.0]), sides, coat: None })
}

fn triangles() -> Vec<Specimen> {
    let triangle = |p, sides| TriangleLight::new(p, &TriangleAttributes::default(), false, emitter(sides));
    let specimen = |name, p, sides, points| {
        triangle(p, sides).map(|light| Specimen { name, light: Light::Triangle(light), points })
    };
    let right = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let sliver = [Vec3::ZERO, Vec3::X, Vec3::new(0.9, 0.01, 0.0)];
    let hall = right.map(|p| p * 1e4 + Vec3::new(0.0, 0.0, 1e3));
    [
        specimen(
            "triangle",
            right,
            Sides::Front,
            vec![
                ("near", Vec3::new(0.2, 0.3, 0.4)),
                ("touching", Vec3::new(0.3, 0.3, 0.02)),
                ("grazing", Vec3::new(-0.5, 0.3, 0.01)),
                ("over an edge", Vec3::new(0.5, 0.0, 1e-4)),
                ("over a corner", Vec3::new(1e-3, 1e-3, 2e-3)),
                ("in its plane", Vec3::new(2.0, 0.3, 0.0)),
                ("beyond a corner", Vec3::new(1.5, -0.2, 0.3)),
                ("at the switch to area", Vec3::new(0.3, 0.3, 1.49)),
                ("far", Vec3::new(3.0, 2.0, 9.0)),
                ("behind", Vec3::new(0.2, 0.3, -0.4)),
            ],
        ),
        specimen(
            "two-sided sliver",
            sliver,
            Sides::Both,
            vec![("near", Vec3::new(0.5, 0.2, 0.3)), ("behind", Vec3::new(0.5, 0.0, -0.5))],
        ),
        colored(right),
        specimen("triangle of 10 km", hall, Sides::Both, vec![("below", Vec3::new(1e3, 2e3, 0.0))]),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// One whose radiance grows towards a corner: drawn by its bright parts.
fn colored(p: [Vec3; 3]) -> Option<Specimen> {
    let grey = |x: f32| Vec4::new(x, x, x, 1.0);
    let attributes = TriangleAttributes { colors: Some([grey(0.1), grey(0.2), grey(5.0)]), ..Default::default() };
    let radiance = ColorParam { vertex_color: true, ..ColorParam::constant([2.0, 3.0, 1.0]) };
    let emitter = Emitter::new(&Emission { radiance, sides: Sides::Front, coat: None });
    let mut light = TriangleLight::new(p, &attributes, false, emitter)?;
    light.divide(&Textures::default(), 1 << 14);
    let points = vec![("near", Vec3::new(0.2, 0.3, 0.4)), ("far", Vec3::new(3.0, 2.0, 9.0))];
    Some(Specimen { name: "triangle with colours", light: Light::Triangle(light), points })
}

fn quadrics() -> Vec<Specimen> {
    let specimen = |name, quadric, to_world: Mat4, reversed, sides, points| {
        Transform::from_mat4(to_world).map(|transform| {
            let shape = PlacedQuadric::new(quadric, transform, reversed);
            Specimen { name, light: Light::Quadric(Box::new(QuadricLight::new(shape, emitter(sides)))), points }
        })
    };
    let turned = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -1.0).normalize(), 0.7);
    let at = Vec3::new(1.0, -2.0, 0.5);
    let similar = Mat4::from_scale_rotation_translation(Vec3::splat(0.5), turned, at);
    let stretched = Mat4::from_scale_rotation_translation(Vec3::new(0.3, 1.0, -2.0), turned, at);
    let (sphere, disk) = (Quadric::Sphere { radius: 1.4 }, Quadric::Disk { radius: 0.8 });
    let cylinder = Quadric::Cylinder { radius: 0.6, height: 1.5 };
    let outside = vec![
        ("near", at + Vec3::new(0.8, 0.3, 0.2)),
        ("touching", at + Vec3::new(0.0, 0.0, 0.7001)),
        ("far", at + Vec3::new(30.0, -20.0, 7.0)),
    ];
    let around = vec![
        ("near", at + Vec3::new(1.9, 0.6, 1.3)),
        ("other side", at + Vec3::new(-1.7, -1.0, -1.4)),
        ("far", at + Vec3::new(4.0, 3.0, 8.0)),
    ];
    let inside = vec![("centre", at), ("off centre", at + Vec3::new(0.3, 0.4, 0.1))];
    [
        specimen("sphere", sphere, similar, false, Sides::Front, outside),
        specimen("sphere from inside", sphere, similar, true, Sides::Front, inside),
        specimen("ellipsoid", sphere, stretched, false, Sides::Front, around.clone()),
        specimen("ellipsoid from inside", sphere, stretched, false, Sides::Both, vec![("centre", at)]),
        specimen("disk", disk, similar, false, Sides::Front, around.clone()),
        specimen("elliptic disk, reversed", disk, stretched, true, Sides::Both, around.clone()),
        specimen("cylinder", cylinder, similar, false, Sides::Both, around.clone()),
        specimen("elliptic cylinder", cylinder, stretched, false, Sides::Front, around),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn environments() -> Vec<Specimen> {
    let origin = vec![("anywhere", Vec3::ZERO)];
    let specimen = |name, image: Option<&desc::Image>| {
        let to_world = Mat3::from_axis_angle(Vec3::new(2.0, -1.0, 0.5).normalize(), 1.1);
        let written = desc::Environment { radiance: [1.0, 2.0, 3.0], image: image.map(|_| 0), to_world };
        let light = Light::Environment(Box::new(Environment::new(&written, image)));
        Specimen { name, light, points: origin.clone() }
    };
    // A sky with a gradient, dark ground, one sun, and bright poles.
    let [width, height] = [16u32, 8];
    let pixel = |i: u32| match (i % width, i / width) {
        (_, 0) => [1.5, 1.0, 0.5, 1.0],
        (11, 2) => [300.0, 250.0, 200.0, 1.0],
        (column, row) if row < 4 => [0.2, 0.4, 0.1 * column as f32, 1.0],
        (column, 7) => [0.1 * column as f32, 0.0, 0.0, 1.0],
        _ => [0.0, 0.0, 0.0, 1.0],
    };
    let sky = desc::Image {
        name: "sky".into(),
        size: [width, height],
        pixels: desc::Pixels::Rgba32F((0..width * height).map(pixel).collect()),
    };
    vec![specimen("uniform environment", None), specimen("environment image", Some(&sky))]
}

fn punctual() -> Vec<Specimen> {
    let position = Vec3::new(0.0, 0.0, 2.0);
    let intensity = [3.0, 2.0, 1.0];
    let spot =
        desc::Light::Spot { position, direction: Vec3::NEG_Z, intensity, inner: 0.3, outer: 0.6, range: f32::INFINITY };
    let sun = desc::Light::Directional { direction: Vec3::new(0.6, 0.0, -0.8), irradiance: intensity };
    let disk = desc::Light::Sun { direction: Vec3::new(0.6, 0.0, -0.8), irradiance: intensity, diameter: 0.01 };
    // A luminaire of two vertical angles, brighter along its axis.
    let profile = desc::ies::Profile {
        kind: desc::ies::Photometry::C,
        vertical: vec![0.0, 90.0],
        horizontal: vec![0.0],
        candela: vec![5.0, 1.0],
        tilt: None,
    };
    let to_world = Mat3::IDENTITY;
    let measured = desc::Light::Profile { position, to_world, intensity, profile: profile.into() };
    let specimen = |name, light: &desc::Light, points| Specimen { name, light: Light::from_desc(light), points };
    vec![
        specimen(
            "point",
            &desc::Light::Point { position, intensity, range: f32::INFINITY },
            vec![("below", Vec3::new(0.5, 1.0, 0.0))],
        ),
        specimen(
            "spot",
            &spot,
            vec![
                ("inner cone", Vec3::new(0.5, 0.0, 0.0)),
                ("penumbra", Vec3::new(0.0, 0.9, 0.0)),
                ("outside", Vec3::new(3.0, 0.0, 0.0)),
            ],
        ),
        specimen("measured", &measured, vec![("below", Vec3::new(0.5, 1.0, 0.0))]),
        specimen("directional", &sun, vec![("anywhere", Vec3::ZERO)]),
        specimen("sun", &disk, vec![("anywhere", Vec3::ZERO)]),
    ]
}
