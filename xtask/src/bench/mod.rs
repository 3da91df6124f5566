//! `cargo xtask bench`: what durer is measured by, and beside whom.
mod built;
mod embree;
pub(crate) mod kernel;
pub(crate) mod load;
pub(crate) mod render;
pub(crate) mod samplers;
mod spheres;
pub(crate) mod view;

pub(crate) use built::assets;

/// The middle; of an even number of values the mean of the two in the middle.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match (values.len() % 2, values.get(middle), values.get(middle.wrapping_sub(1))) {
        (0, Some(high), Some(low)) => (high + low) / 2.0,
        (_, Some(value), _) => *value,
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(vec![7.0]), 7.0);
    }
}
