//! Light in fog, smoke and milk against closed forms.
use std::f64::consts::PI;

use durer::{Options, Prepared};
use durer_tests::{render, scene};

/// A picture of one spot, taken from the origin towards `to`.
fn picture(to: &str, integrator: &str, world: &str, samples: u32) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt 0 0 0  {to}  0 1 0\nCamera \"perspective\" \"float fov\" 0.0001\n\
         Integrator \"volpath\" {integrator}\nWorldBegin\n{world}"
    );
    scene(&text, &Options { samples: Some(samples), ..Options::default() })
}

fn colour(scene: &Prepared) -> [f64; 3] {
    let rendered = render(scene);
    assert!(rendered.imbalances.is_empty(), "{:?}", rendered.imbalances);
    rendered.film.pixels()[0].mean().map(f64::from)
}

fn seen(to: &str, integrator: &str, world: &str, samples: u32) -> f64 {
    colour(&picture(to, integrator, world, samples))[1]
}

const AHEAD: &str = "0 0 1";
const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const ALL: &str = "\"integer maxdepth\" 10000 \"integer roulettedepth\" 10000";

/// A medium called fog.
fn fog(params: &str) -> String {
    format!("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" {params}\n")
}

/// A slab of what is called fog between two depths, without surfaces.
fn slab(near: f64, far: f64) -> String {
    format!(
        "AttributeBegin Material \"interface\" MediumInterface \"fog\" \"\"\n\
         Shape \"plane\" \"point3 point\" [0 0 {near}] \"vector3 normal\" [0 0 -1]\n\
         Shape \"plane\" \"point3 point\" [0 0 {far}] \"vector3 normal\" [0 0 1] AttributeEnd\n"
    )
}

/// A ball of what is called fog, five metres ahead.
fn ball(material: &str) -> String {
    format!(
        "AttributeBegin {material} MediumInterface \"fog\" \"\" Translate 0 0 5 Shape \"sphere\" AttributeEnd\n"
    )
}

fn near(found: f64, expected: f64, within: f64, what: &str) {
    assert!((found - expected).abs() <= within * expected.abs(), "{what}: {found}, expected {expected}");
}

#[test]
fn what_only_absorbs_leaves_an_exponential_share_without_noise_e18() {
    let grey = fog("\"rgb sigma_a\" [0.5 0.25 1] \"rgb sigma_s\" [0 0 0]");
    let found = colour(&picture(AHEAD, "", &(SKY.to_owned() + &grey + &slab(2.0, 3.0)), 1));
    for (found, expected) in found.into_iter().zip([0.606_531, (-0.25f64).exp(), (-1.0f64).exp()]) {
        near(found, expected, 2e-6, "slab");
    }
    // I20: a ball of chord 2 sqrt(1 - b²), hit at b = 0.6.
    let found = seen("0 0.6 5", "", &(SKY.to_owned() + &grey + &ball("Material \"interface\"")), 1);
    let sine = 0.6 * 5.0 / (25.36f64).sqrt();
    near(found, (-0.25 * 2.0 * (1.0 - sine * sine).sqrt()).exp(), 1e-5, "ball");
}

#[test]
fn a_slab_scatters_once_as_the_closed_form_says_e18() {
    let sun = |z: i32| format!("LightSource \"distant\" \"point3 from\" [0 0 {z}] \"point3 to\" [0 0 0]\n");
    let mist = fog("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1]");
    // Seen at cos 0.5, lit along the normal, from the same side and from the other.
    for (z, expected) in [(-1, 0.050_410), (1, 0.037_011)] {
        let world = mist.clone() + &sun(z) + &slab(2.0, 3.0);
        let found = seen("1.7320508 0 1", "\"integer maxdepth\" 1", &world, 4096);
        near(found, expected, 6e-3, "single scattering");
    }
}

/// The same slab, by each phase function's share of light turned back by 120 degrees and on by 60, as a multiple of what goes
/// evenly to all sides.
#[test]
fn a_slab_scatters_as_tables_flakes_and_mixtures_say() {
    // Values 0.075 and 0.65 of a mean of 0.45.
    let table = ("table", "\"float phasevalues\" [0.3 0 0.2 2]", [0.075 / 0.45, 0.65 / 0.45]);
    // Normals halfway between, with m^T S^-1 m of 3.25 and 1.75, sqrt det S of 0.5; sigma is sqrt 0.8125.
    let mirrored = |m: f64| 1.0 / (0.5 * m * m * 0.8125f64.sqrt());
    let flakes = ("sggx", "\"float phasevalues\" [1 1 0.25 0 0 0]", [mirrored(3.25), mirrored(1.75)]);
    let mixed = |part: f64| 0.25 * 0.9375 + 0.75 * part;
    let blend = (
        "blend",
        "\"string phases\" [\"rayleigh\" \"table\"] \"float phaseweights\" [1 3] \"float phasevalues\" [0.3 0 0.2 2]",
        table.2.map(mixed),
    );
    for (word, params, factors) in [table, flakes, blend] {
        let mist = fog(&format!(
            "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"string phase\" \"{word}\" {params}"
        ));
        for ((z, even), factor) in [(-1, 0.050_410), (1, 0.037_011)].into_iter().zip(factors) {
            let sun = format!("LightSource \"distant\" \"point3 from\" [0 0 {z}] \"point3 to\" [0 0 0]\n");
            let world = mist.clone() + &sun + &slab(2.0, 3.0);
            let found = seen("1.7320508 0 1", "\"integer maxdepth\" 1", &world, 4096);
            near(found, even * factor, 6e-3, word);
        }
    }
}

#[test]
fn lanes_that_scatter_differently_are_each_right_e18() {
    let sun = "LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0]\n";
    let sigma = [0.1f64, 1.0, 8.0];
    let mist = fog("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [0.1 1 8]");
    let world = mist + sun + &slab(2.0, 3.0);
    let found = colour(&picture("1.7320508 0 1", "\"integer maxdepth\" 1", &world, 16_384));
    for (found, tau) in found.into_iter().zip(sigma) {
        let mu = 0.5;
        let expected = (1.0 - (-tau * (1.0 + 1.0 / mu)).exp()) / (4.0 * PI * (1.0 + mu));
        near(found, expected, 1e-2, "chromatic");
    }
}

#[test]
fn where_nothing_is_lost_scattering_disappears_in_a_uniform_sky() {
    for (sigma, g) in [(0.3, 0.0), (3.0, 0.0), (3.0, 0.8), (20.0, -0.5)] {
        let milk = fog(&format!(
            "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [{sigma} {sigma} {sigma}] \"float g\" {g}"
        ));
        for material in ["Material \"interface\"", "Material \"dielectric\" \"float eta\" 1"] {
            let found = seen("0 0.3 5", ALL, &(SKY.to_owned() + &milk + &ball(material)), 64);
            near(found, 1.0, 1e-4, &format!("sigma {sigma}, g {g}, {material}"));
        }
    }
    // Each lane by itself is right in the mean only.
    let milk = fog("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [0.2 1 5]");
    let world = SKY.to_owned() + &milk + &ball("Material \"interface\"");
    let found = colour(&picture("0 0.3 5", ALL, &world, 65_536));
    found.into_iter().for_each(|found| near(found, 1.0, 2e-2, "chromatic"));
}

#[test]
fn what_glows_sends_what_it_keeps() {
    // Kirchhoff: where stuff absorbs 1 - exp(-tau), it sends that share of Le.
    let ember =
        fog("\"rgb sigma_a\" [0.7 0.7 0.7] \"rgb sigma_s\" [0 0 0] \"rgb Le\" [2 2 2] \"float Lescale\" 1.5");
    let dark = "LightSource \"infinite\" \"rgb L\" [0 0 0]\n";
    let found = seen(AHEAD, "", &(dark.to_owned() + &ember + &slab(2.0, 4.0)), 1);
    near(found, 3.0 * (1.0 - (-1.4f64).exp()), 1e-5, "slab");
    // In a sky as bright nothing is seen of it, also where it scatters.
    let ember = fog("\"rgb sigma_a\" [0.7 0.7 0.7] \"rgb sigma_s\" [1.5 1.5 1.5] \"rgb Le\" [1 1 1]");
    let world = SKY.to_owned() + &ember + &ball("Material \"interface\"");
    near(seen("0 0.3 5", ALL, &world, 65_536), 1.0, 5e-3, "thermal equilibrium");
}

#[test]
fn lamps_in_fog_and_cameras_in_fog_are_seen_through_it() {
    let mist = fog("\"rgb sigma_a\" [0.2 0.2 0.2] \"rgb sigma_s\" [0 0 0]");
    let lamp = "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] Translate 0 0 4 Shape \"sphere\" AttributeEnd\n";
    // Everything lies in fog, as the file says of the camera.
    let said = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n{mist}\
         MediumInterface \"\" \"fog\"\nLookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 0.0001\n\
         Integrator \"volpath\"\nWorldBegin\n{lamp}"
    );
    let options = Options { samples: Some(1), ..Options::default() };
    near(colour(&scene(&said, &options))[1], 5.0 * (-0.6f64).exp(), 1e-5, "said");
    // Nobody says so, but the camera is in a ball of it, which ends behind the lamp.
    let around = mist.clone()
        + lamp
        + "Material \"interface\" MediumInterface \"fog\" \"\" Shape \"sphere\" \"float radius\" 20\n";
    near(seen(AHEAD, "", &around, 1), 5.0 * (-0.6f64).exp(), 1e-5, "found out");
}

