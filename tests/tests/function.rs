//! pbrt-v4's test functions as pictures: how well samplers integrate.
use durer::Options;
use durer_tests::{render, scene};

const FUNCTIONS: [&str; 6] = ["step", "diagonal", "disk", "checkerboard", "rotatedcheckerboard", "gaussian"];

/// Mean over 32 x 32 pixels, and the deviation of one of `samples` samples from 1.
fn error(function: &str, sampler: &str, samples: u32) -> (f64, f64) {
    let edge = f64::from(samples).sqrt();
    let count = match sampler {
        "stratified" => format!("\"integer xsamples\" {edge} \"integer ysamples\" {edge}"),
        _ => format!("\"integer pixelsamples\" {samples}"),
    };
    let text = format!(
        "PixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n\
         Sampler \"{sampler}\" {count}\n\
         Integrator \"function\" \"string function\" \"{function}\"\nWorldBegin\n"
    );
    let pixels = render(&scene(&text, &Options::default())).film.pixels();
    let values: Vec<f64> = pixels.iter().map(|pixel| f64::from(pixel.mean()[1])).collect();
    let n = values.len() as f64;
    let square = values.iter().map(|v| (v - 1.0).powi(2)).sum::<f64>() / n;
    (values.iter().sum::<f64>() / n, square.sqrt())
}

#[test]
fn pictures_of_all_functions_are_1_in_the_mean() {
    for function in FUNCTIONS {
        let (mean, _) = error(function, "independent", 16);
        // 16384 samples of a standard deviation of 1 or less.
        assert!((mean - 1.0).abs() < 0.03, "{function}: {mean}");
    }
}

#[test]
fn errors_fall_as_theory_has_it() {
    // Of n independent samples of 0 and 2: 1 / sqrt n.
    for samples in [4, 64] {
        let (_, found) = error("step", "independent", samples);
        let expected = 1.0 / f64::from(samples).sqrt();
        assert!((found / expected - 1.0).abs() < 0.1, "{samples}: {found}, expected {expected}");
    }
    // Half of every power of two of Sobol's points lie on either side of a middle.
    for samples in [4, 16] {
        let (_, found) = error("step", "zsobol", samples);
        assert!(found < 1e-6, "{samples}: {found}");
    }
    // Scrambled points lie evenly under a smooth function; strata already help under an edge.
    assert!(error("gaussian", "sobol", 64).1 < 0.1 * error("gaussian", "independent", 64).1);
    assert!(error("disk", "stratified", 64).1 < 0.6 * error("disk", "independent", 64).1);
}

#[test]
fn its_words_are_checked() {
    let mut imported =
        durer_tests::import("Integrator \"function\" \"string function\" \"discus\"\nWorldBegin");
    assert!(durer::prepare(&mut imported, &Options::default()).is_none());
    let said: Vec<_> = imported.diagnostics.iter().map(|d| d.message.clone()).collect();
    assert!(said.iter().any(|m| m.contains("unknown function \"discus\"")), "{said:?}");
}
