//! N1: BSDFs about shading normals that are bent away from the geometric one.

use crate::bsdf::{Pdf, Scratch};
use crate::desc::{self, ColorParam, Fresnel, Layers, MetallicRoughness, Model, Roughness, ScalarParam};
use crate::material::Material;
use crate::sampler::{Kind, Sampler, hash};
use crate::scene::{DirectionSample, Shading, Vertex};
use crate::shape::Surface;
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use crate::verify::scattering::{Claims, Density, Draw, Rgb, Scattering, check};
use crate::verify::{Findings, Task, Topic, Trial};
use crate::warp::uniform_sphere;
use glam::{DVec3, Vec3A};

const TOPIC: Topic = Topic {
    id: "N1",
    title: "about bent normals: lossless, drawn by its density, fades to 0 at the horizon, its adjoint is itself from the other end",
    source: "conservation of energy; Veach 1997, section 5.3",
};

/// Angles between the normals \[°\].
const BENDS: [f32; 3] = [8.0, 35.0, 75.0];

/// A material that loses nothing.
struct Subject {
    name: &'static str,
    material: Material,
    /// Of what is behind the surface; 1 where nothing refracts.
    eta: f64,
    transmits: bool,
}

fn subjects() -> Vec<Subject> {
    let white = ColorParam::constant([1.0; 3]);
    let gltf = MetallicRoughness {
        base_color: white,
        metallic: ScalarParam::constant(0.2),
        roughness: ScalarParam::constant(0.5),
        ior: 1.5,
        specular: ScalarParam::constant(1.0),
        specular_color: white,
        transmission: None,
        layers: Layers::default(),
        diffuse_transmission: None,
        iridescence: None,
    };
    let glass = |alpha: f32| Model::Dielectric {
        ior: 1.5,
        roughness: if alpha > 0.0 {
            Roughness::Alpha([alpha; 2])
        } else {
            Roughness::Perceptual(ScalarParam::constant(0.0))
        },
        tint: white,
    };
    let metal = Model::Conductor { fresnel: Fresnel::Schlick { f0: white }, roughness: Roughness::Alpha([0.3, 0.2]) };
    [
        ("diffuse", Model::Diffuse { reflectance: white }, 1.0, false),
        ("metal", metal, 1.0, false),
        ("mirror", Model::Mirror { reflectance: white }, 1.0, false),
        ("glTF", Model::MetallicRoughness(Box::new(gltf)), 1.0, false),
        ("glass", glass(0.0), 1.5, true),
        ("rough glass", glass(0.4), 1.5, true),
    ]
    .map(|(name, model, eta, transmits)| {
        let material = Material::compile(&desc::Material::new(name, model));
        Subject { name, material, eta, transmits }
    })
    .into()
}

pub(super) fn tasks() -> Vec<Task> {
    let names: Vec<_> = ["diffuse", "metal", "mirror", "glTF", "glass", "rough glass"].into();
    names
        .into_iter()
        .flat_map(|name| {
            // Diffuse and rough glass scatter to where all terms of f′ show; of the others one bend has to do.
            let all = matches!(name, "diffuse" | "rough glass");
            BENDS.into_iter().filter(move |bend| all || *bend == BENDS[1]).map(move |bend| (name, bend))
        })
        .map(|(name, bend)| {
            Task::new(TOPIC, format!("{name}, by {bend}°"), move |trial, found| {
                // Made here: a list of tasks asks for no tables.
                let Some(subject) = subjects().into_iter().find(|subject| subject.name == name) else { return };
                let mut u = Sampler::new(Kind::Independent, trial.seed, [0, 0], 0, 1);
                let bent = Bent { subject: &subject, bend, turn: u.next_1d() };
                judge(&bent, trial, found);
            })
        })
        .collect()
}

