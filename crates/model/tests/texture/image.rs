//! Image textures: orientation, wrapping, filtering, decoding.
use durer_model::texture::Texture;
use durer_scene::{Data, Image, ImageData, Params, TextureValue, ValueType};
use durer_testkit::random::Random;

use super::{CX, built, color, float, grey};

fn color_map(params: Params, image: &Image) -> Box<dyn Texture> {
    built("imagemap", TextureValue::Color, params.string("filename", "x.png"), image)
        .expect("sound parameters")
}

fn float_map(params: Params, image: &Image) -> Box<dyn Texture> {
    built("imagemap", TextureValue::Float, params.string("filename", "x.png"), image)
        .expect("sound parameters")
}

fn matrix(m: [f32; 6]) -> Params {
    Params::new().with("uvmatrix", ValueType::Float, Data::Floats(m.to_vec()))
}

#[test]
fn row_zero_of_an_image_is_at_the_top() {
    let map = float_map(Params::new().string("filter", "point"), &grey(2, 2, vec![1.0, 2.0, 3.0, 4.0]));
    let corners = [(0.25, 0.75), (0.75, 0.75), (0.25, 0.25), (0.75, 0.25)];
    assert_eq!(corners.map(|(u, v)| float(map.as_ref(), u, v)), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn wrap_modes_match_rows_written_by_hand() {
    // Texels 1 2 4, sampled at texel centres from two widths left to one width right.
    let image = grey(3, 1, vec![1.0, 2.0, 4.0]);
    let rows = [
        ("repeat", [1., 2., 4., 1., 2., 4., 1., 2., 4., 1., 2., 4.]),
        ("clamp", [1., 1., 1., 1., 1., 1., 1., 2., 4., 4., 4., 4.]),
        ("mirror", [1., 2., 4., 4., 2., 1., 1., 2., 4., 4., 2., 1.]),
        ("black", [0., 0., 0., 0., 0., 0., 1., 2., 4., 0., 0., 0.]),
    ];
    for (word, row) in rows {
        for filter in ["point", "bilinear"] {
            let params = || Params::new().string("filter", filter);
            let u = float_map(params().string("wrap", word).string("wrapv", "clamp"), &image);
            let both = float_map(params().string("wrap", word), &grey(1, 3, vec![4.0, 2.0, 1.0]));
            for (i, expected) in row.into_iter().enumerate() {
                let c = (i as f32 - 6.0 + 0.5) / 3.0;
                assert!((float(u.as_ref(), c, 0.5) - expected).abs() < 1e-5, "{word} {filter} u = {c}");
                assert!((float(both.as_ref(), 0.5, c) - expected).abs() < 1e-5, "{word} {filter} v = {c}");
            }
        }
    }
}

/// Neighbours on the octahedral map are neighbours on the sphere: every step over an edge leads to the texel that the
/// unfolded octahedron has there.
#[test]
fn the_octahedral_map_goes_on_beyond_its_edges_turned_round() {
    let n = 4i32;
    let image = grey(4, 4, (0..16u8).map(f32::from).collect());
    let map = float_map(Params::new().string("wrap", "octahedralsphere").string("filter", "point"), &image);
    let texel = |x: i32, y: i32| float(map.as_ref(), (x as f32 + 0.5) / 4.0, 1.0 - (y as f32 + 0.5) / 4.0);
    for i in 0..n {
        let here = |x: i32, y: i32| (y * n + x) as f32;
        assert_eq!(texel(-1, i), here(0, n - 1 - i), "left of row {i}");
        assert_eq!(texel(n, i), here(n - 1, n - 1 - i), "right of row {i}");
        assert_eq!(texel(i, -1), here(n - 1 - i, 0), "above column {i}");
        assert_eq!(texel(i, n), here(n - 1 - i, n - 1), "below column {i}");
        assert_eq!(texel(i + 2 * n, i - 4 * n), here(i, i), "two and four maps away");
    }
    assert_eq!(texel(-1, -1), (n * n - 1) as f32);
}

#[test]
fn bilinear_lookup_is_the_tent_of_its_neighbours() {
    let mut random = Random::new(1);
    let data: Vec<f32> = (0..20).map(|_| random.unit() as f32).collect();
    let map = float_map(Params::new(), &grey(5, 4, data.clone()));
    for _ in 0..2000 {
        let (u, v) = (random.between(-3.0, 3.0) as f32, random.between(-3.0, 3.0) as f32);
        // The oracle sums tents of all texels over all repetitions.
        let (x, y) = (f64::from(u) * 5.0 - 0.5, (1.0 - f64::from(v)) * 4.0 - 0.5);
        let mut expected = 0.0;
        for j in -20i64..20 {
            for i in -20i64..20 {
                let w = (1.0 - (x - i as f64).abs()).max(0.0) * (1.0 - (y - j as f64).abs()).max(0.0);
                expected += w * f64::from(data[(j.rem_euclid(4) * 5 + i.rem_euclid(5)) as usize]);
            }
        }
        assert!((f64::from(float(map.as_ref(), u, v)) - expected).abs() < 1e-6, "{u} {v}");
    }
}

#[test]
fn colours_of_eight_bits_are_srgb_and_everything_else_is_linear() {
    let image = |data| Image { width: 1, height: 1, channels: 2, data };
    let bytes = image(ImageData::U8(vec![188, 128]));
    let words = image(ImageData::U16(vec![48_316, 32_768]));
    let decoded = |c: f64| ((c + 0.055) / 1.055).powf(2.4) as f32;
    let one = |p: Params, i: &Image| color(color_map(p, i).as_ref(), 0.5, 0.5)[0];
    let number = |p: Params, i: &Image| float(float_map(p, i).as_ref(), 0.5, 0.5);
    let (new, srgb) = (Params::new, || Params::new().string("encoding", "sRGB"));
    assert_eq!(one(new(), &bytes), decoded(188.0 / 255.0));
    assert_eq!(one(new().string("encoding", "linear"), &bytes), 188.0 / 255.0);
    // As in pbrt-v4, where files of 8 bits are sRGB whatever they are for.
    assert!((number(new(), &bytes) - decoded(188.0 / 255.0)).abs() < 1e-6);
    assert!((number(new().string("encoding", "linear"), &bytes) - 188.0 / 255.0).abs() < 1e-6);
    let power = |c: f64| c.powf(1.8) as f32;
    for image in [&bytes, &words] {
        assert!((one(new().string("encoding", "gamma 1.8"), image) - power(188.0 / 255.0)).abs() < 1e-6);
    }
    assert!((number(srgb(), &bytes) - decoded(188.0 / 255.0)).abs() < 1e-6);
    assert_eq!(number(srgb().string("channel", "a"), &bytes), 128.0 / 255.0);
    // Those of 16 bits if they are PNG files: the tests' name is "x.png".
    assert!((one(new(), &words) - decoded(f64::from(48_316.0f32 / 65_535.0))).abs() < 1e-7);
    assert_eq!(one(new().string("encoding", "linear"), &words), 48_316.0 / 65_535.0);
    let odd = new().string("encoding", "gamma -1").string("filename", "x.png");
    assert!(built("imagemap", TextureValue::Color, odd, &words).is_err_and(|m| m.contains("gamma -1")));
    assert!((one(srgb(), &words) - decoded(f64::from(48_316.0f32 / 65_535.0))).abs() < 1e-7);
}

#[test]
fn every_byte_of_an_srgb_image_decodes_to_the_nearest_float() {
    let image = Image {
        width: 256,
        height: 1,
        channels: 3,
        data: ImageData::U8((0..=255).flat_map(|b| [b; 3]).collect()),
    };
    let map = color_map(Params::new().string("filter", "point"), &image);
    for byte in 0..256 {
        let c = f64::from(byte) / 255.0;
        let exact = if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
        assert_eq!(color(map.as_ref(), (byte as f32 + 0.5) / 256.0, 0.5), [exact as f32; 3], "byte {byte}");
    }
}

#[test]
fn channels_scale_factor_and_inversion_apply_in_order() {
    let image = Image { width: 1, height: 1, channels: 4, data: ImageData::F32(vec![0.1, 0.2, 0.4, 0.5]) };
    for (word, expected) in [("r", 0.1), ("g", 0.2), ("b", 0.4), ("a", 0.5)] {
        assert_eq!(
            float(float_map(Params::new().string("channel", word), &image).as_ref(), 0.5, 0.5),
            expected
        );
    }
    let luminance = Params::new().string("channel", "luminance");
    let luminance = float(float_map(luminance, &image).as_ref(), 0.5, 0.5);
    assert!((luminance - (0.1 * 0.2126 + 0.2 * 0.7152 + 0.4 * 0.0722)).abs() < 1e-7);
    let mean = float(float_map(Params::new().string("channel", "mean"), &image).as_ref(), 0.5, 0.5);
    assert!((mean - 0.7 / 3.0).abs() < 1e-7);
    let number = |image: &Image| float(float_map(Params::new(), image).as_ref(), 0.5, 0.5);
    assert_eq!(number(&image), 0.5, "alpha, where there is any");
    let opaque = Image { data: ImageData::F32(vec![0.1, 0.2, 0.4, 1.0]), ..image.clone() };
    assert!((number(&opaque) - 0.7 / 3.0).abs() < 1e-7, "the mean elsewhere");
    let params = Params::new().float("scale", 2.0).bool("invert", true).rgb("factor", [1.0, 10.0, 0.5]);
    let [r, g, b] = color(color_map(params, &image).as_ref(), 0.5, 0.5);
    assert!((r - 0.8).abs() < 1e-6 && (g - 6.0).abs() < 1e-6 && (b - 0.1).abs() < 1e-6);
}

#[test]
fn the_matrix_says_the_same_as_the_four_numbers() {
    let image = grey(3, 2, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let four =
        Params::new().float("uscale", 2.0).float("vscale", -0.5).float("udelta", 0.25).float("vdelta", 1.5);
    let (four, six) = (float_map(four, &image), float_map(matrix([2.0, 0.0, 0.25, 0.0, -0.5, 1.5]), &image));
    let turned = float_map(matrix([0.0, 1.0, 0.0, 1.0, 0.0, 0.0]), &image);
    let plain = float_map(Params::new(), &image);
    let mut random = Random::new(2);
    for _ in 0..500 {
        let (u, v) = (random.between(-2.0, 2.0) as f32, random.between(-2.0, 2.0) as f32);
        assert_eq!(float(four.as_ref(), u, v), float(six.as_ref(), u, v));
        assert_eq!(float(turned.as_ref(), u, v), float(plain.as_ref(), v, u));
    }
    let both = matrix([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).float("uscale", 2.0).string("filename", "x");
    assert!(built("imagemap", TextureValue::Float, both, &image).is_err_and(|m| m.contains("not both")));
    let five =
        Params::new().with("uvmatrix", ValueType::Float, Data::Floats(vec![0.0; 5])).string("filename", "x");
    assert!(built("imagemap", TextureValue::Float, five, &image).is_err_and(|m| m.contains("expected 6")));
}

#[test]
fn coordinates_far_out_or_not_finite_give_finite_colours() {
    let image = grey(3, 2, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    for wrap in ["repeat", "clamp", "mirror", "black"] {
        let map = float_map(Params::new().string("wrap", wrap), &image);
        for c in [f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX, 1e20, -1e20] {
            assert!(
                float(map.as_ref(), c, 0.3).is_finite() && float(map.as_ref(), 0.3, c).is_finite(),
                "{wrap} {c}"
            );
        }
    }
}

#[test]
fn a_missing_image_shows_magenta_and_black() {
    let params = Params::new().string("filename", "missing.png").float("scale", 0.0);
    let map = built("imagemap", TextureValue::Color, params, &grey(1, 1, vec![0.0])).expect("a placeholder");
    let colors = [1, 3].map(|i| color(map.as_ref(), i as f32 / 16.0, 1.0 / 16.0));
    assert!(colors.contains(&[1.0, 0.0, 1.0]) && colors.contains(&[0.0; 3]), "{colors:?}");
}

#[test]
fn unsound_images_and_mappings_are_refused() {
    let short = Image { width: 2, height: 2, channels: 3, data: ImageData::U8(vec![0; 11]) };
    let params = || Params::new().string("filename", "x");
    assert!(built("imagemap", TextureValue::Color, params(), &short).is_err_and(|m| m.contains("not sound")));
    let half = params().string("wrap", "octahedralsphere").string("wrapv", "clamp");
    assert!(
        built("imagemap", TextureValue::Color, half, &grey(1, 1, vec![0.0]))
            .is_err_and(|m| m.contains("both directions"))
    );
}

#[test]
fn the_second_texture_coordinates_are_used_where_asked_for() {
    let image = grey(2, 1, vec![1.0, 2.0]);
    let place = durer_model::texture::TextureAt { second_uv: [0.75, 0.5].into(), ..super::at(0.25, 0.5) };
    let with_set = |set: i32| float_map(Params::new().string("filter", "point").int("uvset", set), &image);
    assert_eq!([with_set(0).float(&CX, &place), with_set(1).float(&CX, &place)], [1.0, 2.0]);
    assert!(
        built("imagemap", TextureValue::Float, Params::new().string("filename", "x").int("uvset", 2), &image)
            .is_err()
    );
}
