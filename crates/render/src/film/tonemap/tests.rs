//! Tone curves against published values.
use super::*;

/// Greys from 2^-24 to 2^24, twelve to the octave.
fn greys() -> impl Iterator<Item = f32> {
    (-288..=288).map(|i| pow(2.0, i as f32 / 12.0))
}

fn colours(n: u32) -> impl Iterator<Item = [f32; 3]> {
    (0..n).map(|i| {
        std::array::from_fn(|k| {
            let h = (i * 3 + k as u32).wrapping_mul(0x9E37_79B9);
            pow(2.0, ((h ^ (h >> 15)).wrapping_mul(0x85EB_CA6B) >> 8) as f32 / (1 << 24) as f32 * 24.0 - 14.0)
        })
    })
}

fn close(a: [f32; 3], b: [f32; 3], tolerance: f32) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance)
}

#[test]
fn words_name_every_map() {
    for (map, word) in ToneMap::ALL.into_iter().zip(ToneMap::WORDS) {
        assert_eq!(map.word(), word);
        assert_eq!(ToneMap::from_word(word), Some(map));
    }
    assert_eq!(ToneMap::from_word("filmic"), None);
    assert_eq!(ToneMap::default(), ToneMap::None);
}

#[test]
fn any_input_gives_displayable_light() {
    let odd: [f32; 12] = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        -1.0,
        -0.0,
        0.0,
        1e-45,
        1e-6,
        0.5,
        1e9,
    ];
    for map in ToneMap::ALL {
        for i in 0..odd.len().pow(3) {
            let c = [odd[i % 12], odd[i / 12 % 12], odd[i / 144]];
            let out = map.apply(c);
            assert!(out.iter().all(|v| (0.0..=1.0).contains(v)), "{map:?} of {c:?} is {out:?}");
        }
    }
}

#[test]
fn greys_stay_exactly_grey() {
    for map in ToneMap::ALL {
        for v in greys() {
            let [r, g, b] = map.apply([v; 3]);
            assert!(r == g && g == b, "{map:?} of grey {v} is {:?}", [r, g, b]);
        }
    }
}

#[test]
fn brighter_greys_never_come_out_darker() {
    for map in ToneMap::ALL {
        let mut last = 0.0;
        for v in greys() {
            let out = map.apply([v; 3])[0];
            assert!(out >= last - 2e-7, "{map:?} falls from {last} to {out} at {v}");
            last = out;
        }
    }
}

#[test]
fn no_light_is_black_and_endless_light_is_white() {
    for map in ToneMap::ALL {
        assert_eq!(map.apply([0.0; 3]), [0.0; 3], "{map:?}");
        assert!(close(map.apply([f32::INFINITY; 3]), [1.0; 3], 1e-6), "{map:?}");
    }
}

#[test]
fn none_clips() {
    assert_eq!(ToneMap::None.apply([-0.5, 0.25, 7.0]), [0.0, 0.25, 1.0]);
}

#[test]
fn reinhard_maps_unit_luminance_to_a_half_and_keeps_ratios() {
    assert!(close(ToneMap::Reinhard.apply([1.0; 3]), [0.5; 3], 1e-6));
    let [r, g, b] = ToneMap::Reinhard.apply([0.4, 0.2, 0.1]);
    assert!((r / g - 2.0).abs() < 1e-6 && (g / b - 2.0).abs() < 1e-6);
}

/// The note of the specification: c_out = c_in - F90 where all channels are in [0.08, 0.8].
#[test]
fn pbr_neutral_keeps_base_colours_less_the_fresnel_offset() {
    for c in [[0.08, 0.08, 0.08], [0.8, 0.8, 0.8], [0.8, 0.08, 0.3], [0.2, 0.5, 0.79]] {
        assert!(close(ToneMap::PbrNeutral.apply(c), c.map(|v| v - 0.04), 1e-6), "{c:?}");
    }
}

