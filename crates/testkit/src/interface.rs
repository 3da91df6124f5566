//! Smooth interfaces in double precision: three statements of Snell's law and Fresnel's equations.
use glam::DVec3;

/// The transmitted direction as the lecture derives it: `i` points back along the ray, `n` to the same side,
/// `eta_r = eta_i / eta_t`. `None` if the root is imaginary.
pub fn snell(i: DVec3, n: DVec3, eta_r: f64) -> Option<DVec3> {
    let cos_i = n.dot(i);
    let under_root = 1.0 - eta_r * eta_r * (1.0 - cos_i * cos_i);
    (under_root >= 0.0).then(|| (eta_r * cos_i - under_root.sqrt()) * n - eta_r * i)
}

/// Whitted's reflected and transmitted directions (1980, section 2), not normalised: `v` runs *towards* the surface,
/// `n` against it, `kn = eta_t / eta_i`. `R = V' + 2 N`, `P = kf (N + V') - N` with `V' = V / |V . N|` and
/// `kf = (kn^2 |V'|^2 - |V' + N|^2)^(-1/2)`; `P` is `None` if `kf` is imaginary.
pub fn whitted_directions(v: DVec3, n: DVec3, kn: f64) -> (DVec3, Option<DVec3>) {
    let v = v / v.dot(n).abs();
    let under_root = kn * kn * v.length_squared() - (v + n).length_squared();
    (v + 2.0 * n, (under_root > 0.0).then(|| (n + v) / under_root.sqrt() - n))
}

/// Reflectance for light polarised perpendicular and parallel to the plane of incidence; `eta = eta_t / eta_i`.
pub fn fresnel(cos_i: f64, eta: f64) -> (f64, f64) {
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if sin2_t >= 1.0 {
        return (1.0, 1.0);
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let p = (cos_t - eta * cos_i) / (cos_t + eta * cos_i);
    (s * s, p * p)
}

/// Unpolarised reflectance.
pub fn fresnel_mean(cos_i: f64, eta: f64) -> f64 {
    let (s, p) = fresnel(cos_i, eta);
    0.5 * (s + p)
}

/// The critical angle in degrees when leaving a medium of index `n` into vacuum.
pub fn critical_angle(n: f64) -> f64 {
    (1.0 / n).asin().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn whitted_and_the_lecture_agree_on_random_inputs() {
        let mut random = Random::new(3);
        for _ in 0..100_000 {
            let n = random.direction();
            let i = random.direction();
            let i = if i.dot(n) < 0.0 { -i } else { i };
            let kn = random.between(0.4, 2.5);
            let (r, p) = whitted_directions(-i, n, kn);
            assert!((r.normalize() - (2.0 * i.dot(n) * n - i)).length() < 1e-12);
            let t = snell(i, n, 1.0 / kn);
            assert_eq!(p.is_some(), t.is_some(), "i {i} n {n} kn {kn}");
            if let (Some(p), Some(t)) = (p, t) {
                assert!((p.normalize() - t.normalize()).length() < 1e-12, "i {i} n {n} kn {kn}");
            }
        }
    }

    #[test]
    fn whitted_example_comes_out() {
        let s = 0.5f64.sqrt();
        let (r, p) = whitted_directions(DVec3::new(s, -s, 0.0), DVec3::Y, 1.5);
        assert!((r - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-12);
        let p = p.expect("entering glass never reflects totally");
        assert!((p - DVec3::new(0.534522, -1.0, 0.0)).length() < 1e-6);
        assert!(((p.x / -p.y).atan().to_degrees() - 28.1255).abs() < 1e-4);
        let steep = DVec3::new(60f64.to_radians().sin(), -0.5, 0.0);
        assert_eq!(whitted_directions(steep, DVec3::Y, 1.0 / 1.5).1, None);
    }

    #[test]
    fn critical_angles_match_the_table() {
        let table =
            [(1.333, 48.6066), (4.0 / 3.0, 48.5904), (1.5, 41.8103), (1.52, 41.1395), (2.417, 24.4397)];
        for (n, degrees) in table {
            assert!((critical_angle(n) - degrees).abs() < 1e-4, "{n}");
        }
    }
}
