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

/// What passes a stack of plates, and what it reflects, after all orders of reflection: plate after plate is put before it.
fn stack(plates: &[f64]) -> (f64, f64) {
    let r = 0.04f64;
    plates.iter().fold((1.0, 0.0), |(passed, reflected), inside| {
        let all = 1.0 - (r * inside).powi(2);
        let (t, back) = ((1.0 - r).powi(2) * inside / all, r + r * (1.0 - r).powi(2) * inside * inside / all);
        let between = 1.0 - back * reflected;
        (t * passed / between, back + t * t * reflected / between)
    })
}

#[test]
fn glass_plates_dim_the_sky_as_all_orders_of_reflection_say_i10() {
    // One plate: 0.9230769 passes, 0.0769231 is reflected; and the closed form for several.
    assert!((stack(&[1.0]).0 - 0.923_076_9).abs() < 1e-7 && (stack(&[1.0]).1 - 0.076_923_1).abs() < 1e-7);
    for k in 0..4 {
        let closed = if k == 0 { 1.0 } else { 0.96 / (1.0 + f64::from(2 * k - 1) * 0.04) };
        assert!((stack(&vec![1.0; k as usize]).0 - closed).abs() < 1e-12);
    }
    let prepared = scene(text("glass-plate"), &Options { samples: Some(1), ..Options::default() });
    // Cyan, magenta and yellow absorb one colour each, 12 cm long.
    let absorbed = [11.0, 10.0, 14.0].map(|sigma: f64| (-0.12 * sigma).exp());
    let places = [
        ([90, 100], [false, false, false]),
        ([260, 400], [true, false, false]),
        ([700, 400], [false, true, false]),
        ([480, 160], [false, false, true]),
        ([480, 420], [true, true, false]),
        ([380, 300], [true, false, true]),
        ([590, 300], [false, true, true]),
        ([480, 310], [true, true, true]),
    ];
    for (pixel, plates) in places {
        let (_, rgb) = prepared.job().record(pixel, 0);
        for (channel, value) in rgb.into_iter().enumerate() {
            let inside = (0..3).filter(|&p| plates[p]).map(|p| if p == channel { absorbed[p] } else { 1.0 });
            let expected = stack(&inside.collect::<Vec<_>>()).0;
            let passed = f64::from(value) / 0.85;
            assert!((passed - expected).abs() < 0.004, "{pixel:?}, {plates:?}: {passed} {expected}");
        }
    }
}
