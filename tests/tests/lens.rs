//! Depth of field in pictures: the blur of a dot has the size, shape and evenness of the thin lens's.
use durer::{
    Options, Prepared, Show,
    compile::{Aperture, Focus, LensOptions},
};
use durer_tests::{import, render, scene};

/// Pixels of an edge of the picture.
const N: u32 = 64;
/// Of the dot, in pixels, were it in focus.
const DOT: f64 = 2.0;

/// A white dot at depth `z` through a lens of radius 0.2 m focused at 4 m, seen 0.1 to each side at depth 1; a dot of the
/// same size in the picture whatever its depth.
fn dot(z: f64, lens: &str) -> Prepared {
    let radius = DOT / 32.0 * 0.1 * z;
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" {N} \"integer yresolution\" {N}\n\
         Sampler \"stratified\" \"integer xsamples\" 12 \"integer ysamples\" 12 PixelFilter \"box\"\n\
         Camera \"perspective\" \"float fov\" {fov} \"float lensradius\" 0.2 \"float focaldistance\" 4 {lens}\n\
         WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [1 1 1]\n\
         Shape \"disk\" \"float height\" {z} \"float radius\" {radius}\n",
        fov = 2.0 * 0.1f64.atan().to_degrees(),
    );
    let cast = Options { integrator: Some("cast".into()), show: Some(Show::Albedo), ..Options::default() };
    scene(&text, &cast)
}

/// Every pixel's middle about the picture's middle (y up), and its value.
fn pixels(prepared: &Prepared) -> Vec<([f64; 2], f64)> {
    let middle = |i: usize| i as f64 + 0.5 - f64::from(N) / 2.0;
    let all = render(prepared).film.pixels();
    let place = |i: usize| [middle(i % N as usize), -middle(i / N as usize)];
    all.iter().enumerate().map(|(i, p)| (place(i), f64::from(p.mean()[0]))).collect()
}

#[test]
fn a_dot_is_blurred_to_an_even_disc_f4() {
    for z in [2.0, 3.0, 16.0] {
        // A |z - z_f| / z on the plane in focus, at depth 4 where a pixel is 0.1 4 / 32.
        let radius = 0.4 * f64::abs(z - 4.0) / z / 2.0 / (0.1 * 4.0 / 32.0);
        let pixels = pixels(&dot(z, ""));
        let sum: f64 = pixels.iter().map(|p| p.1).sum();
        // As much light as the dot itself would give.
        let area = std::f64::consts::PI * DOT * DOT;
        assert!((sum / area - 1.0).abs() < 0.03, "{z}: {sum}, expected {area}");
        let square: f64 = pixels.iter().map(|([x, y], v)| v * (x * x + y * y)).sum::<f64>() / sum;
        // RMS radius r / sqrt 2, with the dot's own and that of the pixels.
        let expected = radius * radius / 2.0 + DOT * DOT / 2.0 + 1.0 / 6.0;
        assert!((square / expected - 1.0).abs() < 0.03, "{z}: {square}, expected {expected}");
        // Even: the inner half of the area holds half the light but for the dot's width.
        let half = radius / 2f64.sqrt();
        let inner: f64 = pixels.iter().filter(|([x, y], _)| x.hypot(*y) < half).map(|p| p.1).sum();
        assert!((inner / sum - 0.5).abs() < 0.035, "{z}: {}", inner / sum);
        // Dark outside.
        let outside = pixels.iter().filter(|([x, y], _)| x.hypot(*y) > radius + DOT + 0.8);
        assert!(outside.clone().count() > 0 && outside.clone().all(|p| p.1 == 0.0), "{z}");
    }
}

#[test]
fn in_focus_the_dot_is_itself() {
    let pixels = pixels(&dot(4.0, ""));
    let sum: f64 = pixels.iter().map(|p| p.1).sum();
    let inner = pixels.iter().filter(|([x, y], _)| x.hypot(*y) < DOT - 0.8).all(|p| p.1 == 1.0);
    assert!(inner && (sum / (std::f64::consts::PI * DOT * DOT) - 1.0).abs() < 0.02, "{sum}");
}

