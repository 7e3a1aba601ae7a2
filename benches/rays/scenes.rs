//! Five scenes, and rays as a path tracer asks them.

use glam::{Quat, Vec3, Vec3A};
use radianza::bvh::{TriangleBvh, TriangleRef};
use radianza::desc;
use radianza::math::{Frame, Ray, offset_origin};
use radianza::sampler::{Kind, Sampler};
use radianza::shape::{flat_surface, triangle_normal};
use radianza::warp;
use std::f32::consts::PI;
use std::path::Path;

/// Rays of a set: 256 × 256.
const SIDE: u32 = 256;

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Query {
    Nearest,
    Occluded,
}

/// Rays of one kind.
pub(crate) struct RaySet {
    pub(crate) name: &'static str,
    pub(crate) query: Query,
    pub(crate) rays: Vec<Ray>,
    /// Of each, the ray whose hit it leaves; none leave the camera.
    pub(crate) parents: Vec<Ray>,
}

impl RaySet {
    /// Its rays leave surfaces, not the camera.
    pub(crate) fn leaves_surfaces(&self) -> bool {
        !self.parents.is_empty()
    }
}

/// Rays, and those whose hits they leave.
#[derive(Default)]
struct Left {
    rays: Vec<Ray>,
    parents: Vec<Ray>,
}

impl Left {
    fn push(&mut self, ray: Ray, parent: &Ray) {
        self.rays.push(ray);
        self.parents.push(*parent);
    }
}

/// Triangles, and where they are looked at and lit from.
pub(crate) struct Meshed {
    pub(crate) name: &'static str,
    pub(crate) positions: Vec<Vec3>,
    pub(crate) indices: Vec<[u32; 3]>,
    eye: Vec3,
    target: Vec3,
    /// Half the angle of view, as a slope.
    slope: f32,
    /// A corner and the edges of the rectangle that lights it.
    lamp: [Vec3; 3],
}

/// The scenes, made one at a time.
pub(crate) fn all() -> impl Iterator<Item = Meshed> {
    [cornell, blob, terrain, spheres, hall].into_iter().map(|make| make())
}

impl Meshed {
    fn new(name: &'static str, [eye, target]: [Vec3; 2], slope: f32, lamp: [Vec3; 3]) -> Self {
        Self { name, positions: Vec::new(), indices: Vec::new(), eye, target, slope, lamp }
    }

    fn triangle(&mut self, corners: [Vec3; 3]) {
        let base = self.positions.len() as u32;
        self.positions.extend(corners);
        self.indices.push([base, base + 1, base + 2]);
    }

    fn quad(&mut self, a: Vec3, u: Vec3, v: Vec3) {
        self.triangle([a, a + u, a + u + v]);
        self.triangle([a, a + u + v, a + v]);
    }

    /// A sphere of `n` × 2n quads that `radius` bends.
    fn globe(&mut self, centre: Vec3, n: u32, radius: impl Fn(Vec3) -> f32) {
        let base = self.positions.len() as u32;
        for i in 0..=n {
            for j in 0..2 * n {
                let (theta, phi) = (i as f32 / n as f32 * PI, j as f32 / n as f32 * PI);
                let d = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
                self.positions.push(centre + d * radius(d));
            }
        }
        let at = |i: u32, j: u32| base + i * 2 * n + j % (2 * n);
        for i in 0..n {
            for j in 0..2 * n {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if i > 0 {
                    self.indices.push([a, b, d]);
                }
                if i + 1 < n {
                    self.indices.push([d, b, c]);
                }
            }
        }
    }

