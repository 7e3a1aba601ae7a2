//! IES LM-63 photometric files (1986, 1991, 1995, 2002, 2019): intensity against direction.
//!
//! The keywords before `TILT=` are passed over. The candela values are multiplied by the file's multiplier, its ballast
//! factor and, up to 1995, its ballast-lamp photometric factor; what later editions have in that place is no factor. A
//! tilt (`TILT=INCLUDE`, or the name of a file) is a factor that depends on how the luminaire hangs: see [`Tilt`].
//! Dimensions of the luminous opening are passed over: light leaves a point.

use glam::{Mat3, Vec3};

/// Intensity against direction, as measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// How angles span the sphere.
    pub kind: Photometry,
    /// Vertical angles, ascending \[degrees\].
    pub vertical: Vec<f32>,
    /// Horizontal angles, ascending \[degrees\].
    pub horizontal: Vec<f32>,
    /// Intensities \[cd\], for each horizontal angle those of all vertical ones; all factors but the tilt's applied.
    pub candela: Vec<f32>,
    /// How the output depends on the luminaire's tilt; `None`: not at all.
    pub tilt: Option<Tilt>,
}

/// Output of a lamp that burns more or less brightly as it is tilted (discharge lamps), as a factor on all intensities:
/// piecewise linear between the angles, and as at the nearest one beyond them.
///
/// The angle is that between the luminaire's aim and straight down, for which it was measured. Which way the lamp lies in the
/// luminaire (vertical, horizontal and staying so, or tilting with it) only says why the factors are what they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Tilt {
    /// Angles \[degrees\], ascending; at least one.
    pub angles: Vec<f32>,
    /// The factor at each.
    pub factors: Vec<f32>,
}

impl Tilt {
    /// The factor at an angle \[degrees\].
    pub fn factor(&self, angle: f32) -> f32 {
        let last = self.angles.len() - 1;
        let i = self.angles.partition_point(|a| *a <= angle);
        if i == 0 || i > last {
            return self.factors[i.min(last)];
        }
        let t = (angle - self.angles[i - 1]) / (self.angles[i] - self.angles[i - 1]);
        self.factors[i - 1] + t * (self.factors[i] - self.factors[i - 1])
    }
}

impl Profile {
    /// The factor of the tilt of a luminaire whose frame, in which it aims along −z, is turned to the world by `to_world`;
    /// straight down in the world is −y.
    pub fn tilt_factor(&self, to_world: Mat3) -> f32 {
        // atan2 keeps small angles, of which acos loses half the digits.
        let aim = -to_world.z_axis;
        let angle = aim.cross(Vec3::NEG_Y).length().atan2(-aim.y);
        self.tilt.as_ref().map_or(1.0, |tilt| tilt.factor(angle.to_degrees()))
    }
}

/// Which way the axes of the goniometer stood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Photometry {
    /// Polar axis up, light aimed at the horizon (vehicles): vertical angle = elevation.
    A,
    /// Polar axis horizontal (floodlights): horizontal angle = elevation above the plane across that axis.
    B,
    /// Polar axis along the aim (luminaires): vertical angle = angle from the aim, usually straight down.
    C,
}

/// The frame of a profile whose z axis (away from the aim) is the unit vector `z` and whose x axis is as near to `x` as may
/// be: the right-handed rotation to the world.
pub fn frame(z: Vec3, x: Vec3) -> Mat3 {
    let across = (x - z * z.dot(x)).try_normalize().unwrap_or(z.any_orthonormal_vector());
    Mat3::from_cols(across, z.cross(across), z)
}

/// Reads a file that stands alone; the error names the line, what was found and what was expected.
pub fn parse(bytes: &[u8]) -> Result<Profile, String> {
    parse_beside(bytes, &|_| Err("a profile in memory has no files beside it".into()))
}

