//! From the unit square to where samples are wanted, keeping what lies together together.
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use crate::math::{Point2, Vector3, float::sqr};

/// The point of the unit disk for a point of the unit square, as a radius with a sign, -1 to 1, and an angle: squares become
/// rings (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
#[inline]
pub fn concentric_polar(u: Point2) -> (f32, f32) {
    let (r, angle, is_from_y) = wedge(u);
    (r, if is_from_y { FRAC_PI_2 - angle } else { angle })
}

/// The same point by its coordinates.
#[inline]
pub fn concentric_disk(u: Point2) -> [f32; 2] {
    let (r, angle, is_from_y) = wedge(u);
    let (sin, cos) = sin_cos_of_eighth(angle);
    if is_from_y { [r * sin, r * cos] } else { [r * cos, r * sin] }
}

/// Radius with a sign, the angle from the nearer axis, in `[-pi/4, pi/4]`, and whether that is the y axis.
#[inline]
fn wedge(u: Point2) -> (f32, f32, bool) {
    let (x, y) = (2.0 * u.x - 1.0, 2.0 * u.y - 1.0);
    match x.abs() > y.abs() {
        _ if x == 0.0 && y == 0.0 => (0.0, 0.0, false),
        true => (x, FRAC_PI_4 * (y / x), false),
        false => (y, FRAC_PI_4 * (x / y), true),
    }
}

/// Sine and cosine of an angle in `[-pi/4, pi/4]`, by their series, to 1e-7. PERF: every scattered ray asks (bench render).
#[inline]
fn sin_cos_of_eighth(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let sin =
        x * (1.0 + x2 * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0)))));
    let cos = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40320.0))));
    (sin, cos)
}

/// The unit direction about +z for a point of the unit square, with density `z / pi`.
#[inline]
pub fn cosine_hemisphere(u: Point2) -> Vector3 {
    let [x, y] = concentric_disk(u);
    // NUMERICS: at the rim rounding leaves nothing, half a step on the average. A direction in the surface would have no density,
    // and a weight as large as the rounding of another frame is beside it.
    let z = (1.0 - sqr(x) - sqr(y)).max(0.25 * f32::EPSILON).sqrt();
    Vector3::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_are_sine_and_cosine() {
        for i in -1000..=1000 {
            let x = FRAC_PI_4 * i as f32 / 1000.0;
            let (sin, cos) = sin_cos_of_eighth(x);
            assert!((f64::from(sin) - f64::from(x).sin()).abs() < 1e-7, "{x}");
            assert!((f64::from(cos) - f64::from(x).cos()).abs() < 1e-7, "{x}");
        }
    }

    #[test]
    fn no_direction_lies_in_the_surface() {
        for u in [[0.0, 0.5], [0.5, 0.0], [0.0, 0.0], [1.0, 0.5]] {
            let d = cosine_hemisphere(Point2::new(u[0], u[1]));
            assert!((1e-4..3e-4).contains(&d.z) && (d.length() - 1.0).abs() < 1e-6, "{u:?}: {d:?}");
        }
    }

    #[test]
    fn equal_areas_stay_equal_and_cosines_have_their_mean() {
        // The square root at the rim makes sums converge slowly.
        let n = 1024;
        let at = |i: u32| (i as f32 + 0.5) / n as f32;
        let all = (0..n * n).map(|i| Point2::new(at(i % n), at(i / n)));
        let (mut inner, mut right, mut cosines) = (0, 0, 0.0f64);
        for u in all {
            let [x, y] = concentric_disk(u);
            assert!(x * x + y * y <= 1.0 + 1e-6);
            inner += u32::from(x * x + y * y < 0.25);
            right += u32::from(x > 0.5);
            let w = cosine_hemisphere(u);
            assert!((w.length() - 1.0).abs() < 1e-6 && w.z > 0.0);
            cosines += f64::from(w.z);
        }
        let share = |count: u32| f64::from(count) / f64::from(n * n);
        assert!((share(inner) - 0.25).abs() < 1e-3, "{}", share(inner));
        // The part of the disk beyond x = 1/2: (pi/3 - sqrt(3)/4) / pi.
        assert!((share(right) - 0.195_501).abs() < 1e-3, "{}", share(right));
        // The mean cosine under a density proportional to the cosine is 2/3.
        assert!((cosines / f64::from(n * n) - 2.0 / 3.0).abs() < 1e-4);
    }
}
