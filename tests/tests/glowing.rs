//! Media that glow send particles: they light walls as paths find it, in every way that walks can be joined, and as far as a
//! formula says.
use std::f64::consts::PI;

use durer::{Options, Prepared, spectrum::Carried};
use durer_tests::{
    scene,
    small::{AHEAD, BOX, THINGS, difference, means, total},
};

const DEPTH: &str = "\"integer maxdepth\" 4 \"integer roulettedepth\" 20";

/// A picture of 12 x 8 pixels.
fn picture((view, integrator, world): (&str, &str, &str), samples: u32, carried: Carried) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n{view}\n{BOX}\nIntegrator {integrator}\n\
         WorldBegin\n{world}"
    );
    scene(&text, &Options { samples: Some(samples), carried: Some(carried), ..Options::default() })
}

/// A ball of it over things on a floor.
fn ball(medium: &str) -> String {
    format!(
        "MakeNamedMedium \"fire\" {medium}\nAttributeBegin Material \"interface\" MediumInterface \"fire\" \"\"\n\
         Translate 0 1.6 -0.4 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n{THINGS}"
    )
}

/// All light that `volpath` finds is found by the others, within `limits` as a whole and pixel by pixel.
fn agree(name: &str, world: &str, (samples, carried): (u32, Carried), limits: (f64, f64)) {
    let of = |word: &str, samples| {
        means(&picture((AHEAD, &format!("\"{word}\" {DEPTH}"), world), samples, carried))
    };
    let expected = of("volpath", 2 * samples);
    assert!(total(&expected) > 1e-3, "{name} is dark");
    for word in ["bdpt", "light"] {
        let (all, pixels) = difference(&expected, &of(word, samples));
        assert!(all.abs() < limits.0 && pixels < limits.1, "{name}, {word}: {all}, pixels {pixels}");
    }
}

fn samples() -> u32 {
    if std::env::var_os("DURER_SLOW").is_some() { 8192 } else { 512 }
}

/// A grid of the box around the ball, which shows but a part of it.
fn grid(params: &str) -> String {
    format!("\"string type\" \"uniformgrid\" \"point3 p0\" [-0.6 1 -1] \"point3 p1\" [0.7 2.3 0.2] {params}")
}

const GAS: &str =
    "\"string type\" \"homogeneous\" \"rgb sigma_a\" [0.5 0.7 1] \"rgb Le\" [30 15 5] \"rgb sigma_s\"";
const DENSITY: &str =
    "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"float density\" [0 1 0.5 2  0 0.3 1 0]";

#[test]
fn a_ball_of_gas_lights_what_lies_around_it() {
    let clear = format!("{GAS} [0 0 0]");
    let smoke = format!("{GAS} [2 2 2]");
    let thick = "\"string type\" \"homogeneous\" \"rgb sigma_a\" [20 30 40] \"rgb Le\" [3 2 1] \"rgb sigma_s\" [5 5 5]";
    for (name, medium) in [("clear", &*clear), ("smoke", &smoke), ("thick", thick)] {
        agree(name, &ball(medium), (samples(), Carried::Rgb), (0.02, 0.15));
    }
    agree("wavelengths", &ball(&smoke), (samples(), Carried::Wavelengths), (0.02, 0.15));
}

#[test]
fn fire_lights_what_lies_around_it() {
    let flame =
        grid(&format!("{DENSITY} \"rgb sigma_a\" [1 1.5 2] \"rgb sigma_s\" [1 1 1] \"rgb Le\" [20 10 5]"));
    let hot = grid(&format!(
        "{DENSITY} \"rgb sigma_a\" [9 9 9] \"rgb sigma_s\" [1 1 1] \"float temperature\" [6000 4500 900 0  2700 5400 7500 60]"
    ));
    let painted = "\"string type\" \"rgbgrid\" \"point3 p0\" [-0.6 1 -1] \"point3 p1\" [0.7 2.3 0.2] \"integer nx\" 2\n\
        \"rgb sigma_a\" [1 0.5 0.1  0.1 2 2] \"rgb sigma_s\" [0.5 0.5 0.5  1 2 3] \"rgb Le\" [9 9 9  20 1 9]";
    for (name, medium) in [("flame", &*flame), ("hot", &hot), ("painted", painted)] {
        agree(name, &ball(medium), (samples(), Carried::Rgb), (0.02, 0.25));
    }
}

/// Lamps shine too, the ball moves, and the gas has a surface on one side only: a window, behind which it ends at walls.
#[test]
fn what_glows_may_lie_anywhere() {
    let gas = format!("MakeNamedMedium \"fire\" {GAS} [0.2 0.2 0.2]\n");
    let lamp = "LightSource \"point\" \"point3 from\" [1 3 -2] \"rgb I\" [9 8 7]\n";
    let moving = "AttributeBegin Material \"interface\" MediumInterface \"fire\" \"\" ActiveTransform EndTime Translate 0.8 0 0 \
        ActiveTransform All Translate 0 1.6 -0.4 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n";
    let window = "AttributeBegin MediumInterface \"fire\" \"\" Material \"interface\"\n\
        Shape \"bilinearmesh\" \"point3 P\" [2 0 -2  -2 0 -2  2 3 -2  -2 3 -2] AttributeEnd\n\
        Material \"diffuse\" \"rgb reflectance\" [0.3 0.3 0.3]\n\
        Shape \"bilinearmesh\" \"point3 P\" [-2 0 -2  -2 0 2  -2 3 -2  -2 3 2]\n\
        Shape \"bilinearmesh\" \"point3 P\" [2 0 -2  2 0 2  2 3 -2  2 3 2]\n\
        Shape \"bilinearmesh\" \"point3 P\" [-2 0 2  2 0 2  -2 3 2  2 3 2]\n\
        Shape \"bilinearmesh\" \"point3 P\" [-2 3 -2  -2 3 2  2 3 -2  2 3 2]\n";
    for (name, world) in [
        ("beside a lamp", format!("{lamp}{}", ball(&format!("{GAS} [0 0 0]")))),
        ("moving", format!("{gas}{moving}{THINGS}")),
        ("behind a window", format!("{gas}{window}{THINGS}")),
    ] {
        // Where the camera is in the gas, particles may scatter as near to it as any.
        let pixels = if name == "behind a window" { 0.6 } else { 0.1 };
        agree(name, &world, (2 * samples(), Carried::Rgb), (0.03, pixels));
    }
}

