//! Memory layout of wide trees.

/// Lanes of a node and of a leaf.
pub(super) const WIDTH: usize = 8;

/// Bit of a child index that marks a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// Child of an empty lane; its box is empty too, so that no ray reaches it.
pub(super) const NONE: u32 = u32::MAX;

/// Most entries that a traversal's stack holds. Trees that could need more are rebuilt balanced.
pub(super) const STACK: usize = 256;

/// Eight boxes and what they hold.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// min x, max x, min y, max y, min z, max z of each lane's box.
    pub(super) planes: [[f32; WIDTH]; 6],
    /// Node index, or leaf index | [`LEAF`], or [`NONE`].
    pub(super) child: [u32; WIDTH],
}

impl Node {
    pub(super) const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        child: [NONE; WIDTH],
    };
}

/// Up to eight triangles; empty lanes are NaN, which no ray hits. Which triangles they are is kept elsewhere: a ray that
/// looks at a leaf asks that of one in a few.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct TriangleLeaf {
    /// Vertex, axis, lane.
    pub(super) v: [[[f32; WIDTH]; 3]; 3],
}

impl TriangleLeaf {
    pub(super) const EMPTY: Self = Self { v: [[[f32::NAN; WIDTH]; 3]; 3] };

    /// The vertices of one lane.
    #[inline]
    pub(super) fn triangle(&self, lane: usize) -> [[f32; 3]; 3] {
        let lane = lane % WIDTH;
        let vertex = |i: usize| [self.v[i][0][lane], self.v[i][1][lane], self.v[i][2][lane]];
        [vertex(0), vertex(1), vertex(2)]
    }
}
