//! Photon mapping: the pictures of paths, what photons bring in closed form, and what no other way finds.
use durer::{Options, Prepared, film::Tile, spectrum::Carried};
use durer_tests::{
    bits, import, render, scene,
    small::{AHEAD, BOX, LAMP, THINGS, difference, means, picture, total},
};

/// Small discs, and many photons all the same: few of those of a lamp in the open are scattered twice.
const FINE: &str = "\"float radius\" 0.2 \"integer photonsperiteration\" 2000";

fn agrees(name: &str, world: &str, limits: (f64, f64)) {
    let of = |integrator: &str| {
        let integrator = format!("{integrator} \"integer maxdepth\" 4");
        means(&picture(&format!("{AHEAD}\n{BOX}"), &integrator, world, 256))
    };
    let (path, found) = (of("\"path\""), of(&format!("\"sppm\" {FINE}")));
    let (bias, error) = difference(&path, &found);
    assert!(total(&path) > 1e-3, "{name} is dark");
    assert!(bias.abs() < limits.0 && error < limits.1, "{name}: {bias}, pixels {error}\n{path:?}\n{found:?}");
}

#[test]
fn photons_bring_what_paths_find_with_every_light() {
    let from = "\"point3 from\" [1 3 -2] \"point3 to\" [0 0 0]";
    for (name, lights) in [
        ("lamp", LAMP.to_owned()),
        ("point", "LightSource \"point\" \"point3 from\" [1 3 -2] \"rgb I\" [9 8 7]".to_owned()),
        ("distant", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1]")),
        ("even sky", "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.6]".to_owned()),
        (
            "many",
            format!(
                "{LAMP}LightSource \"point\" \"point3 from\" [-2 2 -2] \"rgb I\" [2 3 4]\nLightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1]"
            ),
        ),
    ] {
        agrees(name, &format!("{lights}\n{THINGS}"), (0.015, 0.1));
    }
}

#[test]
fn surfaces_change_nothing_of_it() {
    let under = |ball: &str| format!("{LAMP}{THINGS}AttributeBegin Translate 0 1.6 -0.6 {ball} AttributeEnd");
    for (name, ball) in [
        ("glass", "Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\" \"float radius\" 0.5"),
        ("coated", "Material \"coateddiffuse\" Shape \"sphere\" \"float radius\" 0.5"),
        ("translucent", "Material \"diffusetransmission\" Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1"),
        (
            "half there",
            "Material \"diffuse\" Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1 \"float alpha\" 0.4",
        ),
        (
            "moving",
            "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.4",
        ),
    ] {
        // Below the glass ball lies a caustic, which discs blur; a pass has but one moment.
        let limits = if ["glass", "moving"].contains(&name) { (0.03, 0.2) } else { (0.02, 0.1) };
        agrees(name, &under(ball), limits);
    }
}

/// Such a ball is matte and narrowly clear from outside, and narrow only from inside, where light comes to be let out.
#[test]
fn what_comes_through_a_half_clear_ball_is_gathered_outside() {
    let view = format!("LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\n{BOX}");
    let world = "LightSource \"infinite\"\nMaterial \"disney\" \"float spectrans\" 0.7 \"float roughness\" 0.3\n\
        Shape \"sphere\" \"float radius\" 0.6";
    let of = |integrator: &str| {
        total(&means(&picture(&view, &format!("{integrator} \"integer maxdepth\" 2"), world, 128)))
    };
    let (path, found) =
        (of("\"path\""), of("\"sppm\" \"float radius\" 0.05 \"integer photonsperiteration\" 4000"));
    assert!((found / path - 1.0).abs() < 0.03, "{found}, expected {path}");
}

