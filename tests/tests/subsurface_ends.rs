//! Light that walks below surfaces, from both ends: the pictures of `path`, in all ways at once and in each alone.
use durer::{
    Options, Prepared,
    spectrum::{Basis, Carried},
};
use durer_tests::{
    bits, import, render, scene,
    small::{AHEAD, BOX, LAMP, difference, means, picture, total},
};

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const POINT: &str = "LightSource \"point\" \"point3 from\" [1.5 3 -2] \"rgb I\" [20 18 15]\n";
const FLOOR: &str =
    "Material \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" [-2 0 -2  -2 0 2  2 0 -2  2 0 2]\n";
const WAX: &str = "\"rgb sigma_a\" [0.05 0.1 0.3] \"rgb sigma_s\" [3 4 6]";
const DEPTH: &str = "\"integer maxdepth\" 6 \"integer roulettedepth\" 20";
/// Smooth, with narrow facets, and with wide ones.
const BOUNDARIES: [f32; 3] = [0.0, 0.05, 0.25];

fn wax(stuff: &str, roughness: f32) -> String {
    format!("Material \"subsurface\" {stuff} \"float eta\" 1.4 \"float roughness\" {roughness}")
}

fn sphere(material: &str, place: &str, radius: f32) -> String {
    format!(
        "AttributeBegin {material} Translate {place} Shape \"sphere\" \"float radius\" {radius} AttributeEnd\n"
    )
}

fn ball(material: &str) -> String {
    sphere(material, "0 0.8 0", 0.8)
}

fn of(integrator: &str, world: &str, samples: u32) -> Vec<[f64; 3]> {
    means(&picture(&format!("{AHEAD}\n{BOX}"), integrator, world, samples))
}

/// An integrator makes the picture of `path`, within the limits of [`difference`].
fn agree(name: &str, word: &str, world: &str, samples: u32, (bias, error): (f64, f64)) {
    let expected = of(&format!("\"path\" {DEPTH}"), world, 2 * samples);
    let found = of(&format!("\"{word}\" {DEPTH}"), world, samples);
    let (all, pixels) = difference(&expected, &found);
    assert!(total(&expected) > 1e-3 && all.abs() < bias && pixels < error, "{name}, {word}: {all}, {pixels}");
}

#[test]
fn bdpt_sees_what_paths_see_below_surfaces() {
    let chromatic = "\"rgb sigma_a\" [0.02 0.1 0.4] \"rgb sigma_s\" [1 3 8] \"float g\" 0.4";
    for roughness in BOUNDARIES {
        for (name, lights, stuff) in
            [("lamp", LAMP, WAX), ("point", POINT, WAX), ("sky", SKY, WAX), ("chromatic", LAMP, chromatic)]
        {
            let world = format!("{FLOOR}{lights}{}", ball(&wax(stuff, roughness)));
            agree(&format!("{name}, roughness {roughness}"), "bdpt", &world, 2048, (0.02, 0.08));
        }
    }
}

/// Bodies in bodies, and lamps in them.
#[test]
fn what_is_below_surfaces_is_seen_from_both_ends() {
    let lamp = "Material \"diffuse\" AreaLightSource \"diffuse\" \"rgb L\" [20 17 12]";
    let thin = "\"rgb sigma_a\" [0.05 0.1 0.3] \"rgb sigma_s\" [1 1.5 2]";
    for roughness in BOUNDARIES {
        let within = |material: &str| {
            LAMP.to_owned() + &ball(&wax(WAX, roughness)) + &sphere(material, "0 0.8 -0.3", 0.35)
        };
        let glass = format!("Material \"dielectric\" \"float eta\" 1.2 \"float roughness\" {roughness}");
        let red = wax("\"rgb sigma_a\" [0.3 0.01 0.01] \"rgb sigma_s\" [8 8 8]", roughness);
        let sphere_in_glass = sphere(&wax(WAX, roughness), "0 0.8 0", 0.5);
        for (name, things, limits) in [
            ("glass", within(&glass), (0.02, 0.09)),
            ("wax", within(&red), (0.02, 0.09)),
            ("matte", within("Material \"diffuse\""), (0.02, 0.09)),
            (
                "in glass",
                LAMP.to_owned()
                    + &ball("Material \"dielectric\" \"float eta\" 1.3 \"float roughness\" 0.2")
                    + &sphere_in_glass,
                (0.025, 0.12),
            ),
            ("lamp", ball(&wax(thin, roughness)) + &sphere(lamp, "0 0.8 0", 0.3), (0.04, 0.2)),
        ] {
            agree(
                &format!("{name}, roughness {roughness}"),
                "bdpt",
                &(FLOOR.to_owned() + &things),
                2048,
                limits,
            );
        }
    }
}

