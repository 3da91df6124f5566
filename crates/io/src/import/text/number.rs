//! Decimal numbers, correctly rounded to `f32`.
//!
//! Short numbers take the fast path of Clinger (1990, "How to read floating point numbers accurately"): a mantissa below
//! 2^53 times or over a power of ten up to 10^22 is one correctly rounded operation in `f64`. Rounding that to `f32` is
//! right too, unless it lies exactly halfway between two of them; those, and long numbers, go to the standard library.

/// 10^0 to 10^22: exact in `f64`.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// The number that is all of `word`; infinite or NaN if the word says so or is too large; `None` if it is no number.
pub(crate) fn float(word: &[u8]) -> Option<f32> {
    match short(word) {
        Some((value, [])) => Some(value),
        _ => std::str::from_utf8(word).ok()?.parse().ok(),
    }
}

/// The number that `text` begins with and the bytes it takes, if it is short and white space or nothing follows.
#[inline]
pub(crate) fn leading_float(text: &[u8]) -> Option<(f32, usize)> {
    let (value, rest) = short(text)?;
    ends(rest).then_some((value, text.len() - rest.len()))
}

/// The same for whole numbers.
#[inline]
pub(crate) fn leading_integer(text: &[u8]) -> Option<(i64, usize)> {
    let (value, rest) = short_integer(text)?;
    ends(rest).then_some((value, text.len() - rest.len()))
}

/// The whole number of up to 18 digits that `text` begins with, and what follows it.
#[inline]
pub(crate) fn short_integer(text: &[u8]) -> Option<(i64, &[u8])> {
    let (negative, digits) = sign(text);
    let (value, count, rest) = digits_of(digits, 0);
    let value = value as i64;
    // What wraps has too many digits.
    let value = if negative { value.wrapping_neg() } else { value };
    (1..=18).contains(&count).then_some((value, rest))
}

/// Whether a number may end before `rest`.
#[inline]
pub(crate) fn ends(rest: &[u8]) -> bool {
    matches!(rest, [] | [b' ' | b'\n' | b'\r' | b'\t', ..])
}

/// The whole number that is all of `word`; `None` if it is none, or has more than 18 digits.
pub(crate) fn integer(word: &[u8]) -> Option<i64> {
    leading_integer(word).filter(|(_, len)| *len == word.len()).map(|(value, _)| value)
}

fn sign(word: &[u8]) -> (bool, &[u8]) {
    match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        rest => (false, rest),
    }
}

/// `value` with the leading digits of `text` appended, how many they are, and what follows them.
fn digits_of(mut text: &[u8], mut value: u64) -> (u64, i32, &[u8]) {
    let mut count = 0;
    while let [digit @ b'0'..=b'9', rest @ ..] = text {
        value = value.wrapping_mul(10).wrapping_add(u64::from(digit - b'0'));
        count += 1;
        text = rest;
    }
    (value, count, text)
}

/// The number and what follows it.
#[inline]
fn short(word: &[u8]) -> Option<(f32, &[u8])> {
    let (negative, rest) = sign(word);
    let (mut mantissa, mut digits, mut rest) = digits_of(rest, 0);
    let mut exponent = 0;
    if let [b'.', fraction @ ..] = rest {
        let (all, places, behind) = digits_of(fraction, mantissa);
        (mantissa, rest) = (all, behind);
        digits += places;
        exponent = -places;
    }
    if let [b'e' | b'E', power @ ..] = rest {
        let (down, power) = sign(power);
        let (power, places, behind) = digits_of(power, 0);
        (1..=4).contains(&places).then_some(())?;
        exponent += if down { -(power as i32) } else { power as i32 };
        rest = behind;
    }
    if !(1..=19).contains(&digits) || mantissa > 1 << 53 {
        return None;
    }
    let power = *POWERS.get(exponent.unsigned_abs() as usize)?;
    let value = if exponent < 0 { mantissa as f64 / power } else { mantissa as f64 * power };
    let halfway = value.to_bits() & 0x1fff_ffff == 0x1000_0000;
    // Below, f32 has fewer digits.
    let normal = value == 0.0 || (1.2e-38..3.4e38).contains(&value);
    let value = value as f32;
    (normal && !halfway).then_some((if negative { -value } else { value }, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn agree(word: &str) {
        let std: Option<f32> = word.parse().ok();
        assert_eq!(float(word.as_bytes()).map(f32::to_bits), std.map(f32::to_bits), "{word}");
    }

    #[test]
    fn numbers_are_those_of_the_standard_library() {
        for word in [
            "0",
            "-0",
            "1",
            "+1",
            "2.",
            ".5",
            "-.5e1",
            "1e10",
            "1E-2",
            "2.e01",
            "1.00000005960464477539",
            "16777217",
            "1.1754944e-38",
            "1e-45",
            "3.4028236e38",
            "1e39",
            "1e400",
            "9007199254740993",
            "123456789012345678901",
            "nan",
            "-inf",
            "",
            ".",
            "-",
            "+",
            "e5",
            "1e",
            "1e+",
            "3.1+e2",
            "1.#IND",
            "0x10",
            "1,5",
            "1_0",
            "1e99999",
            "00000000000000000000001",
            "8388609.5",
            "8388608.5",
        ] {
            agree(word);
        }
    }

    #[test]
    fn seeded_numbers_are_those_of_the_standard_library() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state
        };
        for _ in 0..50_000 {
            let any = f32::from_bits(next() as u32);
            agree(&format!("{any:e}"));
            agree(&format!("{}.{}", next() as i16, next() as u32));
            // The middle between two neighbours, to the last digit.
            let above = f32::from_bits((next() as u32 & 0x00ff_ffff) | 0x3f00_0000);
            let middle = (f64::from(above) + f64::from(f32::from_bits(above.to_bits() + 1))) / 2.0;
            agree(&format!("{middle}"));
        }
    }

    #[test]
    fn integers_have_signs_and_ends() {
        assert_eq!(integer(b"12"), Some(12));
        assert_eq!(integer(b"-3"), Some(-3));
        assert_eq!(integer(b"1.0"), None);
        assert_eq!(integer(b"-"), None);
        assert_eq!(integer(b"9999999999999999999"), None);
    }
}
