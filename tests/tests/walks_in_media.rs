//! Walks from both ends scatter in media: the pictures of `volpath`, in colours and in wavelengths, in all ways at once and
//! in each alone; and closed forms.
use durer::{Options, Prepared, spectrum::Carried};
use durer_tests::{
    bits, render, scene,
    small::{AHEAD, BOX, LAMP, THINGS, difference, means, total},
};

const NAMES: [&str; 2] = ["bdpt", "light"];

fn taken(text: &str, samples: u32, carried: Carried) -> Prepared {
    scene(text, &Options { samples: Some(samples), carried: Some(carried), ..Options::default() })
}

/// A picture of 12 x 8 pixels, with media made before the camera.
fn picture(integrator: &str, media: &str, world: &str, (samples, carried): (u32, Carried)) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n{media}\n{AHEAD}\n{BOX}\n\
         Integrator {integrator}\nWorldBegin\n{world}"
    );
    taken(&text, samples, carried)
}

/// Both make the picture of `volpath`, within the limits of [`difference`]: all light, and pixels.
fn agree(name: &str, (media, world): (&str, &str), take: (u32, Carried), limits: [(f64, f64); 2]) {
    let depth = "\"integer maxdepth\" 4 \"integer roulettedepth\" 20";
    let of = |word: &str, take| means(&picture(&format!("\"{word}\" {depth}"), media, world, take));
    let expected = of("volpath", (2 * take.0, take.1));
    assert!(total(&expected) > 1e-3, "{name} is dark");
    for (word, (bias, error)) in NAMES.into_iter().zip(limits) {
        let (all, pixels) = difference(&expected, &of(word, take));
        assert!(all.abs() < bias && pixels < error, "{name}, {word}: {all}, pixels {pixels}");
    }
}

/// A medium called fog.
fn fog(params: &str) -> String {
    format!("MakeNamedMedium \"fog\" {params}\n")
}

/// It fills a box around things, of which nothing but fog begins and ends there.
const FILLED: &str = "AttributeBegin Material \"interface\" MediumInterface \"fog\" \"\"\n\
    Shape \"trianglemesh\" \"integer indices\" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 5]\n\
    \"point3 P\" [-1.8 0.01 -1.8  1.8 0.01 -1.8  -1.8 1.8 -1.8  1.8 1.8 -1.8  -1.8 0.01 1.8  1.8 0.01 1.8  -1.8 1.8 1.8  1.8 1.8 1.8]\n\
    AttributeEnd\n";

const EVEN: &str = "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.05 0.1 0.05] \"rgb sigma_s\" [0.4 0.4 0.4] \"float g\" 0.4";
const CHROMATIC: &str =
    "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.02 0.05 0.3] \"rgb sigma_s\" [0.1 0.5 1.5]";
const EMBER: &str = "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.3 0.4 0.5] \"rgb sigma_s\" [0.5 0.5 0.5] \"rgb Le\" [0.5 0.3 0.1]";

/// A kind of grid in the box that is filled.
fn grid(kind: &str, params: &str) -> String {
    format!("\"string type\" \"{kind}\" \"point3 p0\" [-1.8 0 -1.8] \"point3 p1\" [1.8 1.8 1.8] {params}")
}

fn grids() -> [(&'static str, String); 3] {
    let uneven = "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"float density\" [0.3 1 0 0.8 0.5 0.1 0.9 0.4]\n\
        \"rgb sigma_s\" [0.8 1 1.2] \"rgb sigma_a\" [0.1 0.1 0.1] \"float g\" 0.3";
    let colours =
        "\"integer nx\" 2 \"rgb sigma_s\" [0.3 0.9 1.2  1 0.1 0.4] \"rgb sigma_a\" [0.1 0.1 0  0 0.1 0.2]";
    let cloud = "\"rgb sigma_s\" [1.5 1.5 1.5] \"rgb sigma_a\" [0.1 0.1 0.1] \"float density\" 1 \"float frequency\" 2";
    [
        ("uniformgrid", grid("uniformgrid", uneven)),
        ("rgbgrid", grid("rgbgrid", colours)),
        ("cloud", grid("cloud", cloud)),
    ]
}

/// Most of the noise is that of paths, near lamps.
const WALKS: [(f64, f64); 2] = [(0.03, 0.15), (0.03, 0.15)];

#[test]
fn e14_fog_around_things_is_that_of_paths() {
    let world = |lights: &str| format!("{}{lights}{THINGS}{FILLED}", fog(EVEN));
    let from = "\"point3 from\" [1 3 -2]";
    for (name, lights) in [
        ("lamp", LAMP.to_owned()),
        ("lamp in it", "AttributeBegin Translate 0.8 1.4 -0.6 AreaLightSource \"diffuse\" \"rgb L\" [4 3 2] Shape \"sphere\" \"float radius\" 0.35 AttributeEnd\n".to_owned()),
        ("distant", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1]\n")),
        ("sky", "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.6]\n".to_owned()),
        ("disk", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1] \"float angle\" 30\n")),
    ] {
        agree(name, ("", &world(&lights)), (512, Carried::Rgb), WALKS);
    }
}