/// Strands keep no photons: eye rays go on among them as paths do.
#[test]
fn light_goes_from_strand_to_strand_as_on_paths() {
    let mut world =
        format!("{LAMP}Material \"hair\" \"rgb sigma_a\" [0 0 0] Attribute \"shape\" \"float width\" 0.16\n");
    for i in 0..48 {
        let (x, y, z) =
            (f64::from(i % 12) * 0.12 - 0.7, 0.4 + f64::from(i / 12) * 0.2, f64::from(i / 12) * 0.1);
        world += &format!(
            "Shape \"curve\" \"point3 P\" [{x} {y} -1  {} {y} {}  {} {y} {z}  {x} {y} 1]\n",
            x + 0.2,
            z - 0.4,
            x - 0.2
        );
    }
    agrees("hair", &world, (0.02, 0.1));
}

/// E1: in a closed box that glows all light is `L / (1 - a)`, bounce by bounce. On a sphere a ball of radius r about a point
/// covers `pi r²` (Archimedes): nothing is blurred away.
#[test]
fn e1_a_glowing_sphere_gives_a_geometric_series() {
    let view =
        format!("LookAt 0.2 0.1 0.3  1 0.5 0.2  0 0 1\nCamera \"perspective\" \"float fov\" 60\n{BOX}");
    let world = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n\
        ReverseOrientation\nShape \"sphere\"";
    for (depth, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (5, 1.968_75)] {
        let more = "\"float radius\" 0.3 \"integer photonsperiteration\" 1000 \"integer roulettedepth\" 1";
        let integrator = format!("\"sppm\" \"integer maxdepth\" {depth} {more}");
        let found = total(&means(&picture(&view, &integrator, world, 128)));
        assert!((found / expected - 1.0).abs() < 6e-3, "depth {depth}: {found}, expected {expected}");
    }
}

/// In a mirror the same walls have a bounce less to collect light by, whoever brings it.
#[test]
fn bounces_of_eye_and_photon_count_together() {
    let view = format!("LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 30\n{BOX}");
    let world = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
        AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nReverseOrientation\nShape \"sphere\" AttributeEnd\n\
        Material \"conductor\" \"rgb reflectance\" [1 1 1] \"float roughness\" 0\n\
        Translate 0 0 0.5 Shape \"disk\" \"float radius\" 0.4";
    let of = |integrator: &str| {
        total(&means(&picture(&view, &format!("{integrator} \"integer maxdepth\" 2"), world, 128)))
    };
    let (path, found) =
        (of("\"path\""), of("\"sppm\" \"float radius\" 0.3 \"integer photonsperiteration\" 1000"));
    assert!((found / path - 1.0).abs() < 0.01, "{found}, expected {path}");
}

/// A pane, 0.4 m thick and 1 m above a dark floor, in the sun 40 degrees from its normal.
fn under_a_pane(view: &str, integrator: &str, glass: &str, options: &Options) -> f64 {
    let corners = "\"point3 P\" [-4 1 -4  4 1 -4  4 1.4 -4  -4 1.4 -4  -4 1 4  4 1 4  4 1.4 4  -4 1.4 4]";
    let faces = "[2 1 0  3 2 0  5 6 4  6 7 4  1 5 0  5 4 0  6 2 3  7 6 3  7 3 0  4 7 0  6 5 1  2 6 1]";
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n{BOX}\n{view}\n\
         Camera \"orthographic\" \"float screenwindow\" [-1.2 1.2 -0.8 0.8]\n\
         Integrator {integrator} \"integer maxdepth\" 9\nWorldBegin\n\
         LightSource \"distant\" \"point3 from\" [0.8390996 1 0] \"point3 to\" [0 0 0] \"rgb L\" [1 1 1]\n\
         Material \"diffuse\" \"rgb reflectance\" [0.02 0.02 0.02]\n\
         Shape \"bilinearmesh\" \"point3 P\" [-4 0 -4  -4 0 4  4 0 -4  4 0 4]\n\
         Material \"dielectric\" {glass}\nShape \"trianglemesh\" {corners} \"integer indices\" {faces}"
    );
    total(&means(&scene(&text, options)))
}

