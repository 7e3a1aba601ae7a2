//! What the tests of a ray share.

use crate::bvh::node::TriangleLeaf;
use crate::bvh::triangles::TriangleRef;
use crate::math::Ray;
use glam::{Vec3, Vec3A, Vec3Swizzles};

/// Widening of a slab's far side: 1 + 2 γ₃ (Ize 2013, "Robust BVH Ray Traversal") and the rounding of its product with
/// 1/d, rounded up.
const FAR: f32 = 1.0 + 5e-7;

/// Index in `Node::planes` of the near plane of each axis, for each set of axes along which the direction is negative.
static NEAR: [[u32; 4]; 8] = {
    let mut near = [[0; 4]; 8];
    let mut i = 0;
    while i < 8 {
        near[i] = [i as u32 & 1, 2 + (i as u32 >> 1 & 1), 4 + (i as u32 >> 2 & 1), 0];
        i += 1;
    }
    near
};

/// Permutation of the axes, for each set of axes along which the direction is longest and, in the three bits below, each
/// along which it is negative. The first two are swapped where the third is negative, which keeps the winding of triangles.
static AXES: [[u32; 4]; 64] = {
    let mut axes = [[0; 4]; 64];
    let mut i = 0;
    while i < 64 {
        let z = if i & 0b100_000 != 0 || i & 0b011_000 == 0 {
            2
        } else if i & 0b010_000 != 0 {
            1
        } else {
            0
        };
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        axes[i] = if i >> z & 1 == 0 { [x, y, z, 0] } else { [y, x, z, 0] };
        i += 1;
    }
    axes
};

/// What all box tests of a ray share.
///
/// This and [`Shear`] are made where they are used, in the kernels: in registers. What is written to memory in parts and
/// read as a whole, or the other way round, costs a ray more than to make it twice.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Slabs {
    pub(super) o: Vec3A,
    /// −1/d.
    pub(super) minus_d_inv: Vec3A,
    /// −1/d times [`FAR`].
    pub(super) minus_d_inv_far: Vec3A,
    /// Index of the near plane of each axis in `Node::planes`; the far one is `near ^ 1`.
    pub(super) near: [u32; 4],
}

impl Slabs {
    #[inline(always)]
    pub(in crate::bvh) fn new(ray: &Ray) -> Self {
        let minus_d_inv = -ray.d.recip();
        let near = NEAR[ray.d.is_negative_bitmask() as usize];
        Self { o: ray.o, minus_d_inv, minus_d_inv_far: minus_d_inv * FAR, near }
    }
}

/// What all triangle tests of a ray share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    /// Permutation of the axes: the third is the one along which the direction is longest (Woop et al. 2013).
    pub(super) axes: [usize; 3],
    /// Shear that maps the direction to the third axis, and the factor of negated coordinates along that axis.
    pub(super) shear: [f32; 3],
    /// The triangle that the ray leaves.
    pub(super) excluded: Excluded,
}

/// A triangle that a ray does not meet: the leaf that holds it, and the lanes of the others there, a bit each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Excluded {
    pub(super) leaf: u32,
    pub(super) others: u32,
}

impl Excluded {
    #[inline(always)]
    pub(super) fn new(slot: TriangleRef) -> Self {
        let (leaf, lane) = slot.place();
        Self { leaf: leaf as u32, others: !(1 << lane) }
    }

    /// Lanes of a leaf that the ray may meet.
    #[inline(always)]
    pub(super) fn of(self, leaf: u32) -> u32 {
        if leaf == self.leaf { self.others } else { !0 }
    }
}

impl Shear {
    /// Of a ray that does not meet this triangle.
    #[inline(always)]
    pub(super) fn new(ray: &Ray, excluded: TriangleRef) -> Self {
        // By look-ups: branches on random directions would be guessed wrong.
        let (size, negative) = (ray.d.abs(), ray.d.is_negative_bitmask() as usize);
        let longest = size.cmpeq(size.zxy().max(size).max(size.yzx())).bitmask() as usize;
        let axes = AXES[longest * 8 + negative];
        let [kx, ky, kz] = [0, 1, 2].map(|i| axes[i].min(2) as usize);
        let d: &[f32; 3] = ray.d.as_ref();
        let d_inv = 1.0 / d[kz];
        Self { axes: [kx, ky, kz], shear: [d[kx] * d_inv, d[ky] * d_inv, -d_inv], excluded: Excluded::new(excluded) }
    }
}

/// t = n·(a − o)/(n·d) of the plane of a lane's triangle, n = (b − a) × (c − a), in f64, if it is positive.
#[inline]
pub(super) fn plane_ahead(ray: &Ray, leaf: &TriangleLeaf, lane: usize) -> Option<f64> {
    let [a, b, c] = leaf.triangle(lane).map(|v| Vec3::from(v).as_dvec3());
    let n = (b - a).cross(c - a);
    let (height, slope) = (n.dot(a - ray.o.as_dvec3()), n.dot(ray.d.as_dvec3()));
    (height * slope > 0.0).then(|| height / slope)
}
