//! A quadric placed in the world.

use super::{Chart, Derivatives, Quadric, QuadricPoint, Surface};
use crate::math::{Ray, Transform, UNIT_ROUNDOFF};
use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3, Vec3A, Vec4};

/// Relative error bound of the few f64 operations that map a point to object space and back: γ₃₂ of f64.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A quadric under an affine map. The map is inverted once in f64 and applied in f64, so that the only f32 roundings
/// are those of the world-space ray that came and of the point that goes.
#[derive(Clone, Copy, Debug)]
pub struct PlacedQuadric {
    /// The shape in object space.
    pub quadric: Quadric,
    /// Object ↔ world.
    pub transform: Transform,
    /// The front is the other side.
    pub reversed: bool,
    to_world: DAffine3,
    to_object: DAffine3,
}

impl PlacedQuadric {
    /// Places `quadric`; `reversed` turns its normals to the other side.
    pub fn new(quadric: Quadric, transform: Transform, reversed: bool) -> Self {
        let to_world = transform.to_world.as_daffine3();
        Self { quadric, transform, reversed, to_world, to_object: to_world.inverse() }
    }

    /// Nearest intersection in `(0, ray.t_max)`.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f32> {
        self.intersect_before(ray, ray.t_max)
    }

    /// Nearest intersection in `(0, t_max)`, whatever the ray says of its end.
    ///
    /// A root counts only beyond the error that rounding in the map leaves on the origin, |d|·δₒ/|d|² in units of t
    /// (PBRT 4th ed., section 6.8.5); in f64 that is far below one step of an f32 origin, so nothing real is lost.
    #[inline]
    pub fn intersect_before(&self, ray: &Ray, t_max: f32) -> Option<f32> {
        // The end is compared after rounding: a ray cut at its own hit is open there.
        let [near, far] = self.ahead(ray).map(|t| t as f32);
        if near < t_max {
            Some(near)
        } else if far < t_max {
            Some(far)
        } else {
            None
        }
    }

    /// Whether it stands before the point of it that the ray leads to, at about `t`: the root nearest to that is the point, and
    /// the other one hides it where it comes first.
    #[inline]
    pub fn hides_own_point(&self, ray: &Ray, t: f32) -> bool {
        let [near, far] = self.ahead(ray);
        // False where either is NaN.
        (far - f64::from(t)).abs() < (near - f64::from(t)).abs()
    }

    /// Parameters of the points that count, ascending; NaN for those that there are not.
    #[inline]
    fn ahead(&self, ray: &Ray) -> [f64; 2] {
        let (o, d) = self.ray_to_object(ray);
        let o_error =
            (self.to_object.matrix3.abs() * ray.o.as_dvec3().abs() + self.to_object.translation.abs()) * ROUNDING;
        let t_min = d.abs().dot(o_error) / d.length_squared();
        self.quadric.roots(o, d).map(|t| if t > t_min { t } else { f64::NAN })
    }

    /// The surface where `ray` meets it at `t`, in world space; texture coordinates and tangent only where the material
    /// `needs_uv`, for they take a while.
    pub fn surface(&self, ray: &Ray, t: f32, needs_uv: bool) -> Surface {
        let (o, d) = self.ray_to_object(ray);
        self.surface_at(&self.quadric.refine(o, d, f64::from(t)), needs_uv)
    }

    /// ∂p/∂u and ∂p/∂v in world space where `ray` meets it at `t`.
    pub fn derivatives(&self, ray: &Ray, t: f32) -> Option<Derivatives> {
        let (o, d) = self.ray_to_object(ray);
        let chart = self.quadric.chart(&self.quadric.refine(o, d, f64::from(t)));
        let m = &self.to_world.matrix3;
        Some(Derivatives { dpdu: (*m * chart.dpdu).as_vec3a(), dpdv: (*m * chart.dpdv).as_vec3a() })
    }

    /// The world-space surface at a point of the quadric.
    pub fn surface_at(&self, point: &QuadricPoint, needs_uv: bool) -> Surface {
        let chart = if needs_uv { self.quadric.chart(point) } else { Chart::default() };
        let p = self.to_world.transform_point3(point.p);
        let ng = self.normal_to_world(point.n).as_vec3a();
        let mirror = if self.transform.mirrors() != self.reversed { -1.0 } else { 1.0 };
        Surface {
            p: p.as_vec3a(),
            p_error: self.p_error(point.p, p),
            ng,
            ns: ng,
            tangent: (self.to_world.matrix3 * chart.dpdu).as_vec3a(),
            handedness: mirror,
            uv: [chart.uv, Vec2::ZERO],
            color: Vec4::ONE,
        }
    }

    /// Bound on the distance of the f32 point from the surface that [`intersect`](Self::intersect) sees: one rounding
    /// to f32, and the f64 rounding of the map and of the way back.
    fn p_error(&self, object: DVec3, world: DVec3) -> Vec3A {
        let (m, inverse) = (self.to_world.matrix3.abs(), self.to_object.matrix3.abs());
        let forth = m * object.abs() + self.to_world.translation.abs();
        let back = m * (inverse * forth + self.to_object.translation.abs());
        let error = world.abs() * f64::from(UNIT_ROUNDOFF) + (forth + back) * ROUNDING;
        // Rounding the bound itself must not shrink it, and even an exact point must move off the surface.
        error.as_vec3a() * (1.0 + f32::EPSILON) + f32::MIN_POSITIVE
    }

    /// Unit normal in the world, towards the front. A normal is a covector: it stays outward under a mirroring map.
    fn normal_to_world(&self, n: DVec3) -> DVec3 {
        let n = (self.to_object.matrix3.transpose() * n).normalize();
        if self.reversed { -n } else { n }
    }

    /// Lower and upper corner of the bounding box in world space, rounded outwards.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = self.to_world.matrix3;
        let t = self.to_world.translation;
        // A circle r (cos φ x + sin φ y) reaches r √(xᵢ² + yᵢ²) along axis i; a sphere likewise with three terms.
        let circle = |r: f32| (x * x + y * y).map(f64::sqrt) * f64::from(r);
        let (center_low, center_high, reach) = match self.quadric {
            Quadric::Sphere { radius } => (t, t, (x * x + y * y + z * z).map(f64::sqrt) * f64::from(radius)),
            Quadric::Disk { radius } => (t, t, circle(radius)),
            Quadric::Cylinder { radius, height } => {
                let top = t + z * f64::from(height);
                (t.min(top), t.max(top), circle(radius))
            }
        };
        let (low, high) = (center_low - reach, center_high + reach);
        (low.as_vec3().map(f32::next_down), high.as_vec3().map(f32::next_up))
    }

    /// Area in the world per area of the object at unit object normal `n`: |det M| |M⁻ᵀ n|.
    pub fn area_scale(&self, n: DVec3) -> f64 {
        self.to_world.matrix3.determinant().abs() * (self.to_object.matrix3.transpose() * n).length()
    }

    /// Area in the world per area of the object at unit world normal `n`: |det M| / |Mᵀ n|.
    pub fn area_scale_world(&self, n: DVec3) -> f64 {
        self.to_world.matrix3.determinant().abs() / (self.to_world.matrix3.transpose() * n).length()
    }

    /// Area in the world \[m²\]: exact for disks and for maps that scale all axes alike, otherwise the mean of
    /// [`area_scale`](Self::area_scale) over a regular set of points (an ellipsoid's area is no elementary function).
    pub fn area(&self) -> f64 {
        const N: u32 = 24;
        let at = |i: u32| (f64::from(i) + 0.5) as f32 / N as f32;
        let scale = |i: u32, j: u32| self.area_scale(self.quadric.sample_area([at(i), at(j)]).n);
        let sum: f64 = (0..N * N).map(|k| scale(k / N, k % N)).sum();
        self.quadric.area() * sum / f64::from(N * N)
    }

    /// Centre and radius of the sphere that this is in the world: of a [`Quadric::Sphere`] under a similarity, whose
    /// columns are orthogonal and of one length up to the rounding of an f32 matrix.
    pub fn as_sphere(&self) -> Option<(DVec3, f64)> {
        let Quadric::Sphere { radius } = self.quadric else { return None };
        let m = self.to_world.matrix3;
        let scale2 = m.determinant().abs().powf(2.0 / 3.0);
        let gram = m.transpose() * m;
        let tolerance = 16.0 * f64::from(f32::EPSILON) * scale2;
        gram.abs_diff_eq(DMat3::from_diagonal(DVec3::splat(scale2)), tolerance)
            .then(|| (self.to_world.translation, f64::from(radius) * scale2.sqrt()))
    }

    /// The point of the quadric at a world-space point on (or, by rounding, next to) it.
    pub fn point_at(&self, p: DVec3) -> QuadricPoint {
        self.quadric.project(self.to_object.transform_point3(p))
    }

    fn ray_to_object(&self, ray: &Ray) -> (DVec3, DVec3) {
        let (o, d) = (ray.o.as_dvec3(), ray.d.as_dvec3());
        (self.to_object.transform_point3(o), self.to_object.transform_vector3(d))
    }
}
