//! Image maps under footprints: means kept, ellipses where they belong.
use durer_core::math::Vector3;
use durer_model::texture::{Filters, Footprint, Habit, Texture, TextureAt};
use durer_scene::{Image, ImageData, Params, TextureValue};
use durer_testkit::random::Random;

use super::{CX, at, built, float, grey};

fn map(params: Params, image: &Image) -> Box<dyn Texture> {
    built("imagemap", TextureValue::Float, params.string("filename", "x.pfm"), image).expect("sound")
}

fn with(filter: &str, image: &Image) -> Box<dyn Texture> {
    map(Params::new().string("filter", filter), image)
}

fn under(map: &dyn Texture, [u, v]: [f32; 2], [duvdx, duvdy]: [[f32; 2]; 2]) -> f32 {
    let dpdx = Vector3::new(1.0, 0.0, 0.0);
    let footprint = Footprint { dpdx, duvdx, duvdy, habit: Habit::Asked, ..Footprint::POINT };
    map.float(&CX, &TextureAt { footprint, ..at(u, v) })
}

fn random_image(width: u32, height: u32, seed: u64) -> Image {
    let mut random = Random::new(seed);
    grey(width, height, (0..width * height).map(|_| random.unit() as f32).collect())
}

fn mean(image: &Image) -> f64 {
    let ImageData::F32(values) = &image.data else { panic!("floats") };
    values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64
}

#[test]
fn footprints_that_cover_everything_see_the_mean_whatever_the_size() {
    for (w, h) in [(16, 16), (13, 7), (1, 9), (31, 2), (64, 5), (1, 1)] {
        let image = random_image(w, h, 31);
        for filter in ["trilinear", "ewa"] {
            let seen = under(with(filter, &image).as_ref(), [0.3, 0.8], [[64.0, 0.0], [0.0, 64.0]]);
            assert!((f64::from(seen) - mean(&image)).abs() < 1e-5, "{w} x {h} {filter}: {seen}");
        }
    }
}

#[test]
fn small_footprints_are_looked_up_as_points() {
    let image = random_image(32, 32, 32);
    let (bilinear, trilinear) = (with("bilinear", &image), with("trilinear", &image));
    let mut random = Random::new(33);
    for _ in 0..100 {
        let c: [f32; 2] = std::array::from_fn(|_| random.unit() as f32);
        let expected = float(bilinear.as_ref(), c[0], c[1]);
        assert_eq!(under(trilinear.as_ref(), c, [[0.01, 0.0], [0.0, 0.01]]), expected);
        for filter in ["trilinear", "ewa"] {
            assert_eq!(float(with(filter, &image).as_ref(), c[0], c[1]), expected, "no footprint");
            assert_eq!(under(with(filter, &image).as_ref(), c, [[0.0; 2]; 2]), expected, "a point");
        }
    }
}

/// A linear ramp is its own mean: filters that are symmetric around the point, as all are, do not move it.
#[test]
fn filters_do_not_move_a_picture() {
    let n = 256u32;
    let ramp = grey(n, n, (0..n * n).map(|i| ((i % n) + 2 * (i / n)) as f32 / n as f32).collect());
    let mut random = Random::new(34);
    for filter in ["trilinear", "ewa"] {
        let map = map(Params::new().string("filter", filter).string("wrap", "clamp"), &ramp);
        for _ in 0..200 {
            let [u, v] = std::array::from_fn(|_| random.between(0.4, 0.6) as f32);
            let [a, b, c, d] = std::array::from_fn(|_| random.between(-0.02, 0.02) as f32);
            let seen = under(map.as_ref(), [u, v], [[a, b], [c, d]]);
            let expected = (u * n as f32 - 0.5 + 2.0 * ((1.0 - v) * n as f32 - 0.5)) / n as f32;
            // Texels of the ellipse lie on a lattice: a fraction of one, of the coarser level.
            assert!((seen - expected).abs() < 0.01, "{filter} {u} {v}: {seen} {expected}");
        }
    }
}

