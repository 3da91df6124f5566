//! Where a line meets a bilinear patch, by elimination (Ramsey, Potter and Hansen 2004, "Ray Bilinear Patch
//! Intersections"): the patch is projected along the line, which leaves two equations of the form
//! `A u v + B u + C v + D = 0`; eliminating `v` gives a quadratic equation in `u`.
use glam::DVec3;

/// The parameters `(t, u, v)` at which `o + t d` meets the patch with corners at (0, 0), (1, 0), (0, 1), (1, 1), inside
/// the unit square, ordered by `t`.
pub fn meetings(corners: [DVec3; 4], o: DVec3, d: DVec3) -> Vec<(f64, f64, f64)> {
    let [p00, p10, p01, p11] = corners;
    let (e, f) = d.normalize().any_orthonormal_pair();
    let (bilinear, by_u, by_v, free) = (p11 - p10 - p01 + p00, p10 - p00, p01 - p00, p00 - o);
    let [a1, b1, c1, d1] = [bilinear, by_u, by_v, free].map(|k| k.dot(e));
    let [a2, b2, c2, d2] = [bilinear, by_u, by_v, free].map(|k| k.dot(f));
    // v (a u + c) = -(b u + d) for both; cross-multiplied.
    let qa = b1 * a2 - b2 * a1;
    let qb = b1 * c2 - b2 * c1 + d1 * a2 - d2 * a1;
    let qc = d1 * c2 - d2 * c1;
    let mut found: Vec<_> = roots(qa, qb, qc)
        .into_iter()
        .filter_map(|u| {
            let (n1, n2) = (a1 * u + c1, a2 * u + c2);
            // The better conditioned of the two.
            let v = if n1.abs() > n2.abs() { -(b1 * u + d1) / n1 } else { -(b2 * u + d2) / n2 };
            let p = p00 + by_u * u + by_v * v + bilinear * (u * v);
            let t = (p - o).dot(d) / d.length_squared();
            let inside = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
            inside.then_some((t, u, v))
        })
        .collect();
    found.sort_by(|x, y| x.0.total_cmp(&y.0));
    found
}

/// Real roots of `a x^2 + b x + c`.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    if a.abs() < 1e-13 * (b.abs() + c.abs()) {
        return vec![-c / b];
    }
    let (p, q) = (b / (2.0 * a), c / a);
    let room = p * p - q;
    if room < 0.0 { Vec::new() } else { vec![-p - room.sqrt(), -p + room.sqrt()] }
}
