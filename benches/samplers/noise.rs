//! How much pictures differ that differ in nothing but their random numbers.
use crate::picture::Picture;

/// Keeps dark pixels from counting more than all others.
const DARK: f64 = 0.01;

/// Mean over pixels and channels of variance by square of the mean (and [`DARK`]): the relative mean squared error that is
/// to be expected of one picture, as no kind of sampler that is measured has an error of the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Noise {
    /// Of the pictures as they are.
    pub(crate) sharp: f64,
    /// Of the pictures after a blur, as an eye sees them that is too far away to tell pixels apart.
    pub(crate) blurred: f64,
}

impl Noise {
    /// From two or more pictures, their converged mean and that after the blur.
    pub(crate) fn of(pictures: &[Picture], mean: &Picture, blurred_mean: &Picture) -> Self {
        let blurred: Vec<Picture> = pictures.iter().map(Picture::blurred).collect();
        Self { sharp: relative_variance(pictures, mean), blurred: relative_variance(&blurred, blurred_mean) }
    }
}

fn relative_variance(pictures: &[Picture], mean: &Picture) -> f64 {
    let n = pictures.len() as f64;
    let values = mean.values();
    let of_value = |i: usize| {
        let found = pictures.iter().map(|picture| picture.values()[i]);
        let middle = found.clone().sum::<f64>() / n;
        let variance = found.map(|v| (v - middle).powi(2)).sum::<f64>() / (n - 1.0);
        variance / (values[i].powi(2) + DARK)
    };
    (0..values.len()).map(of_value).sum::<f64>() / values.len() as f64
}