/// Paths ask a point from places that may lie as near as any: particles from there make the same picture as all walks.
#[test]
fn points_in_fog_light_it() {
    let point = "LightSource \"point\" \"point3 from\" [0.2 1.5 -0.9] \"rgb I\" [3 3 2]\n";
    let world = format!("{}{point}{THINGS}{FILLED}", fog(EVEN));
    let depth = "\"integer maxdepth\" 4 \"integer roulettedepth\" 20";
    let of = |word| means(&picture(&format!("\"{word}\" {depth}"), "", &world, (768, Carried::Rgb)));
    let (all, pixels) = difference(&of("light"), &of("bdpt"));
    assert!(all.abs() < 0.02 && pixels < 0.1, "{all}, pixels {pixels}");
}

/// A beam below a glass ball under a small lamp: particles and all walks make the same picture of it, paths hardly any.
#[test]
fn a_caustic_in_fog_is_found_from_the_light() {
    let beam = "AttributeBegin Translate 0 5 0 Rotate 90 1 0 0 AreaLightSource \"diffuse\" \"rgb L\" [3000 2500 2000]\n\
        Shape \"disk\" \"float radius\" 0.05 AttributeEnd\n\
        AttributeBegin Material \"dielectric\" \"float eta\" 1.5 Translate 0 3.9 0 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd\n";
    let world = format!("{}{beam}{THINGS}{FILLED}", fog(EVEN));
    let depth = "\"integer maxdepth\" 4 \"integer roulettedepth\" 20";
    let of = |word| means(&picture(&format!("\"{word}\" {depth}"), "", &world, (512, Carried::Rgb)));
    let [paths, light, both] = ["volpath", "light", "bdpt"].map(of);
    let (all, pixels) = difference(&light, &both);
    assert!(all.abs() < 0.02 && pixels < 0.1, "{all}, pixels {pixels}");
    let (_, lost) = difference(&light, &paths);
    assert!(lost > 5.0 * pixels, "paths are off by {lost}, walks from both ends by {pixels}");
}

/// The same under a lamp that paths meet: all light of the beam is theirs, and none of it is other than the lamp's by glass.
#[test]
fn a_caustic_in_fog_under_a_wide_lamp_is_that_of_paths() {
    let beam = |glass: &str| {
        format!(
            "AttributeBegin Translate 0 5 0 Rotate 90 1 0 0 AreaLightSource \"diffuse\" \"rgb L\" [5 4 3]\n\
             Shape \"disk\" \"float radius\" 1.2 AttributeEnd\n\
             AttributeBegin {glass} Translate 0 3.9 0 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd\n{THINGS}{FILLED}"
        )
    };
    let glass = beam("Material \"dielectric\" \"float eta\" 1.5");
    let (samples, bias) =
        if std::env::var_os("DURER_SLOW").is_some() { (32_768, 0.005) } else { (2048, 0.025) };
    let world = format!("{}{glass}", fog(EVEN));
    agree("beam", ("", &world), (samples, Carried::Rgb), [(bias, 0.2), (bias, 0.2)]);
    let dark = format!("{}{}", fog(EVEN), beam("Material \"diffuse\" \"rgb reflectance\" [0 0 0]"));
    let of = |world: &str| {
        total(&means(&picture("\"bdpt\" \"integer maxdepth\" 4", "", world, (256, Carried::Rgb))))
    };
    let (all, straight) = (of(&world), of(&dark));
    assert!(straight < 0.8 * all, "glass brings next to nothing: {all}, without it {straight}");
}

#[test]
fn grids_and_clouds_are_those_of_paths() {
    for (name, params) in grids() {
        let world = format!("{}{LAMP}{THINGS}{FILLED}", fog(&params));
        agree(name, ("", &world), (512, Carried::Rgb), WALKS);
    }
}

/// The camera, the lamp and everything else are in it, and it has no end: as the file says.
#[test]
fn everything_may_lie_in_fog() {
    let media =
        fog("\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.02 0.02 0.02] \"rgb sigma_s\" [0.1 0.1 0.1]")
            + "MediumInterface \"\" \"fog\"";
    agree("all", (&media, &format!("{LAMP}{THINGS}")), (768, Carried::Rgb), [(0.02, 0.25), (0.03, 0.3)]);
}