/// A thin ball of gas far away: it is a point of `4 pi sigma_a Le V`, of which a place at distance `r` and height `h` gets the
/// irradiance `P h / (4 pi r³)`.
#[test]
fn a_small_thin_ball_is_a_point_of_the_power_it_sends() {
    let (radius, sigma, le, albedo) = (0.1f64, 0.05f64, 3e3f64, 0.5f64);
    let ball = [0.8, 1.0, 0.1];
    let world = format!(
        "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [{sigma} {sigma} {sigma}]\n\
         \"rgb sigma_s\" [0 0 0] \"rgb Le\" [{le} {le} {le}]\n\
         AttributeBegin Material \"interface\" MediumInterface \"fire\" \"\" Translate {} {} {}\n\
         Shape \"sphere\" \"float radius\" {radius} AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [{albedo} {albedo} {albedo}]\n\
         Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  -1 0 1  1 0 -1  1 0 1]",
        ball[0], ball[1], ball[2]
    );
    let view = "LookAt 0 0.5 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40";
    let power = 4.0 * PI * sigma * le * 4.0 / 3.0 * PI * radius.powi(3);
    let half = 0.5 * 20f64.to_radians().tan();
    let mut expected = 0.0;
    const STEPS: usize = 60;
    for i in 0..STEPS * STEPS {
        let at = |i: usize| (i as f64 + 0.5) / STEPS as f64 * 2.0 - 1.0;
        let (x, z) = (1.5 * half * at(i % STEPS), half * at(i / STEPS));
        let r = ((x - ball[0]).powi(2) + ball[1].powi(2) + (z - ball[2]).powi(2)).sqrt();
        expected += albedo / PI * power * ball[1] / (4.0 * PI * r.powi(3)) / (STEPS * STEPS) as f64;
    }
    for (word, samples) in [("bdpt", 4096), ("light", 16_384)] {
        let depth = format!("\"{word}\" \"integer maxdepth\" 1");
        let found = total(&means(&picture((view, &depth, &world), samples, Carried::Rgb)));
        assert!((found / expected - 1.0).abs() < 0.03, "{word}: {found}, expected {expected}");
    }
}

/// All of the light in a box that a ball of gas in it sends, by one way to find it.
fn in_a_box(sigma_s: &str, integrator: &str, samples: u32) -> f64 {
    let view = "LookAt 0.9 0.8 0.7  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40";
    let world = format!(
        "MakeNamedMedium \"fire\" {GAS} [{sigma_s}]\n\
         AttributeBegin Material \"interface\" MediumInterface \"fire\" \"\" Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
         Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]\n\
         \"integer indices\" [0 1 2  0 2 3  4 6 5  4 7 6  0 5 1  0 4 5  3 2 6  3 6 7  0 3 7  0 7 4  1 5 6  1 6 2]"
    );
    total(&means(&picture((view, integrator, &world), samples, Carried::Rgb)))
}

/// Without particles that scatter: edges between two of them may be as short as any, and their squared inverse has a tail
/// without an end.
const CLEAR: &str = "0 0 0";
const SMOKE: &str = "1 1 1";

fn of_strategy(sigma_s: &str, (s, t): (usize, usize), weighted: bool, samples: u32) -> f64 {
    let integrator = format!(
        "\"bdpt\" \"integer maxdepth\" 8 \"integer roulettedepth\" 20 \"string strategy\" \"{s},{t}\" \"bool weighted\" {weighted}"
    );
    in_a_box(sigma_s, &integrator, samples)
}

/// All light of so many bounces, as paths find it.
fn by_paths(sigma_s: &str, bounces: usize) -> f64 {
    let up_to = |depth: usize| {
        let integrator = format!("\"volpath\" \"integer maxdepth\" {depth} \"integer roulettedepth\" 20");
        in_a_box(sigma_s, &integrator, 4096)
    };
    up_to(bounces) - up_to(bounces - 1)
}

/// Each way to find a path, as if it were the only one, finds all light of as many bounces; and all together do by their
/// shares. One that asks for what glows there is not.
#[test]
fn each_strategy_alone_finds_all_light_that_gas_sends() {
    for k in 1..4usize {
        let expected = by_paths(CLEAR, k);
        for s in (0..=k + 1).filter(|s| *s != 1) {
            let found = of_strategy(CLEAR, (s, k + 2 - s), false, 512);
            assert!((found / expected - 1.0).abs() < 0.05, "{s}, bounces {k}: {found}, expected {expected}");
        }
        for sigma_s in [CLEAR, SMOKE] {
            let expected = by_paths(sigma_s, k);
            let sum: f64 = (0..=k + 1).map(|s| of_strategy(sigma_s, (s, k + 2 - s), true, 512)).sum();
            assert!((sum / expected - 1.0).abs() < 0.02, "{k} bounces: {sum}, expected {expected}");
        }
    }
}
