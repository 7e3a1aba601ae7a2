//! Film point → ray, and world point → film point.
//!
//! Film points are in pixels, x to the right and y down; pixel (i, j) is the square [i, i + 1) × [j, j + 1). In its own
//! space the camera stands at the origin, looks along −z and has +y up.

mod specimens;

pub use specimens::{SIZE, Specimen, specimens};

use crate::desc::{self, Fov, Lens, Projection};
use crate::math::Ray;
use crate::warp::uniform_disk;
use glam::{Mat3A, Vec2, Vec3, Vec3A};
use std::f32::consts::PI;

/// A camera with its film.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    origin: Vec3A,
    /// Camera space → world.
    rotation: Mat3A,
    /// Width and height of the film in pixels.
    size: Vec2,
    /// From pixels to −1 … 1 across the window, y up.
    to_window: Vec2,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// `half`: half-size of the view window at distance 1.
    Pinhole {
        half: Vec2,
    },
    /// A pinhole with an aperture.
    ThinLens {
        half: Vec2,
        lens: Lens,
    },
    /// `half`: half-size of the view window \[m\].
    Orthographic {
        half: Vec2,
    },
    Equirectangular,
}

impl Camera {
    /// The camera with a film of `size` pixels (width and height). A view angle across one side fixes that side; the
    /// other follows from square pixels.
    pub fn new(camera: &desc::Camera, size: [u32; 2]) -> Self {
        let size = Vec2::from(size.map(|n| n.max(1) as f32));
        let aspect = size.x / size.y;
        let kind = match camera.projection {
            Projection::Perspective { fov } => {
                let half = match fov {
                    Fov::Vertical(angle) => (0.5 * angle).tan() * Vec2::new(aspect, 1.0),
                    Fov::Horizontal(angle) => (0.5 * angle).tan() * Vec2::new(1.0, 1.0 / aspect),
                };
                match camera.lens {
                    Some(lens) if lens.radius > 0.0 => Kind::ThinLens { half, lens },
                    _ => Kind::Pinhole { half },
                }
            }
            Projection::Orthographic { half_height } => {
                Kind::Orthographic { half: half_height * Vec2::new(aspect, 1.0) }
            }
            Projection::Equirectangular => Kind::Equirectangular,
        };
        let axis = |i| camera.to_world.col(i).truncate().normalize_or_zero();
        Self {
            origin: Vec3A::from_vec4(camera.to_world.w_axis),
            rotation: Mat3A::from_cols(axis(0).into(), axis(1).into(), axis(2).into()),
            size,
            to_window: Vec2::new(2.0, -2.0) / size,
            kind,
        }
    }

    /// Where it stands: the pinhole, the middle of the lens, or of the window of parallel rays.
    pub fn middle(&self) -> Vec3A {
        self.origin
    }

    /// Whether [`ray`](Self::ray) looks at its `lens`.
    #[inline]
    pub fn has_lens(&self) -> bool {
        matches!(self.kind, Kind::ThinLens { .. })
    }

    /// The ray through the film point `film` \[px\], of unit direction; `lens` in [0, 1)² chooses the point of the
    /// aperture where there is one.
    #[inline]
    pub fn ray(&self, film: Vec2, lens: [f32; 2]) -> Ray {
        let window = film * self.to_window + Vec2::new(-1.0, 1.0);
        let (o, d) = match self.kind {
            Kind::Pinhole { half } => {
                return Ray::new(self.origin, (self.rotation * Vec3A::from((window * half).extend(-1.0))).normalize());
            }
            Kind::ThinLens { half, lens: Lens { radius, focus_distance } } => {
                // All rays of a film point meet where its chief ray crosses the plane in focus.
                let aperture = (radius * uniform_disk(lens)).extend(0.0);
                (aperture, (window * half).extend(-1.0) * focus_distance - aperture)
            }
            Kind::Orthographic { half } => ((window * half).extend(0.0), Vec3::NEG_Z),
            Kind::Equirectangular => {
                let (sin_longitude, cos_longitude) = (PI * window.x).sin_cos();
                let (sin_latitude, cos_latitude) = (0.5 * PI * window.y).sin_cos();
                (Vec3::ZERO, Vec3::new(sin_longitude * cos_latitude, sin_latitude, -cos_longitude * cos_latitude))
            }
        };
        Ray::new(self.origin + self.rotation * Vec3A::from(o), (self.rotation * Vec3A::from(d)).normalize())
    }

    /// The film point \[px\] where the world point `p` is seen (through the middle of a lens), inside the film or not;
    /// `None` where it lies behind the camera or at its origin.
    pub fn project(&self, p: impl Into<Vec3A>) -> Option<Vec2> {
        let p = Vec3::from(self.rotation.transpose() * (p.into() - self.origin));
        let window = match self.kind {
            Kind::Pinhole { half } | Kind::ThinLens { half, .. } if p.z < 0.0 => p.truncate() / (-p.z * half),
            Kind::Orthographic { half } if p.z <= 0.0 => p.truncate() / half,
            Kind::Equirectangular if p != Vec3::ZERO => {
                let longitude = p.x.atan2(-p.z);
                let latitude = p.y.atan2(p.x.hypot(p.z));
                Vec2::new(longitude / PI, latitude / (0.5 * PI))
            }
            _ => return None,
        };
        let film = 0.5 * (window * Vec2::new(1.0, -1.0) + 1.0) * self.size;
        film.is_finite().then_some(film)
    }

    /// Direction in which the camera looks, unit.
    pub fn axis(&self) -> Vec3A {
        -self.rotation.z_axis
    }

    /// Width and height of the film in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.size.x as u32, self.size.y as u32]
    }

    /// Solid angle of pixel (x, y) seen from the centre of projection \[sr\]; 0 for parallel projection, which has none.
    pub fn pixel_solid_angle(&self, x: u32, y: u32) -> f64 {
        let size = self.size.as_dvec2();
        let (x, y) = (x as f64, y as f64);
        match self.kind {
            Kind::Pinhole { half } | Kind::ThinLens { half, .. } => {
                // A rectangle of the plane z = 1 between the axis and (a, b) has atan(ab/√(1 + a² + b²)).
                let half = half.as_dvec2();
                let corner = |x: f64, y: f64| {
                    let (a, b) = ((2.0 * x / size.x - 1.0) * half.x, (2.0 * y / size.y - 1.0) * half.y);
                    (a * b / (1.0 + a * a + b * b).sqrt()).atan()
                };
                corner(x + 1.0, y + 1.0) - corner(x, y + 1.0) - corner(x + 1.0, y) + corner(x, y)
            }
            Kind::Orthographic { .. } => 0.0,
            Kind::Equirectangular => {
                // Δλ (cos θ₀ − cos θ₁), θ from the pole.
                let cos = |y: f64| (std::f64::consts::PI * y / size.y).cos();
                std::f64::consts::TAU / size.x * (cos(y) - cos(y + 1.0))
            }
        }
    }
}
