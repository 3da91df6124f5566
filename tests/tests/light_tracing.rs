//! Particles make the pictures that paths make: for each camera, each light, each filter; and closed forms.
use durer_tests::{
    bits, render,
    small::{AHEAD, BOX, LAMP, THINGS, agree, difference, means, picture, total},
};

fn agrees(name: &str, view: &str, world: &str, samples: u32, limits: (f64, f64)) {
    agree(
        name,
        (["path", "light"], "\"integer maxdepth\" 3 \"integer roulettedepth\" 20"),
        view,
        world,
        samples,
        limits,
    );
}

#[test]
fn every_camera_sees_the_particles_where_it_sees_what_scatters_them() {
    let world = format!("{LAMP}{THINGS}");
    let looks = "LookAt 0 2 -6  0 0.6 0  0 1 0\n";
    for (name, view) in [
        ("pinhole", AHEAD.to_owned()),
        ("box filter", format!("{AHEAD}\n{BOX}")),
        ("wide filter", format!("{AHEAD}\nPixelFilter \"triangle\" \"float xradius\" 3 \"float yradius\" 3")),
        ("mitchell", format!("{AHEAD}\nPixelFilter \"mitchell\"")),
        (
            "thin lens",
            format!(
                "{looks}Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.3 \"float focaldistance\" 5"
            ),
        ),
        ("mirrored", format!("Scale -1 1 1\n{AHEAD}")),
        ("scaled", format!("Scale 2 2 2\n{AHEAD}")),
        ("stretched", format!("{looks}Scale 1 2 0.5\nCamera \"perspective\" \"float fov\" 40")),
        ("parallel", format!("{looks}Camera \"orthographic\" \"float screenwindow\" [-2 2 -1.2 1.2]")),
        (
            "parallel with a lens",
            format!(
                "{looks}Camera \"orthographic\" \"float screenwindow\" [-2 2 -1.2 1.2] \"float lensradius\" 0.5 \"float focaldistance\" 5"
            ),
        ),
        ("equal area", "LookAt 0 1 -2  0 0.6 0  0 1 0\nCamera \"spherical\"".to_owned()),
        (
            "equirectangular",
            "LookAt 0 1 -2  0 0.6 0  0 1 0\nCamera \"spherical\" \"string mapping\" \"equirectangular\""
                .to_owned(),
        ),
    ] {
        agrees(name, &view, &world, 1024, (0.012, 0.05));
    }
}

#[test]
fn every_light_sends_what_paths_find() {
    let from = "\"point3 from\" [1 3 -2] \"point3 to\" [0 0 0]";
    for (name, lights) in [
        ("point", "LightSource \"point\" \"point3 from\" [1 3 -2] \"rgb I\" [9 8 7]".to_owned()),
        ("spot", format!("LightSource \"spot\" {from} \"rgb I\" [30 25 20] \"float coneangle\" 30 \"float conedeltaangle\" 20")),
        ("distant", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1]")),
        ("disk", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1] \"float angle\" 30")),
        ("even sky", "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.6]".to_owned()),
        ("gradient", "LightSource \"gradientsky\"".to_owned()),
        ("sun and sky", "LightSource \"sky\"\nLightSource \"sun\"".to_owned()),
        ("two sides", "AttributeBegin Translate 0 1.6 0 AreaLightSource \"diffuse\" \"bool twosided\" true \"rgb L\" [5 4 3]\n\
            Material \"diffuse\" \"rgb reflectance\" [0.3 0.3 0.3] Rotate 80 1 0 0 Shape \"disk\" \"float radius\" 0.5 AttributeEnd".to_owned()),
        ("sphere", "AttributeBegin Translate 0 1.8 -0.6 AreaLightSource \"diffuse\" \"rgb L\" [20 15 10] Shape \"sphere\" \"float radius\" 0.2 AttributeEnd".to_owned()),
        ("checks", "Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 3 \"float vscale\" 3 \"rgb tex1\" [9 1 1] \"rgb tex2\" [0 1 9]\n\
            AttributeBegin Translate 0.5 2.6 -0.5 Rotate 90 1 0 0 AreaLightSource \"diffuse\" \"texture L\" \"c\" Shape \"disk\" \"float radius\" 0.9 AttributeEnd".to_owned()),
        ("many", format!("{LAMP}LightSource \"point\" \"point3 from\" [-2 2 -2] \"rgb I\" [2 3 4]\nLightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1]")),
    ] {
        agrees(name, &format!("{AHEAD}\n{BOX}"), &format!("{lights}\n{THINGS}"), 1024, (0.015, 0.07));
    }
}

/// E1: in a closed box that glows all light is `L / (1 - a)`, bounce by bounce.
#[test]
fn e1_a_glowing_sphere_gives_a_geometric_series() {
    let view =
        format!("LookAt 0.2 0.1 0.3  1 0.5 0.2  0 0 1\nCamera \"perspective\" \"float fov\" 60\n{BOX}");
    let world = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n\
        ReverseOrientation\nShape \"sphere\"";
    for (depth, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (5, 1.968_75)] {
        for roulette in [1, 100] {
            let integrator =
                format!("\"light\" \"integer maxdepth\" {depth} \"integer roulettedepth\" {roulette}");
            let found = total(&means(&picture(&view, &integrator, world, 1024)));
            assert!((found / expected - 1.0).abs() < 6e-3, "depth {depth}: {found}, expected {expected}");
        }
    }
}

