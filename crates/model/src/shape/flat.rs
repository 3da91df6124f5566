//! Flat outlines as lights see them.
use durer_core::glam::DVec3;

/// The corner and both edges of the parallelogram that four corners make, in order around it; `None` if they make none,
/// as far as coordinates rounded to f32 can tell.
pub(crate) fn parallelogram([a, b, c, d]: [DVec3; 4]) -> Option<(DVec3, [DVec3; 2])> {
    let largest = [a, b, c, d].iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
    let noise = 4.0 * f64::from(f32::EPSILON) * largest;
    let edges = [b - a, d - a];
    let closes = (c - b - edges[1]).abs().max_element() <= noise;
    (closes && edges[0].cross(edges[1]) != DVec3::ZERO).then_some((a, edges))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parallelograms_are_told_from_other_quadrilaterals() {
        let corner = |x: f64, y: f64| DVec3::new(x, 3.0, y);
        let [a, b, c, d] = [corner(1.0, 1.0), corner(3.0, 1.5), corner(3.0, 3.5), corner(1.0, 3.0)];
        assert_eq!(parallelogram([a, b, c, d]), Some((a, [b - a, d - a])));
        assert_eq!(parallelogram([a, b, c + DVec3::X * 1e-4, d]), None);
        assert_eq!(parallelogram([a, b, d, c]), None);
        assert_eq!(parallelogram([a, a, c, c]), None);
    }
}
