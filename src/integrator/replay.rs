//! One path in words.

use super::{Classes, Observer, SampledBy};
use crate::math::Ray;
use crate::scene::{Shading, Vertex};
use crate::spectrum::Spectrum;
use std::fmt::Write;

/// Writes a line for every vertex and every piece of light of a path.
#[derive(Default)]
pub struct Replay {
    /// The lines.
    pub text: String,
}

impl Replay {
    fn line(&mut self, args: std::fmt::Arguments) {
        // Writing to a String cannot fail.
        let _ = self.text.write_fmt(args);
        self.text.push('\n');
    }
}

impl Observer for Replay {
    const CLASSES: bool = true;

    fn light(&mut self, radiance: Spectrum, classes: &Classes) {
        if !radiance.is_black() {
            let n = classes.reflections();
            self.line(format_args!("    + radiance {:?} after {n} reflections", radiance.to_rgb()));
        }
    }

    fn vertex(&mut self, depth: u32, ray: &Ray, vertex: &Vertex, shading: Option<&Shading>, beta: Spectrum) {
        let s = &vertex.surface;
        let distance = (s.p - ray.o).length();
        self.line(format_args!(
            "vertex {depth}: p {:?}, distance {distance}, {} side of material {}, beta {:?}",
            s.p.to_array(),
            if vertex.front { "front" } else { "back" },
            vertex.material,
            beta.to_rgb()
        ));
        self.line(format_args!(
            "    ng {:?}, uv {:?}, wo {:?}",
            s.ng.to_array(),
            s.uv[0].to_array(),
            (-ray.d).to_array()
        ));
        if let Some(shading) = shading {
            self.line(format_args!("    ns {:?}", shading.frame.n.to_array()));
        }
        if let Some(light) = vertex.light {
            self.line(format_args!("    on light {light}"));
        }
    }

    fn escaped(&mut self, depth: u32, ray: &Ray, beta: Spectrum) {
        self.line(format_args!(
            "vertex {depth}: left the scene along {:?}, beta {:?}",
            ray.d.to_array(),
            beta.to_rgb()
        ));
    }

    fn sampled(&mut self, sampled_by: SampledBy, beta: Spectrum) {
        self.line(format_args!("    drawn {sampled_by:?}, beta {:?}", beta.to_rgb()));
    }
}
