//! The lecture's ray-triangle test: Cramer's rule on `a + beta (b - a) + gamma (c - a) = R_o + t R_d`.
use durer_core::math::{Point3, Ray, Vector3};

/// The determinant of the matrix with these columns.
fn determinant(x: Vector3, y: Vector3, z: Vector3) -> f32 {
    x.x * (y.y * z.z - z.y * y.z) - y.x * (x.y * z.z - z.y * x.z) + z.x * (x.y * y.z - y.y * x.z)
}

/// `(t, beta, gamma)` as the lecture prints it ("Using Cramer's Rule"): four determinants, inside if
/// `0 < alpha, beta, gamma < 1` and `t_min < t < t_max`. Not watertight: an oracle, and what the ray debugger shows.
pub fn cramer(ray: &Ray, triangle: &[Point3; 3]) -> Option<(f32, f32, f32)> {
    let [a, b, c] = *triangle;
    let (ab, ac, ao) = (a - b, a - c, a - ray.o);
    let whole = determinant(ab, ac, ray.d);
    let beta = determinant(ao, ac, ray.d) / whole;
    let gamma = determinant(ab, ao, ray.d) / whole;
    let t = determinant(ab, ac, ao) / whole;
    let alpha = 1.0 - beta - gamma;
    // A zero determinant gives infinities or NaN, which fail these comparisons.
    let inside = [alpha, beta, gamma].iter().all(|w| 0.0 < *w && *w < 1.0);
    (inside && ray.t_min < t && t < ray.t_max).then_some((t, beta, gamma))
}