/// What is below depends on where a walk begins, or what gets in on the side: that is left to the eye.
#[test]
fn bodies_that_are_not_the_same_backwards_are_those_of_paths() {
    let checks = "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8 \
                  \"rgb tex1\" [0.9 0.2 0.2] \"rgb tex2\" [0.2 0.9 0.3]\n";
    let bodies = [
        ("textured", wax("\"texture reflectance\" \"t\" \"rgb mfp\" [0.1 0.1 0.1]", 0.25)),
        (
            "principled",
            "Material \"principled\" \"float subsurface\" 0.6 \"rgb subsurfaceradius\" [0.3 0.1 0.05] \
             \"rgb basecolor\" [0.8 0.5 0.4] \"float roughness\" 0.5"
                .to_owned(),
        ),
    ];
    let lamp =
        sphere("Material \"diffuse\" AreaLightSource \"diffuse\" \"rgb L\" [20 17 12]", "-0.9 2 -0.8", 0.3);
    for (name, body) in bodies {
        let world = format!("{checks}{FLOOR}{lamp}{}", ball(&body));
        agree(name, "bdpt", &world, 2048, (0.01, 0.05));
        agree(name, "light", &world, 4096, (0.02, 0.06));
        let sent = "\"bdpt\" \"string strategy\" \"3,1\" \"bool weighted\" false";
        assert_eq!(walked(&(checks.to_owned() + &ball(&body)), sent, 64), 0.0, "{name}");
        // The camera sees the lamp through the body, in which it begins.
        let view = "LookAt 0.1 0.9 -0.2  -0.9 2 -0.8  0 1 0\nCamera \"perspective\" \"float fov\" 60";
        let of = |word: &str| means(&picture(view, &format!("\"{word}\" {DEPTH}"), &world, 1024));
        let (all, pixels) = difference(&of("path"), &of("bdpt"));
        assert!(all.abs() < 0.02 && pixels < 0.1, "{name} from within: {all}, {pixels}");
    }
}

/// What a hole lets in and out walks, too.
#[test]
fn holes_let_light_walk() {
    let holes = "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 6 \"float vscale\" 6 \
                 \"float tex1\" 1 \"float tex2\" 0.3\n";
    for roughness in BOUNDARIES {
        let body = format!(
            "AttributeBegin {} Translate 0 0.8 0 Shape \"sphere\" \"float radius\" 0.8 \"texture alpha\" \"holes\" AttributeEnd\n",
            wax(WAX, roughness)
        );
        let world = format!("{holes}{FLOOR}{LAMP}{body}");
        agree(&format!("roughness {roughness}"), "bdpt", &world, 2048, (0.02, 0.13));
    }
}

/// Light of two bounces on a ball, of which all walks: nothing else is there.
fn walked(body: &str, how: &str, samples: u32) -> f64 {
    let up_to = |bounces: u32| {
        let integrator = format!("{how} \"integer maxdepth\" {bounces} \"integer roulettedepth\" 20");
        total(&of(&integrator, &(SKY.to_owned() + body), samples))
    };
    up_to(2) - up_to(1)
}

#[test]
fn each_strategy_alone_finds_all_light_that_walks() {
    for roughness in BOUNDARIES {
        let body = ball(&wax("\"rgb sigma_a\" [0.1 0.1 0.1] \"rgb sigma_s\" [6 6 6]", roughness));
        let expected = walked(&body, "\"path\"", 2048);
        let alone = |s: usize, weighted: bool, samples: u32| {
            let how = format!("\"bdpt\" \"string strategy\" \"{s},{}\" \"bool weighted\" {weighted}", 4 - s);
            walked(&body, &how, samples) / expected
        };
        let (met, sent) = (alone(0, false, 1024), alone(3, false, 6144));
        assert!((met - 1.0).abs() < 0.02, "{roughness}, met: {met}");
        match roughness {
            // Nothing is joined to what leaves a smooth boundary, as it is refracted.
            0.0 => assert_eq!(sent, 0.0),
            _ => assert!((sent - 1.0).abs() < 0.06, "{roughness}, sent: {sent}"),
        }
        // Nothing is joined in between.
        assert_eq!(alone(2, false, 16), 0.0);
        let sum = alone(0, true, 2048) + alone(3, true, 2048);
        assert!((sum - 1.0).abs() < 0.02, "{roughness}: {sum}");
    }
}

