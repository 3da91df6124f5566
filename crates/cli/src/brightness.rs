//! Pictures that nobody can see anything in, for too much or too little light, and which exposure would help.
use durer::{film::Pixel, spectrum::Color};

/// Half of the picture beyond this is too bright: stops above middle grey.
const TOO_BRIGHT: f32 = 4.5;
/// The same, below.
const TOO_DARK: f32 = -6.5;
/// The luminance that a photographer takes the middle of a picture to be.
const MIDDLE_GREY: f32 = 0.18;

/// The exposure in whole stops that makes the middle of the lit pixels grey, if with this `exposure` they are far from it.
pub(crate) fn better_exposure(pixels: &[Pixel], exposure: f32) -> Option<f32> {
    let light = |pixel: &Pixel| Color { rgb: pixel.mean() }.luminance();
    let mut lit: Vec<f32> = pixels.iter().map(light).filter(|v| *v > 0.0 && v.is_finite()).collect();
    if lit.is_empty() {
        return None;
    }
    let middle = lit.len() / 2;
    let (_, median, _) = lit.select_nth_unstable_by(middle, f32::total_cmp);
    let stops = f64::from(*median / MIDDLE_GREY).log2() as f32;
    (!(TOO_DARK..=TOO_BRIGHT).contains(&(stops + exposure))).then(|| 0.0 - stops.round())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn better(values: &[f32], exposure: f32) -> Option<f32> {
        let pixel = |&v: &f32| Pixel { sum: [v; 3], weight: 1.0 };
        better_exposure(&values.iter().map(pixel).collect::<Vec<_>>(), exposure)
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
}