/// Glass bends light that particles bring, and shading normals, holes, bodies within bodies, absorption and motion do to
/// them what they do to eye rays.
#[test]
fn particles_meet_what_paths_meet() {
    let under = |ball: &str| format!("{LAMP}{THINGS}AttributeBegin Translate 0 1.6 -0.6 {ball} AttributeEnd");
    for (name, world) in [
        (
            "smooth normals",
            format!(
                "{LAMP}Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]\nShape \"loopsubdiv\" \"integer levels\" 1 \
            \"point3 P\" [0 2 0  1.4 0 0  0 0 1.4  -1.4 0 0  0 0 -1.4  0 -0.5 0] \
            \"integer indices\" [0 2 1  0 3 2  0 4 3  0 1 4  5 1 2  5 2 3  5 3 4  5 4 1]"
            ),
        ),
        (
            "holes",
            under(
                "Texture \"h\" \"float\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8 \"float tex1\" 0 \"float tex2\" 1\n\
            Material \"diffuse\" Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1 \"texture alpha\" \"h\"",
            ),
        ),
        (
            "half there",
            under(
                "Material \"diffuse\" Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1 \"float alpha\" 0.4",
            ),
        ),
        (
            "translucent",
            under("Material \"diffusetransmission\" Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 1"),
        ),
        (
            "moving",
            under(
                "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.4",
            ),
        ),
    ] {
        agrees(name, &format!("{AHEAD}\n{BOX}"), &world, 1024, (0.015, 0.06));
    }
}

/// Light on a floor below a pane: half of the paths' light goes through it, sharp for both walks.
#[test]
fn light_through_glass_is_that_of_paths() {
    let pane = |material: &str| {
        format!(
            "AttributeBegin Translate 0 2.9 0 Rotate 90 1 0 0 AreaLightSource \"diffuse\" \"rgb L\" [8 7 6] Shape \"disk\" \"float radius\" 1.5 AttributeEnd\n\
             {THINGS}AttributeBegin {material} Translate 0 2.2 0 Scale 3 0.2 3 Shape \"sphere\" AttributeEnd"
        )
    };
    let view = format!("LookAt 0 1 -5  0 0.4 0  0 1 0\nCamera \"perspective\" \"float fov\" 22\n{BOX}");
    for (name, material) in [
        ("clear", "Material \"dielectric\" \"float eta\" 1.5"),
        ("rough", "Material \"dielectric\" \"float eta\" 1.4 \"float roughness\" 0.3"),
        ("thin", "Material \"thindielectric\""),
    ] {
        agrees(name, &view, &pane(material), 4096, (0.02, 0.08));
    }
}

#[test]
fn splats_do_not_depend_on_threads_or_on_how_the_picture_is_taken() {
    let world = format!("{LAMP}{THINGS}");
    let view = format!("{AHEAD}\nPixelFilter \"mitchell\"");
    let of = |threads: usize| {
        let mut scene = picture(&view, "\"light\"", &world, 70);
        scene.settings.threads = threads;
        scene
    };
    let one = render(&of(1));
    for threads in [2, 3, 7] {
        assert_eq!(bits(&one), bits(&render(&of(threads))), "{threads} threads");
    }
    let scene = of(2);
    let mut growing = durer::drive::Growing::new(&scene.job());
    let cancel = Default::default();
    while !growing.is_done(&scene.job()) {
        growing.grow(&scene.job(), &|| true, &cancel);
    }
    assert_eq!(bits(&one), bits(growing.rendered()));
}

/// A part of the picture is as bright as in the whole, though fewer particles are sent for it.
#[test]
fn a_crop_shows_what_the_whole_shows() {
    let world = format!("{LAMP}{THINGS}");
    let whole = means(&picture(AHEAD, "\"light\"", &world, 1024));
    let mut scene = picture(AHEAD, "\"light\"", &world, 4096);
    let crop = durer::film::Tile { x0: 3, y0: 2, x1: 9, y1: 7 };
    scene.settings.crop = Some(crop);
    let part = means(&scene);
    let inside = |i: &usize| (3..9).contains(&(i % 12)) && (2..7).contains(&(i / 12));
    let of = |pixels: &[[f64; 3]], wanted: bool| -> Vec<[f64; 3]> {
        (0..pixels.len()).filter(|i| inside(i) == wanted).map(|i| pixels[i]).collect()
    };
    let (bias, error) = difference(&of(&whole, true), &of(&part, true));
    assert!(bias.abs() < 0.015 && error < 0.05, "{bias} {error}");
    assert!(of(&part, false).iter().all(|p| *p == [0.0; 3]));
}