#[test]
fn the_path_integrator_ignores_media() {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nCamera \"perspective\"\n\
         Integrator \"path\"\nWorldBegin\n{SKY}{}{}",
        fog(""),
        slab(2.0, 3.0)
    );
    let found = colour(&scene(&text, &Options { samples: Some(4), ..Options::default() }));
    assert_eq!(found, [1.0; 3]);
}

/// What a body of the index 1 absorbs besides.
const TINT: [f64; 3] = [0.3, 0.1, 0.6];

#[test]
fn what_a_body_absorbs_and_what_floats_in_it_count_together_i20() {
    let [r, g, b] = TINT;
    let body = format!("Material \"dielectric\" \"float eta\" 1 \"rgb absorption\" [{r} {g} {b}]");
    let of = |light: &str, [a, s]: [[f64; 3]; 2], more: &str, material: &str, samples: u32| {
        let [a, s] = [a, s].map(|[r, g, b]| format!("{r} {g} {b}"));
        let fog = fog(&format!("\"rgb sigma_a\" [{a}] \"rgb sigma_s\" [{s}] {more}"));
        colour(&picture("0 0.2 5", ALL, &format!("{light}{fog}{}", ball(material)), samples))
    };
    let both = |own: f64| TINT.map(|tint| own + tint);
    // As if the medium absorbed as much more, whether it scatters or not.
    for (scattered, samples, within) in [([0.0; 3], 1, 1e-5), ([1.5, 2.0, 1.0], 65_536, 0.01)] {
        let found = of(SKY, [[0.2; 3], scattered], "", &body, samples);
        let expected = of(SKY, [both(0.2), scattered], "", "Material \"interface\"", samples);
        (0..3).for_each(|c| near(found[c], expected[c], within, &format!("{scattered:?}, channel {c}")));
    }
    // What glows is dimmed from where it is on: the chord of 2 sqrt(1 - 25 sin²).
    let dark = "LightSource \"infinite\" \"rgb L\" [0 0 0]\n";
    let found = of(dark, [[0.7; 3], [0.0; 3]], "\"rgb Le\" [2 2 2]", &body, 1);
    let chord = 2.0 * (1.0 - 25.0 * 0.04 / 25.04f64).sqrt();
    for (found, tint) in found.into_iter().zip(TINT) {
        let all = 0.7 + tint;
        near(found, 0.7 * 2.0 / all * (1.0 - (-all * chord).exp()), 1e-4, "glow");
    }
    // The same in a grid, by chance, whether it scatters too or not. It is even between the middles of its outermost cells.
    for scattered in ["0 0 0 ", "1 1 1 "] {
        let grid = |absorbed: &str, material: &str| {
            let world = format!(
                "{dark}MakeNamedMedium \"fog\" \"string type\" \"rgbgrid\" \"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 3 \
                 \"point3 p0\" [-6 -6 -1] \"point3 p1\" [6 6 11] \"rgb sigma_a\" [{}] \"rgb sigma_s\" [{}] \
                 \"rgb Le\" [{}]\n{}",
                absorbed.repeat(27),
                scattered.repeat(27),
                "2 2 2 ".repeat(27),
                ball(material)
            );
            colour(&picture("0 0.2 5", ALL, &world, 65_536))
        };
        let (found, plain) = (grid("0.7 0.7 0.7 ", &body), grid("1 0.8 1.3 ", "Material \"interface\""));
        // Only the medium's own part of what is absorbed glows.
        (0..3).for_each(|c| {
            near(found[c], plain[c] * 0.7 / (0.7 + TINT[c]), 0.015, &format!("glow of a grid, {scattered}"));
        });
    }
}

