//! A zoo of scenes whose pictures show nothing, each with what the scene doctor must find; mended, none of them is ill.
use durer::{
    Options, Prepared,
    doctor::{Finding, examine, explain},
    scene::Severity,
};
use durer_tests::{import, prepared, render};

const LAMP: &str = "Translate 0 3 0 LightSource \"point\" \"string name\" \"lamp\" \"rgb I\" [40 40 40]";
const PANEL: &str = "AreaLightSource \"diffuse\" \"rgb L\" [10 10 10] Shape \"trianglemesh\" \"string name\" \"panel\" \
                     \"point3 P\" [-1 3 -1  1 3 -1  1 3 1  -1 3 1] \"integer indices\" [0 1 2 0 2 3]";
const CORNERS: &str = "\"point3 P\" [-.2 -.2 -.2  .2 -.2 -.2  .2 .2 -.2  -.2 .2 -.2  -.2 -.2 .2  .2 -.2 .2  .2 .2 .2  -.2 .2 .2]";
const OUTWARDS: &str = "[0 3 2 0 2 1 4 5 6 4 6 7 0 4 7 0 7 3 1 2 6 1 6 5 0 1 5 0 5 4 3 7 6 3 6 2]";
const INWARDS: &str = "[0 2 3 0 1 2 4 6 5 4 7 6 0 7 4 0 3 7 1 6 2 1 5 6 0 5 1 0 4 5 3 6 7 3 2 6]";

/// A floor, a ball and a lamp, seen by a camera.
struct Room {
    eye: &'static str,
    before: &'static str,
    light: String,
    floor: &'static str,
    more: String,
}

impl Default for Room {
    fn default() -> Self {
        let (eye, before, floor) = ("0 1 -4  0 0.8 0  0 1 0", "", "Material \"diffuse\"");
        Self { eye, before, light: LAMP.to_owned(), floor, more: String::new() }
    }
}

impl Room {
    fn text(&self) -> String {
        let Self { eye, before, light, floor, more } = self;
        format!(
            "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 32\n\
             Sampler \"zsobol\" \"integer pixelsamples\" 8\n{before}\nLookAt {eye}\n\
             Camera \"perspective\" \"float fov\" 45\nWorldBegin\n\
             AttributeBegin\n{light}\nAttributeEnd\n{floor}\n\
             Shape \"trianglemesh\" \"string name\" \"floor\" \"point3 P\" [-5 0 -3  -5 0 5  5 0 5  5 0 -3] \
             \"integer indices\" [0 1 2 0 2 3]\n\
             AttributeBegin\nTranslate 0 .5 0\n\
             Shape \"sphere\" \"string name\" \"ball\" \"float radius\" 0.5\nAttributeEnd\n{more}\n"
        )
    }
}

/// What is wrong, as `durer info` and as `durer render` say it.
fn ill(text: &str) -> [Vec<Finding>; 2] {
    let mut imported = import(text);
    let ready: Prepared = prepared(
        std::mem::replace(&mut imported, import("WorldBegin")),
        &Options { threads: Some(1), ..Options::default() },
    );
    let desc = import(text).desc;
    let pixels = render(&ready).film.pixels();
    let worse = |found: Vec<Finding>| found.into_iter().filter(|f| f.severity == Severity::Warning).collect();
    [worse(examine(&desc, &ready)), worse(explain(&desc, &ready, &pixels, 0.0))]
}

/// Expects the sentence, first of all that is found, and the remedy; from both where the picture shows that it is ill.
fn expect(room: &Room, both: bool, [sentence, remedy]: [&str; 2]) {
    let found = ill(&room.text());
    for found in &found[..if both { 2 } else { 1 }] {
        let first = found.first().unwrap_or_else(|| panic!("nothing found, expected: {sentence}"));
        assert!(first.message.contains(sentence), "{sentence} in {found:#?}");
        assert!(first.remedy.as_ref().is_some_and(|r| r.contains(remedy)), "{remedy} in {found:#?}");
    }
    if !both {
        assert_eq!(found[1], [], "the picture is fine");
    }
}

#[test]
fn healthy_scenes_are_told_nothing() {
    let panel = Room { light: PANEL.to_owned(), ..Room::default() };
    for room in [Room::default(), panel] {
        assert_eq!(ill(&room.text()), [[], []]);
    }
}

#[test]
fn a_lamp_in_a_box_lights_nothing() {
    let more = format!(
        "AttributeBegin Translate 0 3 0 Shape \"trianglemesh\" \"string name\" \"box\" {CORNERS} \
         \"integer indices\" {OUTWARDS} AttributeEnd"
    );
    let room = Room { more, ..Room::default() };
    expect(&room, true, ["none of the light of \"lamp\" arrives: \"box\" is in its way", "out of \"box\""]);
}

#[test]
fn a_panel_that_is_turned_away_lights_nothing() {
    let room = Room { light: format!("ReverseOrientation {PANEL}"), ..Room::default() };
    expect(&room, true, ["the light \"panel\" shines away from all that is seen", "ReverseOrientation"]);
}

