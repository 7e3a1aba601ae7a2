//! What is laid over a metallic-roughness base, in the order of glTF: the base, sheen, a clear coat.
//!
//! This is the one place where layers are stacked. The base hands over its lobes, whatever they are; anisotropy turns
//! them about the normal; sheen covers them, and the coat covers both ([`crate::bsdf::Layer`] says how). The coat has the
//! index 1.5 and a normal of its own: that of its map, or of the shape where it has none.
//!
//! A coat lies on both sides of a surface, as its opaque lobes do.

use super::metallic_roughness::MetallicRoughness;
use super::param::{self, Point};
use super::roughness::Microsurface;
use super::tangent_space_normal;
use crate::bsdf::{Bsdf, Fresnel, Layer, Lobe, Mirror, RoughReflection, Sheen, SheenAlbedo};
use crate::desc::{self, NormalMap, Roughness};
use crate::math::Frame;
use crate::shape::Surface;
use crate::spectrum::Spectrum;
use glam::{Vec2, Vec3, Vec3A};

/// F₀ of the index 1.5.
const COAT_F0: f32 = 0.04;

/// A base with its layers.
#[derive(Clone, Debug)]
pub(super) struct Layered {
    base: MetallicRoughness,
    anisotropy: Option<desc::Anisotropy>,
    sheen: Option<desc::Sheen>,
    coat: Option<(desc::Clearcoat, Microsurface)>,
}

/// Where a layered material is evaluated, beside its parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lie<'a> {
    /// The hit.
    pub surface: &'a Surface,
    /// What bends the normal of the base.
    pub normal_map: Option<&'a NormalMap>,
}

impl Layered {
    pub(super) fn new(desc: &desc::MetallicRoughness) -> Self {
        let layers = &desc.layers;
        let coat = layers.clearcoat.map(|coat| (coat, Microsurface::new(Roughness::Perceptual(coat.roughness))));
        let base = MetallicRoughness::new(desc);
        let anisotropy = layers.anisotropy.filter(|a| a.strength.factor > 0.0);
        if layers.sheen.is_some() {
            SheenAlbedo::prepare();
        }
        Self { base, anisotropy, sheen: layers.sheen, coat }
    }

    /// Whether the lobes are constant over the surface, but for a coat that does not follow the normal of the base.
    pub(super) fn is_constant(&self) -> bool {
        let untextured = |p: &desc::ScalarParam| p.texture.is_none();
        self.base.is_constant()
            && self.anisotropy.is_none_or(|a| a.direction.is_none())
            && self.sheen.is_none_or(|s| param::is_constant(&s.color) && untextured(&s.roughness))
            && self.coat.as_ref().is_none_or(|(coat, micro)| {
                untextured(&coat.factor) && micro.is_constant() && coat.normal_map.is_none()
            })
    }

    /// Adds the lobes and layers, `scale` times.
    pub(super) fn put(&self, at: Point, lie: Lie, scale: f32, bsdf: &mut Bsdf) {
        let tilt = self.coat.as_ref().and_then(|(coat, _)| tilt(coat, lie, at));
        if bsdf.is_empty() && scale == 1.0 {
            self.stack(at, tilt, bsdf);
        } else {
            let mut own = Bsdf::new();
            self.stack(at, tilt, &mut own);
            bsdf.add(&own, scale);
        }
    }

    /// Base, sheen, coat, where the normal of the coat is that of the base.
    pub(super) fn fixed(&self, at: Point, bsdf: &mut Bsdf) {
        self.stack(at, None, bsdf);
    }

    /// Base, sheen, coat; the coat with its normal where that is not the normal of the base.
    fn stack(&self, at: Point, tilt: Option<Vec3>, bsdf: &mut Bsdf) {
        let turned = self.anisotropy.map(|a| direction(&a, at));
        self.base.lobes(at, |lobe, scale| {
            bsdf.push_in(turned.as_ref(), lobe, scale);
        });

        if let Some(sheen) = &self.sheen {
            let color = param::share(&sheen.color, at);
            if !color.is_black() {
                let albedo = SheenAlbedo::new(param::scalar(&sheen.roughness, at));
                bsdf.cover(0, Layer::sheen(color.max_element(), albedo));
                bsdf.push(Lobe::Sheen(Sheen::new(color, albedo)), 1.0);
            }
        }

        if let Some((coat, micro)) = &self.coat {
            let factor = param::scalar(&coat.factor, at);
            if factor > 0.0 {
                let (fresnel, micro) = (Fresnel::schlick(Spectrum::splat(COAT_F0), 1.0), micro.at(at));
                bsdf.cover(0, Layer::coat(factor, COAT_F0, micro.map(|m| *m.energy()), tilt));
                let lobe = match micro {
                    None => Lobe::Mirror(Mirror { fresnel }),
                    Some(micro) => Lobe::RoughReflection(RoughReflection::new(micro, fresnel)),
                };
                bsdf.push_in(tilt.map(Frame::from_z).as_ref(), lobe, factor);
            }
        }
    }
}

/// The frame whose x is the direction of the anisotropy.
fn direction(a: &desc::Anisotropy, at: Point) -> Frame {
    let along = a.direction.map_or(Vec2::X, |texture| {
        let rg = at.textures.lookup(&texture, at.uv).truncate().truncate();
        (rg * 2.0 - Vec2::ONE).normalize_or(Vec2::X)
    });
    let along = Vec2::from_angle(a.rotation).rotate(along);
    Frame { s: along.extend(0.0).into(), t: along.perp().extend(0.0).into(), n: Vec3A::Z }
}

/// Normal of the coat in the shading frame; `None` where it is the same as that of the base.
fn tilt(coat: &desc::Clearcoat, lie: Lie, at: Point) -> Option<Vec3> {
    if coat.normal_map.is_none() && lie.normal_map.is_none() {
        return None;
    }
    let s = lie.surface;
    let normal =
        |map: Option<&NormalMap>| map.and_then(|map| tangent_space_normal(map, s, at.textures)).unwrap_or(s.ns);
    let n = Frame::from_z_tangent(normal(lie.normal_map), s.tangent, s.handedness)
        .to_local(normal(coat.normal_map.as_ref()))
        .normalize_or(Vec3::Z);
    // Sines that f32 does not tell from 0.
    (n.truncate().length_squared() > 1e-10).then_some(n)
}
