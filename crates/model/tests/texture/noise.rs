//! Noise and what is made of it: zeros, periods, means, and a second implementation.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Normal3, Point3, Vector3},
};
use durer_model::texture::{Footprint, Habit, Texture, TextureAt};
use durer_scene::{Data, Params, TextureValue, ValueType};
use durer_testkit::random::Random;

use super::{CX, at, built, float, grey};

fn made(kind: &str, params: Params) -> Box<dyn Texture> {
    built(kind, TextureValue::Float, params, &grey(1, 1, vec![0.0])).expect("sound")
}

fn number(texture: &dyn Texture, p: [f32; 3]) -> f32 {
    texture.float(&CX, &TextureAt { p: p.into(), ..at(0.0, 0.0) })
}

fn noise() -> Box<dyn Texture> {
    made("fbm", Params::new().int("octaves", 1))
}

#[test]
fn noise_is_zero_at_corners_and_repeats_after_256_cells() {
    let (noise, mut random) = (noise(), Random::new(11));
    for _ in 0..500 {
        let p: [f32; 3] = std::array::from_fn(|_| random.between(-60.0, 60.0) as f32);
        assert_eq!(number(noise.as_ref(), p.map(f32::round)), 0.0);
        // Sixteenths are exact in both cells.
        let p = p.map(|c| (c * 16.0).round() / 16.0);
        for axis in 0..3 {
            let mut q = p;
            q[axis] += 256.0;
            assert_eq!(number(noise.as_ref(), p), number(noise.as_ref(), q), "{p:?}");
        }
    }
}

/// Values of pbrt-v4's noise, worked out apart from this code from its permutation and gradients in double precision.
#[test]
fn noise_has_the_values_of_pbrt() {
    for (p, expected) in [
        ([0.5, 0.5, 0.5], -0.125),
        ([3.25, -7.5, 11.75], 0.0383635),
        ([200.125, 255.5, -0.25], 0.4716489),
        ([-1.5, 2.5, 0.5], -0.125),
    ] {
        let value = number(noise().as_ref(), p);
        assert!((value - expected).abs() < 1e-5, "{p:?}: {value} {expected}");
    }
}

#[test]
fn noise_is_smooth_small_and_has_mean_zero() {
    let (noise, mut random) = (noise(), Random::new(12));
    let (mut sum, mut squares, mut most) = (0.0, 0.0, 0.0f32);
    let n = 40_000;
    for _ in 0..n {
        let p: [f32; 3] = std::array::from_fn(|_| random.between(0.0, 256.0) as f32);
        let value = number(noise.as_ref(), p);
        let q = [p[0] + 1e-3, p[1], p[2]];
        assert!((number(noise.as_ref(), q) - value).abs() < 5e-3, "{p:?}");
        sum += f64::from(value);
        squares += f64::from(value * value);
        most = most.max(value.abs());
    }
    let (mean, deviation) = (sum / f64::from(n), (squares / f64::from(n)).sqrt());
    // Samples of a cell are correlated: 4 sigma of as many samples as there are cells hit.
    assert!(mean.abs() < 4.0 * deviation / f64::from(n).sqrt(), "{mean} {deviation}");
    assert!((0.2..0.35).contains(&deviation), "{deviation}");
    assert!((0.7..=1.1).contains(&most) && most <= noise.largest(&CX), "{most}");
}

#[test]
fn fbm_is_the_sum_of_its_octaves() {
    let (noise, mut random) = (noise(), Random::new(13));
    let params = || Params::new().int("octaves", 5).float("roughness", 0.6);
    let (fbm, wrinkled) = (made("fbm", params()), made("wrinkled", params()));
    for _ in 0..200 {
        let p: [f32; 3] = std::array::from_fn(|_| random.between(-5.0, 5.0) as f32);
        let octave =
            |i: i32| f64::from(number(noise.as_ref(), p.map(|c| (f64::from(c) * 1.99f64.powi(i)) as f32)));
        let strength = |i: i32| 0.6f64.powi(i);
        let smooth: f64 = (0..5).map(|i| strength(i) * octave(i)).sum();
        // What is beyond the last octave counts with its mean.
        let creased: f64 = (0..5).map(|i| strength(i) * octave(i).abs()).sum::<f64>() + 0.2 * strength(5);
        assert!((f64::from(number(fbm.as_ref(), p)) - smooth).abs() < 1e-4, "{p:?}");
        assert!((f64::from(number(wrinkled.as_ref(), p)) - creased).abs() < 1e-4, "{p:?}");
    }
}

#[test]
fn octaves_finer_than_a_footprint_are_left_out() {
    let (fbm, octave) = (made("fbm", Params::new()), noise());
    let p = Point3::new(0.3, 1.7, -2.2);
    let seen = |width: f32, habit: Habit| {
        let footprint = Footprint { dpdx: Vector3::new(width, 0.0, 0.0), habit, ..Footprint::POINT };
        fbm.float(&CX, &TextureAt { p, footprint, ..at(0.0, 0.0) })
    };
    let all = number(fbm.as_ref(), p.to_array());
    assert_eq!(
        seen(0.25, Habit::AsPbrt),
        number(octave.as_ref(), p.to_array()),
        "a quarter leaves one octave"
    );
    assert_eq!(seen(1.0, Habit::AsPbrt), 0.0);
    assert_eq!(seen(1e-6, Habit::AsPbrt), all);
    assert_eq!(seen(0.25, Habit::Asked), all, "nobody asked");
}

