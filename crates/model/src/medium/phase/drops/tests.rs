//! Against Descartes' angles in closed form, and sums.
use durer_core::math::{Point2, Point3, Vector3};

use super::{super::Phase, *};

/// Where the bow of `p` chords stands, as an angle of deflection in degrees: `cos² i = (n² - 1) / (p² - 1)`.
fn bow(n: f64, p: f64) -> f64 {
    let i = ((n * n - 1.0) / (p * p - 1.0)).sqrt().acos();
    let turned = (2.0 * i - 2.0 * p * (i.sin() / n).asin()).to_degrees() + (p - 1.0) * 180.0;
    if turned > 180.0 { 360.0 - turned } else { turned }
}

/// Densities of a wavelength at angles of deflection in degrees.
fn of(drops: &Drops, nm: f32, degrees: f64) -> f64 {
    let step = (degrees * STEPS as f64 / 180.0) as usize;
    f64::from(drops.mean[step] * drops.of_wave(step, nm))
}

#[test]
fn bows_of_all_colours_stand_where_descartes_says() {
    let drops = Drops::new();
    for nm in [430.0f32, 486.0, 550.0, 589.0, 656.0, 700.0] {
        let n = index("water", nm.into()).expect("known");
        // The brightest step of each, against the angle from the point opposite to the sun.
        for (p, between) in [(2.0, (130.0, 145.0)), (3.0, (122.0, 133.0))] {
            let angles =
                (0..((between.1 - between.0) * 20.0) as usize).map(|i| between.0 + (i as f64 + 0.5) * 0.05);
            let brightest =
                angles.max_by(|a, b| of(&drops, nm, *a).total_cmp(&of(&drops, nm, *b))).expect("some");
            let expected = bow(n, p);
            assert!((brightest - expected).abs() < 0.06, "{nm} nm, {p}: {brightest}, expected {expected}");
        }
    }
    // Handbooks: 42.4 degrees from the opposite point in red, 40.5 in violet; the second bow has them the other way round.
    let at = |nm: f64, p: f64| 180.0 - bow(index("water", nm).expect("known"), p);
    assert!((at(700.0, 2.0) - 42.5).abs() < 0.2 && (at(400.0, 2.0) - 40.6).abs() < 0.2);
    assert!((at(700.0, 3.0) - 50.2).abs() < 0.3 && (at(400.0, 3.0) - 53.6).abs() < 0.3);
}

#[test]
fn alexanders_band_is_darker_than_what_is_inside_and_outside_of_it() {
    let drops = Drops::new();
    for nm in [450.0, 550.0, 650.0] {
        let [inside, dark, outside] = [148.0, 133.0, 120.0].map(|angle| of(&drops, nm, angle));
        assert!(dark < 0.4 * inside && dark < 0.8 * outside, "{nm}: {inside} {dark} {outside}");
    }
}

#[test]
fn all_light_goes_somewhere() {
    let drops = Drops::new();
    let solid: f64 = (0..STEPS).map(|step| f64::from(angles(step))).sum();
    assert!((solid / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-6, "{solid}");
    for nm in [360.0, 402.5, 550.0, 829.0, 830.0] {
        let sum: f64 = (0..STEPS)
            .map(|step| f64::from(angles(step)) * f64::from(drops.mean[step] * drops.of_wave(step, nm)))
            .sum();
        assert!((sum - 1.0).abs() < 1e-5, "{nm}: {sum}");
    }
    // Before sums are made 1, next to nothing lacks.
    let sum: f64 = turned_by(1.333).iter().sum();
    assert!((0.999..1.0).contains(&sum), "{sum}");
}

#[test]
fn rays_mirrored_at_the_outside_go_where_fresnel_and_spheres_say() {
    // A sphere mirrors evenly in all directions: R(i) / (4 pi), with 180 - 2 i degrees. In the shade of the bows, where nothing
    // passes straight on either, there is little else.
    let shares = turned_by(1.333);
    let step = (100.0 * STEPS as f64 / 180.0) as usize;
    let (s, p) = fresnel_polarized(cos((40.0f32 - 0.0125).to_radians()), 1.333);
    let mirrored = f64::from(0.5 * (s + p)) / (4.0 * std::f64::consts::PI);
    let found = shares[step] / f64::from(angles(step));
    assert!(found > mirrored && found < 1.35 * mirrored, "{found}, mirrored {mirrored}");
}

#[test]
fn drawn_deflections_have_their_density() {
    let drops = Drops::new();
    let phase = Phase::Drops(drops.clone().into());
    let w = Vector3::new(0.36, 0.48, 0.8);
    let n = 200_000u32;
    let (mut counts, mut mean) = ([0.0f64; 36], 0.0);
    for i in 0..n {
        let u = Point2::new((i as f32 + 0.5) / n as f32, (i as f32 * 0.618_034).fract());
        let d = phase.deflected((Point3::ZERO, w), u);
        let cos = d.dot(w).clamp(-1.0, 1.0);
        counts[((f64::from(cos).acos().to_degrees() / 5.0) as usize).min(35)] += 1.0 / f64::from(n);
        mean += f64::from(cos) / f64::from(n);
    }
    for (i, count) in counts.iter().enumerate() {
        let expected: f64 = (i * 100..(i + 1) * 100)
            .map(|step| f64::from(angles(step) * drops.density(0.5 * (edge(step) + edge(step + 1)))))
            .sum();
        assert!((count - expected).abs() < 3e-4, "{} degrees: {count}, expected {expected}", i * 5);
    }
    assert!((mean - f64::from(phase.g())).abs() < 1e-3, "{mean} {}", phase.g());
    // With as much light bent around the drops, straight on, 0.885 (van de Hulst 1957; Mie's series of large drops).
    assert!((0.5 * (1.0 + phase.g()) - 0.885).abs() < 0.01, "{}", phase.g());
}