/// Reads a file like [`parse`]; `beside` reads the file of a tilt, which is named relative to this one.
pub fn parse_beside(bytes: &[u8], beside: &dyn Fn(&str) -> Result<Vec<u8>, String>) -> Result<Profile, String> {
    let text = String::from_utf8_lossy(bytes);
    let upper = |line: &str| line.trim().to_ascii_uppercase();
    let Some(tilt) = text.lines().position(|line| upper(line).starts_with("TILT=")) else {
        return Err("has no line `TILT=…`; expected an IES LM-63 file".into());
    };
    let edition = text.lines().next().map(upper).unwrap_or_default();
    let later = ["LM-63-2002", "LM-63-2019"].iter().any(|name| edition.contains(name));
    let mut numbers = Numbers { tokens: tokens(&text, tilt + 1), line: tilt + 1 };
    let source = text.lines().nth(tilt).and_then(|line| line.trim().get(5..)).unwrap_or_default().trim();
    let tilt = match &*source.to_ascii_uppercase() {
        "NONE" | "" => None,
        "INCLUDE" => Some(numbers.tilt()?),
        _ => {
            let says = |message: String| format!("line {}: the tilt's file `{source}`: {message}", tilt + 1);
            let bytes = beside(source).map_err(says)?;
            let text = String::from_utf8_lossy(&bytes);
            Some(Numbers { tokens: tokens(&text, 0), line: 1 }.tilt().map_err(says)?)
        }
    };

    // Ten numbers of the luminaire, three of its ballast.
    numbers.next("the number of lamps")?;
    numbers.next("the lumens of a lamp")?;
    let mut factor = numbers.not_negative("the candela multiplier")?;
    let vertical = numbers.count("the number of vertical angles")?;
    let horizontal = numbers.count("the number of horizontal angles")?;
    let kind = match numbers.next("the photometric type")? {
        3.0 => Photometry::A,
        2.0 => Photometry::B,
        1.0 => Photometry::C,
        other => return Err(numbers.says(format!("the photometric type is {other}; expected 1, 2 or 3"))),
    };
    for what in ["the type of units", "the width", "the length", "the height"] {
        numbers.next(what)?;
    }
    factor *= numbers.not_negative("the ballast factor")?;
    let third = numbers.not_negative("the ballast-lamp factor")?;
    factor *= if later { 1.0 } else { third };
    numbers.next("the watts")?;

    let vertical = numbers.angles("vertical", vertical)?;
    let horizontal = numbers.angles("horizontal", horizontal)?;
    range(kind, &vertical, &horizontal).map_err(|message| numbers.says(message))?;
    let mut candela = Vec::new();
    for _ in 0..vertical.len() * horizontal.len() {
        let value = numbers.not_negative("a candela value")? * factor;
        let value = value as f32;
        if !value.is_finite() {
            return Err(numbers.says("a candela value times its factors is beyond f32".into()));
        }
        candela.push(value);
    }
    Ok(Profile { kind, vertical, horizontal, candela, tilt })
}

/// The words of a text from line `skip` on, with the numbers of their lines.
fn tokens(text: &str, skip: usize) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().skip(skip).flat_map(|(i, line)| {
        line.split(|c: char| c.is_whitespace() || c == ',').filter(|t| !t.is_empty()).map(move |t| (i + 1, t))
    })
}

/// What is wrong with a profile that was put together elsewhere, if anything.
pub(super) fn check(profile: &Profile) -> Result<(), String> {
    let Profile { kind, vertical, horizontal, candela, tilt } = profile;
    let tilted = tilt.as_ref().map(|tilt| ("tilt", &tilt.angles));
    for (which, angles) in [("vertical", vertical), ("horizontal", horizontal)].into_iter().chain(tilted) {
        if angles.is_empty() {
            return Err(format!("there are no {which} angles; expected at least one"));
        }
        if !angles.is_sorted_by(|a, b| a < b) {
            return Err(format!("the {which} angles do not ascend"));
        }
    }
    if let Some(Tilt { angles, factors }) = tilt
        && angles.len() != factors.len()
    {
        return Err(format!("there are {} factors of the tilt; expected {}", factors.len(), angles.len()));
    }
    let expected = vertical.len() * horizontal.len();
    if candela.len() != expected {
        return Err(format!("there are {} intensities; expected {expected}", candela.len()));
    }
    range(*kind, vertical, horizontal)
}

