//! Laws that all phase functions keep.
use std::f64::consts::PI;

use super::*;

/// Values that belong to no point of a grid alone.
const HERE: Point3 = Point3::new(0.2, 0.9, 0.6);
const W: Vector3 = Vector3::new(0.36, 0.48, 0.8);

fn flakes(size: [usize; 3], values: &[f32]) -> Phase {
    Phase::Flakes(Flakes::new(size, values).expect("ellipsoids").into())
}

fn blend(parts: Vec<Phase>, size: [usize; 3], weights: &[f32]) -> Phase {
    Phase::Blend(Blend::new(parts, size, weights).expect("weights").into())
}

/// A fibre, and cloth that lies across.
const FIBRE: [f32; 6] = [1.0, 0.9, 0.1, 0.05, -0.1, 0.2];
const CLOTH: [f32; 6] = [0.05, 0.04, 1.0, 0.01, 0.1, -0.05];

fn all() -> Vec<Phase> {
    let of = |g| Phase::HenyeyGreenstein(HenyeyGreenstein::new(g));
    let table = |values: &[f32]| Phase::Table(Table::new(values).expect("a density").into());
    let changing = [FIBRE, CLOTH].concat();
    vec![
        of(0.0),
        of(0.6),
        of(-0.4),
        Phase::Rayleigh,
        Phase::Drops(Drops::new().into()),
        table(&[1.0, 1.0]),
        table(&[0.2, 0.1, 0.4, 0.0, 3.0]),
        flakes([1; 3], &[2.0, 2.0, 2.0, 0.0, 0.0, 0.0]),
        flakes([1; 3], &FIBRE),
        flakes([1; 3], &CLOTH),
        flakes([1, 2, 1], &changing),
        blend(vec![of(0.7), of(-0.5), Phase::Rayleigh], [1; 3], &[0.6, 0.3, 0.1]),
        blend(vec![of(0.7), flakes([1; 3], &FIBRE)], [2, 1, 1], &[1.0, 0.0, 1.0, 3.0]),
    ]
}

/// Numbers without order between them, the same in each run.
fn mixed(i: u32, key: u32) -> f32 {
    let x = (i ^ key).wrapping_mul(0x9e37_79b9);
    let x = (x ^ (x >> 15)).wrapping_mul(0x85eb_ca6b);
    let x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
    ((x ^ (x >> 16)) >> 8) as f32 / (1 << 24) as f32
}

/// Sums over turns from `W`: `n` cosines, and as many ways around as the phase function has.
fn sum(phase: &Phase, n: u32, mut add: impl FnMut(&Turn, f64)) {
    let around = if phase.is_symmetric() { 1 } else { 64 };
    let angle = 4.0 * PI / f64::from(n) / f64::from(around);
    for (i, j) in (0..n).flat_map(|i| (0..around).map(move |j| (i, j))) {
        let cos = -1.0 + 2.0 * (i as f32 + 0.5) / n as f32;
        let to = turned(W, cos, (j as f32 + 0.5) / around as f32);
        let turn = Turn { p: HERE, from: W, to };
        add(&turn, f64::from(phase.density(&turn)) * angle);
    }
}

#[test]
fn all_light_goes_somewhere_and_its_mean_is_told() {
    for phase in all() {
        let (mut all, mut mean) = (0.0, 0.0);
        let n = if phase.is_symmetric() { 200_000 } else { 4000 };
        sum(&phase, n, |turn, part| {
            assert!(part > 0.0 || matches!(phase, Phase::Drops(_) | Phase::Table(_)), "{phase:?} {turn:?}");
            (all, mean) = (all + part, mean + part * f64::from(turn.cos()));
        });
        assert!((all - 1.0).abs() < 2e-3, "{}: {all}", phase.name());
        // That of flakes is over all directions.
        let told = if phase.is_symmetric() { f64::from(phase.g()) } else { mean };
        assert!((mean - told).abs() < 2e-3, "{}: {mean}, told {told}", phase.name());
    }
}

#[test]
fn the_mean_of_flakes_is_that_of_turns_from_all_sides() {
    for values in [FIBRE, CLOTH] {
        let phase = flakes([1; 3], &values);
        const DRAWS: u32 = 200_000;
        let mut mean = 0.0;
        for i in 0..DRAWS {
            let u = |key| mixed(i, key);
            let from = turned(W, 2.0 * u(0x1234_5678) - 1.0, u(0x5bd1_e995));
            let to = phase.deflected((HERE, from), Point2::new(u(0x7feb_352d), u(0x846c_a68b)));
            mean += f64::from(from.dot(to)) / f64::from(DRAWS);
        }
        assert!((mean - f64::from(phase.g())).abs() < 5e-3, "{mean}, told {}", phase.g());
    }
}

#[test]
fn light_goes_back_as_it_came_and_that_of_flakes_by_what_is_seen_of_them() {
    let [a, b] = [W, Vector3::new(0.6, -0.8, 0.0)];
    for phase in all() {
        let turn = Turn { p: HERE, from: a, to: b };
        let (on, back) = (phase.density(&turn), phase.density(&turn.back()));
        assert!((phase.skew(&turn) * on / back - 1.0).abs() < 1e-5, "{}", phase.name());
        if phase.is_symmetric() {
            assert_eq!((on, phase.skew(&turn)), (back, 1.0), "{}", phase.name());
        }
    }
    // How much of them is seen along a direction, by their matrix.
    let [xx, yy, zz, xy, xz, yz] = FIBRE;
    let seen = |w: Vector3| {
        let squared = xx * w.x * w.x + yy * w.y * w.y + zz * w.z * w.z;
        (squared + 2.0 * (xy * w.x * w.y + xz * w.x * w.z + yz * w.y * w.z)).sqrt()
    };
    let skew = flakes([1; 3], &FIBRE).skew(&Turn { p: HERE, from: a, to: b });
    assert!((skew - seen(a) / seen(b)).abs() < 1e-5, "{skew}");
}

