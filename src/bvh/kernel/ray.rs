//! A ray prepared for slabs and triangles.

use crate::bvh::node::TriangleLeaf;
use crate::bvh::triangles::Slot;
use crate::math::Ray;
use glam::{DVec3, Vec3Swizzles};

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

/// A ray with what every box and triangle test of it shares.
#[derive(Clone, Copy, Debug)]
pub struct PreparedRay {
    pub(in crate::bvh) o: [f32; 3],
    pub(in crate::bvh) d: [f32; 3],
    /// −1/d.
    pub(in crate::bvh) minus_d_inv: [f32; 3],
    /// The same, [`FAR`] times.
    pub(in crate::bvh) minus_d_inv_far: [f32; 3],
    /// Index of the near plane of each axis in `Node::planes`; the far one is `near ^ 1`.
    pub(in crate::bvh) near: [u32; 4],
    /// Permutation of the axes: the third is the one along which the direction is longest (Woop et al. 2013).
    pub(in crate::bvh) axes: [u32; 4],
    /// Shear that maps the direction to the third axis, and the factor of negated coordinates along that axis.
    pub(in crate::bvh) shear: [f32; 3],
    pub(in crate::bvh) t_max: f32,
    /// Leaf that holds the triangle which the ray leaves, and the bit of its lane.
    pub(in crate::bvh) own_leaf: u32,
    pub(in crate::bvh) own_lane: u32,
}

impl PreparedRay {
    /// Of a ray that leaves the triangle at `leaving` of the tree that it is traced in first.
    #[inline(always)]
    pub fn new(ray: &Ray, leaving: Slot) -> Self {
        let (own_leaf, own_lane) = leaving.place();
        let minus_d_inv = -ray.d.recip();
        // By look-ups: branches on random directions would be guessed wrong.
        let (size, negative) = (ray.d.abs(), ray.d.is_negative_bitmask() as usize);
        let longest = size.cmpeq(size.zxy().max(size).max(size.yzx())).bitmask() as usize;
        let axes = AXES[longest * 8 + negative];
        let [kx, ky, kz] = [0, 1, 2].map(|i| axes[i].min(2) as usize);
        let (d, minus_d_inv_far, minus_d_inv) =
            (ray.d.to_array(), (minus_d_inv * FAR).to_array(), minus_d_inv.to_array());
        let d_inv = -minus_d_inv[kz];
        Self {
            o: ray.o.to_array(),
            d,
            minus_d_inv,
            minus_d_inv_far,
            near: NEAR[negative],
            axes,
            shear: [d[kx] * d_inv, d[ky] * d_inv, -d_inv],
            t_max: ray.t_max,
            own_leaf: own_leaf as u32,
            own_lane: 1 << own_lane,
        }
    }

    /// t = n·(a − o)/(n·d) of the plane of a lane's triangle, n = (b − a) × (c − a), in f64, if it is positive.
    #[inline]
    pub(in crate::bvh) fn plane_ahead(&self, leaf: &TriangleLeaf, lane: usize) -> Option<f64> {
        let double = |v: [f32; 3]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
        let [a, b, c] = leaf.triangle(lane).map(double);
        let n = (b - a).cross(c - a);
        let (height, slope) = (n.dot(a - double(self.o)), n.dot(double(self.d)));
        (height * slope > 0.0).then(|| height / slope)
    }
}
