//! The four wavelengths of a sample: one drawn, the others by rotation (Wilkie et al. 2014, "Hero Wavelength Spectral
//! Sampling"), each where the eye sees much.
//!
//! The density is that of Radziszewski, Boryczko and Alda 2009 as pbrt-v4 has it, `sech²(0.0072 (nm - 538))` within the
//! visible range. Its integral is a hyperbolic tangent, so that it is inverted in closed form.
use super::{
    Spectrum,
    observer::{RANGE, rgb},
};

/// Steepness, in 1/nm, and the wavelength seen best, in nm.
const STEEP: f64 = 0.0072;
const BEST: f64 = 538.0;

/// Four wavelengths. Each has by itself the same density; together they are spread over the visible range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelengths {
    nm: [f32; 4],
}

/// What a sample says of one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtWavelength {
    /// The wavelength in nm.
    pub nm: f32,
    /// The value there.
    pub value: f32,
    /// How many nm of the visible range it stands for: 1 by the density with which it was drawn.
    pub width: f32,
}

/// `tanh` at both ends of the range.
fn ends() -> (f64, f64) {
    let at = |nm: i32| libm::tanh(STEEP * (f64::from(nm) - BEST));
    (at(RANGE.0), at(RANGE.1))
}

impl Wavelengths {
    /// Those of a number in `[0, 1)`. The first, the leading one, is drawn with it, the others a quarter further each.
    pub fn drawn(u: f32) -> Self {
        let (low, high) = ends();
        let nm = |i: u8| {
            let u = f64::from(u) + f64::from(i) / 4.0;
            let u = if u >= 1.0 { u - 1.0 } else { u };
            (BEST + libm::atanh(low + u * (high - low)) / STEEP) as f32
        };
        Self { nm: [nm(0), nm(1), nm(2), nm(3)] }
    }

    /// The wavelengths in nm, the leading one first.
    pub fn nm(&self) -> [f32; 4] {
        self.nm
    }

    /// The values of `s`, each at its wavelength.
    pub fn values(&self, s: Spectrum) -> [AtWavelength; 4] {
        let (lanes, width) = (s.lanes(), self.nm.map(|nm| 1.0 / density(nm)));
        std::array::from_fn(|i| AtWavelength { nm: self.nm[i], value: lanes[i], width: width[i] })
    }

    /// `f` of every wavelength in nm and the value there.
    #[inline]
    pub fn map(&self, s: Spectrum, f: impl Fn(f32, f32) -> f32) -> Spectrum {
        s.zip(Spectrum::from_lanes(self.nm), |value, nm| f(nm, value))
    }

    /// What a lane of 1 counts in the picture's red, green and blue: the matching functions by the density and the number
    /// of lanes.
    pub fn weights(&self) -> [[f32; 3]; 4] {
        self.nm.map(|nm| {
            let factor = 0.25 / density(nm);
            rgb(nm).map(|c| c * factor)
        })
    }
}

/// Density with which each of the wavelengths is drawn, 1/nm.
fn density(nm: f32) -> f32 {
    let (low, high) = ends();
    let cosh = libm::cosh(STEEP * (f64::from(nm) - BEST));
    (STEEP / ((high - low) * cosh * cosh)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_are_those_of_what_is_drawn() {
        let sum: f64 = (RANGE.0..RANGE.1).map(|nm| f64::from(density(nm as f32 + 0.5))).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        // Share of wavelengths below 550 nm, drawn and integrated.
        let below = (0..10_000).filter(|i| Wavelengths::drawn(*i as f32 / 1e4).nm[0] < 550.0).count();
        let expected: f64 = (RANGE.0..550).map(|nm| f64::from(density(nm as f32 + 0.5))).sum();
        assert!((below as f64 / 1e4 - expected).abs() < 1e-3, "{below} {expected}");
    }

    #[test]
    fn the_four_are_spread_over_what_is_seen() {
        for i in 0..100 {
            let mut nm = Wavelengths::drawn((i as f32 + 0.5) / 100.0).nm();
            assert!(nm.iter().all(|nm| (360.0..=830.0).contains(nm)));
            nm.sort_by(f32::total_cmp);
            assert!(nm.windows(2).all(|w| w[1] - w[0] > 40.0), "{nm:?}");
        }
        // The leading one takes each of the four quarters in turn.
        let quarter = |u: f32| Wavelengths::drawn(u).nm()[0];
        assert!(quarter(0.1) < quarter(0.3) && quarter(0.3) < quarter(0.6) && quarter(0.6) < quarter(0.9));
    }
}
