//! Path tracing against closed forms and against the integrators that branch.
use durer::{Options, Prepared};
use durer_tests::{prepared, render, scene};

fn options(integrator: &str, samples: u32) -> Options {
    Options { integrator: Some(integrator.to_owned()), samples: Some(samples), ..Options::default() }
}

/// A picture of 4 x 4 pixels under an integrator as a file names it.
fn picture(view: &str, integrator: &str, world: &str, samples: u32) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\n{view}\n\
         Integrator {integrator}\nWorldBegin\n{world}"
    );
    scene(&text, &Options { samples: Some(samples), ..Options::default() })
}

const FROM_WITHIN: &str = "LookAt 0.2 0.1 0.3  1 0.5 0.2  0 0 1\nCamera \"perspective\" \"float fov\" 60";

fn means(scene: &Prepared) -> Vec<f64> {
    render(scene).film.pixels().iter().map(|p| p.mean()[1].into()).collect()
}
fn mean(scene: &Prepared) -> f64 {
    let all = means(scene);
    all.iter().sum::<f64>() / all.len() as f64
}

/// A closed sphere of radius 1 that reflects half of what arrives, and what is said of it before its shape.
fn furnace(light: &str) -> String {
    format!(
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n{light}\nReverseOrientation\nShape \"sphere\""
    )
}

#[test]
fn e1_a_glowing_sphere_gives_a_geometric_series() {
    let glow = furnace("AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]");
    for (depth, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (5, 1.968_75)] {
        let integrator = format!("\"path\" \"integer maxdepth\" {depth} \"integer roulettedepth\" 100");
        let found = mean(&picture(FROM_WITHIN, &integrator, &glow, 1024));
        assert!((found / expected - 1.0).abs() < 4e-3, "depth {depth}: {found}, expected {expected}");
    }
}

#[test]
fn e2_a_point_light_in_a_sphere_gives_the_same_everywhere() {
    // a I / (pi r² (1 - a)) = 1, light after light: without chance every sample is exact.
    let lamp = |n: u32| {
        let one =
            format!("LightSource \"point\" \"rgb I\" [{0} {0} {0}]\n", std::f64::consts::PI / f64::from(n));
        furnace(&one.repeat(n as usize))
    };
    for lamps in [1, 4] {
        let integrator = "\"path\" \"integer maxdepth\" 40 \"integer roulettedepth\" 100";
        for found in means(&picture(FROM_WITHIN, integrator, &lamp(lamps), 4)) {
            assert!((found - 1.0).abs() < 1e-4, "{found} with {lamps} lamps");
        }
    }
    // E15: roulette changes no mean.
    let found = mean(&picture(FROM_WITHIN, "\"path\" \"integer maxdepth\" 40", &lamp(1), 4096));
    assert!((found - 1.0).abs() < 5e-3, "{found} with roulette");
}

const AFAR: &str = "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30";
const WHITE_SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

#[test]
fn i19_glass_disappears_in_a_uniform_sky() {
    let world = format!("{WHITE_SKY}Material \"dielectric\" \"float eta\" 1.5\nShape \"sphere\"");
    let integrator = "\"path\" \"integer maxdepth\" 200 \"integer roulettedepth\" 500";
    for found in means(&picture(AFAR, integrator, &world, 64)) {
        assert!((found - 1.0).abs() < 1e-4, "{found}: each path carries all");
    }
    // Roulette asks for what paths carry without what the index does to radiance: it ends none of them.
    let integrator = "\"path\" \"integer maxdepth\" 200";
    for found in means(&picture(AFAR, integrator, &world, 64)) {
        assert!((found - 1.0).abs() < 1e-4, "{found} with roulette");
    }
}

#[test]
fn i4_radiance_under_water_is_that_of_physics() {
    let view = "LookAt 0 0 -1  0 0 5  0 1 0\nCamera \"perspective\" \"float fov\" 0.001";
    let water = format!(
        "{WHITE_SKY}Material \"dielectric\" \"float eta\" 1.3333333\nTranslate 0 0 -3\nShape \"sphere\" \"float radius\" 1000\n"
    );
    // At the middle of so large a ball the way out is along its normal.
    let found = mean(&picture(view, "\"path\" \"integer maxdepth\" 1", &water, 4096));
    // (1 - F) n² = 0.979592 x 16 / 9, met with probability 1 - F.
    assert!((found / 1.741_497 - 1.0).abs() < 1e-2, "{found}");
}

