//! What `durer explain` says of known pixels, against numbers computed here.
use std::f64::consts::PI;

use durer::{
    Options, Prepared, Show, builtin,
    explain::{Explanation, explain},
    tree::Subject,
};
use durer_tests::{prepared, scene};

/// Three significant digits.
fn three(v: f64) -> String {
    let digits = 2 - v.abs().log10().floor() as i32;
    let text = format!("{v:.0$}", digits.max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn explained(prepared: &Prepared, pixel: [u32; 2]) -> Explanation {
    let subject = Subject { name: "test", prepared };
    explain(&subject, pixel, &subject.samples(pixel), None)
}

/// Parallel rays along +z, one through the middle of each of 3 x 3 pixels that are `pitch` metres apart.
fn parallel(pitch: f64, world: &str, options: &Options) -> Prepared {
    let half = 1.5 * pitch;
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 3 \"integer yresolution\" 3\n\
         Sampler \"stratified\" \"integer xsamples\" 1 \"integer ysamples\" 1 \"bool jitter\" false\n\
         PixelFilter \"box\"\nLookAt 0 0 -5  0 0 0  0 1 0\n\
         Camera \"orthographic\" \"float screenwindow\" [{} {half} {} {half}]\nWorldBegin\n{world}",
        -half, -half
    );
    scene(&text, &Options { samples: Some(1), ..options.clone() })
}

fn whitted() -> Options {
    Options { integrator: Some("whitted".to_owned()), ..Options::default() }
}

fn assert_says(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "no {word:?} in:\n{text}");
    }
}

/// The sum of the named parts is what is explained.
fn assert_sum(name: &str, explanation: &Explanation) {
    for parts in [&explanation.parts, &explanation.sources] {
        let sum: [f64; 3] = std::array::from_fn(|i| parts.iter().map(|p| p.rgb[i]).sum());
        for (sum, rgb) in sum.iter().zip(explanation.rgb) {
            assert!((sum - rgb).abs() <= 1e-5 * rgb.abs().max(0.1), "{name}: {sum} for {rgb}: {parts:?}");
        }
        let shares: f64 = parts.iter().map(|p| p.share).sum();
        assert!(parts.is_empty() || (shares - 1.0).abs() < 1e-9, "{name}: {shares}");
    }
}

#[test]
fn the_parts_sum_to_the_pixel() {
    for one in builtin::SCENES {
        for integrator in ["whitted", "distributed", "cast"] {
            let options = Options {
                integrator: Some(integrator.to_owned()),
                width: Some(48),
                samples: Some(3),
                max_depth: (integrator != "cast").then_some(4),
                ..Options::default()
            };
            let prepared = prepared(one.import(), &options);
            let height = prepared.scene.view.height;
            for pixel in [[3, 3], [24, height / 2], [30, height - 4], [11, height / 3]] {
                assert_sum(one.name, &explained(&prepared, pixel));
            }
        }
    }
}

#[test]
fn a_pixel_of_the_sky_is_the_sky() {
    let world = "LightSource \"infinite\" \"rgb L\" [0.25 0.5 0.75]\nTranslate 9 9 9\nShape \"sphere\"\n";
    let explanation = explained(&parallel(0.1, world, &whitted()), [1, 1]);
    let text = explanation.text(false);
    assert_says(
        &text,
        &["(0.25, 0.5, 0.75)", "All of it is the sky.", "leaves the scene without meeting anything"],
    );
    assert_sum("sky", &explanation);
}

/// A wall at z = 0, lit 60 degrees off its normal.
const LIT: &str = "LightSource \"distant\" \"string name\" \"sun\" \"rgb L\" [2 2 2]\n\
    \"point3 from\" [0 1.7320508 -1] \"point3 to\" [0 0 0]\n\
    Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
    Shape \"polygon\" \"string name\" \"wall\" \"point3 P\" [-9 -9 0  -9 9 0  9 9 0  9 -9 0]\n";

#[test]
fn a_lit_wall_has_lamberts_formula() {
    let explanation = explained(&parallel(0.1, LIT, &whitted()), [1, 1]);
    let value = 0.5 / PI * 2.0 * 0.5;
    assert!((explanation.rgb[0] - value).abs() < 1e-6);
    let formula = format!(
        "Light \"sun\" arrives 60.0 degrees off the normal: kd / pi E cos a = 0.5 / 3.142 x 2 x 0.5 = {}, 100 % of the \
         sample.",
        three(value)
    );
    let text = explanation.text(false);
    assert_says(
        &text,
        &[&formula, "All of it is light of \"sun\".", "\"wall\"", "after 5 m, 0.0 degrees off its normal"],
    );
}

