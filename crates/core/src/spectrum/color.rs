//! Colours as people write them.
use std::ops::{Add, Mul};

use serde::Serialize;

/// Linear RGB with Rec. 709 primaries and D65 white; a reflectance or an emission, by context.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Color {
    /// Linear red, green, blue.
    pub rgb: [f32; 3],
}

impl Color {
    /// All zero.
    pub const BLACK: Self = Self::gray(0.0);
    /// All one.
    pub const WHITE: Self = Self::gray(1.0);

    /// From linear components.
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { rgb: [r, g, b] }
    }
    /// Equal components.
    pub const fn gray(v: f32) -> Self {
        Self { rgb: [v; 3] }
    }
    /// `f` of every component.
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let [r, g, b] = self.rgb;
        Self::new(f(r), f(g), f(b))
    }
    /// `f` of every pair of components.
    #[inline]
    fn zip(self, o: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let ([r, g, b], [x, y, z]) = (self.rgb, o.rgb);
        Self::new(f(r, x), f(g, y), f(b, z))
    }
    /// Luminance of the linear components (Rec. 709 weights).
    pub fn luminance(self) -> f32 {
        let ([r, g, b], [to_r, to_g, to_b]) = (self.rgb, LUMINANCE);
        to_r as f32 * r + to_g as f32 * g + to_b as f32 * b
    }
}

/// What red, green and blue of Rec. 709 count in luminance.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Luminance of linear Rec. 709 components in double precision; infinite or NaN if one of them is.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    let [to_r, to_g, to_b] = LUMINANCE;
    to_r * r + to_g * g + to_b * b
}

impl Add for Color {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
}
impl Mul for Color {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
}
impl Mul<f32> for Color {
    type Output = Self;
    fn mul(self, s: f32) -> Self {
        self.map(|v| v * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_precisions_have_the_weights_of_rec_709() {
        for (i, weight) in [0.2126f32, 0.7152, 0.0722].into_iter().enumerate() {
            let mut rgb = [0.0; 3];
            rgb[i] = 1.0;
            assert_eq!(Color { rgb }.luminance().to_bits(), weight.to_bits());
            assert!((luminance(rgb.map(f64::from)) - f64::from(weight)).abs() < 1e-8);
        }
        assert_eq!((Color::WHITE.luminance(), luminance([1.0; 3])), (1.0, 1.0));
    }
}
