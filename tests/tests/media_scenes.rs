//! What the built-in scenes about transparent and mirroring things show, measured in their pictures.
#![allow(clippy::expect_used, reason = "a scene that lacks what a test looks for is a failed test")]
use durer::{Options, builtin};
use durer_tests::{render, scene};

fn text(name: &str) -> &'static str {
    builtin::find(name).expect("built in").text
}

#[test]
fn snells_window_measures_97_degrees_in_the_picture_i3() {
    // With a black floor nothing is seen outside the window, where the floor is mirrored.
    let black = text("snell")
        .replace("[0.10 0.42 0.50]", "[0 0 0]")
        .replace("[0.72 0.86 0.84]", "[0 0 0]")
        .replace("\"float fov\" 120", "\"float fov\" 120 \"string fovaxis\" \"x\"");
    let size = 6001;
    let options = Options { width: Some(size), height: Some(1), samples: Some(1), ..Options::default() };
    let pixels = render(&scene(&black, &options)).film.pixels();
    let lit: Vec<u32> = (0..size).filter(|&x| pixels[x as usize].mean()[1] > 0.0).collect();
    let angle = |x: f64| (60f64.to_radians().tan() * (x / f64::from(size) * 2.0 - 1.0)).atan().to_degrees();
    let (first, last) = (lit[0], lit[lit.len() - 1]);
    let cone = angle(f64::from(last) + 1.0) - angle(f64::from(first));
    assert!((cone - 97.181).abs() < 0.05, "{cone}");
    // The radius of the window at a depth of 1.
    let radius =
        0.5 * (angle(f64::from(last) + 1.0).to_radians().tan() - angle(f64::from(first)).to_radians().tan());
    assert!((radius - 1.133_893).abs() < 1e-3, "{radius}");
}

#[test]
fn the_beaker_looks_the_same_however_far_the_water_reaches_into_its_wall_i18() {
    let options = Options { width: Some(54), height: Some(66), samples: Some(1), ..Options::default() };
    let here = render(&scene(text("beaker"), &options));
    let thinner = text("beaker")
        .replace("\"float radius\" 0.965", "\"float radius\" 0.945")
        .replace("0.917183", "0.896090")
        .replace("0.664248", "0.634843");
    assert_ne!(thinner, text("beaker"));
    let there = render(&scene(&thinner, &options));
    let (here_pixels, there_pixels) = (here.film.pixels(), there.film.pixels());
    let is_other = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-3);
    let differ = here_pixels.iter().zip(&there_pixels).filter(|(a, b)| is_other(a.mean(), b.mean()));
    let differ = differ.count();
    assert!(differ <= 54 * 66 / 100, "{differ} of {} pixels", 54 * 66);
    let wrong: u64 = here.imbalances.objects.values().sum();
    assert!(wrong * 100_000 <= here.rays, "{:?}", here.imbalances);
}

#[test]
fn the_mirrors_show_a_ball_and_five_images_i15() {
    let (w, h) = (275usize, 225usize);
    let options =
        Options { width: Some(w as u32), height: Some(h as u32), samples: Some(1), ..Options::default() };
    let film = render(&scene(text("mirrors"), &options)).film;
    let mut red: Vec<bool> = film.pixels().iter().map(|p| p.mean()).map(|[r, g, _]| r > 2.5 * g).collect();
    let mut balls = 0;
    for start in 0..w * h {
        let mut open = vec![start];
        let mut size = 0;
        while let Some(at) = open.pop() {
            if !std::mem::take(&mut red[at]) {
                continue;
            }
            size += 1;
            let neighbours = [at.checked_sub(w), Some(at + w), at.checked_sub(1), Some(at + 1)];
            open.extend(neighbours.into_iter().flatten().filter(|&n| n < w * h));
        }
        balls += u32::from(size > 60);
    }
    assert_eq!(balls, 6);
}

#[test]
fn glass_plates_dim_the_sky_as_all_orders_of_reflection_say_i10() {
    let prepared = scene(text("glass-plate"), &Options { samples: Some(1), ..Options::default() });
    for (plates, x) in [(0u32, 120), (1, 352), (2, 600), (3, 830)] {
        let (_, rgb) = prepared.job().record([x, 289], 0);
        let r = 0.04;
        let expected =
            if plates == 0 { 1.0 } else { (1.0 - r) / (1.0 + (2.0 * f64::from(plates) - 1.0) * r) };
        let passed = f64::from(rgb[0]) / 0.85;
        assert!((passed - expected).abs() < 0.006, "{plates} plates: {passed} {expected}");
    }
}
