//! Bidirectional path tracing: the pictures of paths, in all ways at once and in each alone.
use durer::Options;
use durer_tests::{
    bits, render,
    small::{AHEAD, BOX, LAMP, THINGS, agree, means, picture, total},
};

/// With metal that is smoother than particles alone could show.
fn things() -> String {
    THINGS.replace("\"float roughness\" 0.4", "\"float roughness\" 0.3")
}

fn agrees(name: &str, view: &str, world: &str, samples: u32, limits: (f64, f64)) {
    agree(name, (["path", "bdpt"], "\"integer maxdepth\" 4"), view, world, samples, limits);
}

#[test]
fn e14_both_ways_find_what_paths_find_with_every_light() {
    let from = "\"point3 from\" [1 3 -2] \"point3 to\" [0 0 0]";
    for (name, lights) in [
        ("lamp", LAMP.to_owned()),
        ("point", "LightSource \"point\" \"point3 from\" [1 3 -2] \"rgb I\" [9 8 7]".to_owned()),
        ("does not fade", "LightSource \"point\" \"point3 from\" [1 3 -2] \"rgb I\" [1 1 1] \"string falloff\" \"none\"".to_owned()),
        ("spot", format!("LightSource \"spot\" {from} \"rgb I\" [30 25 20] \"float coneangle\" 30 \"float conedeltaangle\" 20")),
        ("distant", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1]")),
        ("disk", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1] \"float angle\" 30")),
        ("even sky", "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.6]".to_owned()),
        ("gradient", "LightSource \"gradientsky\"".to_owned()),
        ("sphere", "AttributeBegin Translate 0 1.8 -0.6 AreaLightSource \"diffuse\" \"rgb L\" [20 15 10] Shape \"sphere\" \"float radius\" 0.2 AttributeEnd".to_owned()),
        ("many", format!("{LAMP}LightSource \"point\" \"point3 from\" [-2 2 -2] \"rgb I\" [2 3 4]\nLightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1]")),
    ] {
        agrees(name, &format!("{AHEAD}\n{BOX}"), &format!("{lights}\n{}", things()), 512, (0.015, 0.06));
    }
}

#[test]
fn e14_cameras_and_surfaces_change_nothing_of_it() {
    let looks = "LookAt 0 2 -6  0 0.6 0  0 1 0\n";
    let world = format!("{LAMP}{}", things());
    for (name, view) in [
        ("gauss", AHEAD.to_owned()),
        (
            "thin lens",
            format!(
                "{looks}Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.3 \"float focaldistance\" 5"
            ),
        ),
        ("parallel", format!("{looks}Camera \"orthographic\" \"float screenwindow\" [-2 2 -1.2 1.2]")),
        ("equal area", "LookAt 0 1 -2  0 0.6 0  0 1 0\nCamera \"spherical\"".to_owned()),
        ("rolling", format!("{looks}Camera \"perspective\" \"float fov\" 40 \"float rollingshutter\" 1")),
    ] {
        agrees(name, &view, &world, 512, (0.015, 0.06));
    }
    let under = |ball: &str| {
        let things = things();
        format!("{LAMP}{things}AttributeBegin Translate 0 1.6 -0.6 {ball} AttributeEnd")
    };
    for (name, world) in [
        ("glass", under("Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\" \"float radius\" 0.5")),
        (
            "frosted",
            under(
                "Material \"dielectric\" \"float eta\" 1.5 \"float roughness\" 0.4 Shape \"sphere\" \"float radius\" 0.5",
            ),
        ),
        ("coated", under("Material \"coateddiffuse\" Shape \"sphere\" \"float radius\" 0.5")),
        (
            "translucent",
            under("Material \"diffusetransmission\" Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1"),
        ),
        (
            "half there",
            under(
                "Material \"diffuse\" Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1 \"float alpha\" 0.4",
            ),
        ),
        (
            "moving",
            under(
                "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.4",
            ),
        ),
        (
            "shading normals",
            format!(
                "{LAMP}Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]\nShape \"loopsubdiv\" \"integer levels\" 1 \
            \"point3 P\" [0 2 0  1.4 0 0  0 0 1.4  -1.4 0 0  0 0 -1.4  0 -0.5 0] \
            \"integer indices\" [0 2 1  0 3 2  0 4 3  0 1 4  5 1 2  5 2 3  5 3 4  5 4 1]"
            ),
        ),
    ] {
        agrees(name, &format!("{AHEAD}\n{BOX}"), &world, 1024, (0.02, 0.08));
    }
}

