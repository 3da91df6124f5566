//! Light by its wavelength: pbrt-v4's film `spectral`.
use durer::{
    Options, Prepared,
    spectrum::{Carried, Spectrum, luminance},
};
use durer_tests::{exr, render, scene, small::BOX};

/// A light whose curve has corners at the ends of buckets of 10 nm, and what it is between them.
const CORNERS: [(f32, f32); 4] = [(360.0, 1.0), (500.0, 2.0), (600.0, 0.5), (830.0, 3.0)];

fn curve(nm: f32) -> f32 {
    let after = CORNERS.iter().position(|c| nm <= c.0).unwrap_or(3).max(1);
    let ((a, low), (b, high)) = (CORNERS[after - 1], CORNERS[after]);
    low + (high - low) * (nm - a) / (b - a)
}

/// What pixels of light that is `f` of the wavelength are, red, green and blue.
fn rgb(f: impl Fn(f32) -> f32) -> [f32; 3] {
    const STEPS: u32 = 4000;
    let mut sum = [0.0; 3];
    for i in 0..STEPS {
        let basis = Carried::Wavelengths.basis(|| (i as f32 + 0.5) / STEPS as f32);
        let lanes = basis.wavelengths().expect("wavelengths").map(Spectrum::ONE, |nm, _| f(nm));
        sum.iter_mut().zip(basis.to_rgb(lanes)).for_each(|(sum, v)| *sum += v / STEPS as f32);
    }
    sum
}

/// A white wall that a white-walled room's lamp lights, or that glows itself, of one pixel.
fn wall(film: &str, integrator: &str, samples: u32, lamp: &str) -> Prepared {
    let text = format!(
        "Film \"spectral\" \"integer xresolution\" 2 \"integer yresolution\" 2 {film}\n{BOX}\n\
         Integrator \"{integrator}\"\nLookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\n\
         {lamp}\nMaterial \"diffuse\" \"spectrum reflectance\" [ 360 0.5 830 0.5 ]\n\
         Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 0  2 -2 0  -2 2 0  2 2 0 ]"
    );
    scene(&text, &Options { layers: true, samples: Some(samples), ..Options::default() })
}

fn glow(values: &str) -> String {
    format!("AreaLightSource \"diffuse\" \"bool twosided\" true \"spectrum L\" [ {values} ]")
}
fn corners() -> String {
    CORNERS.map(|(nm, v)| format!("{nm} {v} ")).concat()
}

/// The buckets of the first pixel.
fn buckets(prepared: &Prepared) -> Vec<f32> {
    render(prepared).film.layers().iter().map(|layer| layer.values[0]).collect()
}

#[test]
fn light_that_is_the_same_everywhere_is_so_in_every_bucket_without_noise() {
    let seen = buckets(&wall("", "path", 64, &glow("360 3 830 3")));
    assert_eq!(seen.len(), 16);
    // As far as the light is scaled exactly.
    assert!(seen.iter().all(|v| (v - 1.0).abs() < 1e-4 && (v - seen[0]).abs() < 1e-6), "{seen:?}");
}

#[test]
fn a_lights_curve_comes_back_bucket_by_bucket() {
    let film = "\"integer nbuckets\" 47 \"float lambdamin\" 360 \"float lambdamax\" 830 \"float iso\" 200";
    let bright = luminance(rgb(curve).map(f64::from)) as f32;
    let lamp = format!(
        "LightSource \"point\" \"point3 from\" [ 0 0 -3 ] \"spectrum I\" [ {} ] \"float scale\" 5",
        corners()
    );
    let glowing = buckets(&wall(film, "path", 1024, &glow(&corners())));
    let lit = buckets(&wall(film, "path", 1024, &lamp));
    let share = lit.iter().sum::<f32>() / glowing.iter().sum::<f32>();
    for (i, (glowing, lit)) in glowing.iter().zip(lit).enumerate() {
        let expected = 2.0 * curve(365.0 + 10.0 * i as f32) / bright;
        assert!((glowing / expected - 1.0).abs() < 0.01, "{i}: {glowing} {expected}");
        assert!((lit / (share * expected) - 1.0).abs() < 0.03, "{i}: {lit} {expected}");
    }
    let narrow = buckets(&wall(
        "\"integer nbuckets\" 4 \"float lambdamin\" 560 \"float lambdamax\" 600",
        "path",
        4096,
        &glow(&corners()),
    ));
    for (i, found) in narrow.iter().enumerate() {
        let expected = curve(565.0 + 10.0 * i as f32) / bright;
        assert!((found / expected - 1.0).abs() < 0.01, "{i}: {found} {expected}");
    }
}

#[test]
fn buckets_add_up_to_the_colours() {
    let prepared = wall("\"integer nbuckets\" 94", "path", 2048, &glow(&corners()));
    let rendered = render(&prepared);
    let found = buckets(&prepared);
    let by_buckets = rgb(|nm| found[(((nm - 360.0) / 5.0) as usize).min(93)]);
    let mean = rendered.film.pixels()[0].mean();
    assert!(mean.iter().zip(by_buckets).all(|(a, b)| (a / b - 1.0).abs() < 0.01), "{mean:?} {by_buckets:?}");
}

#[test]
fn particles_from_lights_reach_the_same_buckets() {
    let lamp = format!(
        "LightSource \"point\" \"point3 from\" [ 0 0 -3 ] \"spectrum I\" [ {} ] \"float scale\" 5",
        corners()
    );
    let film = "\"integer nbuckets\" 8 \"float maxcomponentvalue\" 1000";
    let mean = |integrator: &str, samples: u32| -> Vec<f32> {
        let layers = render(&wall(film, integrator, samples, &lamp)).film.layers();
        layers.iter().map(|layer| layer.values.iter().sum::<f32>() / 4.0).collect()
    };
    let expected = mean("path", 1024);
    for integrator in ["light", "bdpt"] {
        let found = mean(integrator, 40_000);
        assert!(
            found.iter().zip(&expected).all(|(a, b)| (a / b - 1.0).abs() < 0.04),
            "{integrator}: {found:?} {expected:?}"
        );
    }
}

#[test]
fn threads_change_no_bucket() {
    let mut prepared = wall("", "bdpt", 70, &glow(&corners()));
    // Of four tiles.
    (prepared.scene.view.width, prepared.scene.view.height) = (40, 40);
    let one = render(&prepared).film.layers();
    prepared.settings.threads = 3;
    assert_eq!(render(&prepared).film.layers(), one);
}

#[test]
fn a_file_follows_the_layout_for_spectral_pictures() {
    let prepared = wall("\"integer nbuckets\" 2", "path", 4, &glow(&corners()));
    let rendered = render(&prepared);
    let (bytes, read) = exr(&prepared, &rendered);
    let names: Vec<&str> = read.iter().map(|channel| channel.name.as_str()).collect();
    assert_eq!(names, ["B", "G", "R", "S0.477,500nm", "S0.712,500nm"]);
    let holds = |text: &[u8]| bytes.windows(text.len()).any(|window| window == text);
    assert!(holds(b"spectralLayoutVersion") && holds(b"emissiveUnits") && holds(b"W.m^-2.sr^-1"));
}
