//! Antialiasing: filters and strata in pictures, against areas and against the rates that theory promises.
use durer::{
    Options, Prepared, Show,
    math::Point2,
    sampling::{Dim, Sampler, SamplerKind},
};
use durer_tests::{bits, render, scene};

/// White left of a line, black right of it; the line crosses the picture, `width` pixels by 1 m each, at `x` at the bottom
/// and `x + slant` at the top.
fn half_plane(width: u32, height: u32, x: f64, slant: f64, head: &str) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" {width} \"integer yresolution\" {height} {head}\n\
         Camera \"orthographic\" \"float screenwindow\" [0 {width} 0 {height}]\nWorldBegin\n\
         Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n\
         Shape \"polygon\" \"point3 P\" [-50 {low} 1  {left} {low} 1  {right} {high} 1  -50 {high} 1]\n",
        left = x - slant,
        right = x + 2.0 * slant,
        low = -f64::from(height),
        high = 2.0 * f64::from(height),
    );
    let cast = Options { integrator: Some("cast".into()), show: Some(Show::Albedo), ..Options::default() };
    scene(&text, &cast)
}

fn values(prepared: &Prepared) -> Vec<f64> {
    render(prepared).film.pixels().iter().map(|p| f64::from(p.mean()[0])).collect()
}

#[test]
fn an_edge_covers_its_share_of_the_pixel_f10() {
    let heads = [
        ("zsobol\" \"integer pixelsamples\" 16", 1.0 / 16.0),
        ("stratified\" \"integer xsamples\" 4 \"integer ysamples\" 4", 1.0 / 4.0),
    ];
    for (sampler, bound) in heads {
        let head = format!("Sampler \"{sampler} PixelFilter \"box\"");
        for x in [0.1, 0.37, 0.5, 0.871] {
            // Every row is another trial of the same axis-aligned edge.
            let all = values(&half_plane(1, 500, x, 0.0, &head));
            assert!(all.iter().all(|v| (v - x).abs() <= bound + 1e-6), "{sampler} {x}");
            let mean = all.iter().sum::<f64>() / 500.0;
            assert!((mean - x).abs() < 4.0 * bound / 500f64.sqrt(), "{sampler}: {mean}, expected {x}");
        }
    }
}

#[test]
fn pictures_of_an_edge_are_those_of_the_filter_in_x_and_in_y() {
    // An upright edge tells of the radius in x alone: 1 px, not the 3 in y. The tent's integral is a parabola.
    let head = "Sampler \"stratified\" \"integer xsamples\" 16 \"integer ysamples\" 16 \
                PixelFilter \"triangle\" \"float xradius\" 1 \"float yradius\" 3";
    let picture = half_plane(7, 60, 3.2, 0.0, head);
    let all = values(&picture);
    for column in 0..7 {
        let mean = (0..60).map(|row| all[row * 7 + column]).sum::<f64>() / 60.0;
        let d = (3.2 - (column as f64 + 0.5)).clamp(-1.0, 1.0);
        let expected = if d < 0.0 { (1.0 + d).powi(2) / 2.0 } else { 1.0 - (1.0 - d).powi(2) / 2.0 };
        assert!((mean - expected).abs() < 0.004, "column {column}: {mean}, expected {expected}");
    }
}

#[test]
fn one_sample_goes_through_the_middle_whatever_the_filter() {
    let options = |head: &str| {
        half_plane(3, 20, 0.5, 2.0, &format!("Sampler \"sobol\" \"integer pixelsamples\" 1 {head}"))
    };
    let boxed = bits(&render(&options("PixelFilter \"box\"")));
    for filter in ["gaussian", "mitchell", "sinc", "triangle", "blackmanharris"] {
        assert!(bits(&render(&options(&format!("PixelFilter \"{filter}\"")))) == boxed, "{filter}");
    }
    let white = boxed.iter().filter(|p| p[0] != 0).count();
    assert_eq!(white, 30, "the edge has half the middles on its left");
}

#[test]
fn data_pictures_keep_to_their_pixels() {
    let text = "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24 PixelFilter \"sinc\"\n\
                LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 60\nWorldBegin\nShape \"sphere\"\n";
    let depth = |text: &str| {
        let options = Options {
            integrator: Some("cast".into()),
            show: Some(Show::Depth),
            samples: Some(9),
            ..Options::default()
        };
        bits(&render(&scene(text, &options)))
    };
    assert!(depth(text) == depth(&text.replace("sinc", "box")));
}

