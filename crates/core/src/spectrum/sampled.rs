//! Measured spectra as colours.
//!
//! Where rays carry red, green and blue, a spectrum becomes linear Rec. 709 where it is read:
//! a share of light (reflectance, transmittance) by what it does to D65, `sum(R D65 c)` for each of the three matching
//! functions `c` of Rec. 709, so that a share of 1 at all wavelengths is white (1, 1, 1);
//! a light ([`super::LightColor`]) by its own sums, scaled to luminance 1 (pbrt-v4 divides lights by their luminance too;
//! `scale` and `power` say how strong they are). Components below 0, colours that Rec. 709 does not hold, become 0.
use super::{
    Color,
    observer::{DAYLIGHT, MATCHING, RANGE, rec709},
};

/// Values at wavelengths, straight lines between them, 0 outside (pbrt-v4's `PiecewiseLinearSpectrum`).
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// `(nm, value)`, wavelengths rising; not empty.
    samples: Vec<(f32, f32)>,
}

/// The wavelength for which indices of refraction are tabulated as `n_d`: the yellow line of helium, in nm.
pub const HELIUM_D: f64 = 587.6;
/// Dominant wavelengths of the primaries of Rec. 709, in nm: those that red, green and blue stand for.
pub const HUES: [f64; 3] = [611.4, 549.1, 464.2];

impl Sampled {
    /// From wavelength (nm) and value in turn.
    ///
    /// # Errors
    /// What is wrong: an odd number of numbers or none, one that is not finite, wavelengths that do not rise.
    pub fn new(interleaved: &[f32]) -> Result<Self, String> {
        let (pairs, rest) = interleaved.as_chunks::<2>();
        if pairs.is_empty() || !rest.is_empty() {
            let count = interleaved.len();
            return Err(format!(
                "a spectrum has {count} numbers, expected pairs of wavelength (nm) and value"
            ));
        }
        if let Some(bad) = interleaved.iter().find(|v| !v.is_finite()) {
            return Err(format!("a spectrum holds {bad}, expected finite numbers"));
        }
        if let Some(w) = pairs.windows(2).find(|w| w[0][0] >= w[1][0]) {
            return Err(format!(
                "the wavelengths of a spectrum must rise, but {} nm follows {} nm",
                w[1][0], w[0][0]
            ));
        }
        Ok(Self { samples: pairs.iter().map(|p| (p[0], p[1])).collect() })
    }

    /// The value at a wavelength in nm; `None` outside.
    fn inside(&self, nm: f64) -> Option<f64> {
        let after = self.samples.partition_point(|s| f64::from(s.0) <= nm);
        let (l0, v0) = *self.samples.get(after.checked_sub(1)?)?;
        let (l0, v0) = (f64::from(l0), f64::from(v0));
        let Some(&(l1, v1)) = self.samples.get(after) else { return (l0 == nm).then_some(v0) };
        let u = (nm - l0) / (f64::from(l1) - l0);
        Some(v0 * (1.0 - u) + f64::from(v1) * u)
    }

    /// The value at a wavelength in nm; the first or last one outside: for indices of refraction.
    pub fn nearest(&self, nm: f64) -> f32 {
        let ends = (self.samples[0], self.samples[self.samples.len() - 1]);
        match self.inside(nm) {
            Some(value) => value as f32,
            None if nm < ends.0.0.into() => ends.0.1,
            None => ends.1.1,
        }
    }

    /// The colour of a share of light, under D65.
    pub fn share(&self) -> Color {
        share_of(|nm| self.or_zero(nm))
    }

    /// The luminance of a light of this power over wavelengths, where 1 at all of them has luminance 1.
    pub fn luminance(&self) -> f32 {
        let of = |(i, weights): (usize, &[f32; 3])| {
            super::luminance(weights.map(f64::from)) * self.or_zero(f64::from(RANGE.0) + i as f64)
        };
        MATCHING.iter().enumerate().map(of).sum::<f64>() as f32
    }

    /// The value at a wavelength in nm, 0 outside.
    pub(super) fn or_zero(&self, nm: f64) -> f64 {
        self.inside(nm).unwrap_or(0.0)
    }
}