fn judge(bent: &Bent, trial: &Trial, found: &mut Findings) {
    let (lossless, two_sided) = (true, bent.subject.transmits);
    let claims = Claims { lossless, reciprocal: false, two_sided, granted: 1e-3, rounding: 2e-3 };
    check(found, trial, bent.subject.name, bent, &claims);
    let (mut worst, mut horizon) = ([0f64; 2], 0f64);
    for i in 0..trial.work(20_000, 200_000) {
        let mut u = Sampler::new(Kind::Independent, trial.seed, [1, 0], i, 1);
        let (o, i) = (uniform_sphere(u.next_2d()), uniform_sphere(u.next_2d()));
        // f'(o, i), as each end sees it.
        let here = bent.at(o.into(), |shading| shading.eval(i.into()));
        let there = bent.at(i.into(), |shading| shading.eval_adjoint(o.into()));
        let pairs =
            [(here.f_cos.max_element() / i.z.abs(), there.f_cos.max_element() / o.z.abs()), (here.pdf, there.pdf)];
        for (worst, (here, there)) in worst.iter_mut().zip(pairs) {
            if here.max(there) > 1e-6 {
                *worst = worst.max(f64::from((here - there).abs() / here.max(there)));
            }
        }
        // Towards the horizon, in proportion to the cosine for a lobe that is no peak.
        if bent.subject.name == "diffuse" {
            let low = glam::Vec3::new(i.x, i.y, 1e-3 * i.z).normalize();
            let f = bent.at(o.into(), |shading| shading.eval(low.into()).f_cos);
            horizon = horizon.max(f64::from(f.max_element() / low.z.abs()) * std::f64::consts::PI);
        }
    }
    found.checks.bound("f′(o, i) by radiance at o = by importance at i", worst[0], 1e-3);
    found.checks.bound("density from o to i = that of the reverse at i", worst[1], 1e-2);
    // At most c from light that leaves as it is, and 1 from what leaks.
    found.checks.holds("f′(o, i) |i·g| goes to 0 at the horizon as 3 |i·g|/π or less", horizon <= 3.001);
}

/// A material about a normal that is bent by `bend` degrees, at one angle of leaked light; the geometric normal is z.
struct Bent<'a> {
    subject: &'a Subject,
    bend: f32,
    turn: f32,
}

impl Bent<'_> {
    /// What `ask` finds at a vertex that is seen along `wo`.
    fn at<T>(&self, wo: Vec3A, ask: impl FnOnce(&mut Shading) -> T) -> T {
        let (sin, cos) = self.bend.to_radians().sin_cos();
        let ns = Vec3A::new(0.28 * sin, -0.96 * sin, cos);
        let surface = Surface { ns, tangent: Vec3A::X, ..Surface::NOWHERE };
        let vertex = Vertex { surface, wo, front: wo.z > 0.0, ..Vertex::NOWHERE };
        let (textures, mut scratch) = (Textures::default(), Scratch::new());
        let mut shading = Shading::new(&self.subject.material, &vertex, &textures, &mut scratch);
        shading.leak = [self.turn, 0.5];
        ask(&mut shading)
    }

    /// η² of the way from `wo` to `wi`: radiance is divided by it, energy is not.
    fn eta(&self, wo: DVec3, wi: DVec3) -> f64 {
        match (wo.z > 0.0, wi.z > 0.0) {
            (true, false) => self.subject.eta,
            (false, true) => 1.0 / self.subject.eta,
            _ => 1.0,
        }
    }
}

fn rgb(s: Spectrum, k: f64) -> Rgb {
    s.to_rgb().map(|x| f64::from(x) * k)
}

impl Scattering for Bent<'_> {
    fn sample(&self, wo: DVec3, u: [f32; 3]) -> Option<Draw> {
        let draw = self.at(wo.as_vec3a(), |shading| {
            // A fourth number, independent of the three.
            let bits = hash(&u.map(|u| u64::from(u.to_bits())));
            shading.leak[1] = (bits >> 40) as f32 / (1 << 24) as f32;
            shading.sample(u[0], [u[1], u[2]])
        });
        let DirectionSample { wi, weight, pdf, .. } = draw?;
        let wi = wi.as_dvec3().normalize();
        let eta = self.eta(wo, wi);
        let density = match pdf {
            Pdf::SolidAngle(pdf) => Density::SolidAngle(pdf.into()),
            Pdf::Discrete(p) => Density::Discrete(p.into()),
        };
        Some(Draw { wi, weight: rgb(weight, eta * eta), density, eta })
    }

    fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb {
        self.both(wo, wi).0
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.both(wo, wi).1
    }

    fn both(&self, wo: DVec3, wi: DVec3) -> (Rgb, f64) {
        let eval = self.at(wo.as_vec3a(), |shading| shading.eval(wi.as_vec3a()));
        let eta = self.eta(wo, wi);
        (rgb(eval.f_cos, eta * eta / wi.z.abs()), eval.pdf.into())
    }
}