#[test]
fn e14_where_only_sharp_things_and_points_are_paths_give_what_branching_gives() {
    let world = "LightSource \"point\" \"point3 from\" [2 4 -4] \"rgb I\" [40 30 20]\n\
        Material \"mirror\" \"rgb reflectance\" [0.8 0.9 0.7]\nShape \"sphere\"\n\
        Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]\nTranslate 0 -1 0 Shape \"plane\"\n";
    let whitted = means(&picture(AFAR, "\"whitted\" \"float mincontribution\" 0", world, 64));
    let direct = means(&picture(AFAR, "\"direct\" \"integer maxdepth\" 10", world, 64));
    for (a, b) in whitted.iter().zip(&direct) {
        assert!((a - b).abs() <= 1e-5 * a.abs().max(0.1), "{a} by whitted, {b} by direct");
    }
    assert!(whitted.iter().any(|v| *v > 0.1));
}

/// A picture of one spot of a floor of `material`, lit by `lights`.
fn spot(material: &str, lights: &str, integrator: &str, samples: u32) -> f64 {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt 2 1.4 0  0 0 0  0.1 0.9 0.3\nCamera \"perspective\" \"float fov\" 0.0001\n\
         WorldBegin\n{material}\nShape \"plane\"\n{lights}"
    );
    mean(&scene(&text, &options(integrator, samples)))
}

const DISK: &str = "AttributeBegin AreaLightSource \"diffuse\" Translate 0 2 0 Rotate 90 1 0 0 Shape \"disk\" AttributeEnd\n";
const SQUARE: &str = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] \
     AreaLightSource \"diffuse\" \"rgb L\" [6 6 6] \
     Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \
     \"point3 P\" [-2.2 1 -.5  -2.2 2 -.5  -2.2 2 .5  -2.2 1 .5] AttributeEnd\n";
const POINT: &str = "LightSource \"point\" \"point3 from\" [1 2 0] \"rgb I\" [3 3 3]\n";

#[test]
fn e9_a_disk_lights_a_floor_as_the_formula_says() {
    let white = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]";
    let found = spot(white, DISK, "direct", 16384);
    let expected = 0.628_319 / std::f64::consts::PI;
    assert!((found / expected - 1.0).abs() < 2e-3, "{found}, expected {expected}");
}

#[test]
fn lights_met_and_lights_sampled_count_once() {
    let glossy = "Material \"classic\" \"rgb diffuse\" [0.2 0.2 0.2] \"rgb reflection\" [0.8 0.8 0.8] \"float gloss\" 40";
    let lights = format!("{SQUARE}{DISK}{POINT}");
    let direct = spot(glossy, &lights, "direct", 65536);
    let all = spot(glossy, &lights, "distributed", 65536);
    assert!(all > 0.2 && (direct / all - 1.0).abs() < 5e-3, "{direct}, distributed {all}");
}

#[test]
fn e7_a_sky_lights_a_floor_evenly() {
    let white = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]";
    // Directions by cosine see the same everywhere: no light is asked, and every sample is exact.
    let found = spot(white, WHITE_SKY, "path", 16);
    assert!((found - 1.0).abs() < 1e-5, "{found}: irradiance pi, radiance 1");
}

#[test]
fn thin_veils_pass_light_on_its_straight_way() {
    // A veil of coverage 1/2 between the floor and all of its lights.
    let veil = "AttributeBegin Material \"principled\" \"float alpha\" 0.5 \"string alphamode\" \"blend\" \
        \"rgb basecolor\" [0 0 0] \"float eta\" 1 Translate 0 0.5 0 Scale 9 9 9 Rotate 90 1 0 0 Shape \"disk\" AttributeEnd\n";
    let white = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]";
    let free = spot(white, &format!("{DISK}{POINT}"), "direct", 16384);
    // The eye looks through it as well.
    let veiled = spot(white, &format!("{DISK}{POINT}{veil}"), "direct", 65536);
    assert!((veiled / (0.25 * free) - 1.0).abs() < 1e-2, "{veiled}, without the veil {free}");
}

#[test]
fn ambient_occlusion_is_the_free_share_of_the_hemisphere() {
    // A ball that touches nothing: seen from the point below its centre at distance 2 it covers (r / d)² of the
    // cosine-weighted hemisphere.
    let ball = "AttributeBegin Translate 0 2 0 Shape \"sphere\" AttributeEnd\n";
    for integrator in ["ambientocclusion", "ao"] {
        let found = spot("", ball, integrator, 16384);
        assert!((found - 0.75).abs() < 5e-3, "{found}");
    }
}

