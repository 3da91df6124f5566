//! Colours of a thin film: soap, oil on water, tempered steel.
//!
//! Light mirrored by both sides of a film of index `eta` interferes. The sum over all orders, its spectrum integrated with
//! Gaussians in the place of the colour matching functions, is that of Belcour and Barla 2017, "A Practical Extension to
//! Microfacet Theory for the Modeling of Varying Iridescence", unpolarised and with Schlick's approximation as in
//! KHR_materials_iridescence.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::float::{cos, exp, sqr},
    spectrum::Color,
};

/// Reflectance of a base of reflectance `f0` at normal incidence below a film of this index and thickness in nm, seen under
/// a cosine.
pub(super) fn reflected(cos_outside: f32, eta: f32, thickness: f32, f0: Color) -> Color {
    // A film of no thickness is none: its index fades to that of the outside.
    let t = (thickness / 30.0).clamp(0.0, 1.0);
    let eta = 1.0 + (eta - 1.0) * sqr(t) * (3.0 - 2.0 * t);
    let cos2 = 1.0 - (1.0 - sqr(cos_outside)) / sqr(eta);
    if cos2 <= 0.0 {
        return Color::WHITE;
    }
    let cos_film = cos2.sqrt();
    let first = schlick(at_normal(eta, 1.0), cos_outside);
    let passed = 1.0 - first;
    let path = 2.0 * eta * thickness * cos_film;
    let lanes: [f32; 3] = std::array::from_fn(|i| {
        // The index of the base that reflects so much, seen from outside.
        let root = f0.rgb[i].clamp(0.0, 0.9999).sqrt();
        let base = (1.0 + root) / (1.0 - root);
        let second = schlick(at_normal(base, eta), cos_film);
        // Half a wave is lost where light is mirrored by the denser side.
        let shift = PI + if base < eta { PI } else { 0.0 };
        let ratio = (first * second).clamp(1e-5, 0.9999);
        let inside = sqr(passed) * second / (1.0 - ratio);
        let mut sum = first + inside;
        let mut order = inside - passed;
        for m in [1.0, 2.0] {
            order *= ratio.sqrt();
            sum += order * 2.0 * response(m * path, m * shift)[i];
        }
        sum.clamp(0.0, 1.0)
    });
    Color { rgb: lanes }
}

fn at_normal(inside: f32, outside: f32) -> f32 {
    sqr((inside - outside) / (inside + outside))
}

fn schlick(f0: f32, cos: f32) -> f32 {
    let m = 1.0 - cos.clamp(0.0, 1.0);
    f0 + (1.0 - f0) * sqr(sqr(m)) * m
}

/// What the eye makes of a cosine over wavelengths, in linear Rec. 709: Gaussians of this height, place and variance.
fn response(path_nm: f32, shift: f32) -> [f32; 3] {
    const X2: [f32; 3] = [9.747e-14, 2.2399e6, 4.5282e9];
    const XYZ: [[f32; 3]; 3] =
        [[5.4856e-13, 1.681e6, 4.3278e9], [4.4201e-13, 1.7953e6, 9.3046e9], [5.2481e-13, 2.2084e6, 6.6121e9]];
    let phase = TAU * path_nm * 1e-9;
    let gauss = |[height, place, variance]: [f32; 3]| {
        height * (TAU * variance).sqrt() * cos(place * phase + shift) * exp(-sqr(phase) * variance)
            / 1.0685e-7
    };
    let [x, y, z] = XYZ.map(gauss);
    let x = x + gauss(X2);
    [
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266 * x + 1.876_010_8 * y + 0.041_556 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_film_reflects_as_the_base_and_films_are_coloured() {
        let glass = Color::gray(0.04);
        let none = reflected(1.0, 1.4, 0.0, glass);
        assert!(none.rgb.iter().all(|v| (v - 0.04).abs() < 0.01), "{none:?}");
        let spread = |c: Color| {
            let [r, g, b] = c.rgb;
            r.max(g).max(b) - r.min(g).min(b)
        };
        assert!(spread(reflected(1.0, 1.8, 400.0, glass)) > 0.05);
        // Far beyond the length of coherence the colours have mixed to grey.
        assert!(spread(reflected(1.0, 1.8, 20_000.0, glass)) < 2e-3);
        for cos in [0.0, 0.2, 0.7, 1.0] {
            assert!(reflected(cos, 1.33, 600.0, Color::WHITE).rgb.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
}
