//! Traversal kernels: one text ([`traverse`]), compiled for each instruction set. All give identical hits: they do
//! the same f32 operations in the same order, and none fuses a multiplication with an addition.
//!
//! `unsafe` is allowed here: it stands where a kernel is entered after its CPU features were detected, where
//! SIMD registers are loaded from arrays, in the stack that is not cleared, and where the system is asked for huge pages.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod lanes;
mod pages;
mod portable;
mod ray;
#[cfg(target_arch = "x86_64")]
mod register;
mod stack;
mod traverse;

pub(super) use pages::with_capacity;
pub(super) use ray::Slabs;
pub(super) use stack::{Entry, Stack};

use super::node::{Node, TriangleLeaf, WIDTH};
use super::obstacle::{LeafPassages, Obstacle, Passing};
use super::triangles::TriangleRef;
use crate::math::Ray;
use glam::Vec4;
use std::sync::OnceLock;

/// Instruction sets that a kernel exists for, the better the later.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Isa {
    /// Plain arrays that the compiler vectorises for the baseline of the target.
    Portable,
    /// 256-bit AVX2 (x86-64).
    Avx2,
    /// AVX-512 with 256-bit vectors (x86-64).
    Avx512,
}

impl Isa {
    /// All, and what each is called.
    pub const ALL: [(Self, &str); 3] = [(Self::Portable, "portable"), (Self::Avx2, "avx2"), (Self::Avx512, "avx512")];

    /// Name of the environment variable that chooses one.
    pub const VARIABLE: &str = "RADIANZA_ISA";

    /// The best that this CPU runs.
    pub fn detect() -> Self {
        static FOUND: OnceLock<Isa> = OnceLock::new();
        *FOUND.get_or_init(|| {
            #[cfg(target_arch = "x86_64")]
            if is_x86_feature_detected!("avx2") {
                let more = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl");
                return if more { Isa::Avx512 } else { Isa::Avx2 };
            }
            Isa::Portable
        })
    }

    /// The one that [`VARIABLE`](Self::VARIABLE) names, else the best.
    ///
    /// # Errors
    /// It names none, or one that this CPU does not run.
    pub fn chosen() -> Result<Self, String> {
        static CHOSEN: OnceLock<Result<Isa, String>> = OnceLock::new();
        let choose = || match std::env::var_os(Self::VARIABLE) {
            None => Ok(Self::detect()),
            Some(wanted) => match Self::ALL.into_iter().find(|(_, name)| wanted.as_os_str() == *name) {
                Some((isa, _)) if isa.is_available() => Ok(isa),
                Some((_, name)) => Err(format!("{} is {name}, which this CPU does not run", Self::VARIABLE)),
                None => {
                    let names = Self::ALL.map(|(_, name)| name).join(", ");
                    Err(format!("{} is {wanted:?}, which is none of {names}", Self::VARIABLE))
                }
            },
        };
        CHOSEN.get_or_init(choose).clone()
    }

    /// The [`chosen`](Self::chosen) one, or the best where it cannot be: tracing has nobody to report an error to.
    pub(super) fn in_use() -> Self {
        Self::chosen().unwrap_or_else(|_| Self::detect())
    }

    /// Whether this CPU runs it.
    pub fn is_available(self) -> bool {
        self <= Self::detect()
    }
}

/// A hit as kernels report it: the ray parameter, the barycentric coordinates of v1 and v2, the bits of the slot. One
/// register, written at once: what is written in parts and read as a whole has to wait.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found(Vec4);

impl Found {
    pub(super) const NOTHING: Self = Self(Vec4::ZERO);

    #[inline]
    fn new(t: f32, u: f32, v: f32, slot: TriangleRef) -> Self {
        Self(Vec4::new(t, u, v, f32::from_bits(slot.bits())))
    }

    /// t, u, v, and where.
    #[inline]
    pub(super) fn parts(self) -> ([f32; 3], TriangleRef) {
        let [t, u, v, slot] = self.0.to_array();
        ([t, u, v], TriangleRef::from_bits(slot.to_bits()))
    }
}

/// Nearest hit before the ray's end; `hit` is written where there is one.
#[inline]
pub(super) fn nearest(
    isa: Isa,
    nodes: &[Node],
    leaves: &[TriangleLeaf],
    ray: &Ray,
    excluded: TriangleRef,
    hit: &mut Found,
) -> bool {
    match isa {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: an `Isa` reaches a tree only through `Isa::in_use` or `is_available`, which saw the features.
        Isa::Avx2 => unsafe { avx2::nearest(nodes, leaves, ray, excluded, hit) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx512 => unsafe { avx512::nearest(nodes, leaves, ray, excluded, hit) },
        _ => portable::nearest(nodes, leaves, ray, excluded, hit),
    }
}

/// A ray that only asks what is in its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadowRay<'a> {
    pub(super) ray: &'a Ray,
    /// It does not meet the triangles at these slots.
    pub(super) excluded: [TriangleRef; 2],
    /// What it passes.
    pub(super) passing: Passing,
    /// What may be passed in each leaf; in those beyond nothing.
    pub(super) passages: &'a [LeafPassages],
}

/// What is hit before the ray's end.
#[inline]
pub(super) fn obstacle(isa: Isa, nodes: &[Node], leaves: &[TriangleLeaf], ray: &ShadowRay) -> Obstacle {
    match isa {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx2 => unsafe { avx2::obstacle(nodes, leaves, ray) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx512 => unsafe { avx512::obstacle(nodes, leaves, ray) },
        _ => portable::obstacle(nodes, leaves, ray),
    }
}

/// Lanes of a node whose box the ray may meet before `t_max`, a bit each, and where it enters them.
#[inline]
pub(super) fn enter(isa: Isa, node: &Node, slabs: &Slabs, t_max: f32) -> (u32, [f32; WIDTH]) {
    match isa {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx2 => unsafe { avx2::enter(node, slabs, t_max) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx512 => unsafe { avx512::enter(node, slabs, t_max) },
        _ => portable::enter(node, slabs, t_max),
    }
}