#[test]
fn few_samples_with_negative_lobes_are_warned_about() {
    let said = |samples: u32| {
        let mut imported = durer_tests::import("PixelFilter \"mitchell\"\nWorldBegin\nShape \"sphere\"\n");
        let options = Options { samples: Some(samples), ..Options::default() };
        assert!(durer::prepare(&mut imported, &options).is_some());
        imported.diagnostics.iter().any(|d| d.message.contains("negative lobes"))
    };
    assert_eq!([1, 4, 15, 16, 64].map(said), [false, true, true, false, false]);
}

/// The slope of log(mean square error) over log N, N from 4 to 256 samples.
fn slope(kind: SamplerKind, exact: f64, v: impl Fn(Point2, u32) -> f64) -> f64 {
    let trials = 3000;
    let points: Vec<(f64, f64)> = [4u32, 16, 64, 256]
        .into_iter()
        .map(|n| {
            let error = |pixel: u32| {
                let of = |i| v(Sampler::new(kind, 8, [pixel, 5], i, n).d2(Dim::Lens), pixel);
                ((0..n).map(of).sum::<f64>() / f64::from(n) - exact).powi(2)
            };
            (f64::from(n).ln(), ((0..trials).map(error).sum::<f64>() / f64::from(trials)).ln())
        })
        .collect();
    let (mx, my) = points.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / 4.0, m.1 + p.1 / 4.0));
    let covariance: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    covariance / points.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>()
}

#[test]
fn errors_fall_as_fast_as_theory_says_c5() {
    // Left of the line x = 0.3 + 0.4 y, whose mean over y is 0.5.
    let edge = |p: Point2, _: u32| f64::from(u8::from(f64::from(p.x) < 0.3 + 0.4 * f64::from(p.y)));
    // Integral (e - 1) (1 - cos 2) / 2.
    let smooth = |p: Point2, _: u32| f64::from(p.x).exp() * (2.0 * f64::from(p.y)).sin();
    let of_smooth = (1f64.exp() - 1.0) * (1.0 - 2f64.cos()) / 2.0;
    // 3000 trials leave 3 % of a mean square error uncertain: 0.02 of the slope; the rest of the tolerance is for small N.
    for (kind, what, expected, tolerance, found) in [
        ("random", "edge", -1.0, 0.05, slope(SamplerKind::Independent, 0.5, edge)),
        ("random", "smooth", -1.0, 0.05, slope(SamplerKind::Independent, of_smooth, smooth)),
        ("jittered", "edge", -1.5, 0.1, slope(SamplerKind::Stratified, 0.5, edge)),
        ("jittered", "smooth", -2.0, 0.1, slope(SamplerKind::Stratified, of_smooth, smooth)),
    ] {
        assert!((found - expected).abs() < tolerance, "{kind}, {what}: N^{found}, expected N^{expected}");
    }
}

#[test]
fn scenes_choose_their_sampler() {
    let of = |sampler: &str| {
        let text = format!("Sampler {sampler}\nWorldBegin\nShape \"sphere\"\n");
        let settings = scene(&text, &Options::default()).settings;
        (settings.sampler, settings.samples)
    };
    let cells = "\"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5";
    assert_eq!(of(cells), (SamplerKind::Stratified, 15));
    assert_eq!(of(&format!("{cells} \"bool jitter\" false")), (SamplerKind::Regular, 15));
    assert_eq!(of("\"independent\""), (SamplerKind::Independent, 16));
    for (word, kind) in [
        ("halton", SamplerKind::Halton),
        ("sobol", SamplerKind::Sobol),
        ("paddedsobol", SamplerKind::PaddedSobol),
        ("zsobol", SamplerKind::ZSobol),
        ("pmj02bn", SamplerKind::ZSobol),
    ] {
        assert_eq!(of(&format!("\"{word}\"")), (kind, 16));
    }
    let asked = Options { sampler: Some(SamplerKind::Halton), ..Options::default() };
    assert_eq!(scene("WorldBegin\nShape \"sphere\"\n", &asked).settings.sampler, SamplerKind::Halton);
    let unasked = scene("WorldBegin\nShape \"sphere\"\n", &Options::default());
    assert_eq!(unasked.settings.sampler, SamplerKind::ZSobol);
}
