//! Colours of a thin film: soap, oil on water, tempered steel.
//!
//! Light mirrored by both sides of a film of index `eta` interferes. The sum over all orders, its spectrum integrated with
//! Gaussians in the place of the colour matching functions, is that of Belcour and Barla 2017, "A Practical Extension to
//! Microfacet Theory for the Modeling of Varying Iridescence", unpolarised and with Schlick's approximation as in
//! KHR_materials_iridescence.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::float::{cos, exp, sqr},
    spectrum::{Basis, Color, Spectrum},
};

/// Reflectance of a base of reflectance `f0` at normal incidence below a film of this index and thickness in nm, seen under
/// a cosine. For wavelengths the sum over all orders is exact: `sum of r^m cos(m x)` is
/// `(r cos x - r²) / (1 - 2 r cos x + r²)`.
pub(super) fn reflected(
    basis: &Basis,
    cos_outside: f32,
    (eta, thickness): (f32, f32),
    f0: Spectrum,
) -> Spectrum {
    match basis {
        Basis::Rgb => {
            let waves = |i: usize, path: f32, shift: f32, ratio: f32| {
                let first = ratio * response(path, shift)[i];
                first + sqr(ratio) * response(2.0 * path, 2.0 * shift)[i]
            };
            let [r, g, b] = basis.to_rgb(f0);
            let lane =
                |i: usize, f0: f32| of_lane(cos_outside, (eta, thickness), f0, |p, s, r| waves(i, p, s, r));
            basis.reflectance(Color::new(lane(0, r), lane(1, g), lane(2, b)))
        }
        Basis::Spectral(wavelengths) => wavelengths.map(f0, |nm, f0| {
            of_lane(cos_outside, (eta, thickness), f0, |path, shift, ratio| {
                let c = cos(TAU * path / nm + shift);
                (ratio * c - sqr(ratio)) / (1.0 - 2.0 * ratio * c + sqr(ratio))
            })
        }),
    }
}

/// The reflectance of one lane; `waves` says what interference makes of all orders beyond the first, given the difference of
/// the ways in nm, the shift of phase and the share of the amplitude that each order leaves.
fn of_lane(
    cos_outside: f32,
    (eta, thickness): (f32, f32),
    f0: f32,
    waves: impl Fn(f32, f32, f32) -> f32,
) -> f32 {
    // A film of no thickness is none: its index fades to that of the outside.
    let t = (thickness / 30.0).clamp(0.0, 1.0);
    let eta = 1.0 + (eta - 1.0) * sqr(t) * (3.0 - 2.0 * t);
    let cos2 = 1.0 - (1.0 - sqr(cos_outside)) / sqr(eta);
    if cos2 <= 0.0 {
        return 1.0;
    }
    let cos_film = cos2.sqrt();
    let first = schlick(at_normal(eta, 1.0), cos_outside);
    let passed = 1.0 - first;
    let path = 2.0 * eta * thickness * cos_film;
    // The index of the base that reflects so much, seen from outside.
    let root = f0.clamp(0.0, 0.9999).sqrt();
    let base = (1.0 + root) / (1.0 - root);
    let second = schlick(at_normal(base, eta), cos_film);
    // Half a wave is lost where light is mirrored by the denser side.
    let shift = PI + if base < eta { PI } else { 0.0 };
    let ratio = (first * second).clamp(1e-5, 0.9999);
    let inside = sqr(passed) * second / (1.0 - ratio);
    let sum = first + inside + 2.0 * (inside - passed) * waves(path, shift, ratio.sqrt());
    sum.clamp(0.0, 1.0)
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
    use durer_core::spectrum::Carried;

    use super::*;

    fn rgb(cos: f32, eta: f32, thickness: f32, f0: Color) -> Color {
        let basis = Basis::Rgb;
        Color { rgb: basis.to_rgb(reflected(&basis, cos, (eta, thickness), basis.reflectance(f0))) }
    }

    /// The same by wavelengths, under white light.
    fn spectral(cos: f32, eta: f32, thickness: f32, f0: Color) -> Color {
        const COUNT: u32 = 512;
        (0..COUNT).fold(Color::BLACK, |sum, i| {
            let basis = Carried::Wavelengths.basis(|| (i as f32 + 0.5) / COUNT as f32);
            let film = reflected(&basis, cos, (eta, thickness), basis.reflectance(f0));
            sum + Color { rgb: basis.to_rgb(film * basis.emission(Color::WHITE)) } * (1.0 / COUNT as f32)
        })
    }

    #[test]
    fn wavelengths_and_colours_agree() {
        for (cos, eta, thickness) in [(1.0, 1.33, 250.0), (0.7, 1.5, 400.0), (0.9, 1.33, 550.0)] {
            let (a, b) = (
                rgb(cos, eta, thickness, Color::gray(0.04)),
                spectral(cos, eta, thickness, Color::gray(0.04)),
            );
            // The colours' Gaussians are a fit, and they know two orders.
            assert!((0..3).all(|i| (a.rgb[i] - b.rgb[i]).abs() < 0.03), "{thickness} nm: {a:?} {b:?}");
        }
        // A layer of a quarter wave whose index is the root of the base's reflects nothing (Fresnel): glass of index 1.5.
        let basis = Carried::Wavelengths.basis(|| 0.5);
        let Some(nm) = basis.wavelengths().map(|w| w.nm()[0]) else { panic!("no wavelengths") };
        let eta = 1.5f32.sqrt();
        let film = reflected(&basis, 1.0, (eta, nm / (4.0 * eta)), basis.reflectance(Color::gray(0.04)));
        assert!(film.at(basis.lead(0.0)) < 1e-5, "{film:?}");
    }

    #[test]
    fn no_film_reflects_as_the_base_and_films_are_coloured() {
        let glass = Color::gray(0.04);
        let none = rgb(1.0, 1.4, 0.0, glass);
        assert!(none.rgb.iter().all(|v| (v - 0.04).abs() < 0.01), "{none:?}");
        let spread = |c: Color| {
            let [r, g, b] = c.rgb;
            r.max(g).max(b) - r.min(g).min(b)
        };
        assert!(spread(rgb(1.0, 1.8, 400.0, glass)) > 0.05);
        // Far beyond the length of coherence the colours have mixed to grey.
        assert!(spread(rgb(1.0, 1.8, 20_000.0, glass)) < 2e-3);
        for cos in [0.0, 0.2, 0.7, 1.0] {
            assert!(rgb(cos, 1.33, 600.0, Color::WHITE).rgb.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
}
