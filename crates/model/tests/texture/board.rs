//! Checkerboards: cubes, and what a footprint averages to.
use durer_core::math::{Point3, Vector3};
use durer_model::texture::{Footprint, Habit, Texture, TextureAt};
use durer_scene::{Params, TextureValue};
use durer_testkit::random::Random;

use super::{CX, at, built, float, grey};

fn board(params: Params) -> Box<dyn Texture> {
    built("checkerboard", TextureValue::Float, params, &grey(1, 1, vec![0.0])).expect("sound")
}

fn under(board: &dyn Texture, [u, v]: [f32; 2], steps: [[f32; 2]; 2], habit: Habit) -> f32 {
    let footprint = Footprint {
        dpdx: Vector3::new(1.0, 0.0, 0.0),
        duvdx: steps[0],
        duvdy: steps[1],
        habit,
        ..Footprint::POINT
    };
    board.float(&CX, &TextureAt { footprint, ..at(u, v) })
}

#[test]
fn cubes_alternate_in_all_directions() {
    let cubes = board(Params::new().int("dimension", 3));
    let seen = |p: [f32; 3]| cubes.float(&CX, &TextureAt { p: p.into(), ..at(0.0, 0.0) });
    assert_eq!(seen([0.5; 3]), 1.0);
    for axis in 0..3 {
        let mut p = [0.5f32; 3];
        for steps in 0..4 {
            p[axis] = 0.5 - steps as f32;
            assert_eq!(seen(p), [1.0, 0.0][steps % 2], "{p:?}");
        }
    }
    assert_eq!(seen([-0.5; 3]), 0.0);
    let footprint =
        Footprint { dpdx: Vector3::new(900.0, 700.0, 800.0), habit: Habit::AsPbrt, ..Footprint::POINT };
    let far = cubes.float(&CX, &TextureAt { p: Point3::new(0.5, 0.5, 0.5), footprint, ..at(0.0, 0.0) });
    assert!((far - 0.5).abs() < 1e-6);
}

#[test]
fn a_filtered_board_is_the_mean_under_a_tent() {
    let mut random = Random::new(21);
    let (sharp, soft) = (board(Params::new()), board(Params::new().string("filter", "tent")));
    for _ in 0..40 {
        let [u, v, a, b] = std::array::from_fn(|_| random.between(-3.0, 3.0) as f32);
        let (a, b) = (a * a / 3.0, b);
        let filtered = under(soft.as_ref(), [u, v], [[a, 0.1], [-0.2, b]], Habit::Asked);
        let (ru, rv) = (1.5 * a.abs().max(0.2), 1.5 * b.abs().max(0.1));
        let n = 600;
        let mut expected = 0.0;
        for k in 0..n * n {
            let t = |k: i32| (k as f32 + 0.5) / n as f32 * 2.0 - 1.0;
            let (s, t) = (t(k % n), t(k / n));
            let weight = f64::from((1.0 - s.abs()) * (1.0 - t.abs()));
            expected += weight * f64::from(float(sharp.as_ref(), u + s * ru, v + t * rv));
        }
        expected /= f64::from(n * n) / 4.0;
        assert!((f64::from(filtered) - expected).abs() < 4e-3, "{u} {v} {a} {b}: {filtered} {expected}");
    }
}

#[test]
fn boards_are_filtered_where_pbrt_does_it_or_a_parameter_says_so() {
    let wide = [[0.4, 0.0], [0.0, 0.4]];
    let edge = [0.9f32, 0.5];
    let value = |params: Params, habit: Habit| under(board(params).as_ref(), edge, wide, habit);
    let usual = value(Params::new(), Habit::AsPbrt);
    assert!(usual > 0.5 && usual < 0.9, "{usual}");
    assert_eq!(value(Params::new(), Habit::Asked), 1.0);
    assert_eq!(value(Params::new().string("filter", "none"), Habit::AsPbrt), 1.0);
    assert_eq!(value(Params::new().string("filter", "tent"), Habit::Asked), usual);
    // Where the tent meets no edge nothing changes, not even the last bit.
    let narrow = [[0.01, 0.0], [0.0, 0.01]];
    assert_eq!(under(board(Params::new()).as_ref(), [7.5, -3.5], narrow, Habit::AsPbrt), 0.0);
}

#[test]
fn footprints_of_any_size_give_shares() {
    let soft = board(Params::new().string("filter", "tent"));
    for size in [1e-30f32, 1e-7, 1e-3, 1.0, 1e4, 1e8, f32::MAX] {
        for c in [0.0f32, 0.999_999, 1.0, -7.3, 1e6, 1e30, f32::INFINITY, f32::NAN] {
            let share = under(soft.as_ref(), [c, 0.3], [[size, size], [0.0, size]], Habit::Asked);
            assert!((0.0..=1.0).contains(&share), "{size} {c}: {share}");
        }
    }
    let far = under(soft.as_ref(), [0.3, 0.4], [[1e4, 0.0], [0.0, 1e4]], Habit::Asked);
    assert!((far - 0.5).abs() < 1e-6);
}
