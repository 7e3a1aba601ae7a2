//! Values on the command line.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use radianza::bvh::Quality;
use radianza::film::{GROUPS, Group};
use std::str::FromStr;
use std::time::Duration;

/// Longest side of an image.
const MAX_SIDE: u32 = 65_536;

/// `60s`, `2m`, `1h30m`, `1.5m`, or plain seconds.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let expected = || format!("`{text}` is no time; expected for example 60s, 2m or 1h30m");
    let (mut seconds, mut rest, mut last) = (0.0, text, f64::INFINITY);
    while !rest.is_empty() {
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let number: f64 = rest[..digits].parse().map_err(|_| expected())?;
        let unit = match rest[digits..].chars().next() {
            Some('h') => 3600.0,
            Some('m') => 60.0,
            Some('s') => 1.0,
            None if digits == text.len() => 1.0,
            _ => return Err(expected()),
        };
        // Units come once each, the largest first.
        if unit >= last {
            return Err(expected());
        }
        (seconds, last) = (seconds + number * unit, unit);
        rest = rest.get(digits + 1..).unwrap_or("");
    }
    match Duration::try_from_secs_f64(seconds) {
        Ok(duration) if !duration.is_zero() => Ok(duration),
        _ => Err(expected()),
    }
}

/// `WxH` in pixels.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let expected = || format!("`{text}` is no size; expected WIDTHxHEIGHT, each from 1 to {MAX_SIDE}");
    let (w, h) = text.split_once(['x', '×']).ok_or_else(expected)?;
    let side = |s: &str| s.parse().ok().filter(|n| (1..=MAX_SIDE).contains(n)).ok_or_else(expected);
    Ok([side(w)?, side(h)?])
}

/// `x0,y0,x1,y1` in pixels, upper ends excluded.
pub(crate) fn crop(text: &str) -> Result<[u32; 4], String> {
    let crop @ [x0, y0, x1, y1] = numbers(text).ok_or_else(|| format!("`{text}` is not of the form x0,y0,x1,y1"))?;
    if x0 >= x1 || y0 >= y1 {
        return Err(format!("`{text}` holds no pixel; upper ends are excluded"));
    }
    Ok(crop)
}

/// `X,Y,INDEX`: one sample of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Replay {
    /// Column and row.
    pub(crate) pixel: [u32; 2],
    /// Sample index.
    pub(crate) index: u64,
}

impl FromStr for Replay {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let fail = || format!("`{text}` is not of the form X,Y,INDEX");
        let [x, y, index] = numbers::<u64, 3>(text).ok_or_else(fail)?;
        let side = |n: u64| u32::try_from(n).map_err(|_| fail());
        Ok(Self { pixel: [side(x)?, side(y)?], index })
    }
}

fn numbers<T: FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    let numbers: Option<Vec<T>> = text.split(',').map(|s| s.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// A group of layers by its name, as the film lists them.
pub(crate) fn layers() -> impl TypedValueParser<Value = &'static Group> {
    let names = GROUPS.iter().map(|group| PossibleValue::new(group.name).help(group.about));
    let found = |name: String| Group::named(&name).ok_or("no such layer");
    PossibleValuesParser::new(names).try_map(found)
}

/// A quality of hierarchies by its name.
pub(crate) fn quality(text: &str) -> Result<Quality, String> {
    let found = Quality::ALL.into_iter().find(|(_, name)| *name == text);
    found
        .map(|(quality, _)| quality)
        .ok_or_else(|| format!("`{text}` is no quality; expected {}", Quality::ALL.map(|(_, name)| name).join(", ")))
}

/// An exposure or a threshold: any finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| format!("`{text}` is no finite number"))
}

/// A significance: what lies between impossible and certain.
pub(crate) fn significance(text: &str) -> Result<f64, String> {
    let inside = |p: &f64| *p > 0.0 && *p < 1.0;
    text.parse()
        .ok()
        .filter(inside)
        .ok_or_else(|| format!("`{text}` is no probability between 0 and 1, for example 1e-4"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations() {
        for (text, seconds) in
            [("60s", 60.0), ("2m", 120.0), ("1h30m", 5400.0), ("1.5m", 90.0), ("7", 7.0), ("1m5", -1.0)]
        {
            assert_eq!(duration(text).map_or(-1.0, |d| d.as_secs_f64()), seconds, "{text}");
        }
        for wrong in ["", "s", "5x", "1m2h", "1m1m", "-5s", "0s", "1e400s", "..s", "5 s", "5µ", "99999999999999999999h"]
        {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn significances() {
        assert_eq!(significance("1e-4"), Ok(1e-4));
        for wrong in ["0", "1", "-0.1", "nan", "inf", "", "p"] {
            assert!(significance(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_and_windows() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for wrong in ["640", "0x480", "640x-1", "640x480x3", "x", "70000x2", "4294967297x1"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
        assert_eq!(crop("1, 2,3,4"), Ok([1, 2, 3, 4]));
        for wrong in ["1,2,3", "1,2,1,4", "3,2,1,4", "1,2,3,4,5", "a,b,c,d", ""] {
            assert!(crop(wrong).is_err(), "{wrong}");
        }
        assert_eq!("3,4,18446744073709551615".parse(), Ok(Replay { pixel: [3, 4], index: u64::MAX }));
        assert!("3,4294967296,1".parse::<Replay>().is_err());
        assert!(finite("1e999").is_err() && finite("nan").is_err() && finite("-1.5") == Ok(-1.5));
    }
}