fn with(samples: u32, carried: Carried) -> Options {
    Options { samples: Some(samples), carried: Some(carried), ..Options::default() }
}

const BELOW: &str = "LookAt 0 0.6 0  0 0 0  0 0 1";
const ABOVE: &str = "LookAt 0 3 0  0 0 0  0 0 1";
const PHOTONS: &str = "\"sppm\" \"float radius\" 0.1 \"integer photonsperiteration\" 4000";

/// What a pane of index `n` lets through, `(1 - F) / (1 + F)` with all reflections within.
fn pane(cos: f64, n: f64) -> f64 {
    let inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let s = (cos - n * inside) / (cos + n * inside);
    let p = (n * cos - inside) / (n * cos + inside);
    // Each polarisation by itself, as the renderer mixes them at every surface: by the mean of both.
    let f = 0.5 * (s * s + p * p);
    (1.0 - f) / (1.0 + f)
}

/// Light that goes through glass to a floor and is seen through glass: neither paths nor walks from both ends find any of it.
#[test]
fn a_floor_in_the_sun_is_seen_through_a_pane() {
    let glass = "\"float eta\" 1.5";
    let cos = 40f64.to_radians().cos();
    let floor = 0.02 / std::f64::consts::PI * cos * pane(cos, 1.5);
    let seen = floor * pane(1.0, 1.5);
    let below = under_a_pane(BELOW, PHOTONS, glass, &with(96, Carried::Rgb));
    assert!((below / floor - 1.0).abs() < 0.02, "{below}, expected {floor}");
    let particles = under_a_pane(BELOW, "\"light\"", glass, &with(4096, Carried::Rgb));
    assert!((particles / floor - 1.0).abs() < 0.03, "particles: {particles}, expected {floor}");
    let above = under_a_pane(ABOVE, PHOTONS, glass, &with(96, Carried::Rgb));
    assert!((above / seen - 1.0).abs() < 0.02, "{above}, expected {seen}");
    for integrator in ["\"path\"", "\"bdpt\""] {
        let found = under_a_pane(ABOVE, integrator, glass, &with(96, Carried::Rgb));
        assert!(found < 0.01 * seen, "{integrator}: {found}");
    }
}

/// Glass that disperses leaves one wavelength of four, to photons and to eye rays: together it is one wavelength too.
#[test]
fn photons_have_the_wavelengths_of_their_pass() {
    let cos = 40f64.to_radians().cos();
    let through = |n: f64| pane(cos, n) * pane(1.0, n);
    let expected = 0.02 / std::f64::consts::PI * cos * through(1.5168);
    for (name, glass) in [("plain", "\"float eta\" 1.5168"), ("disperses", "\"spectrum eta\" \"glass-BK7\"")]
    {
        let found = under_a_pane(ABOVE, PHOTONS, glass, &with(96, Carried::Wavelengths));
        // The mean over the channels: few wavelengths are tinted.
        assert!((found / expected - 1.0).abs() < 0.05, "{name}: {found}, expected {expected}");
    }
}

fn small(samples: u32) -> Prepared {
    // Sent in three parts.
    picture(AHEAD, "\"sppm\" \"integer photonsperiteration\" 9000", &format!("{LAMP}{THINGS}"), samples)
}

#[test]
fn pictures_do_not_depend_on_threads_or_on_how_they_are_taken() {
    let of = |threads: usize| {
        let mut scene = small(20);
        scene.settings.threads = threads;
        scene
    };
    let one = bits(&render(&of(1)));
    for threads in [2, 5] {
        assert_eq!(one, bits(&render(&of(threads))), "{threads} threads");
    }
    let scene = of(2);
    let mut growing = durer::drive::Growing::new(&scene.job());
    while !growing.is_done(&scene.job()) {
        growing.grow(&scene.job(), &|| true, &Default::default());
    }
    assert_eq!(one, bits(growing.rendered()));
    assert_eq!(render(&scene).rays, growing.rendered().rays, "rays of photons too, and once");
    let other = Prepared { settings: durer::Settings { seed: 1, ..scene.settings }, ..scene };
    assert_ne!(one, bits(&render(&other)), "another seed");
}

