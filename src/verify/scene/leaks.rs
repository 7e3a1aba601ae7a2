//! Light leaks: rays that start inside of a closed surface and get out without meeting it.
//!
//! A surface is closed where its author says so (`closed = true` on a shape, `"extras": {"closed": true}` on a glTF node
//! or mesh), and then must be; or where its topology says so: every edge is run along as often as against. The rays start
//! on the surface itself, as those of light do, and half of them aim at edges and vertices, where a hierarchy or a
//! triangle test that is not watertight would let them through.

use super::surfaces::corners;
use super::topology::{Edges, signed_volume, winding};
use super::{Subject, count, unique};
use crate::desc::{self, Model, Object, Shape};
use crate::math::{Frame, Ray, Transform, offset_origin};
use crate::sampler::{Kind, Sampler};
use crate::scene::{PrimitiveRef, Scene};
use crate::shape::{flat_surface, triangle_normal};
use crate::verify::{Findings, Task, Topic, Trial};
use crate::warp::{uniform_hemisphere, uniform_triangle};
use glam::{Vec3, Vec3A};

const TOPIC: Topic = Topic {
    id: "leaks",
    title: "no ray from inside of a closed surface gets out without meeting it",
    source: "Woop, Benthin & Wald 2013, Watertight Ray/Triangle Intersection; van Oosterom & Strackee 1983 for inside",
};

/// Rays in all.
const RAYS: [usize; 2] = [1_000_000, 20_000_000];

/// Most triangles of a mesh whose topology is looked at.
const MOST_TRIANGLES: [usize; 2] = [2_000_000, 20_000_000];

/// Most names in a sentence.
const NAMED: usize = 8;

/// One task for each surface that is declared closed, and one for all others.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    let groups = groups(&subject.desc);
    let names = unique(groups.iter().map(|g| &*subject.desc.objects[g[0]].name), "object");
    let rays = |groups: usize, trial: &Trial| (trial.work(RAYS[0], RAYS[1]) / groups.max(1)).clamp(2_000, 200_000);
    let declared: Vec<_> = groups.into_iter().zip(names).filter(|(g, _)| subject.desc.objects[g[0]].closed).collect();
    let shares = declared.len();
    let mut tasks: Vec<Task> = Vec::new();
    for (group, name) in declared {
        let subject = subject.clone();
        tasks.push(Task::new(TOPIC, format!("{name}, declared closed"), move |trial, found| {
            let surface = Surface::new(&subject.desc, &group);
            let edges = Edges::of(&surface.triangles);
            found.checks.holds("every edge is shared by triangles of one sense", edges.closed());
            if !edges.closed() {
                let first = edges.first.unwrap_or(0);
                found.words.push(format!(
                    "`{name}` is declared closed, but {} of {} edges are open and {} twisted (first: triangle {first})",
                    edges.open, edges.all, edges.twisted
                ));
            }
            let verdict = surface.leaks(rays(shares, trial), trial.seed);
            found.checks.holds("no ray from inside gets out", verdict.escaped == 0 && verdict.rays > 0);
            found.words.push(format!("`{name}`: {}", verdict.text()));
        }));
    }
    if meshes_left(&subject.desc) {
        let subject = subject.clone();
        tasks.push(Task::new(TOPIC, "meshes closed by topology", move |trial, found| {
            undeclared(&subject, trial, found)
        }));
    }
    tasks
}

fn is_mesh(scene: &desc::Scene, object: &Object) -> bool {
    matches!(scene.shapes.get(object.shape), Some(Shape::Mesh(_)))
}

fn meshes_left(scene: &desc::Scene) -> bool {
    scene.objects.iter().any(|o| !o.closed && is_mesh(scene, o))
}

/// Objects that are one surface: neighbours of one name in one place, the primitives of a glTF mesh.
fn groups(scene: &desc::Scene) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, object) in scene.objects.iter().enumerate().filter(|(_, o)| is_mesh(scene, o)) {
        let joins = |group: &&mut Vec<usize>| {
            let last = &scene.objects[*group.last().unwrap_or(&0)];
            last.name == object.name && last.to_world == object.to_world && last.closed == object.closed
        };
        match groups.last_mut().filter(joins) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups
}