/// What each of the values at these wavelengths in nm, which rise, adds to the colour of a share of light, under D65: between
/// them are straight lines, outside is the first or last one. The sums may be below 0, where Rec. 709 does not hold the colour.
pub fn share_weights(wavelengths: &[f32]) -> Vec<[f32; 3]> {
    let mut weights = vec![[0.0f64; 3]; wavelengths.len()];
    let Some(last) = wavelengths.len().checked_sub(1) else { return Vec::new() };
    for (i, (matching, light)) in MATCHING.iter().zip(DAYLIGHT).enumerate() {
        let nm = (RANGE.0 + i as i32) as f32;
        let high = wavelengths.partition_point(|w| *w <= nm).min(last);
        let low = high.saturating_sub(1);
        let u = match high > low {
            true => ((nm - wavelengths[low]) / (wavelengths[high] - wavelengths[low])).clamp(0.0, 1.0),
            false => 0.0,
        };
        for (at, share) in [(low, 1.0 - u), (high, u)] {
            let factor = f64::from(share * light);
            weights[at].iter_mut().zip(matching).for_each(|(sum, m)| *sum += f64::from(*m) * factor);
        }
    }
    weights.into_iter().map(|sums| sums.map(|v| v as f32)).collect()
}

/// The colour of a share of light, given by wavelength in nm, under D65.
pub(super) fn share_of(value: impl Fn(f64) -> f64) -> Color {
    let mut sum = [0.0; 3];
    for (i, (weights, light)) in MATCHING.iter().zip(DAYLIGHT).enumerate() {
        let value = value(f64::from(RANGE.0) + i as f64) * f64::from(light);
        sum.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += f64::from(*weight) * value);
    }
    Color { rgb: sum.map(|v| v.max(0.0) as f32) }
}

/// The colour of CIE chromaticity `(x, y)`, at luminance 1.
pub(super) fn chromatic(x: f64, y: f64) -> Color {
    within([x / y, 1.0, (1.0 - x - y) / y])
}

fn within(xyz: [f64; 3]) -> Color {
    let [r, g, b] = rec709(xyz).map(|v| v.max(0.0) as f32);
    Color::new(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(c: Color, expected: [f32; 3], within: f32) {
        assert!((0..3).all(|i| (c.rgb[i] - expected[i]).abs() < within), "{:?} {expected:?}", c.rgb);
    }

    #[test]
    fn equal_shares_are_white_and_their_half_is_grey() {
        let flat = |v: f32| Sampled::new(&[300.0, v, 900.0, v]).expect("a spectrum").share();
        near(flat(1.0), [1.0; 3], 1e-6);
        near(flat(0.25), [0.25; 3], 1e-6);
    }

    #[test]
    fn spectra_are_linear_between_samples_and_zero_outside() {
        let s = Sampled::new(&[400.0, 1.0, 500.0, 3.0, 700.0, 2.0]).expect("a spectrum");
        assert_eq!([400.0, 450.0, 600.0, 700.0].map(|l| s.inside(l)), [1.0, 2.0, 2.5, 2.0].map(Some));
        assert_eq!([399.0, 701.0].map(|l| s.inside(l)), [None; 2]);
        assert_eq!([300.0, 600.0, 800.0].map(|l| s.nearest(l)), [1.0, 2.5, 2.0]);
    }

    #[test]
    fn weights_of_wavelengths_add_up_to_the_colour() {
        let (wavelengths, values) = ([350.0, 480.0, 560.0, 600.0, 900.0], [0.2, 0.1, 0.7, 0.9, 0.5]);
        let pairs: Vec<f32> = wavelengths.iter().zip(values).flat_map(|(w, v)| [*w, v]).collect();
        let mut sum = [0.0; 3];
        for (weights, value) in share_weights(&wavelengths).iter().zip(values) {
            sum.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * value);
        }
        near(Sampled::new(&pairs).expect("a spectrum").share(), sum, 1e-4);
        // One alone stands for all.
        near(Color { rgb: share_weights(&[500.0])[0] }, [1.0; 3], 1e-4);
        assert!(share_weights(&[]).is_empty());
    }

    #[test]
    fn the_luminance_of_a_light_is_linear_in_its_power_and_1_where_that_is_1() {
        let flat = |v: f32| Sampled::new(&[300.0, v, 900.0, v]).expect("a spectrum").luminance();
        assert!((flat(1.0) - 1.0).abs() < 1e-3 && (flat(20.0) - 20.0 * flat(1.0)).abs() < 1e-4);
    }

    #[test]
    fn daylight_is_white() {
        near(chromatic(0.312_727, 0.329_023), [1.0; 3], 1e-3);
    }

    #[test]
    fn bad_spectra_are_refused() {
        assert!(Sampled::new(&[]).is_err() && Sampled::new(&[400.0]).is_err());
        assert!(Sampled::new(&[400.0, 1.0, 400.0, 2.0]).is_err_and(|m| m.contains("must rise")));
        assert!(Sampled::new(&[400.0, f32::NAN]).is_err());
    }
}