#[test]
fn a_crop_is_a_part_of_the_whole_picture() {
    let whole = means(&small(9));
    let mut scene = small(9);
    scene.settings.crop = Some(Tile { x0: 3, y0: 2, x1: 9, y1: 7 });
    let part = means(&scene);
    for i in (0..part.len()).filter(|i| (3..9).contains(&(i % 12)) && (2..7).contains(&(i / 12))) {
        assert_eq!(part[i], whole[i]);
    }
}

/// The blur of a pass goes away with the passes.
#[test]
fn a_hundred_times_the_passes_blur_less() {
    // The edge of the shadow of indirect light is sharp nowhere: that of light through a mirror is.
    let world = "LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [1 0 0] \"rgb L\" [3 3 3]\n\
        Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
        Shape \"bilinearmesh\" \"point3 P\" [-4 0 -2  -4 0 2  1 0 -2  1 0 2]\n\
        Material \"conductor\" \"rgb reflectance\" [1 1 1] \"float roughness\" 0\n\
        Shape \"bilinearmesh\" \"point3 P\" [1.5 0.5 -0.5  1.5 0.5 0.5  1.5 1.5 -0.5  1.5 1.5 0.5]";
    let view = "LookAt 0 5 0  0 0 0  0 0 1\nCamera \"orthographic\" \"float screenwindow\" [-1.5 1.5 -1 1]";
    let of = |passes: u32| {
        let photons = 120_000 / passes;
        let sppm = format!("\"sppm\" \"float radius\" 0.3 \"integer photonsperiteration\" {photons}");
        means(&picture(&format!("{view}\n{BOX}"), &sppm, world, passes))
    };
    let truth = means(&picture(&format!("{view}\n{BOX}"), "\"light\"", world, 4096));
    let errors = [4, 400].map(|passes| difference(&truth, &of(passes)).1);
    assert!(errors[1] < 0.7 * errors[0], "{errors:?}");
}

#[test]
fn trees_know_what_was_gathered() {
    let sppm = "\"sppm\" \"float radius\" 0.5 \"integer photonsperiteration\" 4000";
    let scene = picture(AHEAD, sppm, &format!("{LAMP}{THINGS}"), 4);
    let (tree, _) = scene.job().record([5, 6], 2);
    let eye = &tree.nodes[0];
    let gathered = eye.gathered.expect("the floor gathers");
    assert!(gathered.photons > 0 && gathered.radius > 0.0 && !gathered.radiance.is_black());
    assert_eq!(eye.local, gathered.radiance, "the floor does not shine");
}

#[test]
fn what_cannot_be_is_refused() {
    for (parameter, said) in [
        ("\"integer photonsperiteration\" 0", "expected 1 or more"),
        ("\"integer photonsperiteration\" 900000000", "GiB"),
        ("\"float radius\" 0", "radius"),
        ("\"integer photonsperiterations\" 10", "photonsperiteration"),
    ] {
        let mut imported = import(&format!("Integrator \"sppm\" {parameter}\nWorldBegin\n{LAMP}{THINGS}"));
        let prepared = durer::prepare(&mut imported, &Options::default());
        let said_it = imported.diagnostics.iter().any(|d| format!("{d:?}").contains(said));
        assert!(said_it && (prepared.is_none() || parameter.contains("iterations")), "{parameter}");
    }
    let rolling = "Camera \"perspective\" \"float rollingshutter\" 1\nIntegrator \"sppm\"\nWorldBegin\n";
    let moves = "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Shape \"sphere\"";
    let mut imported = import(&format!("{rolling}{LAMP}{THINGS}{moves}"));
    assert!(durer::prepare(&mut imported, &Options::default()).is_none());
    assert!(imported.diagnostics.iter().any(|d| d.message.contains("rolling")));
}
