//! Measured spectra made ready for rays: a value each nanometre.
use std::sync::Arc;

use super::{
    Sampled,
    observer::{RANGE, place},
};

/// A quantity over visible wavelengths, straight lines between nanometres.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    values: Arc<[f32]>,
}

impl Curve {
    /// From its value at a wavelength in nm.
    pub fn of(value: impl Fn(f64) -> f64) -> Self {
        Self { values: (RANGE.0..=RANGE.1).map(|nm| value(f64::from(nm)) as f32).collect() }
    }
    /// From measurements; 0 where there are none.
    pub fn measured(sampled: &Sampled) -> Self {
        Self::of(|nm| sampled.or_zero(nm))
    }
    /// From measurements, the first or last one where there are none: for indices of refraction.
    pub fn nearest(sampled: &Sampled) -> Self {
        Self::of(|nm| sampled.nearest(nm).into())
    }
    /// The value at a wavelength in nm; of wavelengths that are not seen, at the end of those that are.
    #[inline]
    pub fn at(&self, nm: f32) -> f32 {
        let (i, u) = place(nm);
        self.values[i] * (1.0 - u) + self.values[i + 1] * u
    }
    /// The smallest and the largest value.
    pub fn ends(&self) -> [f32; 2] {
        let fold = |start: f32, pick: fn(f32, f32) -> f32| self.values.iter().copied().fold(start, pick);
        [fold(f32::INFINITY, f32::min), fold(f32::NEG_INFINITY, f32::max)]
    }
    /// True if it is the same at all wavelengths.
    pub fn is_flat(&self) -> bool {
        self.values.iter().all(|v| *v == self.values[0])
    }
    /// All values times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        Self { values: self.values.iter().map(|v| v * factor).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_what_was_measured() {
        let sampled = Sampled::new(&[400.0, 1.0, 500.0, 3.0, 700.0, 2.0]).expect("a spectrum");
        let (share, index) = (Curve::measured(&sampled), Curve::nearest(&sampled));
        for nm in [400.0, 437.25, 500.0, 650.5, 700.0] {
            assert!((share.at(nm) - sampled.nearest(nm.into())).abs() < 1e-5, "{nm}");
            assert_eq!(share.at(nm), index.at(nm));
        }
        assert_eq!([share.at(390.0), share.at(800.0)], [0.0; 2]);
        assert_eq!([index.at(390.0), index.at(800.0), index.at(2000.0)], [1.0, 2.0, 2.0]);
        assert_eq!((share.ends(), share.scaled(2.0).ends()), ([0.0, 3.0], [0.0, 6.0]));
        assert!(!share.is_flat() && Curve::of(|_| 1.5).is_flat());
    }
}