/// Worked by hand from the specification's equations.
#[test]
fn pbr_neutral_has_the_specified_values() {
    // x = 0.04: f = 0.04 - 0.0016 / 0.16 = 0.03.
    assert!(close(ToneMap::PbrNeutral.apply([0.04, 0.5, 0.1]), [0.01, 0.47, 0.07], 1e-6));
    // Grey 1: p = 0.96, p_n = 1 - 0.0576 / 0.44.
    assert!(close(ToneMap::PbrNeutral.apply([1.0; 3]), [0.869_090_9; 3], 1e-6));
    // Red 4: f = 0, p_n = 1 - 0.0576 / 3.48 = 0.983448, g = 1 / (0.15 * 3.016552 + 1) = 0.688478.
    assert!(close(ToneMap::PbrNeutral.apply([4.0, 0.0, 0.0]), [0.983_448, 0.306_366, 0.306_366], 1e-5));
}

#[test]
fn pbr_neutral_keeps_the_hue() {
    let place = |[r, g, b]: [f32; 3]| {
        let (lo, hi) = (r.min(g).min(b), r.max(g).max(b));
        [r, g, b].map(|v| (v - lo) / (hi - lo))
    };
    for c in [[3.0, 1.0, 0.2], [0.1, 0.9, 6.0], [0.5, 0.7, 0.02]] {
        assert!(close(place(c), place(ToneMap::PbrNeutral.apply(c)), 1e-4), "{c:?}");
    }
}

/// (0.18 * 0.2045786 - 0.000090537) / (0.18 * (0.983729 * 0.18 + 0.432951) + 0.238081), greys passing both matrices.
#[test]
fn aces_has_the_published_fit_on_greys() {
    assert!(close(ToneMap::Aces.apply([0.18; 3]), [0.105_591; 3], 1e-5));
    assert!(close(ToneMap::Aces.apply([1.0; 3]), [0.619_12; 3], 1e-4));
}

/// The matrices as published, in full, in f64.
#[test]
fn aces_agrees_with_the_published_matrices() {
    const IN: [[f64; 3]; 3] =
        [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];
    const OUT: [[f64; 3]; 3] =
        [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];
    let times = |m: &[[f64; 3]; 3], c: [f64; 3]| m.map(|row| row[0] * c[0] + row[1] * c[1] + row[2] * c[2]);
    for c in colours(1000) {
        let v = times(&IN, c.map(f64::from));
        let fit = v.map(|v| (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081));
        let expected = times(&OUT, fit).map(|v| v.clamp(0.0, 1.0) as f32);
        assert!(
            close(ToneMap::Aces.apply(c), expected, 2e-5),
            "{c:?}: {:?} {expected:?}",
            ToneMap::Aces.apply(c)
        );
    }
}

/// Entries of `AgX_Default_Contrast.spi1d` (4096 samples of [0, 1]), Sobotka, AgX, commit 1ba3230.
#[test]
fn agx_sigmoid_is_the_published_table() {
    let table = [
        (0, 0.0),
        (500, 0.0107926),
        (1000, 0.0370196),
        (1500, 0.1072621),
        (2000, 0.271826),
        (2482, 0.5000888),
        (3000, 0.7468467),
        (3500, 0.9180099),
        (4000, 0.9925869),
        (4095, 1.0),
    ];
    for (i, y) in table {
        let found = agx_sigmoid(i as f32 / 4095.0);
        assert!((found - y).abs() < 5e-7, "entry {i}: {found} {y}");
    }
}

#[test]
fn agx_shows_middle_grey_half_way_and_ends_at_its_stops() {
    let [middle, ..] = ToneMap::Agx.apply([0.18; 3]);
    assert!((middle - srgb_decode(0.5)).abs() < 1e-6, "{middle}");
    let ends = [0.18 * pow(2.0, -10.0), 0.18 * pow(2.0, 6.5)];
    assert!(ToneMap::Agx.apply([ends[0]; 3])[0] < 1e-6);
    assert!(ToneMap::Agx.apply([ends[1]; 3])[0] > 1.0 - 1e-6);
}

