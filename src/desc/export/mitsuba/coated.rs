//! A diffuse base under a dielectric coat.
//!
//! `roughplastic` loses what its microfacets scatter more than once, twice: a white base of α = 0.5 reflects 0.54 of the light.
//! `principled` reflects more than it receives. So the two lobes stand side by side,
//!
//! ```text
//! f = c · (coat/c) + (1 − c) · (base/(1 − c)),
//! ```
//!
//! in a `blendbsdf` of weight c, with reflectances that may exceed 1. The coat is `roughconductor` of κ = 0, whose reflectance
//! is a dielectric's. The base is ρ T(ωo) T(ωi)/(1 − E_avg), T = 1 − E the share that passes the coat: smooth, that is
//! `plastic`'s without its non-linear term; the rougher the coat, the less E rises towards grazing angles, and the nearer is
//! the base to Lambert's. The blend of both has E at one grazing angle right, and E_avg.

use super::super::ExportError;
use super::super::fit;
use super::super::micro::Micro;
use super::super::value::{Color, Scalar};
use super::material::{Writer, alphas, blend, diffuse, two_sided};
use super::xml::Element;
use crate::bsdf::Fresnel;
use crate::desc::{ColorParam, Roughness};
use crate::spectrum::Spectrum;
use glam::Vec3;

/// Weight c of the coat: how often it is drawn.
const COAT: f32 = 0.25;

/// Cosine of the grazing angle.
const GRAZING: f32 = 0.2;

/// The base of this albedo under a coat of this F₀ per lane.
pub(super) fn coated(
    w: &mut Writer,
    base: &ColorParam,
    roughness: &Roughness,
    f0: [f32; 3],
) -> Result<Element, ExportError> {
    let strongest = f0.into_iter().fold(0.0, f32::max).clamp(0.0, 0.98);
    if strongest <= 1e-6 {
        return Ok(two_sided(diffuse(&w.share(base)?)));
    }
    if f0.iter().any(|x| *x != f0[0]) {
        w.note("under its coloured coat the base is dimmed in all lanes as in that of the strongest reflection");
    }
    let eta = fit::index(strongest);
    let micro = w.micro(roughness)?;
    let tint = Color::Constant(f0.map(|x| (x / strongest).clamp(0.0, 1.0)));
    let plastic = |base: &Color, tint: &Color| {
        let plastic = Element::bsdf("plastic").float("int_ior", eta).float("ext_ior", 1.0).boolean("nonlinear", false);
        plastic.unbounded("diffuse_reflectance", base).unbounded("specular_reflectance", tint)
    };
    if micro == Micro::Smooth {
        return Ok(two_sided(plastic(&w.share(base)?, &tint)));
    }

    // How much of the base is Lambert's, and what of the light reaches it.
    let (like_plastic, passed) = share(w.alpha_of(&micro), strongest);
    let scaled = |k: f32| ColorParam { factor: base.factor.map(|x| x.clamp(0.0, 1.0) * k), ..*base };
    let clear = w.beside.radiance(&scaled(1.0 / (1.0 - COAT)))?;
    let matte = w.beside.radiance(&scaled(passed / (1.0 - COAT)))?;
    let none = Color::Constant([0.0; 3]);
    let matte = Element::bsdf("diffuse").unbounded("reflectance", &matte);
    // Without light to share out, `plastic` divides by 0.
    let base = match &clear {
        Color::Constant([0.0, 0.0, 0.0]) => matte,
        clear => blend(matte, plastic(clear, &none), &Scalar::Constant(like_plastic)),
    };

    let coat = Element::bsdf("roughconductor").string("distribution", "ggx").float("eta", eta).float("k", 0.0);
    let coat = alphas(coat, &micro).unbounded(
        "specular_reflectance",
        &match tint {
            Color::Constant(tint) => Color::Constant(tint.map(|x| x / COAT)),
            other => other,
        },
    );
    w.note("its diffuse base under the rough coat is a blend of smooth plastic and Lambert");
    Ok(two_sided(blend(base, coat, &Scalar::Constant(COAT))))
}

/// Share of the base that is smooth plastic's, and the albedo of the rest where the base is white.
fn share(alpha: f32, f0: f32) -> (f32, f32) {
    let fresnel = Fresnel::schlick(Spectrum::splat(f0), 1.0);
    let coat = fit::rough(alpha, [f0; 3]);
    let at = |cos: f32| 1.0 - coat.transmitted(Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)).0.x;
    let smooth = |cos: f32| fresnel.eval(cos).0.x;
    let share = ((at(GRAZING) - at(1.0)) / (smooth(GRAZING) - smooth(1.0))).clamp(0.0, 1.0);
    // Both together let pass what the coat does.
    let (passed, clear) = (coat.transmitted_average().0.x, 1.0 - fresnel.average().0.x);
    let matte = if share < 1.0 { (passed - share * clear) / (1.0 - share) } else { 1.0 };
    (share, matte.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn the_rougher_the_coat_the_nearer_is_the_base_to_lambert_s() {
        let [smooth, rough] = [0.02, 0.5].map(|alpha| share(alpha, 0.04));
        assert!(smooth.0 > 0.85 && rough.0 < 0.3, "{smooth:?} {rough:?}");
        assert!(rough.1 > 0.93 && rough.1 < 0.98, "{rough:?}");
    }
}
