//! Words to numbers.
//!
//! pbrt-v4 takes what C's `strtod` takes in decimal: `1`, `+1`, `-1.`, `.5`, `1e-3`, `1.E+3`; not `inf`, `nan`, hex.

/// Why a word is not the number asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NotNumber {
    /// It is no number at all.
    NoNumber,
    /// It is a number, but not a whole one.
    NotWhole,
    /// It does not fit.
    TooLarge,
}

/// True if `word` begins as a number does; keeps Rust's `inf` and `nan` out.
fn looks_numeric(word: &str) -> bool {
    let unsigned = word.strip_prefix(['+', '-']).unwrap_or(word);
    matches!(unsigned.as_bytes(), [b'0'..=b'9', ..] | [b'.', b'0'..=b'9', ..])
}

/// A number in double precision.
pub(super) fn float64(word: &str) -> Result<f64, NotNumber> {
    if !looks_numeric(word) {
        return Err(NotNumber::NoNumber);
    }
    let value: f64 = word.parse().map_err(|_| NotNumber::NoNumber)?;
    if value.is_finite() { Ok(value) } else { Err(NotNumber::TooLarge) }
}

/// A number in single precision, rounded once.
pub(super) fn float32(word: &str) -> Result<f32, NotNumber> {
    if !looks_numeric(word) {
        return Err(NotNumber::NoNumber);
    }
    let value: f32 = word.parse().map_err(|_| NotNumber::NoNumber)?;
    if value.is_finite() { Ok(value) } else { Err(NotNumber::TooLarge) }
}

/// A whole number.
pub(super) fn int32(word: &str) -> Result<i32, NotNumber> {
    let digits = word.strip_prefix(['+', '-']).unwrap_or(word);
    if !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) {
        return word.parse().map_err(|_| NotNumber::TooLarge);
    }
    match float64(word) {
        Ok(_) => Err(NotNumber::NotWhole),
        Err(why) => Err(why),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_decimal_form_is_read() {
        for (word, value) in [
            ("1", 1.0),
            ("+1", 1.0),
            ("-1.", -1.0),
            (".5", 0.5),
            ("-.5", -0.5),
            ("+.5e1", 5.0),
            ("1e-3", 0.001),
            ("1.E+3", 1000.0),
            ("-0", 0.0),
            ("1E2", 100.0),
        ] {
            assert_eq!(float64(word), Ok(value), "{word}");
            assert_eq!(float32(word), Ok(value as f32), "{word}");
        }
    }

    #[test]
    fn other_words_are_no_numbers() {
        for word in [
            "", "+", "-", ".", "e5", "inf", "-inf", "nan", "infinity", "1.2.3", "0x10", "1f", "--1", "1,5",
            "+-1",
        ] {
            assert_eq!(float64(word), Err(NotNumber::NoNumber), "{word}");
            assert_eq!(float32(word), Err(NotNumber::NoNumber), "{word}");
            assert_eq!(int32(word), Err(NotNumber::NoNumber), "{word}");
        }
    }

    #[test]
    fn numbers_that_do_not_fit_are_told_apart() {
        assert_eq!(float32("1e39"), Err(NotNumber::TooLarge));
        assert_eq!(float64("1e39"), Ok(1e39));
        assert_eq!(float64("1e999"), Err(NotNumber::TooLarge));
        assert_eq!(int32("1.0"), Err(NotNumber::NotWhole));
        assert_eq!(int32("1e3"), Err(NotNumber::NotWhole));
        assert_eq!(int32("2147483648"), Err(NotNumber::TooLarge));
        assert_eq!(int32("-2147483648"), Ok(i32::MIN));
        assert_eq!(int32("+7"), Ok(7));
    }
}
