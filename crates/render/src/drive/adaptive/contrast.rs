//! How different colours look.
use durer_core::math::float;

/// What the eye sees of linear light, roughly: 0 is black, 1 white. A square root is close to the sRGB curve up to white;
/// beyond it light is told apart by its ratios, as tone maps show it, and the curve goes on without a bend.
fn seen(light: f32) -> f32 {
    if light <= 1.0 { light.max(0.0).sqrt() } else { 1.0 + 0.5 * float::ln(light) }
}

/// The largest difference in a channel between any two of four colours, on the scale from black 0 to white 1. A colour of
/// NaN is none.
pub(super) fn contrast(corners: &[[f32; 3]; 4]) -> f32 {
    let [a, b, c, d] = corners;
    let least = std::array::from_fn(|i| a[i].min(b[i]).min(c[i].min(d[i])));
    let largest = std::array::from_fn(|i| a[i].max(b[i]).max(c[i].max(d[i])));
    spread(&least, &largest)
}

/// The largest difference in a channel between the least and the largest values of a set of colours.
pub(super) fn spread(least: &[f32; 3], largest: &[f32; 3]) -> f32 {
    let mut most = 0.0f32;
    for (&least, &largest) in least.iter().zip(largest) {
        // PERF: most squares are of one colour (bench render).
        if least < largest {
            most = most.max(seen(largest) - seen(least));
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_difference_of_a_channel_counts() {
        let grey = [0.25; 3];
        assert_eq!(contrast(&[grey; 4]), 0.0);
        assert_eq!(contrast(&[grey, grey, [0.25, 1.0, 0.25], grey]), 0.5);
        assert_eq!(contrast(&[grey, [0.25, 0.25, -3.0], grey, [0.16, 0.25, 0.25]]), 0.5);
    }

    #[test]
    fn what_is_no_colour_is_not_compared() {
        let (grey, none) = ([0.25; 3], [f32::NAN; 3]);
        assert_eq!(contrast(&[grey, none, grey, grey]), 0.0);
        assert_eq!(contrast(&[none; 4]), 0.0);
    }

    #[test]
    fn light_beyond_white_is_told_apart_without_a_jump() {
        assert_eq!(seen(1.0), 1.0);
        assert!((seen(1.001) - seen(0.999) - 0.001).abs() < 1e-5);
        assert!(seen(8.0) - seen(4.0) > 0.3 && (seen(8.0) - seen(4.0) - seen(4.0) + seen(2.0)).abs() < 1e-6);
    }
}
