//! Sphere, disk and cylinder in their own space.
//!
//! All in f64: the coordinates of an f32 ray are squared without rounding, so roots, and the side of the surface on
//! which an origin lies, come out right at every scale that f32 can hold.

use super::Surface;
use crate::desc;
use crate::math::UNIT_ROUNDOFF;
use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};
use std::f64::consts::{PI, TAU};

/// A quadric about the origin of its object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quadric {
    /// x² + y² + z² = r², normals outwards.
    Sphere {
        /// Radius r.
        radius: f32,
    },
    /// z = 0, x² + y² ≤ r², normal +z.
    Disk {
        /// Radius r.
        radius: f32,
    },
    /// x² + y² = r², 0 ≤ z ≤ h, open, normals outwards.
    Cylinder {
        /// Radius r.
        radius: f32,
        /// Height h.
        height: f32,
    },
}

/// A point of a quadric, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadricPoint {
    /// The point.
    pub p: DVec3,
    /// Unit normal.
    pub n: DVec3,
}

/// How texture coordinates lie on a quadric, at a point in object space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chart {
    /// Texture coordinates in \[0, 1\]²; v grows downwards (sphere and cylinder: towards −z, disk: towards −y).
    pub uv: Vec2,
    /// ∂p/∂u; 0 at the poles of a sphere.
    pub dpdu: DVec3,
    /// ∂p/∂v.
    pub dpdv: DVec3,
}

impl Quadric {
    /// The quadric that was written; `None` for meshes and for sizes that are not positive and finite.
    pub fn from_desc(shape: &desc::Shape) -> Option<Self> {
        let valid = |x: f32| x > 0.0 && x.is_finite();
        match *shape {
            desc::Shape::Sphere { radius } => valid(radius).then_some(Self::Sphere { radius }),
            desc::Shape::Disk { radius } => valid(radius).then_some(Self::Disk { radius }),
            desc::Shape::Cylinder { radius, height } => {
                (valid(radius) && valid(height)).then_some(Self::Cylinder { radius, height })
            }
            desc::Shape::Mesh(_) => None,
        }
    }

