//! Our own lobes as scattering functions under test.

use super::{Density, Draw, Rgb, Scattering};
use crate::bsdf::{Bsdf, Pdf, Transport};
use crate::spectrum::Spectrum;
use glam::DVec3;

fn rgb(s: Spectrum) -> Rgb {
    s.to_rgb().map(f64::from)
}

/// In importance transport: energy out per energy in.
impl Scattering for Bsdf {
    fn sample(&self, wo: DVec3, [uc, u, v]: [f32; 3]) -> Option<Draw> {
        let s = Bsdf::sample(self, wo.as_vec3(), uc, [u, v], Transport::Importance)?;
        let density = match s.pdf {
            Pdf::SolidAngle(pdf) => Density::SolidAngle(pdf.into()),
            Pdf::Discrete(p) => Density::Discrete(p.into()),
        };
        Some(Draw { wi: s.wi.as_dvec3(), weight: rgb(s.weight), density, eta: s.eta.into() })
    }

    fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb {
        self.both(wo, wi).0
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.both(wo, wi).1
    }

    fn both(&self, wo: DVec3, wi: DVec3) -> (Rgb, f64) {
        let e = Bsdf::eval(self, wo.as_vec3(), wi.as_vec3(), Transport::Importance);
        (rgb(e.f), e.pdf.into())
    }

    fn pdf_rev(&self, wo: DVec3, wi: DVec3) -> Option<f64> {
        Some(Bsdf::eval(self, wo.as_vec3(), wi.as_vec3(), Transport::Importance).pdf_rev.into())
    }
}
