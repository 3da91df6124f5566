//! The bound on what rays could have brought that were given up: the largest radiance of the scene, not of what was seen.
use durer::{Options, Prepared, builtin, spectrum::Basis};
use durer_tests::{prepared, scene};

const HEAD: &str = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
    Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\nWorldBegin\n";

fn of(world: &str, max_depth: u32) -> Prepared {
    let options = Options {
        integrator: Some("whitted".to_owned()),
        samples: Some(1),
        max_depth: Some(max_depth),
        min_contribution: Some(0.0),
        ..Options::default()
    };
    scene(&format!("{HEAD}{world}"), &options)
}

fn brightest(world: &str) -> Result<f32, String> {
    of(world, 4).brightest().map_err(str::to_owned)
}

/// A polygon that faces the camera at this depth.
fn wall(z: f32) -> String {
    format!("Shape \"polygon\" \"point3 P\" [-9 -9 {z}  -9 9 {z}  9 9 {z}  9 -9 {z}]\n")
}

#[test]
fn a_lamp_that_only_the_given_up_ray_would_have_seen_is_within_the_bound() {
    // The eye looks into a dim mirror, and over its shoulder is a lamp.
    let world = format!(
        "LightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1]\n\
         AttributeBegin Material \"mirror\" \"rgb reflectance\" [.5 .5 .5]\n{}AttributeEnd\n\
         AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [50 40 30] \"bool twosided\" true\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}AttributeEnd\n",
        wall(5.0),
        wall(-5.0)
    );
    let (cut, whole) = (of(&world, 0), of(&world, 9));
    let (some, less) = cut.job().record([3, 3], 0);
    let (_, more) = whole.job().record([3, 3], 0);
    let missing = more[0] - less[0];
    assert!((missing - 25.0).abs() < 1e-4, "{missing}");
    let seen = Basis::Rgb.to_rgb(some.killed())[0] * some.max_radiance();
    assert!(seen < 1.0, "what was seen would say {seen}");
    let most = cut.brightest().expect("a bound");
    assert!((50.0..60.0).contains(&most), "{most}");
    assert!(missing <= Basis::Rgb.to_rgb(some.lost_bound(most))[0] * 1.0001);
    let tree =
        durer::tree::Subject { name: "test", prepared: &cut }.tree_of([3, 3], 1, 0, Default::default());
    assert_eq!((tree.brightest.map(|v| v.0), tree.no_bound), (Some(most), None));
    assert!(tree.missing.is_some_and(|v| v[0].0 >= missing));
}

#[test]
fn nothing_in_the_built_in_scenes_is_brighter_than_their_bound() {
    let mut bounded = 0;
    for built_in in builtin::SCENES {
        let of = |depth| {
            let options = Options {
                integrator: Some("whitted".to_owned()),
                width: Some(32),
                samples: Some(1),
                max_depth: Some(depth),
                min_contribution: Some(0.0),
                ..Options::default()
            };
            prepared(built_in.import(), &options)
        };
        let (cut, whole) = (of(1), of(8));
        let Ok(most) = cut.brightest() else { continue };
        bounded += 1;
        let view = &cut.scene.view;
        for i in 0..view.width * view.height {
            let pixel = [i % view.width, i / view.width];
            let ((some, less), (_, more)) = (cut.job().record(pixel, 0), whole.job().record(pixel, 0));
            let bound = Basis::Rgb.to_rgb(some.lost_bound(most));
            for channel in 0..3 {
                let missing = more[channel] - less[channel];
                let allowed = bound[channel] * 1.0001 + 1e-5;
                assert!(missing <= allowed, "{}, {pixel:?}: {missing} {allowed}", built_in.name);
                // A sample of a lamp's light may be larger than the lamp: the bound is on its mean.
                let surfaces = some.nodes.iter().filter(|n| n.light.is_none());
                let largest = surfaces.map(|n| n.result.max()).fold(0.0, f32::max);
                assert!(largest <= 4.0 * most, "{}, {pixel:?}: {largest} {most}", built_in.name);
            }
        }
    }
    assert!(bounded >= 6, "{bounded} scenes have a bound");
}

#[test]
fn lights_without_extent_count_where_they_can_reach() {
    let white = |light: &str| {
        brightest(&format!("{light}\nMaterial \"diffuse\" \"rgb reflectance\" [1 1 1]\n{}", wall(5.0)))
    };
    let close = |found: Result<f32, String>, expected: f32| {
        let found = found.expect("a bound");
        assert!((found - expected).abs() < 1e-4 * expected, "{found} {expected}");
    };
    let pi = std::f32::consts::PI;
    close(white("LightSource \"distant\" \"rgb L\" [3 2 1]"), 3.0 / pi);
    close(white("LightSource \"point\" \"rgb I\" [7 7 7] \"string falloff\" \"none\""), 7.0);
    // Two metres in front of the wall, and in it.
    close(white("LightSource \"point\" \"rgb I\" [8 8 8] \"point3 from\" [1 1 3]"), 2.0 / pi);
    let why = white("LightSource \"point\" \"rgb I\" [8 8 8] \"point3 from\" [1 1 5]").expect_err("none");
    assert!(why.contains("light \"point 0\" grows without limit near it"), "{why}");
}

#[test]
fn where_there_is_no_bound_it_is_said_why() {
    let sun = "LightSource \"distant\" \"rgb L\" [1 1 1]\n";
    let mirror = |roughness: f32| {
        format!("{sun}Material \"mirror\" \"rgb reflectance\" [1 1 1] \"float roughness\" {roughness}\n")
    };
    let why = brightest(&(mirror(0.1) + &wall(5.0))).expect_err("a highlight, and all is reflected");
    assert!(why.contains("adds light to all that it reflects"), "{why}");
    let frosted = format!("{sun}Material \"dielectric\" \"float roughness\" 0.1\n{}", wall(5.0));
    let why = brightest(&frosted).expect_err("frosted glass");
    assert!(why.contains("highlights of lights without extent"), "{why}");
    assert_eq!(brightest(&(mirror(0.0) + &wall(5.0))), Ok(0.0), "a mirror shows nothing by itself");
    let shining = format!("AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\n{}{}", mirror(0.0), wall(5.0));
    assert!(brightest(&shining).is_err(), "it shines and mirrors all");
}
