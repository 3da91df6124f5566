//! The encoding against its formula, and data pictures.
use super::*;

/// The formula, in f64: code values in [0, 1].
fn formula(v: f32) -> f64 {
    let v = f64::from(v).clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

fn formula8(v: f32) -> u8 {
    (255.0 * formula(v)).round() as u8
}

/// The published inverse, in f64.
fn linear(code: u8) -> f64 {
    let code = f64::from(code) / 255.0;
    if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

fn hash(i: u32) -> u32 {
    let h = i.wrapping_mul(0x9E37_79B9);
    (h ^ (h >> 15)).wrapping_mul(0x85EB_CA6B)
}

fn one(rgb: [f32; 3], exposure_ev: f32) -> [u8; 3] {
    let out = develop(1, 1, &[rgb], exposure_ev, ToneMap::None).rgb8;
    [out[0], out[1], out[2]]
}

fn ids(n: u16) -> Vec<[u8; 3]> {
    (1..=n).map(|i| id_colour(u32::from(i))).collect()
}

fn largest_difference(a: [u8; 3], b: [u8; 3]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

#[test]
fn every_step_of_the_encoding_is_where_the_formula_rounds_up() {
    for (k, step) in STEPS[..255].iter().enumerate() {
        assert_eq!((usize::from(formula8(*step)), usize::from(formula8(step.next_down()))), (k + 1, k));
        assert_eq!((usize::from(srgb8(*step)), usize::from(srgb8(step.next_down()))), (k + 1, k));
    }
}

#[test]
fn the_encoding_equals_the_formula_at_a_million_values() {
    for i in 0..500_000 {
        let uniform = (hash(i) >> 8) as f32 / (1 << 24) as f32;
        // Any bits of floats in [2^-14, 2).
        let logarithmic = f32::from_bits((1.0f32 / 16384.0).to_bits() + hash(i) % (15 << 23));
        for v in [uniform, logarithmic] {
            assert_eq!(srgb8(v), formula8(v), "{v}");
        }
    }
}

#[test]
fn the_encoding_rises_at_most_once_in_a_cell() {
    for pair in CODES.windows(2) {
        assert!(pair[1] - pair[0] <= 1, "{pair:?}");
    }
    assert_eq!(CODES[0], 0);
    assert_eq!(CODES[CELLS - 1], 255);
}

#[test]
fn the_encoding_clips_what_is_no_light_or_too_much() {
    assert_eq!([f32::NAN, f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-45].map(srgb8), [0; 6]);
    assert_eq!([1.0f32.next_down(), 1.0, 1.0f32.next_up(), 1e30, f32::INFINITY].map(srgb8), [255; 5]);
}

/// E19: decoding what was encoded gives back every code, and light is never off by more than half a code.
#[test]
fn srgb_comes_back_within_one_in_255() {
    for code in 0..=255 {
        assert_eq!(one([linear(code) as f32; 3], 0.0), [code; 3]);
    }
    for i in 0..=100_000 {
        let v = i as f32 / 1e5;
        let back = linear(srgb8(v)) as f32;
        assert!((formula(back) - formula(v)).abs() <= 0.5 / 255.0 + 1e-6, "{v} {back}");
    }
}

#[test]
fn a_stop_of_exposure_doubles_light_before_encoding() {
    for i in 0..1000 {
        let c = [hash(3 * i), hash(3 * i + 1), hash(3 * i + 2)].map(|h| (h >> 8) as f32 / (1 << 24) as f32);
        assert_eq!(one(c, 1.0), one(c.map(|v| 2.0 * v), 0.0));
        assert_eq!(one(c, -2.0), one(c.map(|v| 0.25 * v), 0.0));
    }
    assert_eq!(one([0.25; 3], 1.0), [188; 3]);
    assert_eq!(one([0.25; 3], 0.0), [137; 3]);
}

#[test]
fn tone_maps_act_between_exposure_and_encoding() {
    for map in ToneMap::ALL {
        let c = [0.9, 0.3, 0.05];
        let expected: Vec<u8> = map.apply(c.map(|v| 4.0 * v)).into_iter().map(formula8).collect();
        assert_eq!(develop(1, 1, &[c], 2.0, map).rgb8, expected, "{map:?}");
    }
}

#[test]
fn pixels_keep_their_places() {
    let out =
        develop(2, 2, &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]], 0.0, ToneMap::None);
    assert_eq!((out.width, out.height), (2, 2));
    assert_eq!(out.rgb8, [255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255]);
}

#[test]
#[should_panic(expected = "pixels of a picture of 2 x 2")]
fn a_missing_pixel_is_noticed() {
    develop(2, 2, &[[0.0; 3]; 3], 0.0, ToneMap::None);
}

#[test]
fn depth_is_scaled_over_the_hits_alone() {
    let at = |d: f32| Some([d, 99.0, 0.0]);
    let out = develop_data(Show::Depth, 5, 1, &[None, at(2.0), at(4.0), at(3.0), None]);
    assert_eq!(out.depth, Some(DepthRange { near: 2.0, far: 4.0 }));
    let levels: Vec<u8> = out.picture.rgb8.chunks(3).map(|p| p[0]).collect();
    assert_eq!(levels, [0, 255, DepthRange::FAR_LEVEL, 143, 0]);
    assert!(out.picture.rgb8.chunks(3).all(|p| p[0] == p[1] && p[1] == p[2]));
}

#[test]
fn depth_survives_flat_empty_and_broken_pictures() {
    let flat = develop_data(Show::Depth, 2, 1, &[Some([5.0; 3]), None]);
    assert_eq!(flat.depth, Some(DepthRange { near: 5.0, far: 5.0 }));
    assert_eq!(flat.picture.rgb8, [255, 255, 255, 0, 0, 0]);
    let empty = develop_data(Show::Depth, 2, 1, &[None; 2]);
    assert_eq!((empty.depth, empty.picture.rgb8), (None, vec![0; 6]));
    let broken =
        develop_data(Show::Depth, 3, 1, &[Some([f32::NAN; 3]), Some([f32::INFINITY; 3]), Some([1.0; 3])]);
    assert_eq!(broken.depth, Some(DepthRange { near: 1.0, far: 1.0 }));
    assert_eq!(broken.picture.rgb8, [0, 0, 0, 0, 0, 0, 255, 255, 255]);
}

#[test]
fn normals_are_halved_and_shifted_without_the_curve() {
    let out = develop_data(Show::Normal, 3, 1, &[Some([0.0, 0.0, 1.0]), Some([-1.0, 0.6, -0.6]), None]);
    assert_eq!(out.picture.rgb8, [128, 128, 255, 0, 204, 51, 0, 0, 0]);
    assert_eq!(out.depth, None);
}

#[test]
fn uv_shows_fractions_in_red_and_green() {
    let out = develop_data(Show::Uv, 3, 1, &[Some([0.2, 0.4, 9.0]), Some([3.6, -0.2, 0.0]), None]);
    assert_eq!(out.picture.rgb8, [51, 102, 0, 153, 204, 0, 0, 0, 0]);
}

#[test]
fn shading_and_albedo_are_light() {
    for show in [Show::Shading, Show::Albedo] {
        let out = develop_data(show, 2, 1, &[Some([0.5, 0.0, 2.0]), None]);
        assert_eq!(out.picture.rgb8, [188, 0, 255, 0, 0, 0]);
    }
}

#[test]
fn neighbouring_ids_have_clearly_different_colours() {
    for pair in ids(5000).windows(2) {
        assert!(largest_difference(pair[0], pair[1]) > 80, "{pair:?}");
    }
    for pair in ids(5000).windows(3) {
        assert!(largest_difference(pair[0], pair[2]) > 40, "{pair:?}");
    }
}

#[test]
fn ids_have_colours_of_their_own_and_are_never_black() {
    let mut colours = ids(500);
    assert!(colours.iter().all(|c| c.iter().any(|v| *v >= 160)));
    colours.sort_unstable();
    colours.dedup();
    assert_eq!(colours.len(), 500);
}

#[test]
fn ids_keep_their_colours_from_picture_to_picture() {
    let out = develop_data(Show::Id, 3, 1, &[Some([1.0, 0.0, 0.0]), None, Some([2.0, 0.0, 0.0])]);
    assert_eq!(out.picture.rgb8, [63, 107, 214, 0, 0, 0, 107, 172, 16]);
}

#[test]
fn more_cost_is_lighter() {
    let luminance = |v: f32| {
        let [r, g, b] = heat(v).map(linear);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let shades: Vec<f64> = (0..=500).map(|i| luminance(i as f32 / 500.0)).collect();
    assert!(shades.windows(2).all(|w| w[0] <= w[1] + 1e-3));
    assert!(shades[0] == 0.0 && shades[500] > 0.98);
    let data = [Some([3.0, 1.0, 0.0]), Some([0.0, 0.0, 0.0]), Some([1.0, 1.0, 0.0])];
    let shown = develop_data(Show::Cost, 3, 1, &data);
    assert_eq!(shown.white_tests, Some(4.0));
    assert_eq!(shown.picture.rgb8[..6], [255, 255, 235, 0, 0, 0]);
    assert_eq!(shown.picture.rgb8[6..], heat(0.5));
}
