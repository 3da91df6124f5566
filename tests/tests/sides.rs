//! Surfaces that are not seen from behind, and surfaces that are partly there.
use durer::{Options, Prepared};
use durer_tests::scene;

/// One pixel looking along +z from the origin at `world`, in a sky of radiance 1 on all sides.
fn radiance(world: &str) -> [f32; 3] {
    let head = "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
                Sampler \"independent\" \"integer pixelsamples\" 1\n\
                Camera \"perspective\" \"float fov\" 1\n\
                Integrator \"whitted\" \"float mincontribution\" 0\nWorldBegin\n";
    let prepared: Prepared = scene(&format!("{head}{world}"), &Options::default());
    prepared.job().record([0, 0], 0).1
}

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

/// A triangle across the view at `z`, its corners in this order: "0 1 2" turns its front towards +z.
fn triangle(indices: &str, z: f32) -> String {
    format!(
        "Shape \"trianglemesh\" \"point3 P\" [-9 -9 {z} 9 -9 {z} 0 9 {z}] \"integer indices\" [{indices}]\n"
    )
}

const AWAY: &str = "0 1 2";
const TOWARDS: &str = "0 2 1";
const AWAY_AND_TOWARDS: [&str; 2] = [AWAY, TOWARDS];

const RED: &str =
    "Material \"principled\" \"rgb basecolor\" [1 0 0] \"bool unlit\" true \"bool onesided\" true\n";

#[test]
fn one_sided_surfaces_are_seen_from_where_their_corners_turn_counter_clockwise() {
    let (red, sky) = ([1.0, 0.0, 0.0], [1.0; 3]);
    // n = (p1 - p0) x (p2 - p0) = (18, 0, 0) x (9, 18, 0) points along +z, away from the camera.
    assert_eq!(
        AWAY_AND_TOWARDS.map(|order| radiance(&format!("{SKY}{RED}{}", triangle(order, 2.0)))),
        [sky, red]
    );
    // A mirroring turns the corners round and the surface with them: what was its front still is.
    let mirrored = format!("{SKY}{RED}AttributeBegin\nScale -1 1 1\n{}AttributeEnd\n", triangle(AWAY, 2.0));
    assert_eq!(radiance(&mirrored), sky);
    let behind = format!("{SKY}{RED}AttributeBegin\nScale 1 1 -1\n{}AttributeEnd\n", triangle(AWAY, -2.0));
    assert_eq!(radiance(&behind), red);
    // Used twice, meshes are instances in their own space.
    let object = format!("ObjectBegin \"o\"\n{}ObjectEnd\n", triangle(AWAY, -2.0));
    let uses = "AttributeBegin\nScale 1 1 -1\nObjectInstance \"o\"\nAttributeEnd\n\
                AttributeBegin\nTranslate 0 0 9\nObjectInstance \"o\"\nAttributeEnd\n";
    assert_eq!(radiance(&format!("{SKY}{RED}{object}{uses}")), red);
    let turned = format!("{SKY}{RED}ReverseOrientation\n{}", triangle(AWAY, 2.0));
    assert_eq!(radiance(&turned), red);
}

#[test]
fn one_sided_spheres_are_seen_from_outside_also_among_others_and_moving() {
    let (red, sky, grey) = ([1.0, 0.0, 0.0], [1.0; 3], [0.5; 3]);
    let around = "Shape \"sphere\" \"float radius\" 3\n";
    let ahead = "AttributeBegin\nTranslate 0 0 5\nShape \"sphere\"\nAttributeEnd\n";
    let plain = "Material \"principled\" \"rgb basecolor\" [.5 .5 .5] \"bool unlit\" true\n";
    let moves = "ActiveTransform EndTime\nTranslate 0 0 0.5\nActiveTransform All\n";
    for motion in ["", moves] {
        let of = |spheres: &str| radiance(&format!("{SKY}{RED}{motion}{spheres}"));
        assert_eq!((of(around), of(ahead)), (sky, red), "{motion}");
        assert_eq!(of(&format!("{around}{ahead}")), red, "{motion}");
        // The filter is asked about the plain sphere too where both are among the still shapes.
        assert_eq!(of(&format!("{around}{plain}{ahead}")), grey, "{motion}");
    }
}

#[test]
fn one_sided_surfaces_cast_shadows_from_both_sides() {
    let lit = |blocker: &str| {
        let sun = "LightSource \"distant\" \"point3 from\" [0 0 0] \"point3 to\" [0 0 1] \"rgb L\" [1 1 1]\n";
        let wall = format!("Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\n{}", triangle(AWAY, 5.0));
        radiance(&format!("{sun}{wall}{RED}{blocker}"))[1]
    };
    assert!(lit("") > 0.1);
    // Behind the camera, turned either way.
    assert_eq!(AWAY_AND_TOWARDS.map(|order| lit(&triangle(order, -2.0))), [0.0; 2]);
}

#[test]
fn half_of_a_blended_surface_shows_half_of_what_lies_behind() {
    let blend = "Material \"principled\" \"rgb basecolor\" [1 0 0] \"float alpha\" 0.25 \
                 \"string alphamode\" \"blend\" \"bool unlit\" true\n";
    let [r, g, b] = radiance(&format!("{SKY}{blend}{}{}", triangle(AWAY, 2.0), triangle(TOWARDS, 3.0)));
    // 1/4 red over 1/4 red over white.
    assert_eq!([r, g, b], [1.0, 0.5625, 0.5625]);
}

#[test]
fn a_white_surface_that_is_partly_there_vanishes_in_a_white_sky() {
    for alpha in [0.0, 0.3, 1.0] {
        let blend = format!(
            "Material \"principled\" \"float alpha\" {alpha} \"string alphamode\" \"blend\" \"float roughness\" 0\n"
        );
        let [r, ..] = radiance(&format!("{SKY}{blend}{}", triangle(AWAY, 2.0)));
        assert!((r - 1.0).abs() < 1e-5, "{alpha}: {r}");
    }
}
