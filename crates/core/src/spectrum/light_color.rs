//! Colours of lights: linear Rec. 709, and behind it a measured curve if there is one.
use std::ops::Mul;

use super::{
    Color, Curve, Sampled,
    observer::{MATCHING, RANGE},
};

/// The colour of a light. What has no curve is, in wavelengths, D65 seen through a smooth filter of its colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightColor {
    /// Linear Rec. 709; of a curve that Rec. 709 does not hold, the nearest it does.
    pub color: Color,
    /// A curve of luminance 1, and a factor on it.
    curve: Option<(Curve, f32)>,
}

impl LightColor {
    /// The colour of a measured light, at luminance 1; black if it gives no visible light.
    pub fn measured(power: &Sampled) -> Self {
        Self::of(|nm| power.or_zero(nm))
    }

    /// The colour of a black body of `kelvin`, at luminance 1 (Planck's law); black at 0 K.
    pub fn blackbody(kelvin: f32) -> Self {
        // Relative to 550 nm, so that neither cold nor hot bodies leave the range of numbers.
        let power = |nm: f64| libm::exp(planck(kelvin, nm) - planck(kelvin, 550.0));
        if kelvin > 0.0 { Self::of(power) } else { Self::default() }
    }

    /// The colour of a black body of `kelvin` of which the strongest wavelength sends 1, where 1 at all wavelengths has
    /// luminance 1 (pbrt-v4's `BlackbodySpectrum`): hot bodies outshine warm ones. Black at 0 K.
    pub fn glow(kelvin: f32) -> Self {
        // Wien's law: 2.897771955e-3 m K, in nm K.
        const STRONGEST: f64 = 2.897_771_955e6;
        if kelvin <= 0.0 {
            return Self::default();
        }
        let strongest = planck(kelvin, STRONGEST / f64::from(kelvin));
        let sent = MATCHING.iter().enumerate().map(|(i, weights)| {
            let power = libm::exp(planck(kelvin, f64::from(RANGE.0) + i as f64) - strongest);
            super::luminance(weights.map(f64::from)) * power
        });
        Self::blackbody(kelvin) * sent.sum::<f64>() as f32
    }

    /// From power over wavelengths in nm.
    fn of(power: impl Fn(f64) -> f64) -> Self {
        let mut sum = [0.0; 3];
        for (i, weights) in MATCHING.iter().enumerate() {
            let power = power(f64::from(RANGE.0) + i as f64);
            sum.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += f64::from(*weight) * power);
        }
        let bright = super::luminance(sum);
        if bright.is_nan() || bright <= 0.0 {
            return Self::default();
        }
        let curve = Curve::of(|nm| power(nm) / bright);
        let color = Color { rgb: sum.map(|v| (v / bright).max(0.0) as f32) };
        Self { color, curve: Some((curve, 1.0)) }
    }

    /// The curve and the factor on it.
    #[inline]
    pub(super) fn curve(&self) -> Option<(&Curve, f32)> {
        self.curve.as_ref().map(|(curve, factor)| (curve, *factor))
    }
    /// The same where rays carry wavelengths, another colour where they do not.
    #[must_use]
    pub fn seen_as(self, color: Color) -> Self {
        Self { color, ..self }
    }
    /// Luminance of the colour.
    pub fn luminance(&self) -> f32 {
        self.color.luminance()
    }
}

/// The logarithm of what a black body sends at a wavelength in nm, up to a constant.
pub(super) fn planck(kelvin: f32, nm: f64) -> f64 {
    // h c / k, in nm K.
    const C2: f64 = 1.438_776_877e7;
    let x = C2 / (nm * f64::from(kelvin));
    -5.0 * libm::log(nm / 550.0) - x - libm::log1p(-libm::exp(-x))
}

impl From<Color> for LightColor {
    fn from(color: Color) -> Self {
        Self { color, curve: None }
    }
}

impl Mul<f32> for LightColor {
    type Output = Self;
    fn mul(self, s: f32) -> Self {
        let curve = self.curve.map(|(curve, factor)| (curve, factor * s));
        Self { color: self.color * s, curve }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::sampled::chromatic, *};

    fn near(c: Color, expected: [f32; 3], within: f32) {
        assert!((0..3).all(|i| (c.rgb[i] - expected[i]).abs() < within), "{:?} {expected:?}", c.rgb);
    }

    #[test]
    fn black_bodies_have_the_chromaticity_of_the_planckian_locus() {
        // Wyszecki and Stiles, table 1(3.11): x, y of 2856 K (illuminant A) and 6500 K.
        for (kelvin, x, y) in [(2856.0, 0.4476, 0.4074), (6500.0, 0.3135, 0.3237)] {
            let light = LightColor::blackbody(kelvin);
            near(light.color, chromatic(x, y).rgb, 0.005);
            assert!((light.luminance() - 1.0).abs() < 1e-3);
        }
        for kelvin in [1e-3, 10.0, 1e6, 1e30] {
            let color = LightColor::blackbody(kelvin).color;
            assert!(color.rgb.iter().all(|v| v.is_finite() && *v >= 0.0), "{kelvin}");
        }
        assert_eq!(LightColor::blackbody(0.0), LightColor::default());
    }

    #[test]
    fn lights_have_luminance_1_and_grow_with_their_factor() {
        let light = LightColor::measured(&Sampled::new(&[450.0, 3.0, 650.0, 9.0]).expect("a spectrum"));
        assert!((light.luminance() - 1.0).abs() < 1e-5);
        let (curve, factor) = light.clone().curve().map(|(c, f)| (c.clone(), f)).expect("a curve");
        let twice = light * 2.0;
        assert!((twice.luminance() - 2.0).abs() < 1e-5);
        assert_eq!(twice.curve(), Some((&curve, 2.0 * factor)));
        assert!(LightColor::from(Color::WHITE).curve().is_none());
    }
}
