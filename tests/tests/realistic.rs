//! Pictures through a lens of glass, and the speed of the film.
use std::path::PathBuf;

use durer::{
    Imported, Options, Prepared,
    compile::{Aperture, Focus, LensOptions},
    import::pbrt,
    prepare,
    spectrum::Basis,
};
use durer_tests::{bits, render, scene};

fn import(text: &str) -> Imported {
    let lenses = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../crates/model/tests/lenses");
    let mut imported = Imported::new(lenses, Default::default());
    pbrt::read_text("test.pbrt", text, &mut imported);
    imported
}

fn glass(camera: &str, film: &str, world: &str) -> Result<Prepared, String> {
    let mut imported = import(&format!(
        "Camera \"realistic\" \"string lensfile\" \"double-gauss.dat\" {camera}\n\
         Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16 \"float diagonal\" 43.27 {film}\n\
         Sampler \"sobol\" \"integer pixelsamples\" 64\nPixelFilter \"box\"\nIntegrator \"path\"\nWorldBegin\n{world}"
    ));
    let prepared = prepare(&mut imported, &Options::default());
    let said: Vec<String> = imported.diagnostics.iter().map(|d| d.message.clone()).collect();
    prepared.ok_or_else(|| said.join("; "))
}

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

#[test]
fn an_even_sky_is_as_bright_in_the_middle_and_darker_in_the_corners() {
    let of = |camera: &str, film: &str| {
        let prepared = glass(camera, film, SKY).expect("sound");
        let film = render(&prepared).film;
        let at = |x: u32, y: u32| f64::from(film.pixel(x, y).expect("a pixel").mean()[1]);
        [at(12, 8), at(18, 8), at(18, 12), at(23, 15)]
    };
    let even = of("\"float fnumber\" 2 \"string exposure\" \"even\"", "");
    assert!((even[0] - 1.0).abs() < 0.02, "{even:?}");
    assert!(even.is_sorted_by(|a, b| a > b) && even[3] < 0.5, "{even:?}");
    // As pbrt-v4: pi / 4 N^2 times iso / 100.
    let film = of("\"float fnumber\" 4", "\"float iso\" 800");
    assert!((film[0] - std::f64::consts::PI / 64.0 * 8.0).abs() < 0.015, "{film:?}");
}

#[test]
fn the_film_multiplies_pictures_of_all_cameras() {
    let of = |iso: &str| {
        let text = format!(
            "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 9 \"integer yresolution\" 7 {iso}\n\
             Sampler \"sobol\" \"integer pixelsamples\" 4\nIntegrator \"path\"\nWorldBegin\n{SKY}\
             Translate 0 0 3 Shape \"sphere\""
        );
        render(&scene(&text, &Options::default())).film.pixels()
    };
    for (plain, fast) in of("").iter().zip(of("\"float iso\" 200")) {
        assert_eq!(plain.mean().map(|v| (2.0 * v).to_bits()), fast.mean().map(f32::to_bits));
    }
}

#[test]
fn what_was_recorded_and_what_the_lens_makes_of_it_are_the_sample() {
    let world = format!("{SKY}Translate 0 0 2 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.5");
    let prepared =
        glass("\"float fnumber\" 2 \"float focusdistance\" 2", "\"float iso\" 700", &world).expect("sound");
    let mut blocked = 0;
    for i in 0..200u32 {
        let (pixel, sample) = ([i % 24, (i * 7) % 16], i % 64);
        let (tree, rgb) = prepared.job().record(pixel, sample);
        let eye = tree.eye.expect("an eye");
        let folded = Basis::Rgb.to_rgb(tree.fold()).map(|v| v * eye.gain);
        assert_eq!(folded.map(f32::to_bits), rgb.map(f32::to_bits), "{pixel:?}");
        assert_eq!(prepared.job().value(pixel, sample).map(f32::to_bits), rgb.map(f32::to_bits));
        blocked += u32::from(eye.gain == 0.0);
    }
    assert!((1..100).contains(&blocked), "{blocked} of 200 met the barrel");
    let again =
        glass("\"float fnumber\" 2 \"float focusdistance\" 2", "\"float iso\" 700", &world).expect("sound");
    let threads = |threads: usize| {
        let mut prepared = again.job();
        prepared.settings.threads = threads;
        bits(&prepared.render(Default::default(), &(), &Default::default()))
    };
    assert_eq!(threads(1), threads(3));
}

#[test]
fn it_focuses_on_what_a_pixel_shows() {
    let card = |z: f32| format!("{SKY}Translate 0 0 {z} Shape \"disk\" \"float radius\" 9");
    let focused = |z: f32| {
        let prepared = glass("\"float fnumber\" 4 \"point2 focuspixel\" [12 8]", "", &card(z));
        prepared.map(|p| p.scene.view.camera.lens().focus())
    };
    for z in [0.4, 1.0, 25.0] {
        let found = focused(z).expect("in reach");
        assert!((found / z - 1.0).abs() < 1e-4, "{found} {z}");
    }
    let near = focused(0.15).expect_err("too near");
    assert!(near.contains("cannot focus nearer than"), "{near}");
    let option = |lens: LensOptions| {
        let mut imported = import(
            "Camera \"realistic\" \"string lensfile\" \"double-gauss.dat\" \"float aperturediameter\" 9\n\
             WorldBegin\nShape \"sphere\"",
        );
        let prepared = prepare(&mut imported, &Options { lens, ..Options::default() }).expect("sound");
        let lens = prepared.scene.view.camera.lens().clone();
        (lens.radius(), lens.focus())
    };
    let asked = LensOptions { aperture: Some(Aperture::FNumber(4.0)), focus: Some(Focus::Distance(3.0)) };
    let (radius, focus) = option(asked);
    assert!((radius * 8.0 - 0.05).abs() < 6e-4 && focus == 3.0, "{radius} {focus}");
    let asked = LensOptions { aperture: Some(Aperture::Radius(0.002)), focus: None };
    let (radius, focus) = option(asked);
    assert!((0.002..0.003).contains(&radius) && focus == 10.0, "a stop of 4 mm: {radius} {focus}");
}

#[test]
fn a_camera_without_its_lens_is_an_error_with_its_place() {
    let mut imported =
        import("Camera \"realistic\" \"string lensfile\" \"double-gaus.dat\"\nWorldBegin\nShape \"sphere\"");
    assert!(prepare(&mut imported, &Options::default()).is_none());
    let said: Vec<_> = imported.diagnostics.iter().map(|d| format!("{} | {:?}", d.message, d.hint)).collect();
    assert!(said.iter().any(|s| s.contains("double-gaus.dat: file not found")), "{said:?}");
}
