//! `[environment]` with `type = "sky"`.

use super::build::Builder;
use super::color::Rgb;
use super::keys::keys;
use super::number::{Fraction, Number};
use super::read::{At, Fault};
use super::short::Each;
use crate::desc::sky::{Instant, SUN_DIAMETER, Sky, sun_position};
use crate::desc::{Environment, Light};
use glam::Mat3;
use std::ops::Range;

keys! {
    /// A clear sky with its sun, computed from the sun's place and the haze. Radiance is in W/(sr m²), noon about 1000 W/m²: `strength` scales both. North is −z, east +x.
    struct ClearSky {
        /// Angle of the sun above the horizon in degrees.
        elevation: Option<At<Number>>,
        /// Direction of the sun in degrees clockwise from north as seen from above. Default 180, south.
        azimuth: Option<At<Number>>,
        /// Latitude in degrees, north positive, with `date` and `time` in place of the elevation and azimuth.
        latitude: Option<At<Number>>,
        /// Longitude in degrees, east positive. Default 0.
        longitude: Number = Number(0.0),
        /// Date, "YYYY-MM-DD".
        date: Option<At<String>>,
        /// Universal time, "HH:MM".
        time: Option<At<String>>,
        /// Optical thickness of air and haze over that of air alone, 1 to 20: 2 to 3 on clear days. Default 2.5.
        turbidity: At<Number> = At { at: 0..0, value: Number(2.5) },
        /// Albedo of the ground, which lights the sky and is seen below the horizon, a number or [r, g, b]. Default 0.3.
        ground: Rgb<Fraction> = Each([Fraction(0.3); 3]),
        /// Whether the sun's disk, 0.533 degrees wide, shines too. Default true.
        sun: bool = true,
    }
}

impl ClearSky {
    /// The environment; its sun is added to the lights.
    pub(super) fn build(
        &self,
        at: &Range<usize>,
        strength: [f32; 3],
        to_world: Mat3,
        b: &mut Builder<'_>,
    ) -> Result<Environment, Fault> {
        let turbidity = self.turbidity.value.0;
        if !(1.0..=20.0).contains(&turbidity) {
            let message = format!("`turbidity` is {turbidity}; expected 1 to 20");
            return Err(Fault::new(&self.turbidity.at, message));
        }
        let [elevation, azimuth] = self.sun_place(at)?;
        let ground = self.ground.0.map(|x| x.0);
        let day = Sky { elevation, azimuth, turbidity: f64::from(turbidity), ground }.compute();
        b.scene.images.push(day.image.into());
        let irradiance: [f32; 3] = std::array::from_fn(|i| day.irradiance[i] * strength[i]);
        if self.sun && irradiance.iter().any(|x| *x > 0.0) {
            let direction = -(to_world * day.to_sun).normalize();
            b.scene.lights.push(Light::Sun { direction, irradiance, diameter: SUN_DIAMETER.to_radians() });
        }
        Ok(Environment { radiance: strength, image: Some(b.scene.images.len() - 1), to_world })
    }

    /// Elevation and azimuth of the sun \[rad\].
    fn sun_place(&self, at: &Range<usize>) -> Result<[f64; 2], Fault> {
        let radians = |x: Number| f64::from(x.0).to_radians();
        match (&self.elevation, &self.latitude, &self.date, &self.time) {
            (Some(elevation), None, None, None) => {
                if elevation.value.0.abs() > 90.0 {
                    let message = format!("`elevation` is {}; expected -90 to 90", elevation.value.0);
                    return Err(Fault::new(&elevation.at, message));
                }
                Ok([radians(elevation.value), self.azimuth.as_ref().map_or(std::f64::consts::PI, |a| radians(a.value))])
            }
            (None, Some(latitude), Some(date), Some(time)) if self.azimuth.is_none() => {
                if latitude.value.0.abs() > 90.0 {
                    let message = format!("`latitude` is {}; expected -90 to 90", latitude.value.0);
                    return Err(Fault::new(&latitude.at, message));
                }
                Ok(sun_position(radians(latitude.value), radians(self.longitude), &instant(date, time)?))
            }
            _ => Err(Fault::new(at, "the sky needs either `elevation` or `latitude`, `date` and `time`")),
        }
    }
}

fn instant(date: &At<String>, time: &At<String>) -> Result<Instant, Fault> {
    let parts = |text: &str, mark: char| text.split(mark).map(|p| p.parse().ok()).collect::<Option<Vec<u32>>>();
    let Some([year @ 1901..=2099, month @ 1..=12, day @ 1..=31]) =
        parts(&date.value, '-').as_deref().and_then(|p| p.first_chunk::<3>().copied().filter(|_| p.len() == 3))
    else {
        return Err(Fault::new(
            &date.at,
            format!("`date` is `{}`; expected \"YYYY-MM-DD\" from 1901 to 2099", date.value),
        ));
    };
    let Some([hour @ 0..=24, minute @ 0..=59]) =
        parts(&time.value, ':').as_deref().and_then(|p| p.first_chunk::<2>().copied().filter(|_| p.len() == 2))
    else {
        return Err(Fault::new(&time.at, format!("`time` is `{}`; expected \"HH:MM\"", time.value)));
    };
    Ok(Instant { year: year as i32, month, day, hours: f64::from(hour) + f64::from(minute) / 60.0 })
}