#[test]
fn drawn_directions_pass_a_chi_square_test() {
    const BINS: usize = 32;
    const AROUND: usize = 8;
    const DRAWS: u32 = 100_000;
    // By the cosine to the way they came, and, of flakes, by the angle around it.
    let frame = Frame::from_z(Normal3::from(W));
    for phase in all() {
        let around = if phase.is_symmetric() { 1 } else { AROUND };
        let bin = |d: Vector3| {
            let d = frame.to_local(d);
            let turn = (durer_core::math::float::atan2(d.y, d.x) / std::f32::consts::TAU).rem_euclid(1.0);
            let row = ((d.z + 1.0) * 0.5 * BINS as f32).clamp(0.0, BINS as f32 - 1.0) as usize;
            row * around + ((turn * around as f32) as usize).min(around - 1)
        };
        let mut counts = vec![0.0f64; BINS * around];
        for i in 0..DRAWS {
            let d = phase.deflected((HERE, W), Point2::new(mixed(i, 0), mixed(i, 0x5bd1_e995)));
            assert!((d.length() - 1.0).abs() < 1e-5);
            counts[bin(d)] += 1.0;
        }
        let mut expected = vec![0.0f64; BINS * around];
        let n = if phase.is_symmetric() { 4000 } else { 100 } * BINS as u32;
        sum(&phase, n, |turn, part| expected[bin(turn.to)] += f64::from(DRAWS) * part);
        // What is expected too seldom counts together.
        let mut rare = (0.0, 0.0);
        let (mut chi, mut freedom) = (0.0, -1.0);
        let mut add = |n: f64, e: f64| {
            chi += (n - e).powi(2) / e;
            freedom += 1.0;
        };
        for (n, e) in counts.into_iter().zip(expected) {
            if e < 10.0 { rare = (rare.0 + n, rare.1 + e) } else { add(n, e) }
        }
        if rare.1 > 0.0 {
            add(rare.0, rare.1);
        }
        // Wilson and Hilferty: one in 10 000 is larger.
        let part = 2.0 / (9.0 * freedom);
        let most = freedom * (1.0 - part + 3.72 * f64::sqrt(part)).powi(3);
        assert!(chi < most, "{}: {chi} of {most}", phase.name());
    }
}

#[test]
fn air_sends_as_much_back_as_on_and_half_to_the_sides() {
    let [on, side, back] = [1.0, 0.0, -1.0].map(rayleigh::density);
    assert_eq!(on, back);
    assert_eq!(on, 2.0 * side);
    assert!((side - 3.0 / (16.0 * std::f32::consts::PI)).abs() < 1e-8);
}

#[test]
fn flakes_that_lie_in_all_ways_scatter_evenly() {
    let phase = flakes([1; 3], &[3.0, 3.0, 3.0, 0.0, 0.0, 0.0]);
    for i in 0..20 {
        let to = turned(W, 1.0 - 0.1 * i as f32, 0.3);
        let density = phase.density(&Turn { p: HERE, from: W, to });
        assert!((density * 4.0 * std::f32::consts::PI - 1.0).abs() < 1e-5, "{density}");
    }
}

#[test]
fn flakes_that_lie_flat_mirror() {
    let flat = flakes([1; 3], &[1e-4, 1e-4, 1.0, 0.0, 0.0, 0.0]);
    let to = flat.deflected((HERE, W), Point2::new(0.3, 0.6));
    assert!((to - Vector3::new(0.36, 0.48, -0.8)).length() < 0.1, "{to:?}");
}

#[test]
fn weights_are_those_of_the_place() {
    let parts = || vec![Phase::HenyeyGreenstein(HenyeyGreenstein::new(0.5)), Phase::Rayleigh];
    let phase = blend(parts(), [2, 1, 1], &[1.0, 0.0, 0.0, 1.0]);
    let turn = |x| Turn { p: Point3::new(x, 0.5, 0.5), from: W, to: W };
    let [first, second] = [parts()[0].density(&turn(0.0)), parts()[1].density(&turn(0.0))];
    for (x, expected) in [(0.0, first), (0.5, 0.5 * (first + second)), (1.0, second)] {
        assert!((phase.density(&turn(x)) - expected).abs() < 1e-6);
    }
}

#[test]
fn what_is_no_phase_function_is_told() {
    assert!(
        Table::new(&[1.0]).is_none() && Table::new(&[0.0; 3]).is_none() && Table::new(&[1.0, -1.0]).is_none()
    );
    for (size, values, part) in [
        ([1; 3], vec![1.0; 6], "no ellipsoid"),
        ([1; 3], vec![f32::NAN; 6], "no ellipsoid"),
        ([1; 3], vec![1.0, 1.0, 1.0, 0.0, 0.0], "six for each"),
        ([2, 1, 1], [FIBRE, FIBRE, FIBRE].concat(), "six for each of 2 x 1 x 1"),
        ([1; 3], vec![], "0 numbers"),
    ] {
        let why = Flakes::new(size, &values).expect_err("wrong");
        assert!(why.contains(part), "{why}");
    }
    let two = || vec![Phase::Rayleigh, Phase::Rayleigh];
    assert!(Blend::new(two(), [1; 3], &[0.0, 0.0]).expect_err("wrong").contains("are 0"));
    assert!(Blend::new(two(), [1; 3], &[1.0]).expect_err("wrong").contains("expected 2"));
}