/// Meshes that nothing was said of: a group as a whole, else its parts one by one.
fn undeclared(subject: &Subject, trial: &Trial, found: &mut Findings) {
    let scene = &subject.desc;
    let groups: Vec<Vec<usize>> = groups(scene).into_iter().filter(|g| !scene.objects[g[0]].closed).collect();
    let rays = (trial.work(RAYS[0], RAYS[1]) / groups.len().max(1)).clamp(2_000, 200_000);
    let (mut closed, mut total, mut escaped) = (0, 0, 0);
    let [mut open, mut large, mut refracting, mut inverted] = [const { Vec::<String>::new() }; 4];
    // Surfaces that were looked at, and whether they are open.
    let mut known: Vec<(Vec<usize>, bool)> = Vec::new();
    for group in groups {
        // The same shapes again are the same surface.
        let shapes: Vec<usize> = group.iter().map(|i| scene.objects[*i].shape).collect();
        let name = &scene.objects[group[0]].name;
        let objects = || group.iter().map(|i| &scene.objects[*i]);
        let bent = objects().find(|o| scene.materials.get(o.material).is_some_and(|m| m.model.refracts()));
        let bent = bent.map(|o| format!("`{}` on `{name}`", scene.materials[o.material].name));
        if let Some((_, is_open)) = known.iter().find(|(other, _)| *other == shapes) {
            refracting.extend(bent.filter(|_| *is_open));
            continue;
        }
        let size: usize = objects().map(|object| triangles_of(scene, object)).sum();
        if size > trial.pick(MOST_TRIANGLES[0], MOST_TRIANGLES[1]) {
            large.push(format!("`{name}`"));
            known.push((shapes, false));
            continue;
        }
        let surface = Surface::new(scene, &group);
        let edges = Edges::of(&surface.triangles);
        known.push((shapes, !edges.closed()));
        if !edges.closed() {
            open.push(format!("`{name}` ({} of {} edges)", edges.open + edges.twisted, edges.all));
            refracting.extend(bent);
            continue;
        }
        if surface.volume < 0.0 {
            inverted.push(format!("`{name}`"));
        }
        let verdict = surface.leaks(rays, trial.seed);
        if verdict.escaped > 0 {
            found.words.push(format!("`{name}`: {}", verdict.text()));
        }
        closed += 1;
        (total, escaped) = (total + verdict.rays, escaped + verdict.escaped);
    }
    found.checks.holds("no ray from inside of a closed mesh gets out", escaped == 0);
    found
        .words
        .push(format!("{} closed by topology: {total} rays from inside, {escaped} got out", count(closed, "surface")));
    for (list, text) in [
        (open, "are open, or their triangles disagree about the outside; not tested"),
        (inverted, "are closed but inside out: their fronts look inwards"),
        (refracting, "refract but are not closed: light that enters never leaves, and looks too bright from behind"),
        (large, "have too many triangles for this size; not tested"),
    ] {
        if !list.is_empty() {
            let more = if list.len() > NAMED { ", …" } else { "" };
            found.words.push(format!("{}{more}: {} {text}", list[..list.len().min(NAMED)].join(", "), list.len()));
        }
    }
}

fn triangles_of(scene: &desc::Scene, object: &Object) -> usize {
    match scene.shapes.get(object.shape) {
        Some(Shape::Mesh(mesh)) => mesh.indices.len(),
        _ => 0,
    }
}

/// Objects alone in space.
struct Surface {
    /// In the world, counter-clockwise.
    triangles: Vec<[Vec3; 3]>,
    /// Six times the volume; negative where the surface is inside out.
    volume: f64,
}

/// What became of rays from inside.
struct Verdict {
    rays: usize,
    escaped: usize,
    first: Option<String>,
}

