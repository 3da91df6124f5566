//! Pictures that nobody can see anything in, for too much or too little light, and which exposure would help.
use super::Finding;
use crate::{film::Pixel, spectrum::Color};

/// Half of what is lit beyond this is too bright: stops above middle grey.
const TOO_BRIGHT: f32 = 4.5;
/// The same, below.
const TOO_DARK: f32 = -6.5;
/// The luminance that a photographer takes the middle of a picture to be.
const MIDDLE_GREY: f32 = 0.18;
/// With a smaller share of it lit a picture is black.
const LEAST_LIT: f64 = 0.01;

/// Luminances up to this are what rounding leaves of none: between points of a lamp that faces away, say.
const UNLIT: f32 = 1e-20;

/// What is wrong with a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trouble {
    /// Too little light to see anything.
    Dark,
    /// Too much.
    Bright,
}

/// The light of a picture, or of samples all over it.
#[derive(Clone, Debug)]
pub(super) struct Light {
    /// Luminances.
    pub(super) light: Vec<f32>,
    /// Stops by which it is brightened before it is shown.
    pub(super) exposure: f32,
}

impl Light {
    /// That of the pixels that were rendered.
    pub(super) fn of(pixels: &[Pixel], exposure: f32) -> Self {
        let rendered = pixels.iter().filter(|pixel| pixel.weight > 0.0);
        Self { light: rendered.map(|pixel| Color { rgb: pixel.mean() }.luminance()).collect(), exposure }
    }

    /// What is wrong, if anything is.
    pub(super) fn trouble(&self) -> Option<Trouble> {
        if self.light.is_empty() {
            return None;
        }
        if (self.lit().count() as f64) < LEAST_LIT * self.light.len() as f64 {
            return Some(Trouble::Dark);
        }
        self.better().map(|better| if better > self.exposure { Trouble::Dark } else { Trouble::Bright })
    }

    /// The exposure that would help, if there is light.
    pub(super) fn finding(&self, trouble: Trouble) -> Option<Finding> {
        let better = self.better()?;
        let much = match trouble {
            Trouble::Dark => "dark",
            Trouble::Bright => "bright",
        };
        let message = format!("most of the picture is too {much} to see anything");
        Some(Finding::warning(message).remedy(format!("try --exposure {better}")))
    }

    fn lit(&self) -> impl Iterator<Item = f32> {
        self.light.iter().copied().filter(|v| *v > UNLIT && v.is_finite())
    }

    /// The exposure in whole stops that makes the middle of what is lit grey, if it is far from that.
    fn better(&self) -> Option<f32> {
        let mut lit: Vec<f32> = self.lit().collect();
        if lit.is_empty() {
            return None;
        }
        let middle = lit.len() / 2;
        let (_, median, _) = lit.select_nth_unstable_by(middle, f32::total_cmp);
        let stops = f64::from(*median / MIDDLE_GREY).log2() as f32;
        (!(TOO_DARK..=TOO_BRIGHT).contains(&(stops + self.exposure))).then(|| 0.0 - stops.round())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn better(values: &[f32], exposure: f32) -> Option<f32> {
        let pixel = |&v: &f32| Pixel { sum: [v; 3], weight: 1.0 };
        Light::of(&values.iter().map(pixel).collect::<Vec<_>>(), exposure).better()
    }

    #[test]
    fn the_middle_of_what_is_lit_becomes_grey() {
        assert_eq!(better(&[0.18 * 64.0, 1e6, 0.18 * 64.0, 0.1, 0.0, 0.0], 0.0), Some(-6.0));
        assert_eq!(better(&[0.18 / 128.0; 3], 0.0), Some(7.0));
        assert_eq!(better(&[0.01, 0.5, 3.0], 0.0), None);
        assert_eq!(better(&[0.0; 4], 0.0), None);
        assert_eq!(better(&[], 0.0), None);
        assert_eq!(better(&[0.18 * 64.0; 3], -6.0), None);
        assert_eq!(better(&[0.18; 3], 6.0), Some(0.0));
    }

    #[test]
    fn black_pictures_are_dark_and_unfinished_ones_are_not() {
        let pixels = |lit: usize, weight: f32| {
            let value = |i| if i < lit { 0.2 } else { 0.0 };
            (0..1000).map(|i| Pixel { sum: [value(i) * weight; 3], weight }).collect::<Vec<_>>()
        };
        assert_eq!(Light::of(&pixels(0, 1.0), 0.0).trouble(), Some(Trouble::Dark));
        assert_eq!(Light::of(&pixels(9, 1.0), 0.0).trouble(), Some(Trouble::Dark));
        assert_eq!(Light::of(&pixels(10, 1.0), 0.0).trouble(), None);
        assert_eq!(Light::of(&pixels(0, 0.0), 0.0).trouble(), None);
        assert_eq!(Light::of(&pixels(1000, 1.0), 9.0).trouble(), Some(Trouble::Bright));
        assert_eq!(Light::of(&pixels(1000, 1.0), -9.0).trouble(), Some(Trouble::Dark));
    }
}
