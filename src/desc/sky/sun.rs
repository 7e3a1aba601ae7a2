//! Where the sun stands.

/// A moment in universal time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Of the Gregorian calendar.
    pub year: i32,
    /// 1 to 12.
    pub month: u32,
    /// 1 to 31.
    pub day: u32,
    /// Since midnight UTC.
    pub hours: f64,
}

impl Instant {
    /// Days since 2000-01-01 12:00 UTC (Fliegel & Van Flandern 1968).
    fn days(&self) -> f64 {
        let (y, m, d) = (i64::from(self.year), i64::from(self.month), i64::from(self.day));
        let a = (m - 14) / 12;
        let julian =
            (1461 * (y + 4800 + a)) / 4 + (367 * (m - 2 - 12 * a)) / 12 - (3 * ((y + 4900 + a) / 100)) / 4 + d - 32075;
        (julian - 2_451_545) as f64 + (self.hours - 12.0) / 24.0
    }
}

/// Elevation and azimuth (clockwise from north) of the sun \[rad\], at a latitude and an eastern longitude \[rad\], without
/// refraction: the low-precision formulas of the Astronomical Almanac, good to a hundredth of a degree from 1950 to 2050.
pub fn sun_position(latitude: f64, longitude: f64, at: &Instant) -> [f64; 2] {
    let n = at.days();
    let mean_longitude = (280.460 + 0.985_647_4 * n).to_radians();
    let anomaly = (357.528 + 0.985_600_3 * n).to_radians();
    let ecliptic = mean_longitude + (1.915 * anomaly.sin() + 0.020 * (2.0 * anomaly).sin()).to_radians();
    let obliquity = (23.439 - 4e-7 * n).to_radians();
    let ascension = (obliquity.cos() * ecliptic.sin()).atan2(ecliptic.cos());
    let declination = (obliquity.sin() * ecliptic.sin()).asin();
    let sidereal = (15.0 * (18.697_374_558 + 24.065_709_824_419_08 * n)).to_radians();
    let hour = sidereal + longitude - ascension;
    let up = latitude.sin() * declination.sin() + latitude.cos() * declination.cos() * hour.cos();
    let east = -declination.cos() * hour.sin();
    let north = declination.sin() * latitude.cos() - declination.cos() * hour.cos() * latitude.sin();
    [up.clamp(-1.0, 1.0).asin(), east.atan2(north).rem_euclid(std::f64::consts::TAU)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At the solstices the sun culminates at 90° − latitude ± 23.44°; at the equinox it rises in the east. The equation of
    /// time moves noon by less than a degree at these dates.
    #[test]
    fn the_sun_keeps_its_calendar() {
        let noon = |month, day| {
            let at = Instant { year: 2024, month, day, hours: 12.0 };
            sun_position(50f64.to_radians(), 0.0, &at).map(f64::to_degrees)
        };
        let ([june, south], [december, _]) = (noon(6, 20), noon(12, 21));
        assert!((june - 63.44).abs() < 0.02 && (december - 16.56).abs() < 0.05, "{june} {december}");
        assert!((south - 180.0).abs() < 2.0, "{south}");
        let dawn = Instant { year: 2024, month: 3, day: 20, hours: 6.1 };
        let [up, east] = sun_position(0.0, 0.0, &dawn).map(f64::to_degrees);
        assert!(up.abs() < 1.0 && (east - 90.0).abs() < 0.5, "{up} {east}");
        assert_eq!(Instant { year: 2000, month: 1, day: 1, hours: 12.0 }.days(), 0.0);
        assert_eq!(Instant { year: 2024, month: 2, day: 29, hours: 0.0 }.days(), 8824.5);
    }
}
