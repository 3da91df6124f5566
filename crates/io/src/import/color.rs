//! Vertex colours: sRGB (IEC 61966-2-1) to linear.
use durer_core::math::float;

/// The linear value of an sRGB-encoded one in [0, 1].
pub(crate) fn linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { float::pow((encoded + 0.055) / 1.055, 2.4) }
}