    /// Camera rays in tiles, two diffuse bounces, and shadow rays from the first hits to the lamp.
    pub(crate) fn rays(&self, bvh: &TriangleBvh) -> [RaySet; 4] {
        let mut u = Sampler::new(Kind::Independent, 1, [0, 0], 0, 1);
        let frame =
            Frame::from_z_tangent((self.eye - self.target).normalize(), Vec3::Y.cross(self.eye - self.target), 1.0);
        let mut primary = Vec::new();
        for tile in 0..SIDE * SIDE / 64 {
            for i in 0..64 {
                let x = (tile % (SIDE / 8) * 8 + i % 8) as f32;
                let y = (tile / (SIDE / 8) * 8 + i / 8) as f32;
                let [dx, dy] = u.next_2d();
                let film = |p: f32| (2.0 * p / SIDE as f32 - 1.0) * self.slope;
                let d = frame.to_world(Vec3::new(film(x + dx), -film(y + dy), -1.0));
                primary.push(Ray::new(self.eye, d.normalize()));
            }
        }
        let (first, shadow) = self.leave(bvh, &primary, &mut u);
        let (second, _) = self.leave(bvh, &first.rays, &mut u);
        let set = |name, query, Left { rays, parents }| RaySet { name, query, rays, parents };
        [
            set("primary", Query::Nearest, Left { rays: primary, parents: Vec::new() }),
            set("first bounce", Query::Nearest, first),
            set("second bounce", Query::Nearest, second),
            set("shadow", Query::Occluded, shadow),
        ]
    }

    /// Rays that leave the hits diffusely, and towards the lamp.
    fn leave(&self, bvh: &TriangleBvh, rays: &[Ray], u: &mut Sampler) -> (Left, Left) {
        let (mut bounces, mut shadows) = (Left::default(), Left::default());
        for ray in rays {
            let Some(hit) = bvh.nearest(ray, TriangleRef::NONE) else { continue };
            let corners = bvh.vertices(hit.slot);
            let Some(n) = triangle_normal(corners.map(Vec3::from)).map(Vec3A::from) else { continue };
            let n = if n.dot(ray.d) > 0.0 { -n } else { n };
            let s = flat_surface(corners, hit.u, hit.v, n);
            let d = Frame::from_z(n).to_world(warp::cosine_hemisphere(u.next_2d()));
            bounces.push(Ray::new(offset_origin(s.p, s.p_error, n, d), d), ray);
            let [a, b] = u.next_2d();
            let to = Vec3A::from(self.lamp[0] + self.lamp[1] * a + self.lamp[2] * b) - s.p;
            if to.dot(n) > 0.0 {
                let o = offset_origin(s.p, s.p_error, n, to);
                shadows.push(Ray { o, d: to.normalize(), t_max: to.length() * 0.999 }, ray);
            }
        }
        (bounces, shadows)
    }
}

/// The box of `scenes/cornell-box.toml`.
fn cornell() -> Meshed {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box.toml");
    let scene = desc::load(&path).expect("the scene is shipped");
    let (eye, target) = (Vec3::new(0.278, 0.273, -0.8), Vec3::new(0.278, 0.273, 0.0));
    let lamp = [Vec3::new(0.213, 0.5487, 0.227), Vec3::X * 0.13, Vec3::Z * 0.105];
    let mut all = Meshed::new("cornell", [eye, target], 0.35, lamp);
    for object in &scene.objects {
        if let desc::Shape::Mesh(mesh) = &scene.shapes[object.shape] {
            for t in &mesh.indices {
                all.triangle(t.map(|i| object.to_world.transform_point3(mesh.positions[i as usize])));
            }
        }
    }
    all
}

/// A bent closed surface as a scan has it.
fn blob() -> Meshed {
    let lamp = [Vec3::new(-2.0, 5.0, -2.0), Vec3::X * 4.0, Vec3::Z * 4.0];
    let mut blob = Meshed::new("blob", [Vec3::new(1.5, 1.2, 3.0), Vec3::ZERO], 0.4, lamp);
    blob.globe(Vec3::ZERO, 132, bumps);
    blob
}

fn bumps(d: Vec3) -> f32 {
    let octave = |k: f32| (d.x * k + 1.0).sin() * (d.y * k * 1.1 + 2.0).sin() * (d.z * k * 0.9 + 3.0).sin();
    1.0 + 0.3 * octave(4.0) + 0.1 * octave(13.0) + 0.02 * octave(50.0)
}

