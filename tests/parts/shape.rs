//! Shapes against their equations: intersections, the points they give, and the rays that leave those points.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use radianza::glam::{DVec2, DVec3, Mat4, Quat, Vec2, Vec3, Vec3A, Vec4};
use radianza::math::{Frame, Ray, Transform, offset_origin};
use radianza::shape::{
    PlacedQuadric, Primitive, Quadric, Triangle, TriangleAttributes, interpolate, intersect_triangle, triangle_area,
    triangle_normal, triangle_surface,
};
use radianza::stats::{Family, chi2_test};
use radianza::warp::uniform_sphere;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        max_global_rejects: 1 << 20,
        ..ProptestConfig::default()
    }
}

prop_compose! {
    fn unit_vector()(u in 0f32..1.0, v in 0f32..1.0) -> Vec3 { uniform_sphere([u, v]).normalize() }
}

/// Sizes over nine orders of magnitude.
fn size() -> impl Strategy<Value = f32> {
    (-3f32..6.0).prop_map(|e| 10f32.powf(e))
}

fn quadric() -> impl Strategy<Value = Quadric> {
    (0..3, size(), 0.1f32..5.0).prop_map(|(kind, radius, k)| match kind {
        0 => Quadric::Sphere { radius },
        1 => Quadric::Disk { radius },
        _ => Quadric::Cylinder { radius, height: radius * k },
    })
}

fn extent(quadric: &Quadric) -> f32 {
    match *quadric {
        Quadric::Sphere { radius } | Quadric::Disk { radius } => radius,
        Quadric::Cylinder { radius, height } => radius.max(height),
    }
}

/// The quadric's implicit function, in units of length, positive on the side of its normal.
fn side(quadric: &Quadric, p: DVec3) -> f64 {
    match *quadric {
        Quadric::Sphere { radius } => p.length() - f64::from(radius),
        Quadric::Disk { .. } => p.z,
        Quadric::Cylinder { radius, .. } => p.truncate().length() - f64::from(radius),
    }
}

/// Whether a point of the implicit surface is within the clipped one.
fn within(quadric: &Quadric, p: DVec3) -> bool {
    match *quadric {
        Quadric::Sphere { .. } => true,
        Quadric::Disk { radius } => p.truncate().length() <= f64::from(radius),
        Quadric::Cylinder { height, .. } => (0.0..=f64::from(height)).contains(&p.z),
    }
}

proptest! {
    #![proptest_config(config(20_000))]

    /// The parameter found is a point of the quadric, and no point of the ray before it is.
    #[test]
    fn intersection_is_the_first(
        quadric in quadric(), o in unit_vector(), far in 0f32..4.0, target in unit_vector(), speed in 0.01f32..100.0,
    ) {
        let s = extent(&quadric);
        let (o, target) = (o * (s * far), target * (s * 0.8));
        let d = (target - o) / s * speed;
        prop_assume!(d.length() > 1e-3 * speed);
        let hit = quadric.intersect(o, d, f32::INFINITY);
        let (o64, d64) = (o.as_dvec3(), d.as_dvec3());

        // Walk the ray up to the hit (or far beyond the shape) and look for crossings of the surface in between.
        let end = hit.map_or(20.0 * f64::from(s) / d64.length(), f64::from);
        let steps = 400;
        let crossing = (0..steps).find_map(|i| {
            let t = |i: i32| end * (1.0 - 2e-6) * f64::from(i) / f64::from(steps);
            let f = |t: f64| side(&quadric, o64 + d64 * t);
            let (mut a, mut b) = (t(i), t(i + 1));
            if f(a) * f(b) >= 0.0 {
                return None;
            }
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                (a, b) = if f(a) * f(middle) <= 0.0 { (a, middle) } else { (middle, b) };
            }
            // Whether a crossing on the very rim counts is a matter of rounding.
            let cross = o64 + d64 * a;
            (within(&quadric, cross * (1.0 + 1e-9)) && within(&quadric, cross * (1.0 - 1e-9))).then_some(a)
        });
        prop_assert!(crossing.is_none(), "surface crossed at {crossing:?} before {hit:?}");

        if let Some(t) = hit {
            let surface = quadric.surface(o, d, t);
            let p = surface.p.as_dvec3();
            let error = surface.p_error.as_dvec3().length();
            prop_assert!(side(&quadric, p).abs() <= error, "{} off by more than {error}", side(&quadric, p));
            let on_ray = o64 + d64 * f64::from(t);
            prop_assert!(on_ray.distance(p) <= 1e-6 * (o64.length() + f64::from(t) * d64.length()) + error);
            prop_assert!((surface.ng.length() - 1.0).abs() < 1e-6);
            prop_assert!(surface.uv[0].min_element() >= 0.0 && surface.uv[0].max_element() <= 1.0);
            prop_assert!(surface.tangent.dot(surface.ng).abs() <= 1e-5 * surface.tangent.length());
            prop_assert_eq!(quadric.intersect(o, d, t), None);
        }
    }
}

