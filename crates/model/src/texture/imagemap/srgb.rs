//! The sRGB transfer function (IEC 61966-2-1): `c / 12.92` up to 0.04045, then `((c + 0.055) / 1.055)^2.4`.

/// The linear value of an encoded one; negative values become 0.
pub(super) fn decode(encoded: f64) -> f32 {
    let c = encoded.max(0.0);
    let linear = if c <= 0.04045 { c / 12.92 } else { power_2_4((c + 0.055) / 1.055) };
    linear as f32
}

/// The linear values of all bytes.
pub(super) fn table() -> [f32; 256] {
    std::array::from_fn(|byte| decode(byte as f64 / 255.0))
}

/// `x^2.4 = x^2 (x^2)^(1/5)`, the root by Newton's method: only basic arithmetic, so the same bits everywhere.
fn power_2_4(x: f64) -> f64 {
    let y = x * x;
    let mut root = f64::from(durer_core::math::float::pow(y as f32, 0.2));
    for _ in 0..2 {
        let fourth = (root * root) * (root * root);
        root -= (fourth * root - y) / (5.0 * fourth);
    }
    y * root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_decodes_to_the_nearest_float() {
        for (byte, value) in table().into_iter().enumerate() {
            let c = byte as f64 / 255.0;
            let exact = if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
            assert_eq!(value, exact as f32, "byte {byte}");
        }
    }

    #[test]
    fn both_ends_are_exact_and_the_curve_rises() {
        let t = table();
        assert_eq!((t[0], t[255]), (0.0, 1.0));
        assert!(t.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(decode(-0.5), 0.0);
    }
}