/// All that the camera at `from` sees of a lamp without extent at `to`, with or without facets, by the solid angles of pixels.
fn sent_across(integrator: &str, roughness: f32, [from, to]: [&str; 2]) -> f64 {
    const SIDE: u32 = 12;
    const FOV: f64 = 20.0;
    let stuff = "\"rgb sigma_a\" [0.1 0.3 0.6] \"rgb sigma_s\" [2 2 2]";
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" {SIDE} \"integer yresolution\" {SIDE}\n{BOX}\n\
         LookAt {from}  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" {FOV}\nIntegrator {integrator} {DEPTH}\n\
         WorldBegin\nLightSource \"spot\" \"point3 from\" [{to}] \"point3 to\" [0 0 0] \"float coneangle\" 12 \"float conedeltaangle\" 2 \"rgb I\" [100 100 100]\n{}",
        sphere(&wax(stuff, roughness), "0 0 0", 0.8)
    );
    let pixels = means(&scene(&text, &Options { samples: Some(4096), ..Options::default() }));
    let at = |i: usize| (2.0 * (i as f64 + 0.5) / f64::from(SIDE) - 1.0) * (FOV / 2.0).to_radians().tan();
    let side = SIDE as usize;
    let solid = |i: usize| (1.0 + at(i % side).powi(2) + at(i / side).powi(2)).powf(-1.5);
    pixels.iter().enumerate().map(|(i, pixel)| pixel.iter().sum::<f64>() * solid(i)).sum()
}

/// Particles do what paths do: camera and lamp may change places, and what is a path is a particle.
#[test]
fn particles_walk_as_paths_do_backwards() {
    let places = ["0 0 -6", "4.5 3 -2.4"];
    let back = [places[1], places[0]];
    for roughness in BOUNDARIES {
        let path = sent_across("\"path\"", roughness, places);
        let light = sent_across("\"light\"", roughness, back);
        // Wide facets bring more noise.
        let slack = if roughness == 0.25 { 0.07 } else { 0.02 };
        assert!((light / path - 1.0).abs() < slack, "{roughness}: {light}, path {path}");
        // All in all it is nearly the same the other way round.
        let same = sent_across("\"light\"", roughness, places);
        assert!((same / path - 1.0).abs() < slack, "{roughness}: {same}, path {path}");
    }
}

#[test]
fn light_sees_wide_facets_as_paths_do() {
    for (name, lights) in [("lamp", LAMP), ("point", POINT), ("sky", SKY)] {
        let world = format!("{FLOOR}{lights}{}", ball(&wax(WAX, 0.25)));
        agree(name, "light", &world, 6144, (0.02, 0.2));
    }
}

/// A furnace: `seen` by one pixel on a ball that loses nothing.
fn furnace(integrator: &str, material: &str, samples: u32) -> [f64; 3] {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n{BOX}\nLookAt 0 0 0  0 0 5  0 1 0\n\
         Camera \"perspective\" \"float fov\" 10\nIntegrator {integrator} \"integer maxdepth\" 100 \"integer roulettedepth\" 20\n\
         WorldBegin\n{SKY}{}",
        sphere(material, "0 0 5", 1.0)
    );
    let rendered = render(&scene(&text, &Options { samples: Some(samples), ..Options::default() }));
    assert!(rendered.imbalances.is_empty(), "{:?}", rendered.imbalances);
    rendered.film.pixels()[0].mean().map(f64::from)
}