#[test]
fn fog_in_a_ball_that_moves_is_there_while_the_ball_is() {
    // From 3 m left to 3 m right of the ray: what its chord leaves, in the mean over the shutter.
    let world = format!(
        "{SKY}{}AttributeBegin Material \"interface\" MediumInterface \"fog\" \"\"\n\
         ActiveTransform StartTime Translate -3 0 5 ActiveTransform EndTime Translate 3 0 5 ActiveTransform All\n\
         Shape \"sphere\" AttributeEnd\n",
        fog("\"rgb sigma_a\" [0.9 0.9 0.9] \"rgb sigma_s\" [0 0 0]")
    );
    let left = |t: f64| (-1.8 * (1.0 - (6.0 * t - 3.0).powi(2)).max(0.0).sqrt()).exp();
    let expected = (0..6000).map(|i| left((f64::from(i) + 0.5) / 6000.0)).sum::<f64>() / 6000.0;
    near(seen(AHEAD, "", &world, 4096), expected, 2e-3, "ball");
}

#[test]
fn media_that_are_told_to_move_stay_and_say_so() {
    for (kind, says) in [("cloud", true), ("homogeneous", false)] {
        let moving = format!(
            "WorldBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\n\
             MakeNamedMedium \"m\" \"string type\" \"{kind}\"\n\
             MediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\""
        );
        let said = format!("{:?}", durer_tests::import(&moving).diagnostics);
        assert_eq!(said.contains("the medium \\\"m\\\" moves, which media do not"), says, "{said}");
    }
}
