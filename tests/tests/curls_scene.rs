//! The scene `curls`: what a lamp behind hair shows of it. Light that hairs mirror has the lamp's colour; light that they
//! pass has the colour that their pigment leaves.
use durer::{Options, builtin};
use durer_tests::{render, scene};

/// Red, green and blue of the three curls, from the left, where only the lamp shines, behind them, with these changes.
fn by_lamp(changes: &[(&str, &str)]) -> [[f64; 3]; 3] {
    let mut text = builtin::find("curls").expect("a scene").text.to_owned();
    let dark = [
        ("[0.1 0.15 0.17]", "[0 0 0]"),
        ("[0.1 0.12 0.16]", "[0 0 0]"),
        ("[0.16 0.15 0.14]", "[0 0 0]"),
        ("[0.03 0.03 0.03]", "[0 0 0]"),
        ("[15 15.6 16.5]", "[0 0 0]"),
    ];
    for (from, to) in dark.iter().chain(changes) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let (width, samples) = (64u32, 32);
    let options = Options { width: Some(width), samples: Some(samples), ..Options::default() };
    let film = render(&scene(&text, &options)).film;
    let mut sums = [[0.0; 3]; 3];
    for (i, pixel) in film.pixels().iter().enumerate() {
        // Between the curls the picture is black.
        let curl = match i as u32 % width {
            0..22 => 0,
            22..41 => 1,
            _ => 2,
        };
        sums[curl].iter_mut().zip(pixel.mean()).for_each(|(sum, v)| *sum += f64::from(v));
    }
    sums
}

#[test]
fn hair_mirrors_the_colour_of_a_lamp_and_passes_that_of_its_pigment() {
    let black = "\"rgb sigma_a\" [1000 1000 1000]";
    let mirrored = by_lamp(&[
        ("\"float eumelanin\" 0.12 \"float pheomelanin\" 0.1", black),
        ("\"float eumelanin\" 0.08 \"float pheomelanin\" 0.75", black),
        ("\"float eumelanin\" 1.1", black),
    ]);
    let seen = by_lamp(&[]);
    for [r, g, b] in mirrored {
        assert!((r / g / (44.0 / 36.0) - 1.0).abs() < 0.01, "{mirrored:?}");
        assert!((r / b / (44.0 / 27.0) - 1.0).abs() < 0.01, "{mirrored:?}");
    }
    let passed: Vec<[f64; 3]> =
        (0..3).map(|curl| [0, 1, 2].map(|c| seen[curl][c] - mirrored[curl][c])).collect();
    let light = |curl: usize| passed[curl].iter().sum::<f64>();
    // Pigment keeps blue first, and the more the more there is of it.
    for [r, g, b] in passed.iter().copied() {
        assert!(r > g * 44.0 / 36.0 && g > b * 36.0 / 27.0 && b > 0.0, "{passed:?}");
    }
    let warmth = |curl: usize| passed[curl][0] / passed[curl][2] / (44.0 / 27.0);
    assert!(warmth(0) < warmth(1) && warmth(1) > 2.0, "{passed:?}");
    assert!(light(0) > light(1) && light(1) > light(2), "{passed:?}");
    // Blond hair before a lamp shines by what it passes.
    assert!(light(0) > 2.0 * mirrored[0].iter().sum::<f64>(), "{passed:?} {mirrored:?}");
}
