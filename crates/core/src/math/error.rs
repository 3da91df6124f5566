//! Rounding error bounds (Higham 2002, section 3.1; Physically Based Rendering, section 6.8).
use super::{Normal3, Point3, Vector3};

/// Bound on the relative error of `n` chained roundings: `n u / (1 - n u)`, `u = 2^-24`.
#[inline]
pub const fn gamma(n: u32) -> f32 {
    let u = f32::EPSILON / 2.0;
    (n as f32 * u) / (1.0 - n as f32 * u)
}

/// The next point off the surface from which a ray towards `w` cannot meet the surface again by rounding alone.
///
/// `p` lies within `p_error` (absolute, per coordinate) of the surface with unit normal `n`. The point is moved along
/// the normal, to the side `w` points to, until outside the box of uncertainty, then one float further on each axis.
#[inline]
pub fn offset_ray_origin(p: Point3, p_error: Vector3, n: Normal3, w: Vector3) -> Point3 {
    let distance = n.abs().dot(p_error);
    let side = if n.dot(w) < 0.0 { -1.0 } else { 1.0 };
    let offset = Vector3::from(n) * (distance * side);
    let step = |p: f32, o: f32| {
        let q = p + o;
        if o == 0.0 {
            q
        } else if q == 0.0 {
            f32::from_bits(1).copysign(o)
        } else {
            // PERF: the neighbouring float without the branches of next_up and next_down (bench render).
            let away = (o > 0.0) == (q > 0.0);
            f32::from_bits(q.to_bits().wrapping_add(if away { 1 } else { u32::MAX }))
        }
    };
    Point3::new(step(p.x, offset.x), step(p.y, offset.y), step(p.z, offset.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offset_leaves_the_box_of_uncertainty() {
        let p = Point3::new(1e4, -3.0, 0.25);
        let e = Vector3::new(1e-2, 1e-6, 1e-7);
        let n = Normal3::new(0.6, 0.0, 0.8);
        for w in [Vector3::from(n), -Vector3::from(n)] {
            let moved = offset_ray_origin(p, e, n, w) - p;
            assert!(moved.dot(n).abs() >= n.abs().dot(e), "{moved:?}");
            assert!(moved.dot(w) > 0.0);
        }
    }
}