#[test]
fn a_highlight_has_its_formula() {
    let shiny = LIT.replace(
        "\"diffuse\" \"rgb reflectance\"",
        "\"classic\" \"float exponent\" 4 \"rgb specular\" [0.4 0.4 0.4] \"rgb diffuse\"",
    );
    let explanation = explained(&parallel(0.1, &shiny, &whitted()), [1, 1]);
    // Halfway between 0 and 60 degrees.
    let highlight = 0.4 * 30f64.to_radians().cos().powi(4) / (PI * 0.5);
    let value = (0.5 / PI + highlight) * 2.0 * 0.5;
    assert!((explanation.rgb[0] - value).abs() < 1e-6, "{} {value}", explanation.rgb[0]);
    let formula =
        format!("(0.5 / 3.142 + 0.4 x cos^4(30.0 degrees) / (3.142 x 0.5)) x 2 x 0.5 = {}", three(value));
    assert_says(&explanation.text(false), &[&formula, "(kd / pi + ks cos^n h / (pi cos a)) E cos a"]);
}

#[test]
fn a_shadow_names_what_casts_it() {
    let blocked = format!(
        "{LIT}Translate 0 3.4641016 -2\nShape \"sphere\" \"string name\" \"moon\" \"float radius\" 0.5\n"
    );
    let text = explained(&parallel(0.1, &blocked, &whitted()), [1, 1]).text(false);
    let free = three(0.5 / PI * 2.0 * 0.5);
    let why = format!("Light \"sun\" does not count: it is blocked by \"moon\"; free it would add {free}.");
    assert_says(&text, &[&why, "It is black: no light comes to it."]);
    let behind = LIT.replace("1.7320508 -1]", "1.7320508 1]");
    let text = explained(&parallel(0.1, &behind, &whitted()), [1, 1]).text(false);
    assert_says(
        &text,
        &["Light \"sun\" does not count: it lies behind the surface, 120.0 degrees off the normal."],
    );
}

#[test]
fn a_glass_ball_has_snells_law_and_fresnels_shares() {
    let world = "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"dielectric\" \"float eta\" 1.5\n\
        Shape \"sphere\" \"string name\" \"ball\" \"float radius\" 1\n";
    let explanation = explained(&parallel(0.6, world, &whitted()), [2, 1]);
    // Parallel rays 0.6 m off the middle of a ball of 1 m.
    let (sin_a, n) = (0.6f64, 1.5f64);
    let sin_b = sin_a / n;
    let (cos_a, cos_b) = ((1.0 - sin_a * sin_a).sqrt(), (1.0 - sin_b * sin_b).sqrt());
    let s = (cos_a - n * cos_b) / (cos_a + n * cos_b);
    let p = (n * cos_a - cos_b) / (n * cos_a + cos_b);
    let r = 0.5 * (s * s + p * p);
    let [a, b] = [sin_a, sin_b].map(|s| format!("{:.1}", s.asin().to_degrees()));
    let snell = format!(
        "Snell's law bends the ray from {a} to {b} degrees: n1 sin a = n2 sin b, 1 x 0.6 = 1.5 x 0.4."
    );
    let fresnel =
        format!("From n1 = 1 to n2 = 1.5 at {a} degrees Fresnel's equations reflect R = {:.1} %", 100.0 * r);
    assert_says(
        &explanation.text(false),
        &[&snell, &fresnel, "The refracted ray meets \"ball\" and brings weight x light"],
    );
    assert_sum("glass", &explanation);
}

#[test]
fn total_internal_reflection_names_the_critical_angle() {
    let water = builtin::find("snell").expect("a scene");
    let prepared =
        prepared(water.import(), &Options { scale: Some(0.1), samples: Some(1), ..Options::default() });
    // Outside of the window.
    let text = explained(&prepared, [3, 40]).text(false);
    let critical = format!("the critical angle is {:.1} degrees", (0.75f64).asin().to_degrees());
    assert_says(
        &text,
        &["total internal reflection", &critical, "n1 sin a / n2 = 1.33 x", "\"water\"", "exp(-sigma d)"],
    );
}

#[test]
fn absorption_has_beer_and_lamberts_formula() {
    let world = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n\
        Material \"dielectric\" \"float eta\" 1 \"rgb absorption\" [0.5 0.5 0.5]\n\
        Shape \"sphere\" \"string name\" \"ball\" \"float radius\" 1\n";
    let explanation = explained(&parallel(0.6, world, &whitted()), [1, 1]);
    let left = (-1.0f64).exp();
    let formula =
        format!("On 2 m through \"ball\" absorption leaves exp(-sigma d) = exp(-0.5 x 2) = {}", three(left));
    assert_says(&explanation.text(false), &[&formula]);
    assert!((explanation.rgb[0] - left).abs() < 1e-5);
}