/// A placed quadric with everything that may trouble it.
fn placed() -> impl Strategy<Value = PlacedQuadric> {
    let scale = prop::array::uniform3((0.3f32..3.0, any::<bool>()).prop_map(|(s, m)| if m { -s } else { s }));
    let away = prop_oneof![Just(0f32), 0f32..1.0, 0f32..300.0];
    (quadric(), scale, unit_vector(), 0f32..6.0, unit_vector(), away, any::<bool>()).prop_map(
        |(quadric, scale, axis, angle, direction, away, reversed)| {
            let t = direction * (away * extent(&quadric));
            let m = Mat4::from_scale_rotation_translation(Vec3::from(scale), Quat::from_axis_angle(axis, angle), t);
            PlacedQuadric::new(quadric, Transform::from_mat4(m).unwrap(), reversed)
        },
    )
}

proptest! {
    #![proptest_config(config(60_000))]

    /// A ray that leaves a hit by `offset_origin` starts on the side that it leaves to and does not meet the surface
    /// in the same place again, whatever the size, the place and the angle.
    #[test]
    fn leaving_rays_leave(
        shape in placed(), u in 0f32..1.0, v in 0f32..1.0, from in unit_vector(), distance in 0.1f32..10.0,
        azimuth in 0f32..6.3, height in prop_oneof![-1f32..1.0, -1e-3f32..1e-3, -1e-6f32..1e-6],
    ) {
        // Meet the surface near a random point of it, from a random place.
        let s = extent(&shape.quadric);
        let target = shape.surface_at(&shape.quadric.sample_area([u, v]), true).p;
        let o = target + Vec3A::from(from) * (distance * s);
        let ray = Ray::new(o, (target - o).normalize());
        let Some(t) = shape.intersect(&ray) else { return Ok(()) };
        let surface = shape.surface(&ray, t, true);
        let object = shape.point_at(surface.p.as_dvec3());
        prop_assume!(height != 0.0);

        // The front is outside, unless reversed.
        let m = shape.transform.to_world.as_daffine3();
        let outward = if shape.reversed { -surface.ng } else { surface.ng };
        prop_assert!(m.matrix3.mul_vec3(object.n).dot(outward.as_dvec3()) > 0.0);

        // Leave on either side, steeply or grazing.
        let rho = (1.0 - height * height).sqrt();
        let w = Frame::from_z(surface.ng).to_world(Vec3::new(rho * azimuth.cos(), rho * azimuth.sin(), height));
        let outside = (w.dot(surface.ng) >= 0.0) != shape.reversed;
        let q = offset_origin(surface.p, surface.p_error, surface.ng, w);
        let away = side(&shape.quadric, m.inverse().transform_point3(q.as_dvec3()));
        prop_assert!(if outside { away > 0.0 } else { away < 0.0 }, "origin on the wrong side: {away}");

        let again = shape.intersect(&Ray::new(q, w));
        let flat = matches!(shape.quadric, Quadric::Disk { .. });
        if flat || outside {
            // Disks and the outsides of convex surfaces do not see themselves. On which side of a plane a direction
            // lies that is parallel to it up to the rounding of its normal, nobody can say.
            prop_assert!(again.is_none() || (flat && height.abs() < 3e-7), "met itself at {again:?}");
        } else {
            // From inside, the chord through the point, exact in object space: t = −2 (p·d)/(d·d), cylinders without z.
            let flatten = |x: DVec3| if matches!(shape.quadric, Quadric::Sphere { .. }) { x } else { x.with_z(0.0) };
            let (p, d) = (flatten(object.p), flatten(m.inverse().transform_vector3(w.as_dvec3())));
            let chord = -2.0 * p.dot(d) / d.length_squared();
            match again {
                // The other end is met, and not much beyond where the chord is long beside the rounding.
                Some(t) => prop_assert!(
                    f64::from(t) > 0.5 * chord && (chord < 0.3 * f64::from(s) || f64::from(t) < 1.2 * chord),
                    "met again at {t}, chord {chord}"
                ),
                None => prop_assert!(matches!(shape.quadric, Quadric::Cylinder { .. }), "leaked"),
            }
        }
    }

    /// Bounds hold every point that a ray may be given.
    #[test]
    fn bounds_hold_the_surface(shape in placed(), u in 0f32..1.0, v in 0f32..1.0) {
        let (low, high) = shape.bounds();
        let p = shape.surface_at(&shape.quadric.sample_area([u, v]), true).p;
        prop_assert!(p.cmpge(low.into()).all() && p.cmple(high.into()).all(), "{p} outside {low} {high}");
    }

    /// The same for triangles in an instance: the origin stays on its side after it was rounded to object space.
    #[test]
    fn instanced_triangles_are_left(
        a in unit_vector(), b in unit_vector(), c in unit_vector(), s in size(), away in 0f32..1e3, scale in 0.01f32..100.0,
        axis in unit_vector(), angle in 0f32..6.0, u in 0f32..1.0, v in 0f32..1.0, w in unit_vector(), flip in any::<bool>(),
    ) {
        let p = [a, b, c].map(|x| x * s);
        prop_assume!(triangle_area(p) > 1e-3 * s * s && u + v < 1.0);
        let scale = Vec3::new(scale, 1.0, if flip { -1.0 } else { 1.0 });
        let m = Mat4::from_scale_rotation_translation(scale, Quat::from_axis_angle(axis, angle), axis * (away * s));
        let transform = Transform::from_mat4(m).unwrap();
        let local = triangle_surface(p, u, v, &TriangleAttributes::default(), false);
        let surface = local.to_world(&transform);
        let w = Vec3A::from(w);
        let q = offset_origin(surface.p, surface.p_error, surface.ng, w);
        let q = transform.to_object.transform_point3a(q).as_dvec3();
        let [a, b, c] = p.map(|p| p.as_dvec3());
        let above = (b - a).cross(c - a).dot(q - a);
        prop_assert!(if w.dot(surface.ng) > 0.0 { above > 0.0 } else { above < 0.0 }, "leaked by {above}");
    }

    /// Interpolated points, normals and frames of triangles.
    #[test]
    fn triangle_surfaces(
        a in unit_vector(), b in unit_vector(), c in unit_vector(), s in size(), u in 0f32..1.0, v in 0f32..1.0,
        n in prop::array::uniform3(unit_vector()), uv in prop::array::uniform6(-2f32..2.0), flip in any::<bool>(),
    ) {
        let p = [a, b, c].map(|x| x * s + Vec3::splat(s));
        prop_assume!(triangle_area(p) > 1e-3 * s * s && u + v < 1.0);
        let uv = [Vec2::new(uv[0], uv[1]), Vec2::new(uv[2], uv[3]), Vec2::new(uv[4], uv[5])];
        let det = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]);
        prop_assume!(det.abs() > 1e-2);
        let attributes = TriangleAttributes { normals: Some(n), uv: [Some(uv), None], ..Default::default() };
        let surface = triangle_surface(p, u, v, &attributes, flip);

        // The point within its error bound.
        let [x, y, z] = p.map(|p| p.as_dvec3());
        let exact = x + (y - x) * f64::from(u) + (z - x) * f64::from(v);
        prop_assert!((surface.p.as_dvec3() - exact).abs().cmple(surface.p_error.as_dvec3()).all());

        // Normals: to the front, and the shading normal with it.
        let front = Vec3A::from(triangle_normal(p).unwrap());
        prop_assert_eq!(surface.ng, if flip { -front } else { front });
        prop_assert!(surface.ns.dot(surface.ng) >= 0.0);

        // Along the tangent u grows and v stays; against the bitangent v grows (in the plane of the triangle).
        let flat = triangle_surface(p, u, v, &TriangleAttributes { normals: None, ..attributes }, flip);
        let gradient = |f: [f32; 3]| {
            // f as an affine function on the plane: solve for its gradient with the dual basis of the edges.
            let (e1, e2, n) = (y - x, z - x, front.as_dvec3());
            let area = e1.cross(e2).length();
            (e2.cross(n) * f64::from(f[1] - f[0]) + n.cross(e1) * f64::from(f[2] - f[0])) / area
        };
        let (du, dv) = (gradient(uv.map(|t| t.x)), gradient(uv.map(|t| t.y)));
        let frame = Frame::from_z_tangent(flat.ns, flat.tangent, flat.handedness);
        prop_assert!(du.dot(frame.s.as_dvec3()) > 0.0);
        prop_assert!(dv.dot(frame.s.as_dvec3()).abs() <= 1e-3 * dv.length());
        prop_assert!(dv.dot(frame.t.as_dvec3()) < 0.0);

        // A ray at the point meets it there.
        let ray = Ray::new(surface.p + surface.ng * s, -surface.ng);
        if let Some(hit) = intersect_triangle(&ray, p) {
            prop_assert!((hit.t / s - 1.0).abs() < 1e-4 && (hit.u - u).abs() < 1e-2 && (hit.v - v).abs() < 1e-2);
        }
    }
}