/// Whether the angles are those of the photometric type.
fn range(kind: Photometry, vertical: &[f32], horizontal: &[f32]) -> Result<(), String> {
    let ends = |angles: &[f32]| (angles[0], angles[angles.len() - 1]);
    let ((v0, v1), (h0, h1)) = (ends(vertical), ends(horizontal));
    let (low, high) = if kind == Photometry::C { (0.0, 180.0) } else { (-90.0, 90.0) };
    if v0 < low || v1 > high {
        return Err(format!("the vertical angles are {v0} to {v1}; expected some of [{low}, {high}]"));
    }
    let whole = match kind {
        Photometry::C => (h0 == 0.0 && [0.0, 90.0, 180.0, 360.0].contains(&h1)) || (h0, h1) == (90.0, 270.0),
        Photometry::A | Photometry::B => h0 >= -90.0 && h1 <= 90.0,
    };
    let expected = match kind {
        Photometry::C => "0 to 0, 90, 180 or 360, or 90 to 270",
        Photometry::A | Photometry::B => "some of [-90, 90]",
    };
    if whole { Ok(()) } else { Err(format!("the horizontal angles are {h0} to {h1}; expected {expected}")) }
}

/// The numbers of a file with their lines.
struct Numbers<T> {
    tokens: T,
    /// Of the last number.
    line: usize,
}

impl<'a, T: Iterator<Item = (usize, &'a str)>> Numbers<T> {
    fn says(&self, message: String) -> String {
        format!("line {}: {message}", self.line)
    }