    /// Lower and upper corner of the bounding box in object space.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match *self {
            Self::Sphere { radius } => (Vec3::splat(-radius), Vec3::splat(radius)),
            Self::Disk { radius } => (Vec3::new(-radius, -radius, 0.0), Vec3::new(radius, radius, 0.0)),
            Self::Cylinder { radius, height } => (Vec3::new(-radius, -radius, 0.0), Vec3::new(radius, radius, height)),
        }
    }

    /// Area in object space \[m²\].
    pub fn area(&self) -> f64 {
        match *self {
            Self::Sphere { radius } => 4.0 * PI * f64::from(radius).powi(2),
            Self::Disk { radius } => PI * f64::from(radius).powi(2),
            Self::Cylinder { radius, height } => TAU * f64::from(radius) * f64::from(height),
        }
    }

    /// Parameters of the points in which the line o + t d meets the quadric, ascending, of either sign; NaN for those that
    /// there are not.
    ///
    /// a t² + 2 b t + c = 0 with q = −(b + sgn(b) √(b² − ac)), t = q/a and c/q (Numerical Recipes, section 5.6): no
    /// root is a difference of nearly equal numbers. The discriminant is a (r² − ρ²) with ρ the distance of the line
    /// from the centre (PBRT 4th ed., section 6.8.3), c is (|o| − r)(|o| + r).
    #[inline(always)]
    pub fn roots(&self, o: DVec3, d: DVec3) -> [f64; 2] {
        match *self {
            Self::Sphere { radius } => {
                let r = f64::from(radius);
                let (a, b) = (d.length_squared(), o.dot(d));
                let distance = (o - d * (b / a)).length();
                quadratic(a, b, (o.length() - r) * (o.length() + r), a * (r - distance) * (r + distance))
            }
            Self::Disk { radius } => {
                let t = -o.z / d.z;
                let p = o.truncate() + d.truncate() * t;
                [if p.length_squared() <= f64::from(radius).powi(2) { t } else { f64::NAN }, f64::NAN]
            }
            Self::Cylinder { radius, height } => {
                let r = f64::from(radius);
                let (o2, d2): (DVec2, DVec2) = (o.truncate(), d.truncate());
                let (a, b) = (d2.length_squared(), o2.dot(d2));
                let distance = (o2 - d2 * (b / a)).length();
                quadratic(a, b, (o2.length() - r) * (o2.length() + r), a * (r - distance) * (r + distance))
                    .map(|t| if (0.0..=f64::from(height)).contains(&(o.z + d.z * t)) { t } else { f64::NAN })
            }
        }
    }

    /// Nearest intersection in `(0, t_max)` with a ray of object space, whose direction may have any length.
    pub fn intersect(&self, o: Vec3, d: Vec3, t_max: f32) -> Option<f32> {
        let roots = self.roots(o.as_dvec3(), d.as_dvec3());
        roots.map(|t| t as f32).into_iter().find(|t| *t > 0.0 && *t < t_max)
    }

    /// The point of the ray at the root nearest to `t`, exact where `t` was rounded to f32.
    pub(super) fn refine(&self, o: DVec3, d: DVec3, t: f64) -> QuadricPoint {
        let [a, b] = self.roots(o, d);
        let root = if a.is_nan() || (b - t).abs() < (a - t).abs() { b } else { a };
        self.project(o + d * if root.is_nan() { t } else { root })
    }

    /// The surface where an object-space ray meets it at `t`.
    pub fn surface(&self, o: Vec3, d: Vec3, t: f32) -> Surface {
        let point = self.refine(o.as_dvec3(), d.as_dvec3(), f64::from(t));
        let (p, n, chart) = (point.p.as_vec3a(), point.n.as_vec3a(), self.chart(&point));
        Surface {
            p,
            // One rounding to f32; what f64 lost before it is covered by the doubling.
            p_error: p.abs() * (2.0 * UNIT_ROUNDOFF),
            ng: n,
            ns: n,
            tangent: chart.dpdu.as_vec3a(),
            handedness: 1.0,
            uv: [chart.uv, Vec2::ZERO],
            color: Vec4::ONE,
        }
    }

    /// The point of the quadric at (or, by rounding, next to) `p`.
    pub(super) fn project(&self, p: DVec3) -> QuadricPoint {
        match *self {
            Self::Sphere { radius } => {
                let n = p.try_normalize().unwrap_or(DVec3::Z);
                QuadricPoint { p: n * f64::from(radius), n }
            }
            Self::Disk { .. } => QuadricPoint { p: p.with_z(0.0), n: DVec3::Z },
            Self::Cylinder { radius, height } => {
                let n = p.truncate().try_normalize().unwrap_or(DVec2::X);
                let z = p.z.clamp(0.0, f64::from(height));
                QuadricPoint { p: (n * f64::from(radius)).extend(z), n: n.extend(0.0) }
            }
        }
    }

    /// Texture coordinates and their tangent at a point of the quadric.
    pub fn chart(&self, &QuadricPoint { p, n }: &QuadricPoint) -> Chart {
        let around = |radius: f32| DVec3::new(-n.y, n.x, 0.0) * (TAU * f64::from(radius));
        match *self {
            Self::Sphere { radius } => {
                let rho = n.truncate().length();
                let uv = Vec2::new(turn(n.truncate()), (rho.atan2(n.z) / PI) as f32);
                // Down the meridian; at the poles along that of longitude 0.
                let outwards = n.truncate().try_normalize().unwrap_or(DVec2::X);
                let down = (outwards * n.z).extend(-rho);
                Chart { uv, dpdu: around(radius), dpdv: down * (PI * f64::from(radius)) }
            }
            Self::Disk { radius } => {
                let r = f64::from(radius);
                let uv = 0.5 * (DVec2::new(p.x, -p.y) / r + 1.0);
                Chart {
                    uv: uv.as_vec2().clamp(Vec2::ZERO, Vec2::ONE),
                    dpdu: DVec3::X * (2.0 * r),
                    dpdv: DVec3::NEG_Y * (2.0 * r),
                }
            }
            Self::Cylinder { radius, height } => {
                let uv = Vec2::new(turn(n.truncate()), (1.0 - p.z / f64::from(height)) as f32);
                Chart { uv, dpdu: around(radius), dpdv: DVec3::NEG_Z * f64::from(height) }
            }
        }
    }

    /// Point drawn uniformly by area (in object space) from `u` in \[0, 1)²; density 1/[`area`](Self::area).
    /// Sphere and cylinder by Archimedes' map, the disk in polar form.
    pub fn sample_area(&self, u: [f32; 2]) -> QuadricPoint {
        let [u0, u1] = u.map(f64::from);
        let (sin, cos) = (TAU * u1).sin_cos();
        match *self {
            Self::Sphere { .. } => {
                let rho = 2.0 * (u0 * (1.0 - u0)).sqrt();
                self.project(DVec3::new(rho * cos, rho * sin, 1.0 - 2.0 * u0))
            }
            Self::Disk { radius } => {
                let r = f64::from(radius) * u0.sqrt();
                self.project(DVec3::new(r * cos, r * sin, 0.0))
            }
            Self::Cylinder { height, .. } => self.project(DVec3::new(cos, sin, u0 * f64::from(height))),
        }
    }

    /// The numbers in \[0, 1\]² by which [`sample_area`](Self::sample_area) draws a point.
    pub fn area_coordinates(&self, &QuadricPoint { p, n }: &QuadricPoint) -> [f32; 2] {
        match *self {
            // (1 − cos θ)/2, which keeps its precision about the pole: sin²/2(1 + cos).
            Self::Sphere { .. } => {
                let sin2 = n.truncate().length_squared();
                let u = if n.z > 0.0 { 0.5 * sin2 / (1.0 + n.z) } else { 0.5 * (1.0 - n.z) };
                [u as f32, turn(n.truncate())]
            }
            Self::Disk { radius } => [(p.truncate().length() / f64::from(radius)).powi(2) as f32, turn(p.truncate())],
            Self::Cylinder { height, .. } => [(p.z / f64::from(height)) as f32, turn(n.truncate())],
        }
    }
}

/// Roots of a t² + 2 b t + c, ascending, given its discriminant b² − ac; NaN for those that there are not.
#[inline(always)]
fn quadratic(a: f64, b: f64, c: f64, discriminant: f64) -> [f64; 2] {
    if !(discriminant >= 0.0 && a > 0.0) {
        return [f64::NAN; 2];
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    if q == 0.0 {
        return [0.0, f64::NAN];
    }
    let (t0, t1) = (q / a, c / q);
    if t0 < t1 { [t0, t1] } else { [t1, t0] }
}

/// Angle of a vector about the axis, in turns in \[0, 1\].
#[inline]
fn turn(v: DVec2) -> f32 {
    let turn = v.y.atan2(v.x) / TAU;
    (if turn < 0.0 { turn + 1.0 } else { turn }) as f32
}