/// Bodies of glass and of nothing, with fog in them, one in the other.
#[test]
fn fog_within_bodies_and_between_them_is_that_of_paths() {
    let milk = fog(
        "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.1 0.2 0.3] \"rgb sigma_s\" [3 3 3] \"float g\" 0.5",
    );
    let lamp = "AttributeBegin Translate 0 3 0 Rotate 90 1 0 0 AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] Shape \"disk\" \"float radius\" 1.5 AttributeEnd\n";
    let any = (f64::INFINITY, f64::INFINITY);
    for (name, body, particles) in [
        ("rough glass", "Material \"dielectric\" \"float eta\" 1.2 \"float roughness\" 0.4", (0.09, 0.5)),
        ("paper", "Material \"diffusetransmission\"", (0.03, 0.1)),
        // No particle is seen through what is sharp.
        (
            "clear and absorbing",
            "Material \"dielectric\" \"float eta\" 1 \"rgb absorption\" [0.5 0.2 0.1]",
            any,
        ),
    ] {
        let body = format!(
            "AttributeBegin {body} MediumInterface \"fog\" \"\" Translate -0.3 1.2 -0.8 Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n"
        );
        let world = format!("{milk}{lamp}{THINGS}{body}");
        agree(name, ("", &world), (768, Carried::Rgb), [(0.03, 0.15), particles]);
    }
}

#[test]
fn lanes_that_scatter_differently_are_each_right() {
    for (name, carried) in [("colours", Carried::Rgb), ("wavelengths", Carried::Wavelengths)] {
        let world = format!("{}{LAMP}{THINGS}{FILLED}", fog(CHROMATIC));
        agree(name, ("", &world), (1024, carried), [(0.02, 0.1), (0.02, 0.1)]);
    }
}

#[test]
fn wavelengths_see_the_same_fog_smoke_and_drops() {
    let drops = "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [0.5 0.5 0.5] \"string phase\" \"waterdrops\"";
    let [(_, smoke), ..] = grids();
    for (name, params) in [("fog", EVEN), ("smoke", &smoke), ("drops", drops)] {
        let world = format!("{}{LAMP}{THINGS}{FILLED}", fog(params));
        agree(name, ("", &world), (768, Carried::Wavelengths), [(0.02, 0.12), (0.02, 0.12)]);
    }
}

/// How flakes send light depends on the direction that it comes from: paths from lamps are weighed for that.
#[test]
fn flakes_tables_and_mixtures_are_the_same_from_both_ends() {
    let cloth = "\"string phase\" \"sggx\" \"float phasevalues\" [0.04 1 0.3  0.05 0 0.1]";
    let table = "\"string phase\" \"table\" \"float phasevalues\" [0.3 0 0.2 2]";
    let mixed = "\"string phase\" \"blend\" \"string phases\" [\"henyeygreenstein 0.7\" \"sggx 1 0.03 1 0 0 0\" \"waterdrops\"] \
        \"float phaseweights\" [1 0.5 0.5  0 2 1] \"integer phasesize\" [2 1 1]";
    for (name, phase) in [("cloth", cloth), ("table", table), ("mixed", mixed)] {
        let even =
            "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.05 0.05 0.05] \"rgb sigma_s\" [0.7 0.7 0.7]";
        let world = format!("{}{LAMP}{THINGS}{FILLED}", fog(&format!("{even} {phase}")));
        agree(name, ("", &world), (1024, Carried::Rgb), [(0.02, 0.1), (0.02, 0.1)]);
    }
}

/// What glows is seen by itself, and by what it lights.
#[test]
fn what_glows_is_seen() {
    let glowing = format!("{}{LAMP}{THINGS}{FILLED}", fog(EMBER));
    for carried in [Carried::Rgb, Carried::Wavelengths] {
        agree("ember", ("", &glowing), (768, carried), [(0.02, 0.07), (0.02, 0.1)]);
    }
    let straight = |word: &str| {
        let grid = grid(
            "uniformgrid",
            "\"integer nz\" 2 \"float density\" [1 0.2] \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0.5 0 1] \"rgb Le\" [2 1 1]",
        );
        let world = format!("{}{LAMP}{THINGS}{FILLED}", fog(&grid));
        means(&picture(&format!("\"{word}\" \"integer maxdepth\" 0"), "", &world, (512, Carried::Rgb)))
    };
    let expected = straight("volpath");
    for word in NAMES {
        let (all, pixels) = difference(&expected, &straight(word));
        assert!(all.abs() < 0.01 && pixels < 0.05, "{word}: {all}, pixels {pixels}");
    }
}

