//! A ray prepared for slabs and triangles.

use crate::bvh::node::TriangleLeaf;
use crate::bvh::triangles::Slot;
use crate::math::Ray;
use glam::{DVec3, Vec3A};

/// Widening of a slab's far side: 1 + 2 γ₃ (Ize 2013, "Robust BVH Ray Traversal") and the rounding of its product with
/// 1/d, rounded up.
const FAR: f32 = 1.0 + 5e-7;

/// The other two axes for each third one and the sign of the direction along it: swapping them keeps the winding of
/// triangles.
const OTHERS: [[usize; 2]; 6] = [[1, 2], [2, 1], [2, 0], [0, 2], [0, 1], [1, 0]];

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
    pub(in crate::bvh) near: [usize; 3],
    /// Permutation of the axes: the third is the one along which the direction is longest (Woop et al. 2013).
    pub(in crate::bvh) axes: [usize; 3],
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
        let minus_d_inv = -Vec3A::from(ray.d).recip();
        let minus_d_inv_far = (minus_d_inv * FAR).to_array();
        let (d, minus_d_inv) = (ray.d.to_array(), minus_d_inv.to_array());
        // In integers and look-ups: branches on random directions would be guessed wrong. Sizes are ordered as their bits.
        let bits = d.map(f32::to_bits);
        let [x, y, z] = bits.map(|bits| bits & 0x7fff_ffff);
        let beyond_both = usize::from(z > x.max(y));
        let kz = beyond_both << 1 | (usize::from(y > x) & !beyond_both);
        let [kx, ky] = OTHERS[2 * kz + (bits[kz] >> 31) as usize];
        let d_inv = -minus_d_inv[kz];
        Self {
            o: ray.o.to_array(),
            d,
            minus_d_inv,
            minus_d_inv_far,
            near: std::array::from_fn(|axis| 2 * axis + (bits[axis] >> 31) as usize),
            axes: [kx, ky, kz],
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
