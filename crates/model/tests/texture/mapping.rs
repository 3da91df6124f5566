//! Mappings: known places, and derivatives against difference quotients.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Point3, Vector3},
};
use durer_model::texture::{Footprint, Habit, Texture, TextureAt};
use durer_scene::{Data, Params, TextureValue, ValueType};
use durer_testkit::random::Random;

use super::{CX, at, built, color, grey};

fn vector(params: Params, name: &str, v: [f32; 3]) -> Params {
    params.with(name, ValueType::Vector3, Data::Floats(v.to_vec()))
}

/// `(u, v)` as red and green: u at (1, 0) and (1, 1), v at (0, 1) and (1, 1).
fn coordinates(params: Params, render_from_texture: &DAffine3) -> Box<dyn Texture> {
    let corners =
        [("v00", [0.0; 3]), ("v10", [1.0, 0.0, 0.0]), ("v01", [0.0, 1.0, 0.0]), ("v11", [1.0, 1.0, 0.0])];
    let params = corners.into_iter().fold(params, |params, (name, c)| params.rgb(name, c));
    let mut texture = built("bilerp", TextureValue::Color, params, &grey(1, 1, vec![0.0])).expect("sound");
    texture.place(render_from_texture);
    texture
}

fn seen(texture: &dyn Texture, p: [f32; 3]) -> [f32; 2] {
    let [u, v, _] = texture.color(&CX, &TextureAt { p: p.into(), ..at(0.0, 0.0) }).rgb;
    [u, v]
}

#[test]
fn bilerp_gives_its_corners_and_goes_on_beyond_them() {
    let texture = coordinates(Params::new(), &DAffine3::IDENTITY);
    for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.25, 0.5), (-1.0, 3.0)] {
        assert_eq!(color(texture.as_ref(), u, v), [u, v, 0.0]);
    }
    assert!(texture.largest(&CX) >= 3.0);
}

#[test]
fn points_lie_where_the_mappings_put_them() {
    let with = |mapping: &str| coordinates(Params::new().string("mapping", mapping), &DAffine3::IDENTITY);
    let near = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6;
    let spherical = with("spherical");
    for (p, expected) in [
        ([0.0, 0.0, 2.0], [0.0, 0.0]),
        ([3.0, 0.0, 0.0], [0.5, 0.0]),
        ([0.0, 3.0, 0.0], [0.5, 0.25]),
        ([0.0, -1.0, 0.0], [0.5, 0.75]),
        ([1.0, 1.0, -2f32.sqrt()], [0.75, 0.125]),
    ] {
        assert!(near(seen(spherical.as_ref(), p), expected), "{p:?}: {:?}", seen(spherical.as_ref(), p));
    }
    let cylindrical = with("cylindrical");
    for (p, expected) in
        [([2.0, 0.0, 0.7], [0.5, 0.7]), ([0.0, 1.0, -3.0], [0.75, -3.0]), ([0.0, -1.0, 0.0], [0.25, 0.0])]
    {
        assert!(near(seen(cylindrical.as_ref(), p), expected), "{p:?}");
    }
    let params = Params::new().string("mapping", "planar").float("udelta", 0.25).float("vdelta", -1.0);
    let params = vector(vector(params, "v1", [0.0, 0.0, 2.0]), "v2", [1.0, 1.0, 0.0]);
    assert!(near(seen(coordinates(params, &DAffine3::IDENTITY).as_ref(), [1.0, 2.0, 3.0]), [6.25, 2.0]));
}

#[test]
fn textures_move_with_their_space() {
    let m = DAffine3::from_translation(DVec3::new(5.0, -2.0, 1.0)) * DAffine3::from_scale(DVec3::splat(2.0));
    for mapping in ["spherical", "cylindrical", "planar"] {
        let (still, moved) = (
            coordinates(Params::new().string("mapping", mapping), &DAffine3::IDENTITY),
            coordinates(Params::new().string("mapping", mapping), &m),
        );
        let p = [0.3, 0.4, -0.5];
        let there = m.transform_point3(DVec3::from(p.map(f64::from))).to_array().map(|c| c as f32);
        let (a, b) = (seen(still.as_ref(), p), seen(moved.as_ref(), there));
        assert!((a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6, "{mapping}: {a:?} {b:?}");
    }
}

#[test]
fn derivatives_of_mappings_are_difference_quotients() {
    let mut random = Random::new(3);
    let m = DAffine3::from_rotation_x(0.4) * DAffine3::from_scale(DVec3::new(1.0, 2.0, 0.5));
    for mapping in ["spherical", "cylindrical", "planar"] {
        let place = coordinates(Params::new().string("mapping", mapping), &m);
        for _ in 0..50 {
            let p: [f32; 3] = std::array::from_fn(|_| random.between(0.3, 1.0) as f32);
            let step: [f32; 3] = std::array::from_fn(|_| random.between(-1.0, 1.0) as f32);
            let e = 1e-2;
            let moved = |sign: f32| seen(place.as_ref(), std::array::from_fn(|i| p[i] + sign * e * step[i]));
            let (before, after) = (moved(-1.0), moved(1.0));
            let slope: [f32; 2] = std::array::from_fn(|i| (after[i] - before[i]) / (2.0 * e));
            let width = |axis: usize| read_off(mapping, &m, (p, step), axis);
            for (axis, expected) in slope.map(f32::abs).into_iter().enumerate() {
                assert!((width(axis) - expected).abs() < 2e-3 + 0.01 * expected, "{mapping} {axis}");
            }
        }
    }
}

/// The derivative of a coordinate by the footprint's step, read off an image of thin stripes: the footprint under which
/// half of their contrast is left is `2^(1/2) / 2` texels wide.
fn read_off(mapping: &str, m: &DAffine3, (p, step): ([f32; 3], [f32; 3]), axis: usize) -> f32 {
    let n = 1u32 << 14;
    let size = if axis == 0 { [n, 1] } else { [1, n] };
    // All copies but the image itself are grey: its share in the mean of two gives the width.
    let values = (0..n).map(|i| if i % 2 == 0 { 0.0 } else { 2.0 }).collect();
    let image = grey(size[0], size[1], values);
    let params =
        Params::new().string("filename", "x.pfm").string("filter", "trilinear").string("mapping", mapping);
    let mut map = built("imagemap", TextureValue::Float, params, &image).expect("sound");
    map.place(m);
    // Scale the step until half of the finest level is left: then the width is 2^(1/2) texels.
    let value = |scale: f32| {
        let footprint =
            Footprint { dpdx: Vector3::from(step) * scale, habit: Habit::Asked, ..Footprint::POINT };
        let place = TextureAt { p: Point3::from(p), footprint, ..at(0.0, 0.0) };
        (map.float(&CX, &place) - 1.0).abs()
    };
    let contrast = value(1e-9);
    let (mut low, mut high) = (1e-9f32, 1.0f32);
    for _ in 0..60 {
        let middle = (low * high).sqrt();
        if value(middle) > 0.5 * contrast { low = middle } else { high = middle }
    }
    2f32.sqrt() / (2.0 * n as f32 * low)
}
