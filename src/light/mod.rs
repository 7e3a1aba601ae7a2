//! Lights, and choosing one.

use crate::bsdf::Pdf;
use crate::spectrum::Spectrum;
use glam::Vec3;

/// Light drawn towards a point: Lₑ (or intensity over squared distance, or irradiance) that arrives from `wi`.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Direction from the point to the light, unit, world space.
    pub wi: Vec3,
    /// Where a shadow ray ends: for an area light the drawn point, moved off its surface towards the receiver by its
    /// error bound (`math::offset_origin`), so that the light does not shadow itself at any scale; for point and spot
    /// lights their place; `None` for light from infinity.
    pub end: Option<Vec3>,
    /// Arriving radiance \[W·sr⁻¹·m⁻²\]; for delta lights irradiance perpendicular to `wi` \[W/m²\].
    pub le: Spectrum,
    /// Density over solid angle at the point, or the probability of a delta light; the choice among lights included
    /// where the sample was drawn from all of them.
    pub pdf: Pdf,
}