    fn next(&mut self, what: &str) -> Result<f64, String> {
        let Some((line, token)) = self.tokens.next() else {
            return Err(self.says(format!("the file ends; expected {what}")));
        };
        self.line = line;
        let number = token.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| {
            let token: String = token.chars().take(20).collect();
            self.says(format!("`{token}` is no number; expected {what}"))
        })
    }

    fn not_negative(&mut self, what: &str) -> Result<f64, String> {
        let x = self.next(what)?;
        if x < 0.0 { Err(self.says(format!("{what} is {x}; expected no negative number"))) } else { Ok(x) }
    }

    fn count(&mut self, what: &str) -> Result<u32, String> {
        let x = self.next(what)?;
        let fits = x >= 1.0 && x <= f64::from(u16::MAX) && x.fract() == 0.0;
        if fits { Ok(x as u32) } else { Err(self.says(format!("{what} is {x}; expected 1 to {}", u16::MAX))) }
    }

    /// The lamp's position in the luminaire, and pairs of angles and factors.
    fn tilt(&mut self) -> Result<Tilt, String> {
        let position = self.next("the lamp's position")?;
        if ![1.0, 2.0, 3.0].contains(&position) {
            return Err(self.says(format!("the lamp's position is {position}; expected 1, 2 or 3")));
        }
        let pairs = self.count("the number of tilt angles")?;
        let angles = self.angles("tilt", pairs)?;
        let factors = (0..pairs).map(|_| Ok(self.not_negative("a factor of the tilt")? as f32));
        let factors: Vec<f32> = factors.collect::<Result<_, String>>()?;
        match factors.iter().all(|factor| factor.is_finite()) {
            true => Ok(Tilt { angles, factors }),
            false => Err(self.says("a factor of the tilt is beyond f32".into())),
        }
    }

    fn angles(&mut self, which: &str, count: u32) -> Result<Vec<f32>, String> {
        let mut angles: Vec<f32> = Vec::new();
        for _ in 0..count {
            let angle = self.next(&format!("a {which} angle"))? as f32;
            if angles.last().is_some_and(|last| *last >= angle) {
                return Err(self.says(format!("the {which} angle {angle} does not exceed the one before it")));
            }
            angles.push(angle);
        }
        Ok(angles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f32::consts::FRAC_PI_2;

    const FILE: &str = "IESNA:LM-63-2002\n[TEST] none\nTILT=INCLUDE\n1\n2\n0 90\n1, 0.9\n1 1000 2 3 2 1 2 0 0 0\n0.5 1.00001 60\n0 45 90\n0 90\n100 50 0\n80 40 0\n";

    /// Factors by hand: 1 straight down, 0.9 level, and so 0.95 at 45° and 0.97 at 27°.
    #[test]
    fn tilts_are_factors() {
        let mut profile = parse(FILE.as_bytes()).unwrap();
        let hangs = |profile: &Profile, degrees: f32, azimuth: f32| {
            // The aim −z, turned from straight down by the tilt.
            let down = Mat3::from_rotation_x(-FRAC_PI_2);
            profile.tilt_factor(Mat3::from_rotation_y(azimuth) * Mat3::from_rotation_x(degrees.to_radians()) * down)
        };
        for azimuth in [0.0, 1.0, 4.0] {
            for (angle, factor) in [(0.0, 1.0), (27.0, 0.97), (45.0, 0.95), (90.0, 0.9), (180.0, 0.9)] {
                assert!((hangs(&profile, angle, azimuth) - factor).abs() < 1e-6, "{angle}");
            }
        }
        profile.tilt = Some(Tilt { angles: vec![10.0, 30.0, 90.0], factors: vec![2.0, 1.0, 4.0] });
        for (angle, factor) in [(0.0, 2.0), (10.0, 2.0), (20.0, 1.5), (30.0, 1.0), (50.0, 2.0), (120.0, 4.0)] {
            assert!((hangs(&profile, angle, 0.0) - factor).abs() < 1e-5, "{angle}");
        }
        profile.tilt = None;
        assert_eq!(hangs(&profile, 30.0, 0.0), 1.0);
    }

    #[test]
    fn tilts_may_be_files() {
        let file = FILE.replace("TILT=INCLUDE\n1\n2\n0 90\n1, 0.9\n", "TILT=Lamp.tlt\n");
        let read = |bytes: &[u8]| {
            parse_beside(file.as_bytes(), &|name| {
                assert_eq!(name, "Lamp.tlt");
                Ok(bytes.to_vec())
            })
        };
        assert_eq!(read(b"1\n2\n0 90\n1, 0.9\n"), parse(FILE.as_bytes()));
        assert_eq!(
            read(b"1\n2\n0 90\n1").unwrap_err(),
            "line 3: the tilt's file `Lamp.tlt`: line 4: the file ends; expected a factor of the tilt"
        );
        assert_eq!(
            parse(file.as_bytes()).unwrap_err(),
            "line 3: the tilt's file `Lamp.tlt`: a profile in memory has no files beside it"
        );
        assert_eq!(parse(file.replace("Lamp.tlt", "NONE").as_bytes()).unwrap().tilt, None);
    }

    #[test]
    fn profiles_are_read() {
        let profile = parse(FILE.as_bytes()).unwrap();
        assert_eq!((profile.kind, &profile.vertical[..]), (Photometry::C, &[0.0, 45.0, 90.0][..]));
        assert_eq!(profile.candela, [100.0, 50.0, 0.0, 80.0, 40.0, 0.0]);
        // Up to 1995 the third factor counts.
        let older = parse(FILE.replace("2002", "1995").replace("1.00001", "0.1").as_bytes()).unwrap();
        assert!((older.candela[0] - 10.0).abs() < 1e-5);
    }

    #[test]
    fn errors_name_the_line() {
        for (from, to, expected) in [
            ("TILT=INCLUDE", "", "no line `TILT="),
            ("INCLUDE\n1", "INCLUDE\n4", "line 4: the lamp's position is 4; expected 1, 2 or 3"),
            ("1, 0.9", "1, -0.9", "line 7: a factor of the tilt is -0.9"),
            ("0 90\n1,", "0 0\n1,", "line 6: the tilt angle 0 does not exceed"),
            ("80 40 0\n", "80 40", "line 13: the file ends; expected a candela value"),
            ("80 40", "80 x", "line 13: `x` is no number"),
            ("80 40", "80 -4", "line 13: a candela value is -4"),
            ("0 45 90", "0 95 90", "line 10: the vertical angle 90 does not exceed"),
            ("0 90\n100", "0 80\n100", "the horizontal angles are 0 to 80; expected 0 to 0, 90, 180 or 360"),
            ("2 3 2 1 2", "2 3 2 7 2", "line 8: the photometric type is 7"),
            ("2 3 2 1 2", "2 3e9 2 1 2", "line 8: the number of vertical angles is 3000000000"),
        ] {
            assert!(FILE.contains(from), "{from}");
            let error = parse(FILE.replace(from, to).as_bytes()).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }

    proptest! {
        #[test]
        fn any_bytes_end_in_a_profile_or_an_error(at in 0..FILE.len(), byte: u8, cut in 0..FILE.len()) {
            let mut bytes = FILE.as_bytes().to_vec();
            bytes[at] = byte;
            let _ = parse(&bytes);
            let _ = parse(&bytes[..cut]);
        }
    }
}
