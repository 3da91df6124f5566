//! Laws that all phase functions keep.
use super::*;

fn all() -> Vec<Phase> {
    let of = |g| Phase::HenyeyGreenstein(HenyeyGreenstein::new(g));
    vec![of(0.0), of(0.6), of(-0.4), Phase::Rayleigh, Phase::Drops(Drops::new().into())]
}

/// The middles of steps of the cosine, and their solid angle.
fn steps(n: u32) -> (impl Iterator<Item = f32>, f64) {
    let cos = move |i: u32| -1.0 + 2.0 * (i as f32 + 0.5) / n as f32;
    ((0..n).map(cos), 4.0 * std::f64::consts::PI / f64::from(n))
}

#[test]
fn all_light_goes_somewhere_and_its_mean_is_told() {
    for phase in all() {
        let (cosines, angle) = steps(200_000);
        let (mut sum, mut mean) = (0.0, 0.0);
        for cos in cosines {
            let part = f64::from(phase.density(cos)) * angle;
            assert!(part > 0.0 || phase.name() == "waterdrops", "{phase:?} {cos}");
            (sum, mean) = (sum + part, mean + part * f64::from(cos));
        }
        assert!((sum - 1.0).abs() < 2e-3, "{}: {sum}", phase.name());
        assert!((mean - f64::from(phase.g())).abs() < 2e-3, "{}: {mean}", phase.name());
    }
}

#[test]
fn light_goes_back_as_it_came() {
    let [a, b] = [Vector3::new(0.36, 0.48, 0.8), Vector3::new(0.6, -0.8, 0.0)];
    for phase in all() {
        assert_eq!(phase.density(a.dot(b)), phase.density((-b).dot(-a)), "{}", phase.name());
    }
}

#[test]
fn drawn_directions_pass_a_chi_square_test() {
    const BINS: usize = 32;
    const DRAWS: u32 = 100_000;
    let w = Vector3::new(0.36, 0.48, 0.8);
    for phase in all() {
        let mut counts = [0.0f64; BINS];
        for i in 0..DRAWS {
            // Numbers without order between them, the same in each run.
            let mixed = |key: u32| {
                let x = (i ^ key).wrapping_mul(0x9e37_79b9);
                let x = (x ^ (x >> 15)).wrapping_mul(0x85eb_ca6b);
                let x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
                ((x ^ (x >> 16)) >> 8) as f32 / (1 << 24) as f32
            };
            let d = phase.deflected(w, Point2::new(mixed(0), mixed(0x5bd1_e995)));
            assert!((d.length() - 1.0).abs() < 1e-5);
            counts[((d.dot(w) + 1.0) * 0.5 * BINS as f32).clamp(0.0, BINS as f32 - 1.0) as usize] += 1.0;
        }
        let (cosines, angle) = steps(BINS as u32 * 4000);
        let mut expected = [0.0f64; BINS];
        for (i, cos) in cosines.enumerate() {
            expected[i / 4000] += f64::from(DRAWS) * angle * f64::from(phase.density(cos));
        }
        let sum: f64 = counts.iter().zip(expected).map(|(n, e)| (n - e).powi(2) / e).sum();
        // 31 degrees of freedom: one in 10 000 is larger than 69.
        assert!(sum < 69.0, "{}: {sum}", phase.name());
    }
}

#[test]
fn air_sends_as_much_back_as_on_and_half_to_the_sides() {
    let phase = Phase::Rayleigh;
    let [on, side, back] = [1.0, 0.0, -1.0].map(|cos| phase.density(cos));
    assert_eq!(on, back);
    assert_eq!(on, 2.0 * side);
    assert!((side - 3.0 / (16.0 * std::f32::consts::PI)).abs() < 1e-8);
}