#[test]
fn a_black_lamp_lights_nothing() {
    let room = Room { light: LAMP.replace("[40 40 40]", "[0 0 0]"), ..Room::default() };
    expect(&room, true, ["the light \"lamp\" is black", "above 0"]);
}

#[test]
fn a_lamp_below_the_floor_lights_nothing_above_it() {
    let room = Room {
        eye: "0 4 -1  0 0 0.5  0 1 0",
        light: LAMP.replace("Translate 0 3 0", "Translate 0 -3 0"),
        ..Room::default()
    };
    expect(&room, true, ["the light \"lamp\" stands behind all surfaces that are seen", "to the side"]);
}

#[test]
fn a_camera_in_an_object_sees_its_inside() {
    let room = Room { eye: "0 0.5 -0.1  0 0.5 1  0 1 0", ..Room::default() };
    expect(
        &room,
        true,
        ["100 % of what the camera sees is seen from its inside, most of it of \"ball\"", "out of"],
    );
}

#[test]
fn a_camera_that_looks_the_other_way_is_turned_around() {
    let room = Room { eye: "0 1 -4  0 1 -9  0 1 0", ..Room::default() };
    expect(&room, true, ["all of the scene lies behind it", "the middle of the scene is at 0 0.5 1"]);
    // Beside the view, but not behind.
    let room = Room { eye: "0 1 -4  -9 3 -3  0 1 0", ..Room::default() };
    expect(&room, true, ["met nothing", "point the camera at 0 0.5 1"]);
}

#[test]
fn a_model_in_other_units_than_the_camera_is_smaller_than_a_pixel() {
    let mut text = Room::default().text();
    text = text.replace("WorldBegin", "WorldBegin\nScale 0.001 0.001 0.001");
    let [found, _] = ill(&text);
    assert!(found[0].message.contains("smaller than a pixel, 0.0128 m across and 4.12 m away"), "{found:#?}");
}

#[test]
fn a_scene_in_millimetres_is_too_large_for_its_lamps() {
    let text = Room { eye: "0 1000 -4000  0 800 0  0 1 0", ..Room::default() }.text();
    let found = ill(&text.replace("WorldBegin", "WorldBegin\nScale 1000 1000 1000"));
    for found in found {
        assert_eq!(found.len(), 2, "{found:#?}");
        assert!(found[0].remedy.as_ref().is_some_and(|r| r.contains("--exposure 1")), "{found:#?}");
        assert!(found[1].message.contains("12800 m across: large for its lamps"), "{found:#?}");
        assert!(found[1].remedy.as_ref().is_some_and(|r| r.contains("Scale 0.001")), "{found:#?}");
    }
}

#[test]
fn dark_and_blown_out_pictures_name_their_exposure() {
    let lit = |scale: &str| Room { light: LAMP.replace("40 40 40", scale), ..Room::default() };
    expect(&lit(".01 .01 .01"), true, ["too dark to see anything", "try --exposure 1"]);
    expect(&lit("4e5 4e5 4e5"), true, ["too bright to see anything", "try --exposure -1"]);
}

#[test]
fn black_surfaces_show_nothing() {
    let floor = "MakeNamedMaterial \"soot\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 0]\nNamedMaterial \"soot\"";
    let room = Room { floor, ..Room::default() };
    expect(&room, true, ["reflects nothing: the material \"soot\" is black", "colour above 0"]);
}

#[test]
fn paths_that_end_within_glass_find_no_light() {
    let more = "Material \"dielectric\" Shape \"trianglemesh\" \"point3 P\" [-9 -9 -3  -9 9 -3  9 9 -3  9 -9 -3 \
                -9 -9 -2.9  -9 9 -2.9  9 9 -2.9  9 -9 -2.9] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6]";
    let room = Room {
        before: "Integrator \"path\" \"integer maxdepth\" 1",
        more: more.to_owned(),
        ..Room::default()
    };
    let text = room.text();
    let found = ill(&text);
    for found in found {
        let told = found.iter().find(|f| f.message.contains("given up after 1 bounces"));
        let told = told.unwrap_or_else(|| panic!("{found:#?}"));
        assert_eq!(told.remedy.as_deref(), Some("try --max-depth 6"));
    }
    assert_eq!(ill(&text.replace("maxdepth\" 1", "maxdepth\" 6")), [[], []]);
}

#[test]
fn glass_that_faces_inwards_is_named_and_glass_that_does_not_is_not() {
    let glass = |indices: &str, before: &str| {
        let more = format!(
            "AttributeBegin {before} Translate 1 .5 0 Material \"dielectric\" Shape \"trianglemesh\" \
             \"string name\" \"ice\" {CORNERS} \"integer indices\" {indices} AttributeEnd"
        );
        Room { more, ..Room::default() }
    };
    let told = ["inside out: the triangles of \"ice\" face into the glass", "ReverseOrientation"];
    expect(&glass(INWARDS, ""), false, told);
    expect(&glass(OUTWARDS, "ReverseOrientation"), false, told);
    for healthy in
        [glass(OUTWARDS, ""), glass(INWARDS, "ReverseOrientation"), glass(OUTWARDS, "Scale -1 1 1")]
    {
        assert_eq!(ill(&healthy.text()), [[], []]);
    }
}