/// Rolling hills of a million triangles.
fn terrain() -> Meshed {
    const SIDE: u32 = 708;
    let lamp = [Vec3::new(-50.0, 40.0, -50.0), Vec3::X * 100.0, Vec3::Z * 100.0];
    let mut hills = Meshed::new("terrain", [Vec3::new(0.0, 14.0, 55.0), Vec3::new(0.0, 2.0, 0.0)], 0.5, lamp);
    let height = |x: f32, y: f32| {
        let octave = |k: f32| ((x * k).sin() * (y * k * 1.3 + 1.0).cos()) / k;
        4.0 * (octave(0.1) * 0.1 + octave(0.37) + octave(1.1) + octave(3.7))
    };
    let at = |i: u32| i as f32 / (SIDE - 1) as f32 * 100.0 - 50.0;
    let vertex = |k: u32| Vec3::new(at(k % SIDE), height(at(k % SIDE), at(k / SIDE)), at(k / SIDE));
    let quad = |k: u32| [[k, k + SIDE, k + 1], [k + 1, k + SIDE, k + SIDE + 1]];
    hills.positions = (0..SIDE * SIDE).map(vertex).collect();
    hills.indices = (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| y * SIDE + x)).flat_map(quad).collect();
    hills
}

/// Ten thousand spheres of 128 triangles.
fn spheres() -> Meshed {
    let lamp = [Vec3::new(-4.0, 14.0, -4.0), Vec3::X * 8.0, Vec3::Z * 8.0];
    let mut cloud = Meshed::new("spheres", [Vec3::new(4.0, 6.0, 17.0), Vec3::ZERO], 0.6, lamp);
    let mut u = Sampler::new(Kind::Independent, 7, [0, 0], 0, 1);
    for _ in 0..10_000 {
        let centre = Vec3::new(u.next_1d(), u.next_1d(), u.next_1d()) * 16.0 - 8.0;
        let radius = 0.08 + 0.2 * u.next_1d();
        cloud.globe(centre, 8, |_| radius);
    }
    cloud
}

/// A hall of two huge quads a wall, with scans between columns of long thin triangles, some of them leaning.
fn hall() -> Meshed {
    let lamp = [Vec3::new(-6.0, 9.9, -6.0), Vec3::X * 12.0, Vec3::Z * 12.0];
    let mut hall = Meshed::new("hall", [Vec3::new(10.0, 4.0, 14.0), Vec3::new(0.0, 2.0, 0.0)], 0.6, lamp);
    let (x, y, z) = (Vec3::X * 30.0, Vec3::Y * 10.0, Vec3::Z * 40.0);
    let low = Vec3::new(-15.0, 0.0, -20.0);
    for (corner, u, v) in [(low, z, x), (low + y, x, z), (low, x, y), (low + z, y, x), (low, y, z), (low + x, z, y)] {
        hall.quad(corner, u, v);
    }
    for i in 0..12 {
        let centre = Vec3::new((i % 4) as f32 * 6.0 - 9.0, 1.6, (i / 4) as f32 * 8.0 - 8.0);
        hall.globe(centre, 160, |d| 1.2 * bumps(d + i as f32));
    }
    for i in 0..60 {
        let foot = Vec3::new((i % 10) as f32 * 2.9 - 13.0, 0.0, (i / 10) as f32 * 6.5 - 16.0);
        let lean = Quat::from_rotation_z(if i % 3 == 0 { 0.3 } else { 0.0 }) * Vec3::Y * 10.0;
        for k in 0..24 {
            let side = |k: i32| {
                let angle = k as f32 / 12.0 * PI;
                Vec3::new(angle.cos(), 0.0, angle.sin()) * 0.12
            };
            hall.quad(foot + side(k), lean, side(k + 1) - side(k));
        }
    }
    hall
}
