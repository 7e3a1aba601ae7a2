//! A vertex with its shading frame and lobes.

use super::{MediumInterface, Vertex};
use crate::bsdf::Bsdf;
use crate::light::{Facing, Receiver};
use crate::material::Material;
use crate::math::{Frame, Ray, offset_origin};
use crate::texture::Textures;
use glam::{Vec3, Vec3A};

/// The BSDF at a vertex. The frame's z is the shading normal on the front side.
#[derive(Clone, Copy, Debug)]
pub struct Shading<'a> {
    /// Where.
    pub vertex: &'a Vertex,
    /// The media on both sides.
    pub interface: &'a MediumInterface,
    /// Shading frame.
    pub frame: Frame,
    /// Towards where the ray came from, local.
    pub wo: Vec3,
    /// The lobes.
    pub bsdf: &'a Bsdf,
    /// (1 − cos β)/2 for a shading normal at the angle β to the geometric one: the share of Lambert's light that it sends
    /// into the surface (the rest is the form factor of a tilted plane to the sky).
    stray: f32,
}

impl<'a> Shading<'a> {
    /// Evaluates the material; lobes that vary over the surface are put into `scratch`.
    #[inline]
    pub fn new(material: &'a Material, vertex: &'a Vertex, textures: &Textures, scratch: &'a mut Bsdf) -> Self {
        static VACUUM: MediumInterface = MediumInterface::VACUUM;
        Self::between(material, vertex, textures, &VACUUM, None, scratch)
    }

    /// Evaluates the material between the media of `interface`, where the index behind the surface over the one before it is
    /// `eta`; `None`: the material's own.
    #[inline(always)]
    pub fn between(
        material: &'a Material,
        vertex: &'a Vertex,
        textures: &Textures,
        interface: &'a MediumInterface,
        eta: Option<f32>,
        scratch: &'a mut Bsdf,
    ) -> Self {
        let s = &vertex.surface;
        let ns = material.shading_normal(s, textures).unwrap_or(s.ns);
        let ns = facing(ns, vertex.wo, vertex.front);
        let frame = Frame::from_z_tangent(ns, s.tangent, s.handedness);
        let wo = frame.to_local(vertex.wo);
        let stray = (0.5 - 0.5 * ns.dot(s.ng)).max(0.0);
        Self { vertex, interface, frame, wo, bsdf: material.bsdf_between(s, wo, textures, eta, scratch), stray }
    }

    /// Whether the world direction `wi` (`local` in the frame) lies on the same side of the surface and of the
    /// shading normal. Where they disagree light would leak through the surface, or reflection into it.
    #[inline]
    pub fn agrees(&self, wi: Vec3A, local: Vec3) -> bool {
        wi.dot(self.vertex.surface.ng) * local.z > 0.0
    }

    /// Who asks for light here: the half-space above the shading normal on the side of `wo` (above the surface, where the
    /// normal is bent: strayed light leaves there), or both where something is transmitted.
    #[inline]
    pub fn receiver(&self) -> Receiver {
        let n = if self.is_bent() { self.vertex.surface.ng } else { self.frame.n };
        let facing = match (self.bsdf.transmits(), self.wo.z < 0.0) {
            (true, _) => Facing::Both(n),
            (false, true) => Facing::Half(-n),
            (false, false) => Facing::Half(n),
        };
        Receiver { p: self.vertex.surface.p, facing }
    }

    /// The shading normal differs from the geometric one by more than rounding.
    #[inline]
    pub fn is_bent(&self) -> bool {
        self.stray > 1e-6
    }

    /// Density \[1/sr\] that stands for strayed light towards the world direction `wi`.
    #[inline]
    pub fn stray_pdf(&self, wi: Vec3A) -> f32 {
        self.stray * wi.dot(self.vertex.surface.ng).abs() * std::f32::consts::FRAC_1_PI
    }

    /// The ray that leaves along the world direction `wi`, off the surface by its error bound.
    #[inline]
    pub fn leave(&self, wi: Vec3A) -> Ray {
        let s = &self.vertex.surface;
        Ray::new(offset_origin(s.p, s.p_error, s.ng, wi), wi)
    }
}

/// A shading normal that sees `wo` from the side from which the surface does. Interpolated and mapped normals near a
/// silhouette may look away; they are turned towards `wo` until they see it at a grazing angle, instead of leaving
/// a black rim.
#[inline]
fn facing(ns: Vec3A, wo: Vec3A, front: bool) -> Vec3A {
    /// Cosine of the grazing angle.
    const GRAZING: f32 = 0.01;
    let side = if front { 1.0 } else { -1.0 };
    let cos = ns.dot(wo) * side;
    if cos > 0.0 {
        return ns;
    }
    (ns + wo * (side * (GRAZING - cos))).normalize_or(wo * side)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_that_look_away_are_turned_to_a_grazing_view() {
        let wo = Vec3A::new(0.6, 0.0, 0.8);
        let away = Vec3A::new(-0.9, 0.1, 0.2).normalize();
        assert!(facing(away, wo, true).dot(wo) > 0.0);
        assert!(facing(-away, wo, false).dot(wo) < 0.0);
        assert_eq!(facing(Vec3A::Z, wo, true), Vec3A::Z);
    }
}
