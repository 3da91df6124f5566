//! Isotropic microfacets, GGX or Beckmann's, with height-correlated Smith shadowing, in double precision.
//!
//! Walter et al. 2007 (distributions), Heitz 2014 (shadowing), Schlick 1994 (Fresnel term).
use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// A rough surface.
#[derive(Clone, Copy, Debug)]
pub struct Facets {
    /// Roughness.
    pub alpha: f64,
    /// How normals are distributed.
    pub like: Like,
}

/// A distribution of normals.
#[derive(Clone, Copy, Debug)]
pub enum Like {
    /// Trowbridge and Reitz's.
    Ggx,
    /// Beckmann's.
    Beckmann,
}

impl Facets {
    /// Those of GGX.
    pub fn ggx(alpha: f64) -> Self {
        Self { alpha, like: Like::Ggx }
    }
    /// Beckmann's.
    pub fn beckmann(alpha: f64) -> Self {
        Self { alpha, like: Like::Beckmann }
    }
    /// Density of microfacet normals at cosine `c`.
    pub fn d(self, c: f64) -> f64 {
        let a2 = self.alpha * self.alpha;
        match self.like {
            Like::Ggx => {
                let q = c * c * (a2 - 1.0) + 1.0;
                a2 / (PI * q * q)
            }
            Like::Beckmann => (-(1.0 / (c * c) - 1.0) / a2).exp() / (PI * a2 * c.powi(4)),
        }
    }
    fn lambda(self, c: f64) -> f64 {
        let tan = (1.0 - c * c).max(0.0).sqrt() / c;
        let slope = 1.0 / (self.alpha * tan);
        match self.like {
            Like::Ggx => 0.5 * ((1.0 + 1.0 / (slope * slope)).sqrt() - 1.0),
            Like::Beckmann if slope > 20.0 => 0.0,
            Like::Beckmann => 0.5 * ((-slope * slope).exp() / (slope * PI.sqrt()) - libm::erfc(slope)),
        }
    }
    /// Share of microfacets seen from both directions of cosines `co`, `ci`.
    pub fn g2(self, co: f64, ci: f64) -> f64 {
        1.0 / (1.0 + self.lambda(co) + self.lambda(ci))
    }
    /// The mean of `f(h)` over `n * n` normals `h` with the density `D cos`.
    fn over_normals(self, n: usize, mut f: impl FnMut(DVec3) -> f64) -> f64 {
        let mut sum = 0.0;
        for i in 0..n {
            let u = (i as f64 + 0.5) / n as f64;
            let tan2 = match self.like {
                Like::Ggx => u / (1.0 - u),
                Like::Beckmann => -(1.0 - u).ln(),
            };
            let c = 1.0 / (1.0 + self.alpha * self.alpha * tan2).sqrt();
            let s = (1.0 - c * c).max(0.0).sqrt();
            for j in 0..n {
                let phi = (j as f64 + 0.5) / n as f64 * TAU;
                sum += f(DVec3::new(s * phi.cos(), s * phi.sin(), c));
            }
        }
        sum / (n * n) as f64
    }
    /// Calls `f(wi, h)` for `n * n` directions `wi` that mirrors drawn from the distribution send `wo` to; those below the
    /// surface are left out. Returns the mean of `f / density`, by the solid angle of `wi`.
    pub fn integrate(self, wo: DVec3, n: usize, mut f: impl FnMut(DVec3, DVec3) -> f64) -> f64 {
        self.over_normals(n, |h| {
            let wi = 2.0 * wo.dot(h) * h - wo;
            let is_seen = wi.z > 0.0 && wo.dot(h) > 0.0;
            if is_seen { f(wi, h) * 4.0 * wo.dot(h) / (self.d(h.z) * h.z) } else { 0.0 }
        })
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
    fn as_much_is_seen_of_facets_as_of_what_they_lie_on() {
        // The area of visible facets, projected, is the cosine: Heitz 2014, equation 14.
        for alpha in [0.1, 0.4, 1.0] {
            for mu in [0.05f64, 0.3, 0.7, 0.95] {
                for facets in [Facets::ggx(alpha), Facets::beckmann(alpha)] {
                    let wo = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
                    let seen =
                        facets.over_normals(400, |h| wo.dot(h).max(0.0) / h.z) / (1.0 + facets.lambda(mu));
                    // Sums miss some of the long tail of GGX.
                    let most = if matches!(facets.like, Like::Ggx) { 0.02 } else { 4e-3 };
                    assert!((seen / mu - 1.0).abs() < most, "{facets:?} {mu}: {seen}");
                }
            }
        }
    }

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
            let (a, b) = Facets::ggx(alpha).albedo(mu, 800);
            assert!((a + b - expected).abs() < 3e-4, "mu {mu} alpha {alpha}: {}", a + b);
        }
    }
}