impl Verdict {
    fn text(&self) -> String {
        match &self.first {
            None => format!("{} rays from inside, none got out", self.rays),
            Some(first) => format!("{} of {} rays from inside got out; the first {first}", self.escaped, self.rays),
        }
    }
}

impl Surface {
    fn new(scene: &desc::Scene, group: &[usize]) -> Self {
        let mut triangles = Vec::new();
        for object in group.iter().map(|i| &scene.objects[*i]) {
            let Some(Shape::Mesh(mesh)) = scene.shapes.get(object.shape) else { continue };
            let Some(transform) = Transform::from_mat4(object.to_world) else { continue };
            let flip = transform.mirrors() != object.reversed;
            for index in &mesh.indices {
                let Some([a, b, c]) = corners(&mesh.positions, *index) else { continue };
                let place = |p: Vec3| transform.to_world.transform_point3(p);
                triangles.push(if flip { [place(a), place(c), place(b)] } else { [place(a), place(b), place(c)] });
            }
        }
        let volume = signed_volume(&triangles);
        Self { triangles, volume }
    }

    /// Nothing but this.
    fn compile(&self) -> Option<Scene> {
        let positions: Vec<Vec3> = self.triangles.iter().flatten().copied().collect();
        let indices = (0..self.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let object = Object { closed: true, ..Object::new(0, 0) };
        let alone = desc::Scene {
            shapes: vec![Shape::Mesh(desc::Mesh { positions, indices, ..desc::Mesh::default() }.into())],
            objects: vec![object],
            materials: vec![desc::Material::new("", Model::Absorb)],
            ..desc::Scene::default()
        };
        Scene::compile(&alone).ok()
    }

    /// Traces rays that start just inside of the surface.
    fn leaks(&self, rays: usize, seed: u64) -> Verdict {
        /// Most misses whose origin is looked at: each costs all triangles.
        const MOST_MISSES: usize = 64;
        let mut verdict = Verdict { rays: 0, escaped: 0, first: None };
        let Some(scene) = self.compile() else { return verdict };
        let n = self.triangles.len();
        if n == 0 {
            return verdict;
        }
        let inwards = if self.volume < 0.0 { 1.0 } else { -1.0 };
        let mut misses = 0;
        for i in 0..rays {
            let mut u = Sampler::new(Kind::Independent, seed, [0, 0], i as u64, 1);
            let mut pick = |n: usize| ((u.next_1d() * n as f32) as usize).min(n - 1);
            let (index, aim) = (pick(n), pick(n));
            let triangle = self.triangles[index];
            let Some(ng) = triangle_normal(triangle).map(Vec3A::from) else { continue };
            let [_, b, c] = uniform_triangle(u.next_2d());
            let from = flat_surface(triangle.map(Vec3A::from), b, c, ng);
            let inner = ng * inwards;

            // Half of the rays aim at an edge or a vertex of some triangle, where that lies inwards.
            let [choice, share] = u.next_2d();
            let local = uniform_hemisphere(u.next_2d());
            let target = {
                let [a, b, c] = self.triangles[aim];
                let on_edge = if share < 0.5 { a } else { a.lerp(b, 0.5) };
                let on_edge = if share < 0.25 { c } else { on_edge };
                (Vec3A::from(on_edge) - from.p).normalize_or_zero()
            };
            let aimed = choice < 0.5 && target.dot(inner) > 1e-3;
            let d = if aimed { target } else { Frame::from_z(inner).to_world(local).normalize_or(inner) };
            let o = offset_origin(from.p, from.p_error, ng, d);
            verdict.rays += 1;
            if scene.geometry.nearest(&Ray::new(o, d), PrimitiveRef::NONE).is_some() || misses == MOST_MISSES {
                continue;
            }
            // Inside of thin walls and of overlapping parts the origin may have been outside.
            misses += 1;
            if winding(&self.triangles, o.into()) * f64::from(-inwards) > 0.5 {
                verdict.escaped += 1;
                let (o, d) = (o.to_array(), d.to_array());
                verdict.first.get_or_insert_with(|| format!("at {o:?} along {d:?}, from triangle {index}"));
            }
        }
        verdict
    }
}