#[test]
fn tangents_and_colours_are_interpolated() {
    let p = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let tangents = [Vec4::new(0.0, 1.0, 0.0, -1.0); 3];
    let colors = [Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::new(0.0, 1.0, 0.0, 1.0), Vec4::new(0.0, 0.0, 1.0, 1.0)];
    let attributes = TriangleAttributes { tangents: Some(tangents), colors: Some(colors), ..Default::default() };
    let surface = triangle_surface(p, 0.25, 0.5, &attributes, false);
    assert_eq!((surface.tangent, surface.handedness), (Vec3A::Y, -1.0));
    assert_eq!(triangle_surface(p, 0.25, 0.5, &attributes, true).handedness, 1.0);
    assert_eq!(surface.color, Vec4::new(0.25, 0.25, 0.5, 1.0));
    assert_eq!(interpolate([1f32, 2.0, 4.0], 0.25, 0.5), 2.75);
    assert_eq!(triangle_area(p), 0.5);
    assert_eq!(triangle_normal([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]), None);
}

/// Areas by `area()` against closed forms: spheroids (Archimedes' successors), disks and cylinders.
#[test]
fn areas_are_the_closed_forms() {
    let placed = |quadric, scale: Vec3| {
        PlacedQuadric::new(quadric, Transform::from_mat4(Mat4::from_scale(scale)).unwrap(), false)
    };
    let sphere = Quadric::Sphere { radius: 1.0 };
    let pi = std::f64::consts::PI;
    let (a, c) = (1.0f64, 2.0f64);
    let e = (1.0 - a * a / (c * c)).sqrt();
    let prolate = 2.0 * pi * a * a * (1.0 + c / (a * e) * e.asin());
    let (a, c) = (2.0f64, 1.0f64);
    let e = (1.0 - c * c / (a * a)).sqrt();
    let oblate = 2.0 * pi * a * a * (1.0 + (1.0 - e * e) / e * e.atanh());
    for (shape, exact, tolerance) in [
        (placed(sphere, Vec3::splat(3.0)), 36.0 * pi, 1e-12),
        (placed(sphere, Vec3::new(1.0, 1.0, 2.0)), prolate, 1e-3),
        (placed(sphere, Vec3::new(2.0, 2.0, -1.0)), oblate, 1e-3),
        (placed(Quadric::Disk { radius: 2.0 }, Vec3::new(3.0, 0.5, 9.0)), 6.0 * pi, 1e-12),
        (placed(Quadric::Cylinder { radius: 2.0, height: 1.0 }, Vec3::splat(2.0)), 16.0 * pi, 1e-12),
    ] {
        assert!((shape.area() / exact - 1.0).abs() < tolerance, "{} is not {exact}", shape.area());
    }
}

