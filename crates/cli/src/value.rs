//! Values of options: what is allowed is what is said of anything else.
use std::{ops::RangeInclusive, str::FromStr};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::{
    film::{Tile, ToneMap},
    math::Interval,
};

/// Reads whole numbers of a range.
pub(crate) fn whole<T>(
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + std::fmt::Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let inside = text.trim().parse().ok().filter(|n| range.contains(n));
        inside.ok_or_else(|| format!("expected a whole number from {} to {}", range.start(), range.end()))
    }
}

/// How light becomes colours, by its word.
pub(crate) fn tonemap() -> impl TypedValueParser<Value = ToneMap> {
    PossibleValuesParser::new(ToneMap::WORDS).try_map(|word| ToneMap::from_word(&word).ok_or("unknown"))
}

/// A name and its value.
pub(crate) fn definition(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("expected NAME=VALUE, without blanks between".to_owned()),
    }
}

/// Numbers with commas between.
pub(crate) fn numbers<T: FromStr, const N: usize>(text: &str, form: &str) -> Result<[T; N], String> {
    let list: Option<Vec<T>> = text.split(',').map(|v| v.trim().parse().ok()).collect();
    list.and_then(|l| l.try_into().ok()).ok_or_else(|| format!("expected {form}"))
}

/// The edges of a part of the picture.
pub(crate) fn crop(text: &str) -> Result<Tile, String> {
    let [x0, y0, x1, y1] =
        numbers(text, "X0,Y0,X1,Y1: four whole numbers of pixels, from 0, without blanks between")?;
    if x0 >= x1 || y0 >= y1 {
        return Err("holds no pixel: X0 must be less than X1, and Y0 less than Y1".to_owned());
    }
    Ok(Tile { x0, y0, x1, y1 })
}

/// Column and row.
pub(crate) fn pixel(text: &str) -> Result<[u32; 2], String> {
    numbers(text, "X,Y: two whole numbers, from 0,0 for the upper left pixel, without blanks between")
}

/// When the shutter opens and closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exposure {
    /// In seconds.
    Seconds(Interval),
    /// In parts of the time between two frames.
    Frames(Interval),
}

impl Exposure {
    /// In seconds, if there are so many frames in one.
    pub(crate) fn seconds(self, fps: f32) -> Interval {
        match self {
            Self::Seconds(span) => span,
            Self::Frames(Interval { min, max }) => Interval::new(min / fps, max / fps),
        }
    }
}

/// When the shutter opens and closes: both, or how long it is open; in seconds, or with an `f` in frames.
pub(crate) fn shutter(text: &str) -> Result<Exposure, String> {
    let text = text.trim();
    let (plain, in_frames) = text.strip_suffix('f').map_or((text, false), |plain| (plain, true));
    let [open, close]: [f32; 2] = match plain.contains(',') {
        true => numbers(plain, "OPEN,CLOSE: two numbers of seconds, or of frames with an f behind them")?,
        false => [
            0.0,
            not_negative(plain).map_err(|_| {
                "expected OPEN,CLOSE or LENGTH, in seconds, or in frames with an f behind".to_owned()
            })?,
        ],
    };
    if !open.is_finite() || !close.is_finite() || open > close {
        return Err("must open before it closes".to_owned());
    }
    let span = Interval::new(open, close);
    Ok(if in_frames { Exposure::Frames(span) } else { Exposure::Seconds(span) })
}

/// A number that is neither infinite nor NaN.
pub(crate) fn finite(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|v: &f32| v.is_finite()).ok_or_else(|| "expected a number".to_owned())
}

/// A number above 0.
pub(crate) fn positive(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v > 0.0).ok_or_else(|| "expected a number above 0".to_owned())
}

/// A number of at least 0.
pub(crate) fn not_negative(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v >= 0.0).ok_or_else(|| "expected a number of at least 0".to_owned())
}

/// A point of the picture.
pub(crate) fn film_point(text: &str) -> Result<[f32; 2], String> {
    let form = "X,Y: two numbers of pixels, from 0,0 for the upper left corner";
    let point: [f32; 2] = numbers(text, form)?;
    if point.iter().all(|v| v.is_finite() && *v >= 0.0) { Ok(point) } else { Err(format!("expected {form}")) }
}

/// A number from 0 to 1.
pub(crate) fn fraction(text: &str) -> Result<f32, String> {
    let inside = finite(text).ok().filter(|v| (0.0..=1.0).contains(v));
    inside.ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_need_the_right_length() {
        assert_eq!(numbers::<u32, 2>("3, 4", ""), Ok([3, 4]));
        assert!(numbers::<u32, 2>("3", "").is_err() && numbers::<u32, 2>("3,4,5", "").is_err());
        assert!(crop("4,0,4,9").is_err() && shutter("1,0").is_err() && shutter("nan,1").is_err());
    }

    #[test]
    fn shutters_are_open_for_seconds_or_parts_of_a_frame() {
        let seconds = |text| shutter(text).map(|exposure| exposure.seconds(8.0));
        assert_eq!(seconds("-0.5,0.25"), Ok(Interval::new(-0.5, 0.25)));
        assert_eq!(seconds("0.5"), Ok(Interval::new(0.0, 0.5)));
        assert_eq!(seconds("0.5f"), Ok(Interval::new(0.0, 0.0625)));
        assert_eq!(seconds("-1,1f"), Ok(Interval::new(-0.125, 0.125)));
        for wrong in ["f", "-1", "1,2,3", "x", "1,f", ""] {
            assert!(shutter(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn whole_numbers_say_their_range() {
        let size = whole(1u32..=9);
        assert_eq!((size("1"), size("9")), (Ok(1), Ok(9)));
        for wrong in ["0", "10", "-5", "x", "1.5", "", "99999999999999999999"] {
            assert_eq!(size(wrong), Err("expected a whole number from 1 to 9".to_owned()), "{wrong}");
        }
    }
}