#[test]
fn dots_are_disks_of_one_size_that_keep_to_their_squares() {
    let dots = made("dots", Params::new());
    let n = 128;
    let (mut inside, mut with_dot) = (0u32, 0u32);
    for cell in 0..400 {
        let (i, j) = (cell % 20 - 10, cell / 20 - 10);
        let mut here = 0u32;
        for k in 0..n * n {
            let c = |k: i32| (k as f32 + 0.5) / n as f32 - 0.5;
            here += float(dots.as_ref(), i as f32 + c(k % n), j as f32 + c(k / n)) as u32;
        }
        let area = f64::from(here) / f64::from(n * n);
        assert!(here == 0 || (area - std::f64::consts::PI * 0.35 * 0.35).abs() < 2e-3, "{i} {j}: {area}");
        inside += here;
        with_dot += u32::from(here > 0);
    }
    assert!(inside > 0 && (120..280).contains(&with_dot), "{with_dot} of 400 squares");
}

#[test]
fn marble_runs_through_its_colours_along_y() {
    let params = Params::new().float("variation", 0.0);
    let marble = built("marble", TextureValue::Color, params, &grey(1, 1, vec![0.0])).expect("sound");
    let seen = |y: f32| marble.color(&CX, &TextureAt { p: Point3::new(0.3, y, 0.8), ..at(0.0, 0.0) }).rgb;
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    let half = std::f32::consts::FRAC_PI_2;
    assert!(near(seen(-half), [0.87, 0.87, 0.9]), "the first control point: {:?}", seen(-half));
    assert!(near(seen(half), [0.87, 0.87, 0.9]), "the last: {:?}", seen(half));
    // In the middle, where the fourth piece begins: its first control point.
    assert!(near(seen(0.0), [0.75, 0.75, 0.75]), "{:?}", seen(0.0));
    assert!(near(seen(1.1), seen(1.1 + 4.0 * half)));
    // With variation it is the same with y bent by noise.
    let bent = built("marble", TextureValue::Color, Params::new(), &grey(1, 1, vec![0.0])).expect("sound");
    let (fbm, p) = (made("fbm", Params::new()), [0.3f32, 0.7, 0.8]);
    let y = p[1] + 0.2 * number(fbm.as_ref(), p);
    assert!(near(bent.color(&CX, &TextureAt { p: p.into(), ..at(0.0, 0.0) }).rgb, seen(y)));
}

#[test]
fn windy_water_is_a_product_of_two_sums() {
    let windy = made("windy", Params::new());
    let (wind, waves) =
        (made("fbm", Params::new().int("octaves", 3)), made("fbm", Params::new().int("octaves", 6)));
    for p in [[0.3f32, 1.1, 2.7], [-14.2, 3.3, 8.8]] {
        let expected =
            number(wind.as_ref(), p.map(|c| (f64::from(c) * 0.1) as f32)).abs() * number(waves.as_ref(), p);
        assert!((number(windy.as_ref(), p) - expected).abs() < 1e-5);
    }
}

#[test]
fn mixes_blend_by_amount_and_by_direction() {
    let mix = made("mix", Params::new().float("tex1", 2.0).float("tex2", 6.0).float("amount", 0.25));
    assert_eq!(float(mix.as_ref(), 0.0, 0.0), 3.0);
    assert_eq!(float(made("mix", Params::new()).as_ref(), 0.0, 0.0), 0.5, "black and white in equal parts");
    let dir = |v: [f32; 3]| Params::new().with("dir", ValueType::Vector3, Data::Floats(v.to_vec()));
    let mut mix = made("directionmix", dir([0.0, 3.0, 0.0]).float("tex1", 2.0).float("tex2", 6.0));
    let facing = |mix: &dyn Texture, n: Vector3| {
        mix.float(&CX, &TextureAt { n: Normal3::from(n.normalize()), ..at(0.0, 0.0) })
    };
    assert_eq!(facing(mix.as_ref(), Vector3::new(0.0, 1.0, 0.0)), 2.0);
    assert_eq!(facing(mix.as_ref(), Vector3::new(0.0, -1.0, 0.0)), 2.0);
    assert_eq!(facing(mix.as_ref(), Vector3::new(1.0, 0.0, 0.0)), 6.0);
    assert!((facing(mix.as_ref(), Vector3::new(3f32.sqrt(), 1.0, 0.0)) - 4.0).abs() < 1e-6);
    mix.place(&DAffine3::from_axis_angle(DVec3::Z, std::f64::consts::FRAC_PI_2));
    assert!(
        (facing(mix.as_ref(), Vector3::new(1.0, 0.0, 0.0)) - 2.0).abs() < 1e-6,
        "dir turns with its space"
    );
    let none = built("directionmix", TextureValue::Float, dir([0.0; 3]), &grey(1, 1, vec![0.0]));
    assert!(none.is_err_and(|m| m.contains("expected a direction")));
}