/// Points drawn by area: χ² in coordinates in which equal areas are equal intervals.
#[test]
fn area_sampling_is_uniform() {
    let mut family = Family::new("area sampling of quadrics");
    let mut rng = Pcg64Mcg::new(11);
    let turn = |p: DVec2| (p.y.atan2(p.x) / std::f64::consts::TAU).rem_euclid(1.0);
    type EqualArea<'a> = &'a dyn Fn(DVec3) -> [f64; 2];
    let cases: [(&str, Quadric, EqualArea); 3] = [
        ("sphere", Quadric::Sphere { radius: 3.0 }, &|p| [turn(p.truncate()), 0.5 + p.z / 6.0]),
        ("disk", Quadric::Disk { radius: 3.0 }, &|p| [turn(p.truncate()), p.truncate().length_squared() / 9.0]),
        ("cylinder", Quadric::Cylinder { radius: 3.0, height: 5.0 }, &|p| [turn(p.truncate()), p.z / 5.0]),
    ];
    for (name, quadric, equal_area) in cases {
        let (n, bins) = (200_000, 20);
        let mut counts = vec![0.0; bins * bins];
        for _ in 0..n {
            let p = quadric.sample_area([rng.random(), rng.random()]).p;
            let [x, y] = equal_area(p).map(|x| ((x * bins as f64) as usize).min(bins - 1));
            counts[y * bins + x] += 1.0;
        }
        let expected = vec![f64::from(n) / (bins * bins) as f64; bins * bins];
        family.p(name, chi2_test(&counts, &expected, 5.0).p);
    }
    family.assert();
}

