//! The isotropic GGX distribution with height-correlated Smith shadowing, in double precision.
//!
//! Walter et al. 2007 (distribution), Heitz 2014 (shadowing), Schlick 1994 (Fresnel term).
use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// A GGX surface.
#[derive(Clone, Copy, Debug)]
pub struct Ggx {
    /// Roughness.
    pub alpha: f64,
}

impl Ggx {
    /// Density of microfacet normals at cosine `c`.
    pub fn d(self, c: f64) -> f64 {
        let a2 = self.alpha * self.alpha;
        let q = c * c * (a2 - 1.0) + 1.0;
        a2 / (PI * q * q)
    }
    fn lambda(self, c: f64) -> f64 {
        let tan2 = (1.0 - c * c).max(0.0) / (c * c);
        0.5 * ((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0)
    }
    /// Share of microfacets seen from both directions of cosines `co`, `ci`.
    pub fn g2(self, co: f64, ci: f64) -> f64 {
        1.0 / (1.0 + self.lambda(co) + self.lambda(ci))
    }
    /// Calls `f(wi, h, density)` for `n * n` directions `wi` that mirrors drawn from the distribution send `wo` to,
    /// with the solid-angle density of `wi`; those below the surface are left out. Returns the mean of `f / density`.
    pub fn integrate(self, wo: DVec3, n: usize, mut f: impl FnMut(DVec3, DVec3) -> f64) -> f64 {
        let mut sum = 0.0;
        for i in 0..n {
            let u = (i as f64 + 0.5) / n as f64;
            let tan2 = self.alpha * self.alpha * u / (1.0 - u);
            let c = 1.0 / (1.0 + tan2).sqrt();
            let s = (1.0 - c * c).max(0.0).sqrt();
            for j in 0..n {
                let phi = (j as f64 + 0.5) / n as f64 * TAU;
                let h = DVec3::new(s * phi.cos(), s * phi.sin(), c);
                let wi = 2.0 * wo.dot(h) * h - wo;
                if wi.z > 0.0 && wo.dot(h) > 0.0 {
                    sum += f(wi, h) * 4.0 * wo.dot(h) / (self.d(c) * c);
                }
            }
        }
        sum / (n * n) as f64
    }
    /// `(a, b)` such that the share of light that leaves towards cosine `mu` is `f0 a + b` when Schlick's term runs from
    /// `f0` to 1.
    pub fn albedo(self, mu: f64, n: usize) -> (f64, f64) {
        let wo = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
        let part = |grazing: bool| {
            self.integrate(wo, n, |wi, h| {
                let fc = (1.0 - wo.dot(h)).powi(5);
                let fresnel = if grazing { fc } else { 1.0 - fc };
                fresnel * self.d(h.z) * self.g2(mu, wi.z) / (4.0 * mu)
            })
        };
        (part(false), part(true))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_scattering_loses_what_the_table_says() {
        // validation.md E3 (normal incidence) and E4 (cosine 0.5).
        let table = [
            (1.0, 0.1, 0.988304),
            (1.0, 0.25, 0.915812),
            (1.0, 0.5, 0.687849),
            (1.0, 1.0, 0.306853),
            (0.5, 0.5, 0.698251),
            (0.5, 1.0, 0.450694),
        ];
        for (mu, alpha, expected) in table {
            let (a, b) = Ggx { alpha }.albedo(mu, 800);
            assert!((a + b - expected).abs() < 3e-4, "mu {mu} alpha {alpha}: {}", a + b);
        }
    }
}
