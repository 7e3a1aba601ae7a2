//! Interiors of a scene's materials, and which of them a point is in.

use super::{PrimitiveRef, Scene, Vertex};
use crate::desc;
use crate::material;
use crate::math::{Ray, offset_origin};
use crate::medium::{Crossing, Interior, MOST_NESTED, MediumStack};
use crate::spectrum::Spectrum;
use arrayvec::ArrayVec;
use glam::Vec3A;
use std::sync::atomic::{AtomicU64, Ordering};

/// Of a material whose surfaces enclose nothing.
const NONE: u32 = u32::MAX;

/// What the materials enclose.
#[derive(Debug, Default)]
pub struct Media {
    interiors: Vec<Interior>,
    /// Times that a path entered more interiors than it can remember.
    forgotten: AtomicU64,
    /// Interior of every material. Materials with equal interiors share one, so that a body may wear several.
    of_material: Vec<u32>,
}

/// The media on both sides of a surface, as a path meets it.
#[derive(Clone, Debug, Default)]
pub struct MediumInterface {
    /// Interior before the front of the surface.
    before: Option<u32>,
    /// Interior behind it.
    behind: Option<u32>,
    /// The media on the far side from the path, where they are not those that the path is in.
    pub across: Option<MediumStack>,
}

impl MediumInterface {
    /// Vacuum on both sides.
    pub const VACUUM: Self = Self { before: None, behind: None, across: None };

    /// The media that the world direction `wi` leads into from `vertex`, where it crosses into others.
    #[inline]
    pub fn crossed(&self, vertex: &Vertex, wi: Vec3A) -> Option<&MediumStack> {
        self.across.as_ref().filter(|_| (wi.dot(vertex.surface.ng) > 0.0) != vertex.front)
    }
}

impl Media {
    pub(super) fn new(materials: &[desc::Material]) -> Self {
        let mut media = Self::default();
        let mut known = std::collections::HashMap::new();
        for m in materials {
            media.of_material.push(material::interior(m).map_or(NONE, |interior| {
                let key = (
                    interior.index.to_array().map(f32::to_bits),
                    interior.medium.absorption.0.to_array().map(f32::to_bits),
                    interior.priority,
                );
                *known.entry(key).or_insert_with(|| {
                    media.interiors.push(interior);
                    (media.interiors.len() - 1) as u32
                })
            }));
        }
        media
    }

    /// The interior that a material's surfaces enclose.
    #[inline]
    fn of(&self, material: u32) -> Option<u32> {
        let id = self.of_material[material as usize];
        (id != NONE).then_some(id)
    }

    /// Crosses the surface of an interior, where the vertex lies on one, from the media of `stack`.
    #[inline]
    fn cross(&self, stack: &MediumStack, vertex: &Vertex) -> Option<Crossing> {
        if self.interiors.is_empty() {
            return None;
        }
        let id = self.of(vertex.material)?;
        if vertex.front && stack.is_full() {
            self.forgotten.fetch_add(1, Ordering::Relaxed);
        }
        Some(stack.cross(id, vertex.front, &self.interiors))
    }

    /// The media behind a vertex that is hidden in something of higher priority; `None` where it is not. What emits is never hidden,
    /// or its light would be lost to some and not to others who sample it.
    #[inline]
    pub(super) fn hidden(&self, stack: &MediumStack, vertex: &Vertex) -> Option<MediumStack> {
        if stack.is_empty() || vertex.light.is_some() {
            return None;
        }
        self.cross(stack, vertex).filter(|crossing| !crossing.is_true).map(|crossing| crossing.across)
    }

    /// The media on both sides of the vertex for a path in those of `stack`.
    #[inline]
    pub fn interface(&self, stack: &MediumStack, vertex: &Vertex) -> MediumInterface {
        match self.cross(stack, vertex) {
            None => MediumInterface::default(),
            Some(Crossing { before, across, .. }) => {
                MediumInterface { before, behind: self.of(vertex.material), across: Some(across) }
            }
        }
    }

    /// What passes the interface has another η in every lane, and must choose one.
    #[inline]
    pub fn disperses(&self, interface: &MediumInterface) -> bool {
        let one = |id: Option<u32>| id.is_some_and(|id| self.interiors[id as usize].disperses());
        interface.behind.is_some() && (one(interface.behind) || one(interface.before))
    }