/// A step along ∂p/∂u changes u alone, one along ∂p/∂v changes v alone, on every primitive under every map.
#[test]
fn derivatives_are_those_of_the_texture_coordinates() {
    let turned = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -1.0).normalize(), 0.7);
    let map = Mat4::from_scale_rotation_translation(Vec3::new(0.3, 1.0, -2.0), turned, Vec3::new(1.0, -2.0, 0.5));
    let mut primitives = Vec::new();
    for map in [Mat4::IDENTITY, map] {
        let transform = Transform::from_mat4(map).expect("invertible");
        let (sphere, disk) = (Quadric::Sphere { radius: 1.4 }, Quadric::Disk { radius: 0.8 });
        for quadric in [sphere, disk, Quadric::Cylinder { radius: 0.6, height: 1.5 }] {
            primitives.push(Primitive::Quadric(PlacedQuadric::new(quadric, transform, false)));
        }
        let p = [Vec3::ZERO, Vec3::new(2.0, 0.3, 0.0), Vec3::new(0.2, 1.5, 0.4)].map(|p| map.transform_point3(p));
        let uv = [Vec2::new(0.1, 0.2), Vec2::new(0.9, 0.4), Vec2::new(0.3, 0.8)];
        let attributes = TriangleAttributes { uv: [Some(uv), None], ..TriangleAttributes::default() };
        primitives.push(Primitive::Triangle(Box::new(Triangle { p, attributes, flip: false })));
    }
    let (mut rng, mut compared) = (Pcg64Mcg::new(3), 0);
    let mut direction = move || Vec3A::from(uniform_sphere([rng.random(), rng.random()]));
    for primitive in &primitives {
        let (min, max) = primitive.bounds();
        let size = (max - min).length();
        for _ in 0..400 {
            // A line through the box, and where parallels to it beside the hit meet the surface.
            let d = direction();
            let ray = Ray::new(Vec3A::from(min * 0.5 + max * 0.5) + direction() * (0.3 * size) - d * (2.0 * size), d);
            let Some(hit) = primitive.intersect(&ray, f32::INFINITY) else { continue };
            let (at, found) = (primitive.surface(&ray, &hit, true), primitive.derivatives(&ray, &hit));
            let Some(derivatives) = found.filter(|_| at.ng.dot(d).abs() > 0.3) else { continue };
            // Not about the poles, where u turns fast.
            if derivatives.dpdu.length() < 0.5 * size {
                continue;
            }
            let sides = [(derivatives.dpdu, Vec2::X), (derivatives.dpdv, Vec2::Y)];
            for (derivative, expected) in sides {
                // Central differences over half a percent of the size: of curvature and rounding a thousandth is left.
                let step = 0.0025 * size / derivative.length();
                let uv = |sign: f32| {
                    let ray = Ray::new(ray.o + derivative * (sign * step), d);
                    let beside = primitive.surface(&ray, &primitive.intersect(&ray, f32::INFINITY)?, true);
                    // Not past a rim, on what lies behind.
                    (beside.p.distance(at.p) < 0.02 * size).then_some(beside.uv[0])
                };
                let (Some(more), Some(less)) = (uv(1.0), uv(-1.0)) else { continue };
                let change = (more - less) / (2.0 * step);
                // Not across the seam of u.
                if (more - less).length() < 0.5 {
                    assert!(change.distance(expected) < 0.02, "{primitive:?}: {change} is not {expected}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 500, "{compared}");
}
