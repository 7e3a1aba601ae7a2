//! Traversal kernels: one text ([`traverse`]), compiled for each instruction set. All give identical hits: they do
//! the same f32 operations in the same order, and none fuses a multiplication with an addition.
//!
//! `unsafe` is allowed here: it stands where a kernel is entered after its CPU features were detected, where
//! SIMD registers are loaded from arrays, and in the stack that is not cleared.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod avx2;
mod lanes;
mod portable;
mod ray;
mod stack;
mod traverse;

pub(super) use ray::KernelRay;
pub(super) use stack::Stack;

use super::node::{Node, TriangleLeaf, WIDTH};
use super::triangles::TriangleHit;
use std::sync::OnceLock;

/// Instruction sets that a kernel exists for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Isa {
    /// Plain arrays that the compiler vectorises for the baseline of the target.
    Portable,
    /// 256-bit AVX2 (x86-64).
    Avx2,
}

impl Isa {
    /// The best that this CPU runs.
    pub fn detect() -> Self {
        static FOUND: OnceLock<Isa> = OnceLock::new();
        *FOUND.get_or_init(|| {
            #[cfg(target_arch = "x86_64")]
            if is_x86_feature_detected!("avx2") {
                return Isa::Avx2;
            }
            Isa::Portable
        })
    }

    /// Whether this CPU runs it.
    pub fn is_available(self) -> bool {
        self == Isa::Portable || self == Isa::detect()
    }
}

/// Nearest hit before `ray.t_max`; `hit` is written where there is one.
#[inline]
pub(super) fn nearest(
    isa: Isa,
    nodes: &[Node],
    leaves: &[TriangleLeaf],
    ray: &KernelRay,
    hit: &mut TriangleHit,
) -> bool {
    match isa {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Isa::Avx2` reaches a tree only through `Isa::detect` or `is_available`, which saw the feature.
        Isa::Avx2 => unsafe { avx2::nearest(nodes, leaves, ray, hit) },
        _ => portable::nearest(nodes, leaves, ray, hit),
    }
}

/// Whether anything is hit before `ray.t_max`.
#[inline]
pub(super) fn occluded(isa: Isa, nodes: &[Node], leaves: &[TriangleLeaf], ray: &KernelRay) -> bool {
    match isa {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx2 => unsafe { avx2::occluded(nodes, leaves, ray) },
        _ => portable::occluded(nodes, leaves, ray),
    }
}

/// Lanes of a node whose box the ray may meet before `t_max`, a bit each, and where it enters them.
#[inline]
pub(super) fn enter(isa: Isa, node: &Node, ray: &KernelRay, t_max: f32) -> (u32, [f32; WIDTH]) {
    match isa {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx2 => unsafe { avx2::enter(node, ray, t_max) },
        _ => portable::enter(node, ray, t_max),
    }
}
