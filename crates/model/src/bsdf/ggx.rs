//! The isotropic GGX microfacet distribution with height-correlated Smith shadowing.
//!
//! `D = a² / (pi (c_h² (a² - 1) + 1)²)` (Trowbridge and Reitz 1975; Walter et al. 2007, equation 33). Shadowing and the
//! denominator of the reflection lobe in one (Heitz 2014, equation 99; glTF 2.0, appendix B):
//! `V = G / (4 c_o c_i) = 1 / (2 (c_i sqrt(c_o² (1 - a²) + a²) + c_o sqrt(c_i² (1 - a²) + a²)))`.
use std::f32::consts::PI;

use durer_core::math::{
    Point2, Vector3,
    float::{cos, sin, sqr},
};

/// Density of microfacet normals at the unit vector `h`; 1/sr.
pub(super) fn distribution(h: Vector3, alpha: f32) -> f32 {
    let a2 = sqr(alpha);
    // The sine from x and y: 1 - z² would lose all digits where a narrow lobe has its peak.
    let q = a2 * sqr(h.z) + sqr(h.x) + sqr(h.y);
    a2 / (PI * sqr(q))
}

/// Shadowing and masking divided by four cosines, for cosines above 0.
pub(super) fn visibility(cos_o: f32, cos_i: f32, alpha: f32) -> f32 {
    let a2 = sqr(alpha);
    let root = |c: f32| (sqr(c) * (1.0 - a2) + a2).sqrt();
    0.5 / (cos_i * root(cos_o) + cos_o * root(cos_i))
}

/// Smith's masking of one direction, for a cosine above 0: the share of microfacets seen from it.
pub(super) fn masking(cos: f32, alpha: f32) -> f32 {
    let a2 = sqr(alpha);
    2.0 * cos / (cos + (sqr(cos) * (1.0 - a2) + a2).sqrt())
}

/// The microfacet normal seen from `wo` (`wo.z > 0`) at a point of the unit square: stretched so that the surface is a
/// hemisphere, the normals seen are halfway between `wo` and a uniform cap of directions (Dupuy and Benyoub 2023,
/// "Sampling Visible GGX Normals with Spherical Caps").
pub(super) fn visible_normal(wo: Vector3, alpha: f32, u: Point2) -> Vector3 {
    let stretched = |v: Vector3| Vector3::new(alpha * v.x, alpha * v.y, v.z).normalize();
    let o = stretched(wo);
    let z = 1.0 - u.y * (1.0 + o.z);
    let r = (1.0 - z * z).max(0.0).sqrt();
    let phi = 2.0 * PI * u.x;
    stretched(Vector3::new(r * cos(phi), r * sin(phi), z) + o)
}