#[test]
fn blur_discs_have_the_area_and_the_corners_of_the_blades_f4() {
    let radius: f64 = 16.0;
    for blades in [3, 5, 6] {
        let turn = std::f64::consts::TAU / f64::from(blades);
        let area = f64::from(blades) / 2.0 * radius * radius * turn.sin();
        let pixels = pixels(&dot(2.0, &format!("\"integer blades\" {blades}")));
        // Well inside everything has the same brightness: dot by disc.
        let inscribed = radius * (turn / 2.0).cos() - DOT - 1.0;
        let inner: Vec<f64> =
            pixels.iter().filter(|([x, y], _)| x.hypot(*y) < inscribed).map(|p| p.1).collect();
        let plateau = inner.iter().sum::<f64>() / inner.len() as f64;
        let found = std::f64::consts::PI * DOT * DOT / plateau;
        assert!((found / area - 1.0).abs() < 0.04, "{blades}: area {found}, expected {area}");
        // In front of the plane in focus the aperture is seen upside down: a corner at the bottom, none opposite if the
        // number is odd.
        let light = |sign: f64| -> f64 {
            pixels.iter().filter(|([x, y], _)| x.abs() < 3.0 && sign * y > radius * 0.85).map(|p| p.1).sum()
        };
        let (top, bottom) = (light(1.0), light(-1.0));
        assert!(bottom > 0.05, "{blades}: {top} {bottom}");
        assert!(
            if blades % 2 == 1 { top < 0.3 * bottom } else { top > 0.5 * bottom },
            "{blades}: {top} {bottom}"
        );
    }
}

const TWO: &str = "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 20\n\
    LookAt 1 2 3  1 2 4  0 1 0\n\
    Camera \"perspective\" \"float fov\" 60 \"float lensradius\" 0.1\nWorldBegin\n\
    Shape \"polygon\" \"point3 P\" [-9 -9 8  1 -9 8  1 9 8  -9 9 8]\n\
    Shape \"polygon\" \"point3 P\" [1 -9 13  9 -9 13  9 2 13  1 2 13]\n";

#[test]
fn focus_on_a_pixel_is_the_depth_of_what_is_seen_there() {
    let focused = |pixel: [f32; 2]| {
        let lens = LensOptions { focus: Some(Focus::Pixel(pixel)), ..LensOptions::default() };
        let mut imported = import(TWO);
        let prepared = durer::prepare(&mut imported, &Options { lens, ..Options::default() });
        let said: String = imported.diagnostics.iter().map(|d| d.message.clone()).collect();
        prepared.map(|p| p.scene.view.camera.lens().focus()).ok_or(said)
    };
    // At depth, not at distance: the left wall is 5 m ahead wherever it is looked at.
    for (pixel, depth) in [([18.5, 9.0], 5.0), ([1.0, 2.5], 5.0), ([30.0, 15.0], 10.0)] {
        let found = focused(pixel).expect("something is there");
        assert!((found - depth).abs() < 1e-5, "{pixel:?}: {found}");
    }
    for nothing in [[30.0, 2.0], [1e4, 1e4]] {
        let said = focused(nothing).expect_err("nothing is there");
        assert!(said.contains("nothing is seen"), "{said}");
    }
    let in_file = TWO.replace("0.1\nWorld", "0.1 \"point2 focuspixel\" [30 15]\nWorld");
    for scale in [None, Some(0.5), Some(3.0)] {
        let prepared = scene(&in_file, &Options { scale, ..Options::default() });
        assert!((prepared.scene.view.camera.lens().focus() - 10.0).abs() < 1e-5, "{scale:?}");
    }
}

#[test]
fn options_replace_the_cameras_lens() {
    let with = |camera: &str, lens: LensOptions| {
        let text = format!("Camera \"perspective\" {camera}\nWorldBegin\nShape \"sphere\"\n");
        let lens = scene(&text, &Options { lens, ..Options::default() }).scene.view.camera.lens().clone();
        (lens.radius(), lens.focus())
    };
    let file = "\"float fnumber\" 2 \"float focallength\" 50 \"float focaldistance\" 3";
    assert_eq!(with(file, LensOptions::default()), (0.0125, 3.0));
    let options = |aperture, focus| LensOptions { aperture, focus };
    assert_eq!(with(file, options(Some(Aperture::Radius(0.2)), None)), (0.2, 3.0));
    assert_eq!(with(file, options(Some(Aperture::FNumber(5.0)), Some(Focus::Distance(7.0)))), (0.005, 7.0));
    assert_eq!(with("\"float lensradius\" 1", options(Some(Aperture::Radius(0.0)), None)), (0.0, 1e6));
    let file = "\"float lensradius\" 1 \"point2 focuspixel\" [640 360]";
    assert_eq!(with(file, options(None, Some(Focus::Distance(2.0)))), (1.0, 2.0));
}