    /// Index behind over index before the surface in a lane; `None` where that is the material's own over vacuum.
    #[inline]
    pub fn eta(&self, interface: &MediumInterface, lane: Option<usize>) -> Option<f32> {
        let behind = &self.interiors[interface.behind? as usize];
        let before = interface.before.map(|id| &self.interiors[id as usize]);
        match (before, lane) {
            (None, None) => None,
            _ => {
                // Without a lane all are alike.
                let lane = lane.unwrap_or(1);
                Some(behind.index[lane] / before.map_or(1.0, |i| i.index[lane]))
            }
        }
    }

    /// Share of light that is left after `distance` \[m\] in what is there.
    #[inline]
    pub fn transmittance(&self, stack: &MediumStack, distance: f32) -> Spectrum {
        stack.current().map_or(Spectrum::ONE, |id| self.interiors[id as usize].medium.transmittance(distance))
    }
}

/// The media about a point, from which those about other points nearby are found.
#[derive(Clone, Debug)]
pub struct MediaAbout {
    p: Vec3A,
    media: MediumStack,
}

impl Scene {
    /// Times that a path entered an interior within [`MOST_NESTED`] others, and forgot it: there the image is wrong.
    pub fn forgotten_interiors(&self) -> u64 {
        self.media.forgotten.load(Ordering::Relaxed)
    }

    /// The media about the point `p` and whatever is near it, such as a camera's lens or window.
    pub fn media_near(&self, p: Vec3A) -> MediaAbout {
        MediaAbout { p, media: self.media_about(p) }
    }

    /// The media about the point `p`: those of the place `near` it, changed by what a straight way from there to `p` enters
    /// and leaves.
    #[inline]
    pub fn media_at(&self, near: &MediaAbout, p: Vec3A) -> MediumStack {
        if self.media.interiors.is_empty() || p == near.p { near.media.clone() } else { self.media_across(near, p) }
    }

    #[inline(never)]
    fn media_across(&self, near: &MediaAbout, p: Vec3A) -> MediumStack {
        let (mut media, mut excluded) = (near.media.clone(), PrimitiveRef::NONE);
        let mut ray = Ray { o: near.p, d: p - near.p, t_max: 1.0 };
        while let Some(hit) = self.geometry.nearest(&ray, excluded) {
            let vertex = self.vertex(&ray, &hit);
            if self.coverage(&vertex) >= 0.5
                && let Some(crossing) = self.media.cross(&media, &vertex)
            {
                media = crossing.across;
            }
            (ray, excluded) = (self.beyond(&ray, &vertex), vertex.primitive);
            if ray.t_max <= 0.0 {
                break;
            }
        }
        media
    }

    /// The interiors about a point: those whose surfaces are left more often than entered on the way to infinity, on
    /// every one of several ways, so that open surfaces enclose nothing.
    fn media_about(&self, p: Vec3A) -> MediumStack {
        /// Far from the axes and from each other.
        const WAYS: [Vec3A; 7] = [
            Vec3A::new(0.31, 0.86, 0.41),
            Vec3A::new(-0.53, 0.27, 0.80),
            Vec3A::new(0.73, -0.19, -0.66),
            Vec3A::new(-0.21, -0.92, 0.33),
            Vec3A::new(-0.68, 0.44, -0.59),
            Vec3A::new(0.39, 0.58, -0.71),
            Vec3A::new(0.58, -0.62, 0.53),
        ];
        let mut stack = MediumStack::default();
        if self.media.interiors.is_empty() {
            return stack;
        }
        let mut left = self.left(p, WAYS[0]);
        for way in &WAYS[1..] {
            let others = self.left(p, *way);
            left.retain(|id| others.contains(id));
        }
        // What is left last was entered first.
        for id in left.into_iter().rev() {
            stack = stack.entered(id, &self.media.interiors);
        }
        stack
    }

    /// The interiors that a ray leaves without having entered them, in order.
    fn left(&self, p: Vec3A, way: Vec3A) -> ArrayVec<u32, MOST_NESTED> {
        let (mut ray, mut excluded) = (Ray::new(p, way.normalize()), PrimitiveRef::NONE);
        let (mut left, mut entered) = (ArrayVec::new(), vec![0u32; self.media.interiors.len()]);
        while let Some(hit) = self.geometry.nearest(&ray, excluded) {
            let vertex = self.vertex(&ray, &hit);
            if let Some(id) = self.media.of(vertex.material)
                && self.coverage(&vertex) >= 0.5
            {
                let depth = &mut entered[id as usize];
                if vertex.front {
                    *depth += 1;
                } else if *depth > 0 {
                    *depth -= 1;
                } else if left.try_push(id).is_err() {
                    break;
                }
            }
            let s = &vertex.surface;
            (ray, excluded) = (Ray::new(offset_origin(s.p, s.p_error, s.ng, ray.d), ray.d), vertex.primitive);
        }
        left
    }
}
