//! Smooth functions of two variables, four at a time or more: a grid of nodes with cubic interpolation.

use rayon::prelude::*;
use std::ops::{Add, Mul};

/// What can be interpolated: a vector.
pub(in crate::bsdf) trait Value:
    Copy + Default + Send + Add<Output = Self> + Mul<f32, Output = Self>
{
}
impl<T: Copy + Default + Send + Add<Output = T> + Mul<f32, Output = T>> Value for T {}

/// Values at nodes that are equidistant in both variables.
#[derive(Debug)]
pub(in crate::bsdf) struct Grid<T> {
    nx: usize,
    ny: usize,
    nodes: Vec<T>,
}

/// Four neighbouring nodes of one variable and the weights of the cubic through them.
#[derive(Clone, Copy, Debug)]
pub(in crate::bsdf) struct Stencil {
    first: u32,
    weights: [f32; 4],
}

impl Stencil {
    /// For `t` in \[0, 1\] among `n` nodes; the outermost cubics also serve the outermost intervals.
    #[inline]
    pub(in crate::bsdf) fn new(t: f32, n: usize) -> Self {
        let t = t.clamp(0.0, 1.0) * (n - 1) as f32;
        let first = ((t as usize).max(1) - 1).min(n - 4);
        let x = t - first as f32;
        let (a, b, c, d) = (x, x - 1.0, x - 2.0, x - 3.0);
        let weights = [b * c * d / -6.0, a * c * d * 0.5, a * b * d * -0.5, a * b * c / 6.0];
        Self { first: first as u32, weights }
    }

    /// The first of the four nodes.
    #[inline]
    pub(in crate::bsdf) fn first(&self) -> usize {
        self.first as usize
    }

    /// Weight of the `i`-th of them.
    #[inline]
    pub(in crate::bsdf) fn weight(&self, i: usize) -> f32 {
        self.weights[i]
    }

    /// Weights that stay as they are, among nodes that begin `by` later.
    #[inline]
    pub(in crate::bsdf) fn shifted(self, by: usize) -> Self {
        Self { first: self.first + by as u32, ..self }
    }

    /// The cubic through four of the `values`.
    #[inline]
    pub(in crate::bsdf) fn over<T: Value>(&self, values: &[T]) -> T {
        (0..4).fold(T::default(), |sum, i| sum + values[self.first as usize + i] * self.weights[i])
    }
}

impl<T: Value> Grid<T> {
    /// Evaluates `f` at the `nx` × `ny` nodes, given as integers, on all cores.
    pub(in crate::bsdf) fn tabulate(nx: usize, ny: usize, f: impl Fn(usize, usize) -> T + Sync) -> Self {
        let nodes = (0..nx * ny).into_par_iter().map(|i| f(i % nx, i / nx)).collect();
        Self { nx, ny, nodes }
    }

    /// Evaluates `f` at the `nx` × `ny` nodes on the thread that asks: what is made under a lock must not wait for others.
    pub(in crate::bsdf) fn tabulate_here(nx: usize, ny: usize, f: impl Fn(usize, usize) -> T) -> Self {
        let nodes = (0..nx * ny).map(|i| f(i % nx, i / nx)).collect();
        Self { nx, ny, nodes }
    }

    /// The cubics along the second variable at `by` times as many nodes, between which lines follow them closely.
    pub(super) fn refined(&self, by: usize) -> Self {
        let ny = (self.ny - 1) * by + 1;
        let node = |i: usize| {
            let stencil = Stencil::new((i / self.nx) as f32 / (ny - 1) as f32, self.ny);
            (0..4).fold(T::default(), |sum, j| {
                sum + self.nodes[(stencil.first() + j) * self.nx + i % self.nx] * stencil.weight(j)
            })
        };
        Self { nx: self.nx, ny, nodes: (0..self.nx * ny).map(node).collect() }
    }

    /// Value at `x` by the cubic and at `y` by the line between two nodes, both in \[0, 1\].
    #[inline]
    pub(super) fn between(&self, x: f32, y: f32) -> T {
        let (x, y) = (Stencil::new(x, self.nx), y.clamp(0.0, 1.0) * (self.ny - 1) as f32);
        let j = (y as usize).min(self.ny - 2);
        let (up, down) = (y - j as f32, 1.0 - (y - j as f32));
        let first = j * self.nx + x.first();
        let (a, b) = (&self.nodes[first..][..4], &self.nodes[first + self.nx..][..4]);
        let node = |k: usize| (a[k] * down + b[k] * up) * x.weights[k];
        node(0) + node(1) + (node(2) + node(3))
    }

    /// Value at `x` in \[0, 1\] and the stencil `y` of the other variable.
    #[inline]
    pub(in crate::bsdf) fn at(&self, x: f32, y: Stencil) -> T {
        self.with(Stencil::new(x, self.nx), y)
    }

    /// Value at the stencils of both variables.
    #[inline]
    pub(in crate::bsdf) fn with(&self, x: Stencil, y: Stencil) -> T {
        let mut sum = T::default();
        for j in 0..4 {
            let row = &self.nodes[(y.first as usize + j) * self.nx + x.first as usize..][..4];
            let value = row[0] * x.weights[0] + row[1] * x.weights[1] + row[2] * x.weights[2] + row[3] * x.weights[3];
            sum = sum + value * y.weights[j];
        }
        sum
    }
}
