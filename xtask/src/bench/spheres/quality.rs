//! How far a picture is from what its program would draw in the end.
use std::path::Path;

use super::{Mode, Run};
use crate::assets::picture::Picture;

/// Root of the mean squared difference between the antialiased and the converged picture of a program that leaves its
/// pictures at `path`, as a share of the way from black to white in code values.
pub(super) fn rmse(path: &Path, run: impl Fn(Mode) -> anyhow::Result<Run>) -> anyhow::Result<f64> {
    run(Mode::Converged)?;
    let converged = Picture::read(path)?;
    run(Mode::Antialiased)?;
    Ok(difference(&Picture::read(path)?.rgb, &converged.rgb))
}

fn difference(a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    let sum: f64 = pairs.map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum();
    (sum / a.as_flattened().len() as f64).sqrt() / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_shares_of_white() {
        assert_eq!(difference(&[[0; 3], [9; 3]], &[[255; 3], [9; 3]]), 0.5f64.sqrt());
        assert_eq!(difference(&[[1, 2, 3]], &[[1, 2, 3]]), 0.0);
    }
}
