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
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self { rgb: self.rgb.map(f) }
    }
    /// Luminance of the linear components (Rec. 709 weights).
    pub fn luminance(self) -> f32 {
        let [r, g, b] = self.rgb;
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }
}

impl Add for Color {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { rgb: std::array::from_fn(|i| self.rgb[i] + o.rgb[i]) }
    }
}
impl Mul for Color {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self { rgb: std::array::from_fn(|i| self.rgb[i] * o.rgb[i]) }
    }
}
impl Mul<f32> for Color {
    type Output = Self;
    fn mul(self, s: f32) -> Self {
        self.map(|v| v * s)
    }
}