#[test]
fn surfaces_whose_normals_are_wrong_lose_no_light_of_an_even_sky() {
    // As the floor of pbrt's scene buddha-fractal: normals along the surface.
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt 2 1.4 0  0 0 0  0.1 0.9 0.3\nCamera \"perspective\" \"float fov\" 0.0001\nWorldBegin\n{WHITE_SKY}\
         Material \"diffuse\" \"rgb reflectance\" [1 1 1]\nShape \"trianglemesh\" \"integer indices\" [0 1 2] \
         \"point3 P\" [-9 0 -9  0 0 9  9 0 -9] \"normal N\" [1 0 0  1 0 0  1 0 0]"
    );
    let found = mean(&scene(&text, &options("path", 64)));
    assert!((found - 1.0).abs() < 1e-5, "{found}");
}

#[test]
fn files_without_integrator_are_path_traced_as_deep_as_their_language_has_it() {
    let depth = |of: &Prepared| of.rules["max_depth"].clone();
    let ball = "WorldBegin\nShape \"sphere\"\n";
    let ready = |text: &str, integrator: Option<&str>| {
        scene(text, &Options { integrator: integrator.map(str::to_owned), ..Options::default() })
    };
    let silent = ready(ball, None);
    assert_eq!((silent.integrator_name.as_str(), depth(&silent)), ("path", 5.into()), "as in pbrt-v4");
    assert_eq!(depth(&ready(ball, Some("direct"))), 5);
    assert_eq!(depth(&ready(ball, Some("whitted"))), 10);
    assert_eq!(depth(&ready(&format!("Integrator \"volpath\"\n{ball}"), None)), 5);
    assert_eq!(depth(&ready(&format!("Integrator \"bdpt\"\n{ball}"), None)), 5);
    let said = format!(
        "Integrator \"path\" \"integer maxdepth\" 3 \"integer roulettedepth\" 2 \"string lightsampler\" \"power\"\n{ball}"
    );
    assert_eq!(depth(&ready(&said, None)), 3);
    // Another way to follow paths keeps what the file says of paths; whitted's depth is that of a tree.
    for other in ["bdpt", "light", "volpath", "direct"] {
        assert_eq!(depth(&ready(&said, Some(other))), 3, "{other}");
    }
    let rules = &ready(&said, Some("volpath")).rules;
    assert_eq!((rules["roulettedepth"].clone(), rules["lightsampler"].clone()), (2.into(), "power".into()));
    assert_eq!(depth(&ready(&said, Some("whitted"))), 10);

    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("one.obj");
    std::fs::write(&file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a file");
    let opened = |integrator: Option<&str>| {
        let options = Options { integrator: integrator.map(str::to_owned), ..Options::default() };
        prepared(durer::open(file.to_str().expect("a path")), &options)
    };
    assert_eq!((opened(None).integrator_name.as_str(), depth(&opened(None))), ("path", 8.into()));
    assert_eq!(depth(&opened(Some("whitted"))), 10);
}

#[test]
fn what_is_there_in_part_hides_reflects_and_shines_in_part() {
    // A black disk of which a quarter is there hides a quarter of the sky.
    let black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
    let disk = |alpha: &str| format!("Shape \"disk\" \"float radius\" 9 {alpha}\n");
    let quarter = disk("\"float alpha\" 0.25");
    let seen = |world: &str, integrator: &str| mean(&picture(AFAR, integrator, world, 256));
    for integrator in ["\"path\"", "\"direct\"", "\"whitted\" \"float mincontribution\" 0"] {
        let found = seen(&format!("{WHITE_SKY}{black}{quarter}"), integrator);
        assert!((found - 0.75).abs() < 1e-2, "{integrator}: {found}");
        let lamp =
            format!("AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] \"bool twosided\" true {black}{quarter}");
        let found = seen(&lamp, integrator);
        assert!((found - 0.5).abs() < 1e-3, "{integrator}: {found}");
    }
    // So it does with a texture, of which half is holes; and a mirror, a metal or glass has holes as well.
    let half = "Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 1 \"float uscale\" 64 \
                \"float vscale\" 64\n";
    for material in ["mirror\" \"rgb reflectance\" [0 0 0]", "diffuse\" \"rgb reflectance\" [0 0 0]"] {
        let world =
            format!("{WHITE_SKY}{half}Material \"{material}\n{}", disk("\"texture alpha\" \"holes\""));
        let found = seen(&world, "\"path\"");
        assert!((found - 0.5).abs() < 3e-2, "{material}: {found}");
    }
    let glass = format!("{WHITE_SKY}Material \"conductor\"\n{}", disk("\"float alpha\" 0"));
    assert!((seen(&glass, "\"path\"") - 1.0).abs() < 1e-6);
}
