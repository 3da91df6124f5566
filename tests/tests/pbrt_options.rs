//! The options of pbrt-v4: what they leave out of a picture.
use durer::{Options, Prepared, spectrum::Carried};
use durer_tests::{bits, import, render, scene};

/// A picture of 8 x 8 pixels with these options.
fn picture(options: &str, world: &str) -> Prepared {
    spread(options, world, Options::default())
}
fn spread(options: &str, world: &str, wishes: Options) -> Prepared {
    let text = format!(
        "{options}\nLookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float lensradius\" 0.3\n\
         Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
         Integrator \"path\" \"integer maxdepth\" 1\nSampler \"sobol\" \"integer pixelsamples\" 16\nWorldBegin\n{world}"
    );
    scene(&text, &wishes)
}
fn reds(prepared: &Prepared) -> Vec<f32> {
    render(prepared).film.pixels().iter().map(|pixel| pixel.mean()[0]).collect()
}

/// A black square that hides one side of the sky, up to a third of a pixel beyond the middle: x grows to the left.
const EDGE: &str = "LightSource \"infinite\"\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n\
                    Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 1  0.083 -2 1  -2 2 1  0.083 2 1 ]";

#[test]
fn without_jitter_all_samples_go_through_the_middle() {
    let jittered = reds(&picture("", EDGE));
    let still = picture("Option \"bool disablePixelJitter\" true", EDGE);
    let pixels = reds(&still);
    assert!(jittered.iter().any(|v| *v > 0.0 && *v < 1.0), "an edge is smooth: {jittered:?}");
    for (i, v) in pixels.iter().enumerate() {
        let expected = if i % 8 < 4 { 1.0 } else { 0.0 };
        assert!((v - expected).abs() < 1e-5, "pixel {i}: {v}");
    }
    let job = still.job();
    for sample in 0..16 {
        let eye = job.record([3, 2], sample).0.eye.expect("an eye ray");
        assert_eq!((eye.film, eye.lens, eye.filter_weight), ([3.5, 2.5], None, 1.0));
    }
    assert_eq!(
        bits(&render(&picture("Option \"bool disablepixeljitter\" false", EDGE))),
        bits(&render(&picture("", EDGE)))
    );
}

#[test]
fn without_jitter_of_wavelengths_all_samples_carry_the_same() {
    let wishes = || Options { carried: Some(Carried::Wavelengths), ..Options::default() };
    let carried = |options: &str| {
        let prepared = spread(options, EDGE, wishes());
        let nm =
            |sample| prepared.job().record([6, 2], sample).0.basis.wavelengths().expect("wavelengths").nm();
        (0..16).map(nm).collect::<Vec<_>>()
    };
    let same = carried("Option \"bool disablewavelengthjitter\" true");
    assert!(same.windows(2).all(|w| w[0] == w[1]), "{same:?}");
    assert!(carried("").windows(2).all(|w| w[0] != w[1]));
    // Colours have none: said, not swallowed.
    let mut imported = import("Option \"bool disablewavelengthjitter\" true\nWorldBegin\nShape \"sphere\"");
    let _ = durer::prepare(&mut imported, &Options::default());
    assert!(imported.diagnostics.iter().any(|d| d.message.contains("rays carry red, green and blue")));
}

#[test]
fn without_filtering_textures_are_looked_at_in_points() {
    // Fields much smaller than a pixel: their mean, or one of both.
    let board = "LightSource \"infinite\"\nTexture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 800 \"float vscale\" 800\n\
                 \"rgb tex1\" [ 1 1 1 ] \"rgb tex2\" [ 0 0 0 ]\nMaterial \"diffuse\" \"texture reflectance\" \"c\"\n\
                 Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 0  2 -2 0  -2 2 0  2 2 0 ]";
    let still = "Option \"bool disablepixeljitter\" true\n";
    let averaged = reds(&picture(still, board));
    assert!(averaged.iter().all(|v| (v - 0.5).abs() < 0.1), "{averaged:?}");
    let points = reds(&picture(&format!("{still}Option \"bool disabletexturefiltering\" true"), board));
    assert!(points.iter().all(|v| *v < 1e-3 || *v > 0.99), "{points:?}");
}

/// The brightness of a square of a material under light from straight above, the mean over the pixels it fills.
fn lit(options: &str, material: &str) -> f64 {
    let world = format!(
        "LightSource \"distant\" \"point3 from\" [ 0 0 1 ] \"point3 to\" [ 0 0 0 ]\n{material}\n\
         Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 0  2 -2 0  -2 2 0  2 2 0 ]"
    );
    let wishes = Options { samples: Some(1024), ..Options::default() };
    let all = reds(&spread(options, &world, wishes));
    all.iter().map(|v| f64::from(*v)).sum::<f64>() / all.len() as f64
}

#[test]
fn everything_becomes_as_matte_as_it_is_bright() {
    use std::f64::consts::PI;
    let forced = "Option \"bool forcediffuse\" true";
    let near = |material: &str, reflected: f64| {
        let found = lit(forced, material) * PI;
        assert!((found / reflected - 1.0).abs() < 0.02, "{material}: {found}, expected {reflected}");
    };
    near("Material \"diffuse\" \"rgb reflectance\" [ 0.4 0.4 0.4 ]", 0.4);
    // A mirror shows nothing of a sun that stands elsewhere; forced it scatters what it mirrors.
    let mirror = "Material \"mirror\" \"rgb reflectance\" [ 0.6 0.6 0.6 ]";
    assert_eq!(lit("", mirror), 0.0);
    near(mirror, 0.6);
    // Glass, straight on: 4 % mirrored, and 96 % let through, as radiance by the square of the index less.
    near("Material \"dielectric\" \"float eta\" 1.5", 0.04 + 0.96 / 2.25);
    // A pane: all of it, on this side.
    near("Material \"thindielectric\" \"float eta\" 1.5", 1.0);
    // A third is not there; what is there is matte.
    near(
        "Material \"mirror\" \"rgb reflectance\" [ 0.6 0.6 0.6 ]\nAttribute \"shape\" \"float alpha\" 0.66667",
        0.4,
    );
    // And what is no surface stays none.
    assert_eq!(lit(forced, "Material \"interface\""), 0.0);
}

#[test]
fn options_without_a_counterpart_say_so() {
    let said = |option: &str| {
        let imported = import(&format!("{option}\nWorldBegin\nShape \"sphere\""));
        imported.diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>().join(" | ")
    };
    for (option, expected) in [
        ("Option \"string rendercoordsys\" \"world\"", "\"rendercoordsys\" changes nothing"),
        ("Option \"string rendercoordsys\" \"wolrd\"", "unknown rendercoordsys \"wolrd\""),
        ("Option \"bool wavefront\" true", "\"wavefront\" changes nothing"),
        ("Option \"bool pixelstats\" true", "\"pixelstats\" writes no files"),
        ("Option \"string msereferenceimage\" \"x.exr\"", "is not compared with while"),
        ("Option \"string msereferenceout\" \"x.txt\"", "\"msereferenceout\" is not written"),
        ("Option \"integer disablepixeljitter\" 1", "is declared integer, expected bool"),
    ] {
        let said = said(option);
        assert!(said.contains(expected), "{said} does not say: {expected}");
    }
    assert_eq!(said("Option \"bool pixelstats\" false\nOption \"bool wavefront\" false"), "");
}