const WITHIN: &str =
    "LookAt 0.2 0.1 0.3  1 0.5 0.2  0 0 1\nCamera \"perspective\" \"float fov\" 60\nPixelFilter \"box\"";
const FURNACE: &str = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
    AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nReverseOrientation\nShape \"sphere\"";

/// E1: in a closed box that glows all light is `L / (1 - a)`, bounce by bounce.
#[test]
fn e1_a_glowing_sphere_gives_a_geometric_series() {
    for (depth, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (5, 1.968_75)] {
        let integrator = format!("\"bdpt\" \"integer maxdepth\" {depth}");
        let found = total(&means(&picture(WITHIN, &integrator, FURNACE, 512)));
        assert!((found / expected - 1.0).abs() < 6e-3, "depth {depth}: {found}, expected {expected}");
    }
}

/// A box that glows within: from its walls none of them is hidden. (In a sphere, of which points lie outside by rounding,
/// vertices ask for no light of their own sphere: other ways stand for that.)
const BOX_FURNACE: &str = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
    AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n\
    Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]\n\
    \"integer indices\" [0 1 2  0 2 3  4 6 5  4 7 6  0 5 1  0 4 5  3 2 6  3 6 7  0 3 7  0 7 4  1 5 6  1 6 2]";

fn of_strategy(s: usize, t: usize, weighted: bool, samples: u32) -> f64 {
    let integrator = format!(
        "\"bdpt\" \"integer maxdepth\" 8 \"integer roulettedepth\" 20 \"string strategy\" \"{s},{t}\" \"bool weighted\" {weighted}"
    );
    total(&means(&picture(WITHIN, &integrator, BOX_FURNACE, samples)))
}

/// Each way to find a path, as if it were the only one, finds all light of as many bounces: `a^k`.
#[test]
fn each_strategy_alone_finds_all_light_of_its_bounces() {
    for k in 1..4usize {
        for s in 0..=k + 1 {
            let t = k + 2 - s;
            let expected = 0.5f64.powi(k as i32);
            // Edges may be short, those to the camera too: their squared inverse has a long tail.
            let slack = if s >= 2 { 0.06 } else { 0.02 };
            let found = of_strategy(s, t, false, 384);
            assert!((found / expected - 1.0).abs() < slack, "{s},{t}: {found}, expected {expected}");
        }
    }
}

#[test]
fn shares_of_the_strategies_sum_to_the_whole() {
    for k in 1..4usize {
        let sum: f64 = (0..=k + 1).map(|s| of_strategy(s, k + 2 - s, true, 128)).sum();
        let expected = 0.5f64.powi(k as i32);
        assert!((sum / expected - 1.0).abs() < 0.02, "{k} bounces: {sum}, expected {expected}");
    }
}

#[test]
fn pictures_do_not_depend_on_threads() {
    let world = format!("{LAMP}{}", things());
    let of = |threads: usize| {
        let mut scene = picture(AHEAD, "\"bdpt\"", &world, 20);
        scene.settings.threads = threads;
        bits(&render(&scene))
    };
    let one = of(1);
    for threads in [2, 5] {
        assert_eq!(one, of(threads), "{threads} threads");
    }
}

/// Where rounding lets a disk shine at itself, from beside, no density is known.
#[test]
fn a_lamp_in_its_own_plane_spoils_no_sample() {
    let view = "LookAt 0 1.2 4  0 0.6 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n\
        Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n";
    let world = "AttributeBegin\nTranslate 0 2 0\nAreaLightSource \"diffuse\"\nRotate -90 1 0 0\n\
        Shape \"disk\" \"float radius\" 0.5\nAttributeEnd\nShape \"trianglemesh\" \
        \"point3 P\" [-3 0 -2 3 0 -2 3 3 -2 -3 3 -2] \"integer indices\" [0 1 2 0 2 3]";
    let rendered = render(&picture(view, "\"bdpt\" \"integer maxdepth\" 1", world, 64));
    assert_eq!((rendered.bad_samples, rendered.first_bad), (0, None));
}

#[test]
fn strategies_that_are_none_are_refused() {
    for (word, said) in [("1,1", "not \"1,1\""), ("2", "expected"), ("a,b", "expected"), ("1,0", "expected")]
    {
        let text = format!("Integrator \"bdpt\" \"string strategy\" \"{word}\"\nWorldBegin\n{FURNACE}");
        let mut imported = durer_tests::import(&text);
        assert!(durer::prepare(&mut imported, &Options::default()).is_none());
        assert!(imported.diagnostics.iter().any(|d| d.message.contains(said)), "{word}");
    }
}
