//! Beckmann's distribution of microfacets, their slopes normally distributed, with height-correlated Smith shadowing.
//!
//! `D = exp(-(x²/a_x² + y²/a_y²) / z²) / (pi a_x a_y z⁴)` (Beckmann and Spizzichino 1963). With
//! `a = z / sqrt(a_x² x² + a_y² y²)` of a direction, `Lambda = (exp(-a²) / (a sqrt(pi)) - erfc(a)) / 2` (Heitz 2014, equation
//! 72, for two widths by section 5.3), and the share seen from two of them is `1 / (1 + Lambda_o + Lambda_i)`.
//! All directions are in the frame of the tangent.
//!
//! PERF: not inlined, so that the formulas of GGX are (bench render).
use std::f32::consts::PI;

use durer_core::math::{
    Point2, Vector3,
    float::{erfc, exp, sqr},
};

/// Exponents beyond this give nothing that a float holds.
const NOTHING: f32 = 80.0;
/// Slopes of this size and more, in units of the width, have no share that a float holds.
const STEEPEST: f32 = 4.0;
/// Cosines are taken to be at least this.
const LEAST: f32 = 1e-7;
const FRAC_1_SQRT_PI: f32 = 0.564_189_6;
/// Halvings of the bounds of a slope leave nothing between them after as many.
const STEPS: u32 = 30;

/// Density of microfacet normals at the unit vector `h`; 1/sr.
#[inline(never)]
pub(super) fn distribution(h: Vector3, [x, y]: [f32; 2]) -> f32 {
    let z2 = sqr(h.z);
    let slopes = sqr(h.x / x) + sqr(h.y / y);
    if slopes >= NOTHING * z2 { 0.0 } else { exp(-slopes / z2) / (PI * x * y * sqr(z2)) }
}

/// Smith's `Lambda` of a direction: what is hidden from it by what is seen.
fn lambda(w: Vector3, [x, y]: [f32; 2]) -> f32 {
    let (along, cos) = ((sqr(x * w.x) + sqr(y * w.y)).sqrt(), w.z.abs().max(LEAST));
    if cos >= STEEPEST * along {
        return 0.0;
    }
    let a = cos / along;
    (0.5 * (exp(-sqr(a)) * FRAC_1_SQRT_PI / a - erfc(a))).max(0.0)
}

/// Shadowing and masking divided by four cosines, which are given as well: above 0.
#[inline(never)]
pub(super) fn visibility((o, cos_o): (Vector3, f32), (i, cos_i): (Vector3, f32), widths: [f32; 2]) -> f32 {
    0.25 / (cos_o.max(LEAST) * cos_i.max(LEAST) * (1.0 + lambda(o, widths) + lambda(i, widths)))
}

/// Smith's masking of one direction: the share of microfacets seen from it.
#[inline(never)]
pub(super) fn masking(w: Vector3, widths: [f32; 2]) -> f32 {
    1.0 / (1.0 + lambda(w, widths))
}

/// The microfacet normal seen from `o` (z above 0) at a point of the unit square.
///
/// Stretched so that both widths are 1, slopes across `o` are normally distributed, those along it by the part of the
/// normal distribution that is seen (Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based BSDFs using the Distribution of
/// Visible Normals"): see [`slope`].
#[inline(never)]
pub(super) fn visible_normal(o: Vector3, [x, y]: [f32; 2], u: Point2) -> Vector3 {
    let o = Vector3::new(x * o.x, y * o.y, o.z).normalize();
    let sin = (sqr(o.x) + sqr(o.y)).sqrt();
    let (c, s) = if sin > 0.0 { (o.x / sin, o.y / sin) } else { (1.0, 0.0) };
    let (along, across) = (slope(o.z, sin, u.x), slope(1.0, 0.0, u.y));
    let slopes = [x * (c * along - s * across), y * (s * along + c * across)];
    Vector3::new(-slopes[0], -slopes[1], 1.0).normalize()
}

/// The slope `t` at which the share `u` of `(cos - t sin) exp(-t²)` above 0 is reached: facets of this slope are seen along
/// `(sin, 0, cos)` by that much. Its integral is `cos erfc(-t) + sin exp(-t²) / sqrt(pi)` but for a factor (Jakob 2014, "An
/// Improved Visible Normal Sampling Routine for the Beckmann Distribution"), solved by Newton's method between bounds.
fn slope(cos: f32, sin: f32, u: f32) -> f32 {
    let reached = |t: f32| cos * erfc(-t) + sin * FRAC_1_SQRT_PI * exp(-sqr(t));
    let (mut low, mut high) =
        (-STEEPEST, if cos < STEEPEST * sin { (cos / sin).min(STEEPEST) } else { STEEPEST });
    let aim = u * reached(high);
    let mut t = 0.5 * (low.max(-1.0) + high.min(1.0));
    for _ in 0..STEPS {
        let off = reached(t) - aim;
        if off > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let rise = 2.0 * FRAC_1_SQRT_PI * exp(-sqr(t)) * (cos - t * sin);
        let newton = t - off / rise;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= f32::EPSILON * t.abs().max(1.0) {
            return next;
        }
        t = next;
    }
    t
}
