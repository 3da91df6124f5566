//! Numbers as text.
use std::time::Duration;

/// C's `%.{digits}g`: so many significant digits, trailing zeros dropped. Nine digits carry every bit of an `f32`.
pub(crate) fn significant(value: f32, digits: usize) -> String {
    if !value.is_finite() {
        let sign = if value == f32::NEG_INFINITY { "-" } else { "" };
        return format!("{sign}{}", if value.is_nan() { "nan" } else { "inf" });
    }
    let value = f64::from(value);
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else {
        return scientific;
    };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if exponent < -4 || exponent >= digits as i32 {
        let sign = if exponent < 0 { '-' } else { '+' };
        return format!("{}e{sign}{:02}", trimmed(mantissa), exponent.abs());
    }
    let decimals = digits as i32 - 1 - exponent;
    trimmed(&format!("{value:.*}", decimals.max(0) as usize)).to_owned()
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

/// The line that `trace` ends with.
pub(crate) fn pixel_line(rgb: [f32; 3]) -> String {
    format!("pixel {}", rgb.map(|v| significant(v, 9)).join(" "))
}

/// `12.3 M`; small counts exactly.
pub(crate) fn count(n: u64) -> String {
    match n {
        0..10_000 => n.to_string(),
        10_000..1_000_000 => format!("{:.1} k", n as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.2} M", n as f64 / 1e6),
        _ => format!("{:.2} G", n as f64 / 1e9),
    }
}

/// `1 mesh`, `2 meshes`.
pub(crate) fn counted(n: u64, one: &str, many: &str) -> String {
    format!("{} {}", count(n), if n == 1 { one } else { many })
}

/// `1.2 MiB`.
pub(crate) fn bytes(n: u64) -> String {
    const UNITS: [&str; 4] = ["KiB", "MiB", "GiB", "TiB"];
    if n < 1024 {
        return format!("{n} B");
    }
    let power = (n.ilog2() / 10).min(UNITS.len() as u32);
    let unit = UNITS.get(power as usize - 1).copied().unwrap_or_default();
    format!(
        "{:.1} {unit}",
        n as f64 / f64::from(1u32 << (10 * power.min(3))) / if power > 3 { 1024.0 } else { 1.0 }
    )
}

/// Seconds, finer where they are few.
pub(crate) fn seconds(time: Duration) -> String {
    let s = time.as_secs_f64();
    if s < 0.1 { format!("{:.1} ms", s * 1e3) } else { format!("{s:.2} s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nine_digits_read_like_c_and_carry_every_bit() {
        let cases = [
            (0.0, "0"),
            (-0.0, "-0"),
            (1.0, "1"),
            (0.1, "0.100000001"),
            (123_456_789.0, "123456792"),
            (1e9, "1e+09"),
            (1.5e-5, "1.49999996e-05"),
            (0.000_123, "0.000123000005"),
            (-2.5, "-2.5"),
            (f32::MAX, "3.40282347e+38"),
            (f32::from_bits(1), "1.40129846e-45"),
            (999_999_990.0, "1e+09"),
            (f32::NEG_INFINITY, "-inf"),
            (f32::NAN, "nan"),
        ];
        for (value, text) in cases {
            assert_eq!(significant(value, 9), text);
        }
        let mut bits = 0x9E37_79B9u32;
        for _ in 0..20_000 {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let value = f32::from_bits(bits);
            if value.is_finite() {
                let back: f32 = significant(value, 9).parse().expect("a number");
                assert_eq!(back.to_bits(), value.to_bits(), "{value}");
            }
        }
    }

    #[test]
    fn rounding_may_carry_into_the_exponent() {
        assert_eq!(significant(9.9999, 4), "10");
        assert_eq!(significant(99_999.0, 4), "1e+05");
    }

    #[test]
    fn counts_and_bytes_are_short() {
        assert_eq!([count(9999), count(12_345), count(41_200_000)], ["9999", "12.3 k", "41.20 M"]);
        assert_eq!(
            [bytes(1000), bytes(1536), bytes(3 << 30), bytes(5 << 40)],
            ["1000 B", "1.5 KiB", "3.0 GiB", "5.0 TiB"]
        );
    }
}