/// A picture of one spot of a ball of fog, five metres ahead, under a sky of 1.
fn ball(integrator: &str, params: &str, samples: u32) -> [f64; 3] {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt 0 0 0  0 0 5  0 1 0\nCamera \"perspective\" \"float fov\" 20\nIntegrator {integrator}\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [1 1 1]\n{}\
         AttributeBegin Material \"interface\" MediumInterface \"fog\" \"\" Translate 0 0 5 Shape \"sphere\" AttributeEnd",
        fog(params)
    );
    render(&taken(&text, samples, Carried::Rgb)).film.pixels()[0].mean().map(f64::from)
}

/// A furnace: where nothing is lost fog disappears in a sky that is the same everywhere.
#[test]
fn where_nothing_is_lost_fog_disappears_in_a_uniform_sky() {
    let all = "\"integer maxdepth\" 200 \"integer roulettedepth\" 200";
    for (sigma, g) in [("0.3 0.3 0.3", 0.0), ("3 3 3", 0.7), ("0.2 1 3", 0.0)] {
        let params = format!(
            "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [{sigma}] \"float g\" {g}"
        );
        for word in NAMES {
            // Few particles are seen.
            let samples = if word == "light" { 65_536 } else { 8192 };
            let found = ball(&format!("\"{word}\" {all}"), &params, samples);
            for found in found {
                assert!((found - 1.0).abs() < 0.03, "{word}, sigma {sigma}, g {g}: {found}");
            }
        }
    }
}

/// A box that glows within, with a ball of fog before the camera that loses nothing.
fn glowing_box(integrator: &str, samples: u32) -> f64 {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n\
         LookAt 0.9 0.8 0.7  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\n{BOX}\n\
         Integrator {integrator}\nWorldBegin\n{}\
         AttributeBegin Material \"interface\" MediumInterface \"fog\" \"\" Shape \"sphere\" \"float radius\" 0.7 AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n\
         Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]\n\
         \"integer indices\" [0 1 2  0 2 3  4 6 5  4 7 6  0 5 1  0 4 5  3 2 6  3 6 7  0 3 7  0 7 4  1 5 6  1 6 2]",
        fog(
            "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" 0.3"
        )
    );
    total(&means(&taken(&text, samples, Carried::Rgb)))
}

fn of_strategy(s: usize, t: usize, weighted: bool, samples: u32) -> f64 {
    let integrator = format!(
        "\"bdpt\" \"integer maxdepth\" 8 \"integer roulettedepth\" 20 \"string strategy\" \"{s},{t}\" \"bool weighted\" {weighted}"
    );
    glowing_box(&integrator, samples)
}

/// All light of so many bounces, as paths find it.
fn by_paths(bounces: usize) -> f64 {
    let up_to = |depth: usize| {
        let integrator = format!("\"volpath\" \"integer maxdepth\" {depth} \"integer roulettedepth\" 20");
        glowing_box(&integrator, 1024)
    };
    up_to(bounces) - up_to(bounces - 1)
}

/// Each way to find a path, as if it were the only one, finds all light of as many bounces; and all together do by their
/// shares.
#[test]
fn each_strategy_alone_finds_all_light_of_its_bounces_in_fog() {
    for k in 1..4usize {
        let expected = by_paths(k);
        for s in 0..=k + 1 {
            // Edges may be short: their squared inverse has a long tail.
            let slack = if s >= 2 { 0.08 } else { 0.03 };
            let found = of_strategy(s, k + 2 - s, false, 384);
            assert!((found / expected - 1.0).abs() < slack, "{s}, bounces {k}: {found}, expected {expected}");
        }
        let sum: f64 = (0..=k + 1).map(|s| of_strategy(s, k + 2 - s, true, 128)).sum();
        assert!((sum / expected - 1.0).abs() < 0.025, "{k} bounces: {sum}, expected {expected}");
    }
}

#[test]
fn pictures_do_not_depend_on_threads() {
    let [(_, smoke), ..] = grids();
    let world = format!("{}{LAMP}{THINGS}{FILLED}", fog(&smoke));
    for word in NAMES {
        let of = |threads: usize| {
            let mut scene = picture(&format!("\"{word}\""), "", &world, (20, Carried::Rgb));
            scene.settings.threads = threads;
            bits(&render(&scene))
        };
        assert_eq!(of(1), of(3), "{word}");
    }
}