/// Stripes along u, seen under a footprint that is long along u and narrow along v: the ellipse keeps them, squares as
/// wide as it is long do not. Turned round, both average them.
#[test]
fn ellipses_blur_along_their_longer_axis_only() {
    let n = 128u32;
    let stripes =
        grey(n, n, (0..n * n).map(|i| if (i / n / 8).is_multiple_of(2) { 1.0 } else { 0.0 }).collect());
    let (ewa, trilinear) = (with("ewa", &stripes), with("trilinear", &stripes));
    let middle = [0.5, 1.0 - 20.0 / n as f32];
    let (long, thin) = (8.0 / n as f32, 1.0 / n as f32);
    let along = [[long, 0.0], [0.0, thin]];
    assert_eq!(under(ewa.as_ref(), middle, along), 1.0);
    assert!(under(trilinear.as_ref(), middle, along) < 0.8);
    let across = [[thin, 0.0], [0.0, long]];
    assert!(under(ewa.as_ref(), middle, across) < 0.95);
    // At 45 degrees the ellipse follows diagonal stripes, of slope as v is upwards and rows count downwards.
    let diagonal = grey(
        n,
        n,
        (0..n * n).map(|i| if ((i % n + i / n) / 16).is_multiple_of(2) { 1.0 } else { 0.0 }).collect(),
    );
    let ewa = with("ewa", &diagonal);
    let c = [64.0 / n as f32, 1.0 - (40.0 - 0.5) / n as f32];
    let (a, b) = (0.7 * long, 0.7 * thin);
    assert!(under(ewa.as_ref(), c, [[a, a], [-b, b]]) > 0.99);
    assert!(under(ewa.as_ref(), c, [[a, -a], [b, b]]) < 0.97);
}

#[test]
fn a_bound_on_anisotropy_widens_the_shorter_axis() {
    let n = 128u32;
    let stripes =
        grey(n, n, (0..n * n).map(|i| if (i / n / 4).is_multiple_of(2) { 1.0 } else { 0.0 }).collect());
    let seen = |most: f32| {
        let map = map(Params::new().string("filter", "ewa").float("maxanisotropy", most), &stripes);
        under(map.as_ref(), [0.5, 1.0 - 10.0 / n as f32], [[0.25, 0.0], [0.0, 1.0 / n as f32]])
    };
    assert!(seen(64.0) > 0.95 && seen(2.0) < 0.75, "{} {}", seen(64.0), seen(2.0));
}

#[test]
fn copies_take_a_third_of_what_floats_would_and_are_asked_for_only_where_needed() {
    let image = random_image(64, 32, 35);
    for (filter, expected) in [("point", 0), ("bilinear", 0), ("trilinear", 1), ("ewa", 1)] {
        let map = with(filter, &image);
        let texels: u64 =
            [(32, 16), (16, 8), (8, 4), (4, 2), (2, 1), (1, 1)].iter().map(|(w, h)| w * h).sum();
        assert_eq!(map.bytes(), expected * texels * 4, "{filter}");
        assert_eq!(map.filters(), if expected == 1 { Filters::Always } else { Filters::Never });
    }
}

#[test]
fn copies_are_means_in_linear_light_with_alpha_apart() {
    let rgba = vec![255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 0, 255];
    let image = Image { width: 2, height: 2, channels: 4, data: ImageData::U8(rgba) };
    let params = Params::new().string("filename", "x.png").string("filter", "trilinear");
    let map = built("imagemap", TextureValue::Color, params, &image).expect("sound");
    let dpdx = Vector3::new(1.0, 0.0, 0.0);
    let footprint = Footprint { dpdx, duvdx: [3.0, 0.0], duvdy: [0.0, 3.0], ..Footprint::POINT };
    assert_eq!(map.color(&CX, &TextureAt { footprint, ..at(0.2, 0.2) }).rgb, [0.5, 0.25, 0.0]);
    let params = Params::new().string("channel", "a").string("filename", "x.png").string("filter", "ewa");
    let map = built("imagemap", TextureValue::Float, params, &image).expect("sound");
    assert_eq!(map.float(&CX, &TextureAt { footprint, ..at(0.2, 0.2) }), 0.5);
}

#[test]
fn footprints_of_any_size_give_values_between_the_texels() {
    let image = random_image(33, 20, 36);
    for filter in ["trilinear", "ewa"] {
        for wrap in ["repeat", "clamp", "mirror", "black", "octahedralsphere"] {
            let map = map(Params::new().string("filter", filter).string("wrap", wrap), &image);
            for size in [1e-30f32, 1e-3, 0.3, 1e4, 1e8, f32::MAX] {
                for c in [0.3f32, -5.5, 1e6, 1e30, f32::INFINITY, f32::NAN] {
                    let seen = under(map.as_ref(), [c, 0.3], [[size, -size], [0.0, 0.5 * size]]);
                    assert!((0.0..=1.0 + 1e-6).contains(&seen), "{filter} {wrap} {size} {c}: {seen}");
                }
            }
        }
    }
}