#[test]
fn white_bodies_lose_nothing_from_either_end() {
    for sigma in ["0.5 0.5 0.5", "8 8 8", "2 4 8"] {
        let stuff = format!("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [{sigma}]");
        for found in furnace("\"bdpt\"", &wax(&stuff, 0.0), 4096) {
            assert!((found - 1.0).abs() < 0.03, "bdpt, {sigma}: {found}");
        }
    }
    // Particles do not bring what is mirrored, 1 / 36 there or a little more.
    let stuff = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [8 8 8]";
    let [found, ..] = furnace("\"light\"", &wax(stuff, 0.0), 400_000);
    assert!((found - (1.0 - 0.0285)).abs() < 0.015, "light: {found}");
}

#[test]
fn wavelengths_walk_from_both_ends_as_from_the_eye() {
    let world = format!(
        "{FLOOR}{LAMP}{}",
        ball(&wax("\"rgb sigma_a\" [0.02 0.1 0.4] \"rgb sigma_s\" [2 3 5]", 0.25))
    );
    let of = |word: &str, samples: u32| {
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n{BOX}\n{AHEAD}\nIntegrator \"{word}\" {DEPTH}\n\
             WorldBegin\n{world}"
        );
        let options =
            Options { samples: Some(samples), carried: Some(Carried::Wavelengths), ..Options::default() };
        means(&scene(&text, &options))
    };
    let expected = of("path", 8192);
    for word in ["bdpt", "light"] {
        let (all, pixels) = difference(&expected, &of(word, 4096));
        assert!(all.abs() < 0.02 && pixels < 0.1, "{word}: {all}, {pixels}");
    }
}

fn small(word: &str, roughness: f32, threads: usize) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n{AHEAD}\nIntegrator \"{word}\" {DEPTH}\n\
         WorldBegin\n{FLOOR}{LAMP}{POINT}{}",
        ball(&wax(WAX, roughness))
    );
    scene(&text, &Options { samples: Some(8), threads: Some(threads), ..Options::default() })
}

#[test]
fn threads_change_no_bit() {
    for word in ["bdpt", "light"] {
        for roughness in BOUNDARIES {
            let of = |threads| bits(&render(&small(word, roughness, threads)));
            assert_eq!(of(1), of(3), "{word}, {roughness}");
        }
    }
}

#[test]
fn pixels_are_their_trees_d1_d2() {
    for roughness in BOUNDARIES {
        for word in ["bdpt", "light"] {
            let scene = small(word, roughness, 1);
            let (mut walked, mut replayed) = (0, 0);
            for i in 0..150u32 {
                let (pixel, sample) = ([6 + (i * 7) % 12, 2 + (i * 5) % 12], i % 8);
                let (tree, rgb) = scene.job().record(pixel, sample);
                assert_eq!(scene.job().value(pixel, sample), rgb, "{word} {pixel:?}");
                assert_eq!(Basis::Rgb.to_rgb(tree.fold()), rgb, "{word} {pixel:?}");
                let mut sum = [0.0f64; 3];
                for (index, node) in tree.nodes.iter().enumerate() {
                    let own = Basis::Rgb.to_rgb(node.contribution());
                    sum.iter_mut().zip(own).for_each(|(sum, c)| *sum += f64::from(c));
                    walked += usize::from(node.path.below.is_some() && node.particle().is_some());
                    let Some(again) = scene.job().replay(&tree, index as u32) else { continue };
                    assert_eq!(again.nodes[0].result, node.result, "{word} {pixel:?}, ray {index}");
                    assert_eq!(again.nodes[0].floating, node.floating, "{word} {pixel:?}, ray {index}");
                    replayed += 1;
                }
                for (sum, v) in sum.iter().zip(rgb.map(f64::from)) {
                    assert!((sum - v).abs() <= 1e-5 * v.max(1.0), "{word} {pixel:?}: {sum} is not {v}");
                }
            }
            assert!(
                walked > if word == "bdpt" { 100 } else { 3 } && replayed >= 150,
                "{word}: {walked} {replayed}"
            );
        }
    }
}

#[test]
fn who_walks_from_both_ends_does_not_complain() {
    for (word, says) in [("bdpt", false), ("light", false), ("sppm", true)] {
        let mut imported =
            import(&format!("Integrator \"{word}\"\nWorldBegin\n{LAMP}{}", ball(&wax(WAX, 0.0))));
        durer::prepare(&mut imported, &Options::default());
        let said = imported.diagnostics.iter().any(|d| d.message.contains("does not follow light below"));
        assert_eq!(said, says, "{word}");
    }
}
