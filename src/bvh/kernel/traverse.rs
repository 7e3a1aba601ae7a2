//! The one text of the kernels, for a type `Lanes` of eight f32 and the attributes of its instruction set.

/// `nearest` and `obstacle` for the `Lanes` in scope.
macro_rules! kernels {
    ($(#[$isa:meta])?) => {
        use super::ray::{Excluded, Shear, Slabs, plane_ahead};
        use super::{Entry, Found, Obstacle, ShadowRay, Stack};
        use crate::bvh::node::{LEAF, Node, TriangleLeaf, WIDTH};
        use crate::bvh::triangles::TriangleRef;
        use crate::math::Ray;

        /// γ₂, γ₃ and γ₅ (`math::gamma`).
        const G2: Factor = Factor(crate::math::gamma(2));
        const G3: Factor = Factor(crate::math::gamma(3));
        const G5: Factor = Factor(crate::math::gamma(5));

        /// A constant of all lanes.
        struct Factor(f32);

        impl Factor {
            #[inline]
            $(#[$isa])?
            fn times(&self, x: Lanes) -> Lanes {
                Lanes::splat(self.0).mul(x)
            }
        }

        /// Lanes whose box the ray meets before `t_max`, and where it enters them.
        #[inline]
        $(#[$isa])?
        fn boxes(node: &Node, slabs: &Slabs, t_max: f32) -> (u32, Lanes) {
            // (o − plane) · (−1/d): subtracted from a register, planes need no load of their own.
            let [o, d_inv, d_inv_far] = [slabs.o, slabs.minus_d_inv, slabs.minus_d_inv_far].map(|v| v.to_array());
            let slab = |axis: usize, plane: usize, d_inv: [f32; 3]| {
                Lanes::splat(o[axis]).sub(Lanes::load(&node.planes[plane & 7])).mul(Lanes::splat(d_inv[axis]))
            };
            // 0 · ∞ (a ray inside the plane of a slab) is NaN: min and max then keep their second operand.
            let mut near = Lanes::splat(0.0);
            let mut far = Lanes::splat(t_max);
            for axis in 0..3 {
                let plane = slabs.near[axis] as usize;
                near = slab(axis, plane, d_inv).max(near);
                far = slab(axis, plane ^ 1, d_inv_far).min(far);
            }
            (near.le(far), near)
        }

        /// Boxes that are met; see [`super::enter`].
        $(#[$isa])?
        pub(super) fn enter(node: &Node, slabs: &Slabs, t_max: f32) -> (u32, [f32; WIDTH]) {
            let (met, near) = boxes(node, slabs, t_max);
            (met, near.to_array())
        }

        /// Lanes whose triangle the ray hits in (0, t_max), with t, and the barycentric coordinates of v1 and v2 times the
        /// determinant.
        ///
        /// Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection": in the sheared space the ray is the
        /// third axis and vertices are points of the plane, the same for all triangles that share them. A rounded
        /// difference of products has the right sign unless it is 0; zeros are decided in f64.
        ///
        /// Instantiated for each caller (`NEAREST`) so that it inlines: results and the variables of the loop around it stay
        /// in registers.
        #[inline]
        $(#[$isa])?
        fn triangles<const NEAREST: bool>(
            leaves: &[TriangleLeaf],
            index: u32,
            ray: &Ray,
            shear: &Shear,
            t_max: f32,
        ) -> (u32, [Lanes; 4]) {
            let leaf = &leaves[index as usize];
            let others = shear.excluded.of(index);
            let o: &[f32; 3] = ray.o.as_ref();
            let [kx, ky, kz] = shear.axes.map(|axis| axis.min(2));
            let [sx, sy, sz] = shear.shear;
            let (sx, sy, sz) = (Lanes::splat(sx), Lanes::splat(sy), Lanes::splat(sz));
            let (ox, oy, oz) = (Lanes::splat(o[kx]), Lanes::splat(o[ky]), Lanes::splat(o[kz]));
            // All coordinates negated, which changes no product of two of them; the third is turned back by its factor.
            let vertex = |i: usize| {
                let z = oz.sub(Lanes::load(&leaf.v[i][kz]));
                let x = ox.sub(Lanes::load(&leaf.v[i][kx])).sub(sx.mul(z));
                let y = oy.sub(Lanes::load(&leaf.v[i][ky])).sub(sy.mul(z));
                (x, y, z.mul(sz))
            };
            let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) = (vertex(0), vertex(1), vertex(2));
            let mut u = cx.mul(by).sub(cy.mul(bx));
            let mut v = ax.mul(cy).sub(ay.mul(cx));
            let mut w = bx.mul(ay).sub(by.mul(ax));
            let zero = Lanes::splat(0.0);
            let one_sided = |u: Lanes, v: Lanes, w: Lanes| {
                let (negative, positive) = (u.min(v).min(w).lt(zero), zero.lt(u.max(v).max(w)));
                (!(negative & positive) & 0xff, negative | positive)
            };
            let (mut candidates, mut sided) = one_sided(u, v, w);
            if u.mul(v).mul(w).eq(zero) & candidates != 0 {
                (u, v, w) = (exact(cx, by, cy, bx), exact(ax, cy, ay, cx), exact(bx, ay, by, ax));
                (candidates, sided) = one_sided(u, v, w);
            }
            let candidates = candidates & sided & others;
            if candidates == 0 {
                return (0, [zero; 4]);
            }
            let det = u.add(v).add(w);
            let det_inv = Lanes::splat(1.0).div(det);
            let mut t = u.mul(az).add(v.mul(bz)).add(w.mul(cz)).mul(det_inv);

            // Error bound of t (PBRT 4th ed., section 6.8.7): it grows with the triangle's extent in the sheared space.
            // Within it, f32 does not tell on which side of the origin, or of the ray's end, a triangle is: f64 does.
            let largest = |a: Lanes, b: Lanes, c: Lanes| a.abs().max(b.abs()).max(c.abs());
            let (mx, my, mz) = (largest(ax, bx, cx), largest(ay, by, cy), largest(az, bz, cz));
            let me = largest(u, v, w);
            let (dx, dy, dz) = (G5.times(mx.add(mz)), G5.times(my.add(mz)), G3.times(mz));
            let de = G2.times(mx.mul(my)).add(dy.mul(mx)).add(dx.mul(my));
            let de = de.add(de);
            let dt = G3.times(me.mul(mz)).add(de.mul(mz)).add(dz.mul(me)).mul(det_inv.abs());
            let dt = dt.add(dt).add(dt);
            let end = Lanes::splat(t_max);
            let possible = candidates & zero.sub(dt).le(t) & t.sub(dt).le(end);
            let certain = possible & dt.lt(t) & t.lt(end.sub(dt));
            let mut hits = certain;
            let doubtful = possible & !certain;
            if doubtful != 0 {
                let (more, exact) = decide(leaf, ray, t_max, doubtful, t);
                (hits, t) = (hits | more, exact);
            }
            (hits, [t, v, w, det_inv])
        }

        /// a b − c d in f64.
        #[cold]
        #[inline(never)]
        $(#[$isa])?
        fn exact(a: Lanes, b: Lanes, c: Lanes, d: Lanes) -> Lanes {
            let (a, b, c, d) = (a.to_array(), b.to_array(), c.to_array(), d.to_array());
            Lanes::load(&std::array::from_fn(|i| {
                (f64::from(a[i]) * f64::from(b[i]) - f64::from(c[i]) * f64::from(d[i])) as f32
            }))
        }

        /// Decides the `doubtful` lanes in f64: those that are hit in (0, t_max), and t with theirs corrected.
        #[cold]
        #[inline(never)]
        $(#[$isa])?
        fn decide(leaf: &TriangleLeaf, ray: &Ray, t_max: f32, mut doubtful: u32, t: Lanes) -> (u32, Lanes) {
            let (mut hits, mut exact) = (0, t.to_array());
            while doubtful != 0 {
                let lane = doubtful.trailing_zeros() as usize & 7;
                doubtful &= doubtful - 1;
                let Some(t) = plane_ahead(ray, leaf, lane) else { continue };
                exact[lane] = t as f32;
                hits |= u32::from(exact[lane] < t_max) << lane;
            }
            (hits, Lanes::load(&exact))
        }

        /// Asks for the memory of a child that will be visited, unless a hit comes first: in large trees most of the time is
        /// spent waiting for it.
        #[inline]
        $(#[$isa])?
        fn fetch(nodes: &[Node], leaves: &[TriangleLeaf], child: u32) {
            if child & LEAF != 0 {
                prefetch(leaves.as_ptr().wrapping_add((child & !LEAF) as usize));
            } else {
                prefetch(nodes.as_ptr().wrapping_add(child as usize));
            }
        }

        /// Nearest hit; see [`super::nearest`].
        $(#[$isa])?
        pub(super) fn nearest(
            nodes: &[Node],
            leaves: &[TriangleLeaf],
            ray: &Ray,
            excluded: TriangleRef,
            hit: &mut Found,
        ) -> bool {
            let (slabs, shear) = (&Slabs::new(ray), &Shear::new(ray, excluded));
            let (mut stack, mut size) = (Stack::new(), 0);
            let mut t_max = ray.t_max;
            let mut found = false;
            let mut child = 0;
            loop {
                if child & LEAF != 0 {
                    // Keep the nearest triangle of the leaf.
                    let (mut hits, [t, v, w, det_inv]) = triangles::<true>(leaves, child & !LEAF, ray, shear, t_max);
                    if hits != 0 {
                        let [t, v, w, det_inv] = [t.to_array(), v.to_array(), w.to_array(), det_inv.to_array()];
                        while hits != 0 {
                            let lane = hits.trailing_zeros() as usize & 7;
                            hits &= hits - 1;
                            if t[lane] < t_max {
                                t_max = t[lane];
                                let slot = TriangleRef::new(child & !LEAF, lane as u32);
                                *hit = Found::new(t[lane], v[lane] * det_inv[lane], w[lane] * det_inv[lane], slot);
                                found = true;
                            }
                        }
                    }
                } else {
                    // Go on to the nearest child that is met, and keep the others.
                    let node = &nodes[child as usize];
                    let (mut met, near) = boxes(node, slabs, t_max);
                    if met != 0 {
                        let near = near.to_array();
                        let mut take = || {
                            let lane = met.trailing_zeros() as usize & 7;
                            met &= met - 1;
                            fetch(nodes, leaves, node.child[lane]);
                            (Entry::new(near[lane], node.child[lane]), met != 0)
                        };
                        // Up to four are sorted by exchanges, which no branch has to predict.
                        let (a, more) = take();
                        if !more {
                            child = a.child();
                            continue;
                        }
                        let (b, more) = take();
                        let (a, b) = (a.min(b), a.max(b));
                        if !more {
                            stack.push(&mut size, b);
                            child = a.child();
                            continue;
                        }
                        let (c, more) = take();
                        let (b, c) = (b.min(c), b.max(c));
                        let (a, b) = (a.min(b), a.max(b));
                        if !more {
                            stack.push(&mut size, c);
                            stack.push(&mut size, b);
                            child = a.child();
                            continue;
                        }
                        let (d, mut more) = take();
                        let (c, d) = (c.min(d), c.max(d));
                        let (b, c) = (b.min(c), b.max(c));
                        let (a, b) = (a.min(b), a.max(b));
                        let from = size;
                        stack.push(&mut size, d);
                        stack.push(&mut size, c);
                        stack.push(&mut size, b);
                        if !more {
                            child = a.child();
                            continue;
                        }
                        stack.push(&mut size, a);
                        while more {
                            let (next, any) = take();
                            stack.insert(from, &mut size, next);
                            more = any;
                        }
                    }
                }
                child = loop {
                    match stack.pop(&mut size) {
                        None => return found,
                        Some(next) if next.near() <= t_max => break next.child(),
                        Some(_) => {}
                    }
                };
            }
        }

        /// Any hit of what is opaque, else of what may be passed; see [`super::obstacle`].
        $(#[$isa])?
        pub(super) fn obstacle(nodes: &[Node], leaves: &[TriangleLeaf], shadow: &ShadowRay) -> Obstacle {
            let ray = shadow.ray;
            let [left, sought] = shadow.excluded;
            let (slabs, shear) = (&Slabs::new(ray), &Shear::new(ray, left));
            let (mut stack, mut size) = (Stack::new(), 0);
            let t_max = ray.t_max;
            let (mut child, mut met) = (0, Obstacle::None);
            loop {
                if child & LEAF != 0 {
                    let mut hits = triangles::<false>(leaves, child & !LEAF, ray, shear, t_max).0;
                    // Rays meet the triangle that they lead to more seldom than leaves.
                    if hits != 0 {
                        hits &= Excluded::new(sought).of(child & !LEAF);
                    }
                    if hits != 0 {
                        let passages = shadow.passages.get((child & !LEAF) as usize).copied().unwrap_or_default();
                        if hits & !shadow.passing.lanes(passages) != 0 {
                            return Obstacle::Opaque;
                        }
                        met = Obstacle::Passable;
                    }
                } else {
                    // Go on to the last child that is met, and keep the others.
                    let node = &nodes[child as usize];
                    let (mut lanes, _) = boxes(node, slabs, t_max);
                    if lanes != 0 {
                        loop {
                            let lane = lanes.trailing_zeros() as usize & 7;
                            lanes &= lanes - 1;
                            fetch(nodes, leaves, node.child[lane]);
                            if lanes == 0 {
                                child = node.child[lane];
                                break;
                            }
                            stack.push(&mut size, Entry::new(0.0, node.child[lane]));
                        }
                        continue;
                    }
                }
                match stack.pop(&mut size) {
                    None => return met,
                    Some(next) => child = next.child(),
                }
            }
        }
    };
}

pub(super) use kernels;
