//! Tests of both bases.
use super::*;
use crate::spectrum::Sampled;

/// The mean of what the film stores over evenly drawn wavelengths.
fn film(of: impl Fn(&Basis) -> Spectrum) -> [f64; 3] {
    const COUNT: u32 = 4000;
    let mut sum = [0.0; 3];
    for i in 0..COUNT {
        let basis = Carried::Wavelengths.basis(|| (i as f32 + 0.5) / COUNT as f32);
        let rgb = basis.to_rgb(of(&basis));
        sum.iter_mut().zip(rgb).for_each(|(sum, v)| *sum += f64::from(v) / f64::from(COUNT));
    }
    sum
}

fn near(got: [f64; 3], expected: [f32; 3], within: f64) {
    let miss = |i: usize| (got[i] - f64::from(expected[i])).abs();
    assert!((0..3).all(|i| miss(i) < within), "{got:?} {expected:?}");
}

#[test]
fn white_is_one_in_every_lane() {
    assert_eq!(Basis::Rgb.reflectance(Color::WHITE), Spectrum::ONE);
    for u in [0.0, 0.3, 0.99] {
        let basis = Carried::Wavelengths.basis(|| u);
        assert_eq!(basis.reflectance(Color::WHITE), Spectrum::ONE);
        assert_eq!(basis.reflectance(Color::gray(0.25)), Spectrum::splat(0.25));
        assert_eq!(basis.reflectance(Color::BLACK), Spectrum::BLACK);
        assert_eq!(basis.unbounded(Color::gray(3.0)), Spectrum::splat(3.0));
    }
}

#[test]
fn rgb_survives_the_round_trip_and_the_mean_weighs_green_twice() {
    let s = Basis::Rgb.emission(Color::new(1.0, 2.0, 4.0));
    assert_eq!(Basis::Rgb.to_rgb(s), [1.0, 2.0, 4.0]);
    assert_eq!(s.mean(), (1.0 + 2.0 * 2.0 + 4.0) / 4.0);
    assert_eq!(s.max(), 4.0);
}

#[test]
fn lights_come_back_as_their_colours() {
    for rgb in [[1.0; 3], [108.0, 76.0, 24.0], [0.2, 0.5, 0.9], [1.0, 0.6, 0.3]] {
        let color = Color { rgb };
        let largest = rgb.into_iter().fold(0.0, f32::max);
        near(film(|basis| basis.emission(color)), rgb, 2e-3 * f64::from(largest));
        // Under white light a reflectance shows its colour.
        let share = color.map(|v| v / (1.5 * largest));
        let lit = |basis: &Basis| basis.emission(Color::WHITE) * basis.reflectance(share);
        near(film(lit), share.rgb, 2e-3);
    }
}

#[test]
fn measured_lights_and_reflectances_come_back_as_their_colours() {
    let red = Sampled::new(&[400.0, 0.05, 580.0, 0.1, 620.0, 0.6, 700.0, 0.65]).expect("a spectrum");
    let curve = Curve::measured(&red);
    let lit = |basis: &Basis| basis.emission(Color::WHITE) * basis.curve(&curve, red.share());
    near(film(lit), red.share().rgb, 2e-3);
    for kelvin in [2700.0, 6500.0, 12_000.0] {
        let light = LightColor::blackbody(kelvin) * 3.0;
        near(film(|basis| basis.light(&light)), light.color.rgb, 1e-2);
        assert_eq!(Basis::Rgb.light(&light), Basis::Rgb.emission(light.color));
        // White seen through grey is grey.
        near(film(|basis| basis.tinted(&light, Color::gray(0.5))), (light.color * 0.5).rgb, 1e-2);
    }
}

#[test]
fn a_collapsed_sample_has_the_same_mean() {
    let white = |basis: &Basis| basis.emission(Color::new(0.9, 0.6, 0.3));
    near(film(|basis| white(basis) * basis.collapse()), [0.9, 0.6, 0.3], 3e-3);
    assert_eq!(Basis::Rgb.collapse(), Spectrum::ONE);
}

#[test]
fn the_leading_lane_is_one_of_all() {
    let spectral = Carried::Wavelengths.basis(|| 0.4);
    let Some(wavelengths) = spectral.wavelengths() else { panic!("no wavelengths") };
    let line = Curve::of(|nm| nm);
    for u in [0.0, 0.5, 0.999] {
        let lane = spectral.lead(u);
        assert_eq!(spectral.curve(&line, Color::BLACK).at(lane), wavelengths.nm()[0]);
        assert_eq!(spectral.leading(&line, 1.0), wavelengths.nm()[0]);
    }
    let s = Basis::Rgb.reflectance(Color::new(0.1, 0.2, 0.3));
    let lanes = [0.1, 0.3, 0.6, 0.9].map(|u| s.at(Basis::Rgb.lead(u)));
    assert_eq!(lanes, [0.1, 0.2, 0.3, 0.2]);
    assert_eq!(Basis::Rgb.leading(&line, 1.5), 1.5);
}
