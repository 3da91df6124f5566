//! Numbers in sentences: three significant digits everywhere.
pub(super) use crate::spectrum::luminance;
use crate::spectrum::{Basis, Spectrum};

/// Three significant digits, trailing zeros dropped; powers of ten where the number is very small or large.
pub(super) fn number(v: f64) -> String {
    if v.is_nan() {
        return "NaN".to_owned();
    }
    if v.is_infinite() {
        return if v > 0.0 { "infinity" } else { "-infinity" }.to_owned();
    }
    let scientific = format!("{v:.2e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if v != 0.0 && !(-4..6).contains(&exponent) {
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    let decimals = (2 - exponent).max(0) as usize;
    trimmed(&format!("{v:.decimals$}")).to_owned()
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

/// One number if the channels are the same to three digits, else all of them.
pub(super) fn color(v: [f64; 3]) -> String {
    let [r, g, b] = v.map(number);
    if r == g && g == b { r } else { format!("({r}, {g}, {b})") }
}

/// The same of what rays carry, lane by lane: red, green and blue, or four wavelengths.
pub(super) fn lanes(basis: &Basis, s: Spectrum) -> String {
    each(basis, s.lanes().map(f64::from))
}

/// The same of numbers that were computed of lanes.
pub(super) fn each(basis: &Basis, [a, b, c, d]: [f64; 4]) -> String {
    match basis {
        Basis::Rgb => color([a, b, c]),
        Basis::Spectral(_) if [b, c, d].iter().all(|v| number(*v) == number(a)) => number(a),
        Basis::Spectral(_) => format!("({})", [a, b, c, d].map(number).join(", ")),
    }
}

/// The colour of light in double precision: linear RGB.
pub(super) fn rgb(basis: &Basis, s: Spectrum) -> [f64; 3] {
    basis.to_rgb(s).map(f64::from)
}

/// The colour that a weight gives to white light.
pub(super) fn tint(basis: &Basis, s: Spectrum) -> [f64; 3] {
    basis.under_white(s).map(f64::from)
}

/// `12 %`; a decimal where there are few.
pub(super) fn percent(share: f64) -> String {
    let p = 100.0 * share;
    match p.abs() {
        _ if !p.is_finite() => "an unknown share".to_owned(),
        0.0 => "0 %".to_owned(),
        a if a < 0.05 => "less than 0.1 %".to_owned(),
        a if a < 9.95 => format!("{} %", trimmed(&format!("{p:.1}"))),
        a if a > 99.0 && a < 99.95 => format!("{p:.1} %"),
        _ => format!("{p:.0} %"),
    }
}

/// An angle given by its cosine, in degrees.
pub(super) fn degrees_of(cos: f64) -> String {
    degrees(cos.clamp(-1.0, 1.0).acos())
}

/// An angle in radians, in degrees.
pub(super) fn degrees(angle: f64) -> String {
    format!("{:.1}", angle.to_degrees())
}

/// `a`, `a and b`, `a, b and c`.
pub(super) fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// `1 ray`, `2 rays`.
pub(super) fn counted(n: usize, one: &str) -> String {
    if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (0.5625, "0.562"),
            (12.345, "12.3"),
            (1234.5, "1234"),
            (0.000_123_456, "0.000123"),
            (0.000_012_345, "1.23e-5"),
            (9.996, "10"),
            (-2.5, "-2.5"),
            (f64::NAN, "NaN"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!([color([0.5; 3]), color([1.0, 0.5, 0.25])], ["0.5", "(1, 0.5, 0.25)"]);
    }

    #[test]
    fn shares_are_rounded_as_people_do() {
        let all = [0.0, 0.0001, 0.012, 0.0996, 0.5, 0.997, 0.9999].map(percent);
        assert_eq!(all, ["0 %", "less than 0.1 %", "1.2 %", "10 %", "50 %", "99.7 %", "100 %"]);
    }
}