#[test]
fn the_depth_limit_is_named_with_a_bound() {
    // Two mirrors that face each other; between them a lit strip that only few rays see.
    let world = format!(
        "{LIT}Material \"mirror\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
         Shape \"polygon\" \"string name\" \"near\" \"point3 P\" [-1 -1 -1  -1 1 -1  1 1 -1  1 -1 -1]\n\
         Shape \"polygon\" \"string name\" \"far\" \"point3 P\" [-9 -9 -7  -9 9 -7  9 9 -7  9 -9 -7]\n"
    );
    let options = Options { max_depth: Some(3), min_contribution: Some(0.0), ..whitted() };
    let text = explained(&parallel(0.1, &world, &options), [1, 1]).text(true);
    assert_says(
        &text,
        &[
            "1 ray was given up at the depth limit of 3 bounces.",
            "They would have had 6.2 % of the sample",
            "it would be bounce 4, and 3 are allowed (--max-depth)",
        ],
    );
    let options = Options { min_contribution: Some(0.2), ..whitted() };
    let text = explained(&parallel(0.1, &world, &options), [1, 1]).text(true);
    assert_says(&text, &["its share in the pixel, 0.125, is not above 0.2 (--min-contribution)"]);
}

#[test]
fn a_lamp_that_is_seen_shines_by_itself() {
    let world = "AreaLightSource \"diffuse\" \"rgb L\" [9 6 3]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
        Shape \"sphere\" \"string name\" \"lamp\" \"float radius\" 1\n";
    let text = explained(&parallel(0.1, world, &whitted()), [1, 1]).text(false);
    assert_says(
        &text,
        &[
            "All of it is what \"lamp\" sends out by itself.",
            "\"lamp\" shines by itself: L = (9, 6, 3), 100 % of the sample.",
        ],
    );
}

#[test]
fn half_shadows_count_the_samples_that_see_the_light() {
    let penumbra = builtin::find("penumbra").expect("a scene");
    let options = Options {
        integrator: Some("distributed".to_owned()),
        width: Some(96),
        samples: Some(16),
        ..Options::default()
    };
    let prepared = prepared(penumbra.import(), &options);
    let mut seen = 0;
    for (x, y) in (20..80).step_by(4).flat_map(|x| [30, 36, 42].map(|y| (x, y))) {
        let job = prepared.job();
        // Of the light "green disk", at hits of the ground.
        let trees: Vec<_> = (0..16).map(|sample| job.record([x, y], sample).0).collect();
        let of_disk = |tree: &durer::probe::RayTree| {
            let disk = |n: &&durer::probe::TreeNode| {
                n.light.is_some_and(|l| prepared.scene.light_names[l.light as usize] == "green disk")
            };
            tree.nodes.iter().find(disk).and_then(|n| n.light).map(|l| (l.visible, l.blocker.is_some()))
        };
        let found: Vec<_> = trees.iter().filter_map(of_disk).collect();
        let lit = found.iter().filter(|(visible, _)| *visible).count();
        let blocked = found.iter().filter(|(_, blocked)| *blocked).count();
        if lit > 0 && blocked > 0 && found.len() == 16 {
            let share = format!("Light \"green disk\" reaches {lit} of 16 samples");
            assert_says(&explained(&prepared, [x, y]).text(false), &[&share, "its half-shadow, as \""]);
            seen += 1;
        }
    }
    assert!(seen > 2, "{seen} pixels in half-shadows");
}

#[test]
fn ray_casting_says_what_it_shows() {
    let show = |show| Options { integrator: Some("cast".to_owned()), show: Some(show), ..Options::default() };
    let told = |what| explained(&parallel(0.1, LIT, &show(what)), [1, 1]).text(false);
    assert_says(
        &told(Show::Depth),
        &["depth: 5 m along the camera's axis, beside it 5 m along the ray", "\"wall\""],
    );
    assert_says(&told(Show::Normal), &["shading normal in world space", "z -1"]);
    assert_says(&told(Show::Id), &["the number of the object: 1"]);
    assert_says(&told(Show::Cost), &["tests of primitives"]);
    assert_says(&told(Show::Albedo), &["colour of the material: 0.5"]);
    let lamps = format!("the lamps add {}", three(0.5 / PI * 2.0 * 0.5));
    assert_says(&told(Show::Shading), &["Ray casting follows no more rays", &lamps]);
    let nothing = explained(&parallel(30.0, LIT, &show(Show::Depth)), [0, 0]).text(false);
    assert_says(&nothing, &["here it has no value"]);
}

#[test]
fn one_sample_can_be_asked_for() {
    let whitted = builtin::find("whitted").expect("a scene");
    let prepared =
        prepared(whitted.import(), &Options { scale: Some(0.1), samples: Some(4), ..Options::default() });
    let subject = Subject { name: "whitted", prepared: &prepared };
    let taken = subject.samples([64, 36]);
    for sample in 0..4 {
        let explanation = explain(&subject, [64, 36], &taken, Some(sample));
        assert_eq!((explanation.sample, explanation.explained.as_slice()), (sample, &[sample][..]));
        let value = taken[sample as usize].rgb.expect("light").map(f64::from);
        assert_eq!(explanation.rgb, value);
        assert_sum("sample", &explanation);
        assert_says(&explanation.text(false), &[&format!("Sample {sample} of 4 of pixel 64,36 of whitted")]);
    }
}
