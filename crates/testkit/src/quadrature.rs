//! Midpoint quadrature over directions.
use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// `integral f(w) cos(w, z) dw` over the upper hemisphere, from `n * n` points of equal projected solid angle.
pub fn cosine_hemisphere(n: usize, mut f: impl FnMut(DVec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in 0..n {
        let r2 = (i as f64 + 0.5) / n as f64;
        for j in 0..n {
            let phi = (j as f64 + 0.5) / n as f64 * TAU;
            let r = r2.sqrt();
            sum += f(DVec3::new(r * phi.cos(), r * phi.sin(), (1.0 - r2).sqrt()));
        }
    }
    sum * PI / (n * n) as f64
}

/// `integral f(w) dw` over the sphere, from `n * n` points of equal solid angle.
pub fn sphere(n: usize, mut f: impl FnMut(DVec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in 0..n {
        let z = 1.0 - 2.0 * (i as f64 + 0.5) / n as f64;
        let r = (1.0 - z * z).sqrt();
        for j in 0..n {
            let phi = (j as f64 + 0.5) / n as f64 * TAU;
            sum += f(DVec3::new(r * phi.cos(), r * phi.sin(), z));
        }
    }
    sum * 2.0 * TAU / (n * n) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_integrals_come_out() {
        assert!((cosine_hemisphere(64, |_| 1.0) - PI).abs() < 1e-12);
        assert!((cosine_hemisphere(256, |w| w.z) - TAU / 3.0).abs() < 1e-4);
        assert!((sphere(256, |w| w.x * w.x) - 2.0 * TAU / 3.0).abs() < 1e-4);
    }
}