/// The matrix of Sobotka's configuration, from primaries of four digits; ours differs by less than that rounding.
#[test]
fn agx_inset_is_the_published_matrix() {
    const PUBLISHED: [[f32; 3]; 3] = [
        [0.842_479, 0.078_433_6, 0.079_223_7],
        [0.042_328_2, 0.878_468_6, 0.079_166_1],
        [0.042_375_7, 0.078_433_6, 0.879_143],
    ];
    for (i, row) in PUBLISHED.iter().enumerate() {
        for (k, published) in row.iter().enumerate() {
            let own = if i == k { 1.0 - AGX_INSET } else { 0.0 } + AGX_INSET * WHITE_SHARE[k];
            assert!((own - published).abs() < 1e-4, "({i}, {k}): {own} {published}");
        }
    }
}

/// Chromaticities of Rec. 709 and D65: the shares a solve P a = W, P = primaries with x + y + z = 1.
#[test]
fn white_shares_follow_from_the_primaries() {
    let white = [0.3127, 0.3290];
    let sum = |a: [f64; 3], f: fn([f64; 2]) -> f64| {
        a[0] * f([0.64, 0.33]) + a[1] * f([0.30, 0.60]) + a[2] * f([0.15, 0.06])
    };
    let a = WHITE_SHARE.map(f64::from);
    assert!((a.iter().sum::<f64>() - 1.0).abs() < 1e-7);
    assert!((sum(a, |p| p[0]) - white[0]).abs() < 1e-7);
    assert!((sum(a, |p| p[1]) - white[1]).abs() < 1e-7);
}

#[test]
fn agx_outset_undoes_the_inset() {
    for c in colours(1000) {
        let back = agx(c, |v| v);
        let largest = c[0].max(c[1]).max(c[2]);
        assert!(close(back, c, 1e-6 * largest), "{c:?} {back:?}");
    }
}

/// Worked out apart from this code: the published matrix, the published table, the sRGB curve, the inverse matrix.
#[test]
fn agx_has_the_values_of_the_published_matrix_and_table() {
    let known = [
        ([0.5, 0.1, 0.02], [0.437_685, 0.139_267, 0.034_373]),
        ([1.0, 0.0, 0.0], [0.637_084, 0.027_636, 0.027_687]),
        ([0.05, 0.04, 3.0], [0.245_507, 0.238_511, 0.872_032]),
        ([0.002, 0.005, 0.003], [0.002_159, 0.004_582, 0.002_963]),
        ([9.0, 7.0, 0.1], [0.986_426, 0.959_122, 0.534_909]),
    ];
    for (c, expected) in known {
        let found = ToneMap::Agx.apply(c);
        assert!(close(found, expected, 3e-4), "{c:?}: {found:?} {expected:?}");
    }
}

#[test]
fn maps_made_ready_for_pictures_agree() {
    for map in ToneMap::ALL {
        let prepared = map.prepared();
        let tolerance = if map == ToneMap::Agx { 2e-4 } else { 0.0 };
        let odd = [[0.0; 3], [f32::NAN; 3], [f32::INFINITY; 3], [-1.0, 1e-30, 1e30], [16.29; 3], [32.0; 3]];
        for c in colours(100_000).chain(greys().map(|v| [v; 3])).chain(odd) {
            assert!(close(prepared(c), map.apply(c), tolerance), "{map:?} of {c:?}: {:?}", prepared(c));
        }
    }
}

#[test]
fn agx_takes_bright_colours_to_white() {
    let dim = ToneMap::Agx.apply([0.5, 0.02, 0.02]);
    let bright = ToneMap::Agx.apply([5e3, 2e2, 2e2]);
    assert!(dim[0] > 4.0 * dim[1], "{dim:?}");
    assert!(close(bright, [1.0; 3], 1e-2), "{bright:?}");
}
