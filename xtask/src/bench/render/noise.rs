//! How noisy one picture is.
use super::picture::Picture;

/// Keeps dark pixels from counting more than all others.
const DARK: f64 = 0.01;
/// Pixels about what is left out that are left out too: its edges are no measure of light transport.
const MARGIN: usize = 2;

/// Mean over pixels, channels and pairs of `(a - b)^2 / 2 / (mean^2 + 0.01)`: without bias the relative mean squared error of
/// one picture, as far as it is noise.
pub(super) fn relative_variance(pictures: &[Picture], mean: &Picture, mask: &[bool]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, first) in pictures.iter().enumerate() {
        for second in &pictures[i + 1..] {
            let pixels = first.pixels.iter().zip(&second.pixels).zip(&mean.pixels).zip(mask);
            for (((a, b), m), _) in pixels.filter(|(_, counts)| **counts) {
                let terms = (0..3).map(|c| (a[c] - b[c]).powi(2) / 2.0 / (m[c].powi(2) + DARK));
                sum += terms.sum::<f64>();
                count += 3.0;
            }
        }
    }
    sum / count
}

/// Which pixels count: all, but for those that are brighter than `bright` in the mean of all renderers, and what is next
/// to them.
pub(super) fn mask(bright: Option<f64>, means: &[Picture]) -> Vec<bool> {
    let Some(mean) = Picture::mean(means) else { return Vec::new() };
    let mut counts = vec![true; mean.pixels.len()];
    let (width, height) = (mean.width, mean.pixels.len() / mean.width.max(1));
    for (i, pixel) in mean.pixels.iter().enumerate() {
        if bright.is_none_or(|bright| pixel.iter().all(|value| *value <= bright)) {
            continue;
        }
        let around = |at: usize, size: usize| at.saturating_sub(MARGIN)..(at + MARGIN + 1).min(size);
        for y in around(i / width, height) {
            around(i % width, width).for_each(|x| counts[y * width + x] = false);
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: usize, values: &[f64]) -> Picture {
        Picture { width, pixels: values.iter().map(|v| [*v; 3]).collect() }
    }

    #[test]
    fn variance_is_half_the_squared_difference_of_a_pair() {
        let pictures = [grey(2, &[0.9, 5.0]), grey(2, &[1.1, 7.0])];
        let mean = Picture::mean(&pictures).expect("two");
        let found = relative_variance(&pictures, &mean, &[true, false]);
        assert!((found - 0.02 / 1.01).abs() < 1e-12, "{found}");
    }

    #[test]
    fn lights_and_what_is_next_to_them_do_not_count() {
        let mut values = [0.5; 49];
        values[0] = 3.0;
        let found = mask(Some(2.0), &[grey(7, &values)]);
        assert_eq!(found.iter().filter(|counts| !**counts).count(), 9);
        assert!(!found[2 * 7 + 2] && found[3] && found[3 * 7]);
        assert!(mask(None, &[grey(7, &values)]).iter().all(|counts| *counts));
    }
}
