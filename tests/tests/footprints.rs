//! Footprints: what part of a texture a sample stands for.
use durer::{Options, Show};
use durer_tests::{bits, render, scene};

/// A plane to the horizon, a metre below the eye, in `texture` squares of a metre.
fn plain(texture: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 256 \"integer yresolution\" 128\nLookAt 0 1 0  0 1 1  0 1 0\n\
         Camera \"perspective\" \"float fov\" 60\nWorldBegin\n{texture}\n\
         Material \"diffuse\" \"texture reflectance\" \"floor\"\n\
         Shape \"plane\" \"point3 point\" [0 0 0] \"vector3 normal\" [0 1 0]\n"
    )
}

fn board(parameters: &str) -> String {
    plain(&format!(
        "Texture \"floor\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\" \
         \"vector3 v1\" [1 0 0] \"vector3 v2\" [0 0 1] {parameters}"
    ))
}

fn albedo(text: &str) -> durer::Rendered {
    let cast = Some("cast".into());
    render(&scene(
        text,
        &Options { integrator: cast, show: Some(Show::Albedo), samples: Some(1), ..Options::default() },
    ))
}

/// Mean and variance of the pixels of rows below the horizon, which is row 64: so many rows from `first` on.
fn rows(picture: &durer::Rendered, first: usize, count: usize) -> (f64, f64) {
    let values: Vec<f64> = picture.film.pixels()[(64 + first) * 256..(64 + first + count) * 256]
        .iter()
        .map(|p| f64::from(p.mean()[1]))
        .collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (mean, values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64)
}

/// G8 of the design's validation: the mean tends to 1/2 and the variance falls with distance. Without filtering every pixel
/// is black or white.
#[test]
fn a_filtered_checkerboard_fades_to_grey_towards_the_horizon_g8() {
    let (soft, sharp) = (albedo(&board("\"string filter\" \"tent\"")), albedo(&board("")));
    // Four rows each, from 2 m away to the horizon.
    let variances: Vec<f64> = [56, 16, 10, 4, 0].into_iter().map(|row| rows(&soft, row, 4).1).collect();
    assert!(variances.windows(2).all(|w| w[1] < w[0]), "{variances:?}");
    assert!(variances[0] > 0.2 && variances[4] < 1e-3, "{variances:?}");
    let (mean, variance) = rows(&soft, 0, 2);
    assert!((mean - 0.5).abs() < 2e-3 && variance < 1e-4, "{mean} {variance}");
    for row in [40, 10, 2, 0] {
        let (mean, variance) = rows(&sharp, row, 2);
        assert!((variance - mean * (1.0 - mean)).abs() < 1e-9, "row {row}: black and white only");
    }
}

fn with_integrator(text: &str, integrator: &str) -> Vec<[u32; 3]> {
    let lit = format!("{text}\nLightSource \"infinite\"\n");
    let options = Options {
        integrator: Some(integrator.into()),
        samples: Some(1),
        width: Some(48),
        ..Options::default()
    };
    bits(&render(&scene(&lit, &options)))
}

#[test]
fn boards_are_filtered_unasked_by_path_only() {
    let (usual, tent, none) =
        (board(""), board("\"string filter\" \"tent\""), board("\"string filter\" \"none\""));
    assert_eq!(with_integrator(&usual, "whitted"), with_integrator(&none, "whitted"));
    assert_ne!(with_integrator(&tent, "whitted"), with_integrator(&none, "whitted"));
    assert_eq!(with_integrator(&usual, "path"), with_integrator(&tent, "path"));
    assert_ne!(with_integrator(&usual, "path"), with_integrator(&none, "path"));
    // One that asks leaves those alone that do not.
    let other = "Texture \"other\" \"float\" \"checkerboard\" \"string filter\" \"tent\"\nTexture \"floor\"";
    let both = usual.replacen("Texture \"floor\"", other, 1);
    assert_eq!(with_integrator(&both, "whitted"), with_integrator(&none, "whitted"));
}

/// Solid textures stay with the scene wherever it is, and turn with the transformation they are described under.
#[test]
fn textures_have_a_space_of_their_own() {
    let text = |space: &str, at: [i32; 3], point: [i32; 3]| {
        let [x, y, z] = at;
        format!(
            "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 32\n\
             LookAt {x} {y} {z}  {x} {y} {}  0 1 0\nCamera \"perspective\"\nWorldBegin\n\
             AttributeBegin\n{space}\nTexture \"floor\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3\n\
             AttributeEnd\nMaterial \"diffuse\" \"texture reflectance\" \"floor\"\n\
             Shape \"plane\" \"point3 point\" [{} {} {}] \"vector3 normal\" [0 0 -1]\n",
            z + 1,
            point[0],
            point[1],
            point[2]
        )
    };
    let seen = |text: &str| bits(&albedo(text));
    // The wall lies in the middle of a layer of cubes.
    let here = seen(&text("Translate 0 0 0.5", [0, 0, 0], [0, 0, 4]));
    let there = seen(&text("Translate 1024 4096 2048.5", [1024, 4096, 2048], [1024, 4096, 2052]));
    assert_eq!(here, there);
    let turned = seen(&text("Rotate 45 0 0 1 Translate 0 0 0.5", [0, 0, 0], [0, 0, 4]));
    assert_ne!(here, turned);
    let large = seen(&text("Scale 100 100 100", [50, 50, 0], [0, 0, 4]));
    assert!(large.iter().all(|&p| p == large[0]), "one cube fills the picture");
}

/// A sample's share of the pixel shrinks with their number, and the picture with many samples is the one without filtering:
/// filtered samples have less variance.
#[test]
fn filtering_lowers_the_variance_and_keeps_the_mean() {
    let mean = |filter: &str, seed: u64| {
        let options = Options {
            integrator: Some("cast".into()),
            show: Some(Show::Albedo),
            samples: Some(4),
            seed: Some(seed),
            ..Options::default()
        };
        render(&scene(&board(&format!("\"string filter\" \"{filter}\"")), &options))
    };
    let spread = |filter: &str| {
        let (a, b) = (mean(filter, 1), mean(filter, 2));
        let (a, b) = (a.film.pixels(), b.film.pixels());
        let below = 70 * 256..128 * 256;
        let pairs = a[below.clone()].iter().zip(&b[below]);
        let (mut sum, mut squares) = (0.0, 0.0);
        let mut count = 0.0f64;
        for (a, b) in pairs {
            let (a, b) = (f64::from(a.mean()[1]), f64::from(b.mean()[1]));
            sum += a + b;
            squares += (a - b) * (a - b);
            count += 1.0;
        }
        (sum / (2.0 * count), squares / (2.0 * count))
    };
    let ((soft, little), (sharp, much)) = (spread("tent"), spread("none"));
    assert!(little < 0.5 * much, "{little} {much}");
    // Four standard errors of the mean of both.
    let sigma = ((little + much) / (2.0 * 58.0 * 256.0)).sqrt();
    assert!((soft - sharp).abs() < 4.0 * sigma + 1e-3, "{soft} {sharp} {sigma}");
}
