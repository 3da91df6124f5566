//! The built-in scenes of lens and shutter show what they are for.
use durer::{
    Options, Prepared, builtin,
    compile::{Aperture, LensOptions},
    math::Interval,
};
use durer_tests::{prepared, render};

fn taken(name: &str, options: &Options) -> (Prepared, Vec<[f32; 3]>) {
    let prepared = prepared(builtin::find(name).expect("built in").import(), options);
    let pixels = render(&prepared).film.pixels().iter().map(|p| p.mean()).collect();
    (prepared, pixels)
}

fn mean(pixels: &[[f32; 3]]) -> f32 {
    pixels.iter().map(|p| p.iter().sum::<f32>() / 3.0).sum::<f32>() / pixels.len() as f32
}

#[test]
fn bokeh_has_the_pawn_in_focus_and_lights_as_discs() {
    let options = Options { width: Some(128), samples: Some(36), ..Options::default() };
    let pinhole = LensOptions { aperture: Some(Aperture::Radius(0.0)), ..LensOptions::default() };
    let (scene, blurred) = taken("bokeh", &options);
    let (_, sharp) = taken("bokeh", &Options { lens: pinhole, ..options });
    let lens = scene.scene.view.camera.lens();
    assert!((lens.focus() - 0.29).abs() < 0.02 && lens.radius() > 0.01, "{lens:?}");
    let at = |[x, y]: [usize; 2]| y * 128 + x;
    // The pawn, head and foot, is the same in both.
    for pixel in [[54, 31], [52, 44], [53, 57]] {
        let (a, b) = (blurred[at(pixel)], sharp[at(pixel)]);
        assert!((0..3).all(|i| (a[i] - b[i]).abs() < 0.1 * b[i].max(0.2)), "{pixel:?}: {a:?} {b:?}");
    }
    // Above the table lie lights: as discs they cover several times as many pixels, each darker, and as much light.
    let (blurred, sharp) = (&blurred[..128 * 26], &sharp[..128 * 26]);
    let lit = |pixels: &[[f32; 3]]| pixels.iter().filter(|p| p[0].max(p[2]) > 0.3).count();
    assert!(lit(blurred) > 3 * lit(sharp), "{} {}", lit(blurred), lit(sharp));
    let highest = |pixels: &[[f32; 3]]| pixels.iter().fold(0.0, |m: f32, p| m.max(p[0]).max(p[1]).max(p[2]));
    assert!(highest(blurred) < 0.7 * highest(sharp));
    assert!((mean(blurred) / mean(sharp) - 1.0).abs() < 0.15, "{} {}", mean(blurred), mean(sharp));
}

#[test]
fn shutter_has_one_thing_at_rest_and_streaks_with_sharp_ends() {
    let options = Options { width: Some(160), samples: Some(36), ..Options::default() };
    let still = |time: f32| Options { time, shutter: Some(Interval::point(0.0)), ..options.clone() };
    let (_, moving) = taken("shutter", &options);
    let (_, end) = taken("shutter", &still(1.0));
    let (_, half) = taken("shutter", &still(0.5));
    let at = |[x, y]: [usize; 2]| y * 160 + x;
    let apart = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
    // The mirror ball's lower half, which shows the floor, is the same at all times.
    for pixel in [[83, 67], [80, 70], [88, 69]] {
        assert!(apart(moving[at(pixel)], end[at(pixel)]) < 0.05, "{pixel:?}");
    }
    // Along the path of the blue ball: at its end mostly what is there at the end, in the middle a faint streak.
    let [last, middle] = [[121, 27], [110, 29]].map(at);
    let share = |p: usize, of: &[[f32; 3]], without: &[[f32; 3]]| {
        (moving[p][0] - without[p][0]) / (of[p][0] - without[p][0])
    };
    let (at_end, at_half) = (share(last, &end, &half), share(middle, &half, &end));
    assert!((0.3..0.8).contains(&at_end), "{at_end}");
    assert!((0.05..0.5).contains(&at_half), "{at_half}");
}
