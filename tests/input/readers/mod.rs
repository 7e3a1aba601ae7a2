//! The readers: what they accept, and what they say of what they do not.

mod broken;
mod images;
mod lights;
mod models;
mod schema;
mod toml_budgets;
mod toml_errors;
mod toml_optics;
mod toml_values;
mod toml_written;

use std::path::{Path, PathBuf};

/// A folder of third-party files, if this machine has it: `$RADIANZA_ASSETS/name`.
fn assets(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("RADIANZA_ASSETS").map(|root| Path::new(&root).join(name));
    match folder {
        Some(folder) if folder.is_dir() => Some(folder),
        _ => {
            crate::skip::skip(&format!("RADIANZA_ASSETS names no folder that has `{name}`"));
            None
        }
    }
}

/// A folder with these files in it, which goes when it is dropped.
fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    folder
}

/// A PNG of 2 × 1 pixels.
fn png() -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_fn(2, 1, |x, _| image::Rgb([255 * x as u8, 128, 0]));
    image.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}

/// A scene that uses most of the TOML format, and needs no files.
const EVERYTHING: &str = r##"
name = "Everything"
[[camera]]
name = "main"
position = [1, 2, 10]
target = [1, 2, 0]
horizontal_view_angle = 60
resolution = [320, 200]
lens_radius = 0.1
focus_distance = 7.5
[[camera]]
type = "orthographic"
position = [0, 10, 0]
target = [0, 0, 0]
up = [0, 0, -1]
height = 4
[[camera]]
type = "equirectangular"
position = [0, 1, 0]
target = [1, 1, 0]

[texture.tiles]
type = "checker"
even = 0.9
odd = [0.1, 0.2, 0.3]
scale = [4, 2]
uv_scale = 2
uv_rotate = 90
uv_offset = [0.5, 0]

[material.white]
type = "diffuse"
reflectance = [0.7, 0.6, 0.5]
[material.tiles]
type = "diffuse"
reflectance = { texture = "tiles", factor = 0.5 }
opacity = { texture = "tiles", channel = "g" }
opacity_cutoff = 0.25
normal_map = { texture = "tiles", scale = 2 }
[material.mirror]
type = "mirror"
[material.glass]
type = "dielectric"
ior = 1.33
alpha = [0.1, 0.2]
tint = "#80ff00"
[material.gold]
type = "conductor"
metal = "Au"
roughness = 0.3
[material.plastic]
type = "metallic-roughness"
base_color = "tiles"
roughness = 0.25
transmission = 0.5
thin = false
emission = 2
emission_sides = "both"
[material.blend]
type = "mix"
parts = [{ material = "white", weight = 0.25 }, { material = "mirror", weight = 0.5 }]

[[shape]]
type = "sphere"
name = "ball"
radius = 2
center = [1, 0, 0]
material = "glass"
translate = [0, 3, 0]
scale = 2
[[shape]]
type = "disk"
normal = [0, 1, 0]
emission = [17, 12, 4]
emission_sides = "both"
[[shape]]
type = "cylinder"
from = [0, 0, 0]
to = [0, 3, 4]
radius = 0.5
material = "gold"
reversed = true
[[shape]]
type = "quad"
vertices = [[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 1, 0]]
material = "tiles"
[[shape]]
type = "box"
min = [-1, -1, -1]
max = [1, 1, 1]
material = "blend"
rotate = { axis = [0, 1, 0], angle = 90 }
[[shape]]
type = "mesh"
positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
indices = [[0, 1, 2], [0, 0, 1]]
normals = [[0, 0, 2], [0, 0, 1], [0, 0, 0]]
uv = [[0, 0], [1, 0], [0, 1]]
colors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
material = "plastic"
transform = [{ scale = [1, 2, 3] }, { translate = [5, 0, 0] }, { matrix = [[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0]] }]

[group.pair]
[[group.pair.shape]]
type = "sphere"
material = "white"
[[group.pair.shape]]
type = "sphere"
material = "mirror"
translate = [3, 0, 0]
[[group.pair.light]]
type = "point"
position = [0, 1, 0]
intensity = 3
[group.four]
instance = [{ group = "pair" }, { group = "pair", translate = [0, 0, 5] }]
[[instance]]
group = "four"
translate = [0, 100, 0]
[[instance]]
group = "pair"
material = "gold"
matrix = [[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]

[[light]]
type = "point"
position = [0, 5, 0]
power = 12.566370614
[[light]]
type = "spot"
position = [0, 5, 0]
target = [0, 0, 0]
intensity = [1, 2, 3]
inner_angle = 10
outer_angle = 30
[[light]]
type = "directional"
direction = [0, -2, 0]
irradiance = 4

[environment]
radiance = [1, 2, 3]
strength = 2
rotation = 90

[render]
spp = 64
integrator = "path"
strategy = "mis"
sampler = "sobol"
max-depth = 8
filter = "blackman-harris"
tonemap = "reinhard"
exposure = -1.5

[[expect]]
radiance = 0.5
region = [0, 0, 10, 10]
[[expect]]
layers = { DD = [1, 2, 3] }
strategies = ["bsdf"]
max_depth = 2
tolerance = 1e-3
"##;
