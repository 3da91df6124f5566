//! What the film makes of light: its largest value and its white, in pictures, ray trees and sentences.
use durer::{Options, Prepared, explain::explain_one, spectrum::Carried, tree::Subject};
use durer_tests::{render, scene};

/// A wall that glows with this light, on a film of these words.
fn wall(film: &str, light: &str, integrator: &str) -> Prepared {
    let text = format!(
        "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\"\n\
         Film \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2 {film}\nIntegrator \"{integrator}\"\n\
         Sampler \"sobol\" \"integer pixelsamples\" 4\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n\
         AreaLightSource \"diffuse\" {light}\n\
         Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 0  2 -2 0  -2 2 0  2 2 0 ]"
    );
    scene(&text, &Options::default())
}
fn mean(prepared: &Prepared) -> [f32; 3] {
    render(prepared).film.pixels()[0].mean()
}

#[test]
fn samples_are_scaled_down_to_the_largest_x_y_or_z() {
    let film = "\"float iso\" 200 \"float maxcomponentvalue\" 3";
    // White of 4 has Z = 1.089 times 4.
    let [r, g, b] = mean(&wall(film, "\"rgb L\" [ 2 2 2 ]", "path"));
    assert!((g * 1.089 - 3.0).abs() < 3e-3 && (r - g).abs() < 1e-6 && (b - g).abs() < 1e-6, "{r} {g} {b}");
    assert_eq!(mean(&wall(film, "\"rgb L\" [ 1 1 1 ]", "path")), [2.0; 3]);
    let [r, g, _] = mean(&wall(film, "\"rgb L\" [ 20 2 0 ]", "path"));
    assert!((r / g - 10.0).abs() < 1e-4 && (0.4124 * r + 0.3576 * g - 3.0).abs() < 3e-3, "{r} {g}");
}

#[test]
fn light_of_the_films_white_is_white() {
    // Black bodies below 4000 K, where daylight has none of its own; pbrt's daylight is a thousandth hotter than it is called.
    let film = "\"float whitebalance\" 3000";
    let rgb = mean(&wall(film, "\"blackbody L\" 3001.7", "path"));
    assert!(rgb.iter().all(|v| (v - 1.0).abs() < 2e-3), "{rgb:?}");
    let [r, _, b] = mean(&wall(film, "\"rgb L\" [ 1 1 1 ]", "path"));
    assert!(b > 1.3 && r < 0.8, "daylight is blue beside it: {r} {b}");
    // About the daylight of Rec. 709.
    let [r, g, b] = mean(&wall("\"float whitebalance\" 6500", "\"rgb L\" [ 1 1 1 ]", "path"));
    assert!([r, g, b].iter().all(|v| (v - 1.0).abs() < 2e-3), "{r} {g} {b}");
}

#[test]
fn a_trees_rays_fold_to_what_the_film_holds() {
    let film = "\"float iso\" 250 \"float maxcomponentvalue\" 3 \"float whitebalance\" 4200";
    for carried in [Carried::Rgb, Carried::Wavelengths] {
        let mut prepared = wall(film, "\"rgb L\" [ 5 3 1 ]", "path");
        prepared.settings.carried = carried;
        let subject = Subject { name: "wall", prepared: &prepared };
        let samples = subject.samples([0, 0]);
        for sample in 0..4 {
            let tree = subject.tree([0, 0], &samples, sample, Default::default());
            let rgb = tree.rgb.map(|v| v.0.to_bits());
            assert_eq!(tree.fold().map(f32::to_bits), rgb, "sample {sample}");
            assert_eq!(prepared.job().value([0, 0], sample).map(f32::to_bits), rgb, "sample {sample}");
            assert!(
                tree.clamp.is_some_and(|clamp| clamp.0 < 1.0)
                    && tree.balance.is_some()
                    && tree.gain.is_some()
            );
        }
    }
    let plain = wall("", "\"rgb L\" [ 5 3 1 ]", "path");
    let subject = Subject { name: "wall", prepared: &plain };
    let tree = subject.tree([0, 0], &subject.samples([0, 0]), 0, Default::default());
    assert!(tree.clamp.is_none() && tree.balance.is_none() && tree.gain.is_none());
}

#[test]
fn what_the_film_does_is_told_step_by_step() {
    let prepared = wall("\"float iso\" 200 \"float maxcomponentvalue\" 3", "\"rgb L\" [ 2 2 2 ]", "path");
    let subject = Subject { name: "wall", prepared: &prepared };
    let told = explain_one(&subject, [0, 0], 0);
    let text: Vec<String> = told.paragraphs.iter().flat_map(|p| p.sentences.clone()).collect();
    let text = text.join(" ");
    assert!(text.contains("arrives 2; times 2 by lens and speed of the film and times 0.689"), "{text}");
    assert!(told.findings.is_empty(), "{text}");
}

#[test]
fn what_is_carried_to_other_pixels_is_held_alike() {
    // Particles from the lamp bring all the light of this picture.
    let text = "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n\
                Film \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2 FILM\nIntegrator \"lightpath\"\n\
                Sampler \"independent\" \"integer pixelsamples\" 64\nWorldBegin\n\
                LightSource \"point\" \"point3 from\" [ 0 0 3 ] \"rgb I\" [ 9 9 9 ]\n\
                Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 0  2 -2 0  -2 2 0  2 2 0 ]";
    let of = |film: &str| mean(&scene(&text.replace("FILM", film), &Options::default()))[1];
    let (all, held) = (of(""), of("\"float maxcomponentvalue\" 0.01"));
    assert!(all > 0.1 && held < 0.05 && held > 0.0, "{all} {held}");
}
