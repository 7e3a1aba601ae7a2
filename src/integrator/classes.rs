//! The four transport mechanisms: light by the classes of its last two reflections before the eye.

use crate::spectrum::Spectrum;

/// Which share of the throughput went through specular lobes at the two reflections nearest to the eye. A BSDF may
/// hold diffuse and specular lobes at once: then the shares are fractions of its value, so that the classes sum
/// to the whole for every sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct Classes {
    /// Specular share of the reflection nearest to the eye, then of the one before it.
    specular: [Spectrum; 2],
    /// Reflections so far.
    reflections: u32,
}

impl Classes {
    /// After one more reflection, of whose `value` the part `specular` is specular lobes'.
    #[must_use]
    pub fn reflected(mut self, value: Spectrum, specular: Spectrum) -> Self {
        if let Some(share) = self.specular.get_mut(self.reflections as usize) {
            *share = specular.div_or_zero(value);
        }
        self.reflections += 1;
        self
    }

    /// Adds `radiance` to its classes, in the order of [`crate::film::CLASSES`]. `SD`: reflected specularly, then
    /// diffusely, then seen: a caustic.
    pub fn split(&self, radiance: Spectrum, to: &mut [Spectrum; 7]) {
        let [s1, s2] = self.specular;
        match self.reflections {
            0 => to[0] += radiance,
            1 => {
                let specular = radiance * s1;
                to[1] += radiance - specular;
                to[2] += specular;
            }
            _ => {
                let last_specular = radiance * s1;
                let last_diffuse = radiance - last_specular;
                let sd = last_diffuse * s2;
                let ss = last_specular * s2;
                to[3] += last_diffuse - sd;
                to[4] += sd;
                to[5] += last_specular - ss;
                to[6] += ss;
            }
        }
    }

    /// Reflections so far.
    pub fn reflections(&self) -> u32 {
        self.reflections
    }
}
