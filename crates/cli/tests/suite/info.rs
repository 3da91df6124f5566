//! `durer info`: what it counts, and that `docs/json.md` tells the truth about its JSON form.
use std::collections::BTreeSet;

use serde_json::Value;

use crate::run::Place;

/// Two squares of one material and a ball, with a texture, a light, a camera, and a parameter nobody knows.
const ROOM: &str = r#"
Film "rgb" "integer xresolution" 32 "integer yresolution" 24 "string filename" "room.png"
Sampler "sobol" "integer pixelsamples" 2
Integrator "path"
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 60
WorldBegin
LightSource "infinite"
Texture "grid" "spectrum" "checkerboard"
MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "grid"
NamedMaterial "floor"
Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] "integer indices" [0 1 2 0 2 3]
Translate 0 0 1
Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0] "integer indices" [0 1 2]
Shape "sphere" "float radius" 0.5
"#;

/// A triangle with an animation.
const MOVING: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": 1, "output": 0}]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [1]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

/// Paths of all keys that hold something other than an object or a list of objects.
fn keys(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                keys(value, &path, found);
            }
        }
        Value::Array(items) if items.iter().any(Value::is_object) => {
            items.iter().for_each(|item| keys(item, &format!("{path}[]"), found));
        }
        _ => drop(found.insert(path.to_owned())),
    }
}

/// The keys in the first column of the table below a heading of `docs/json.md`.
fn documented(heading: &str) -> BTreeSet<String> {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/json.md");
    let page = std::fs::read_to_string(page).expect("docs/json.md");
    let (_, section) = page.split_once(heading).expect("the section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `")?.split_once(" | "));
    let words = rows.flat_map(|(first, _)| first.split(['`', ',', ' ']));
    words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

#[test]
fn the_documented_keys_are_those_of_the_output() {
    let place = Place::new().with("room.pbrt", ROOM).with("moving.gltf", MOVING);
    let mut found = BTreeSet::new();
    keys(&place.done("info room.pbrt --json").json(), "", &mut found);
    keys(&place.done("info moving.gltf --json").json(), "", &mut found);
    // A list that is empty in one of them shows its keys in the other.
    let lists: BTreeSet<String> =
        found.iter().filter_map(|key| Some(key.split_once("[]")?.0.to_owned())).collect();
    found.retain(|key| !lists.contains(key));
    let documented = documented("## `durer info --json`");
    let missing: Vec<_> = found.difference(&documented).collect();
    let gone: Vec<_> = documented.difference(&found).collect();
    assert!(missing.is_empty() && gone.is_empty(), "not documented: {missing:?}; not printed: {gone:?}");
}

#[test]
fn triangles_vertices_and_sizes_are_those_of_the_file() {
    let place = Place::new().with("room.pbrt", ROOM);
    let info = place.done("info room.pbrt --json").json();
    let counts = &info["counts"];
    for (key, count) in [
        ("shapes", 3),
        ("vertices", 7),
        ("triangles_described", 3),
        ("triangles_placed", 3),
        ("triangles", 3),
        ("other_shapes", 1),
        ("materials", 1),
        ("textures", 1),
        ("lights", 1),
        ("cameras", 1),
    ] {
        assert_eq!(counts[key], count, "{key}");
    }
    // 12 bytes a vertex and 12 a triangle: nothing else was given.
    assert_eq!(info["memory"]["meshes"], 7 * 12 + 3 * 12);
    assert_eq!(info["bounds"]["min"], serde_json::json!([-1.0, -1.0, 0.0]));
    // The ball's box holds its rounding errors too.
    let far = info["bounds"]["max"][2].as_f64().expect("a number");
    assert!((1.5..1.500_001).contains(&far), "{far}");
    assert_eq!(info["film"]["filename"], "room.png");
}

#[test]
fn a_mesh_that_is_placed_thrice_is_described_once() {
    let text = "WorldBegin\nObjectBegin \"a\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \
                \"integer indices\" [0 1 2]\nObjectEnd\nObjectInstance \"a\"\nTranslate 2 0 0\nObjectInstance \"a\"\n\
                Translate 2 0 0\nObjectInstance \"a\"\n";
    let place = Place::new().with("three.pbrt", text);
    let counts = place.done("info three.pbrt --json").json()["counts"].clone();
    assert_eq!((&counts["triangles_described"], &counts["triangles_placed"]), (&1.into(), &3.into()));
    assert_eq!(counts["triangles"], 1);
}

#[test]
fn the_picture_holds_its_layers_too() {
    let spectral = ROOM.replace("Film \"rgb\"", "Film \"spectral\" \"integer nbuckets\" 4");
    let place = Place::new().with("room.pbrt", ROOM).with("spectral.pbrt", &spectral);
    let [alone, with] = ["room", "spectral"].map(|scene| {
        place.done(&format!("info {scene}.pbrt --json")).json()["memory"]["film"].as_u64().expect("bytes")
    });
    // Each bucket's sum and weight, and its splats.
    assert_eq!(with - alone, 32 * 24 * 4 * (8 + 8 + 16));
}

#[test]
fn phases_are_parts_of_the_whole() {
    let seconds = Place::new().done("info whitted --json").json()["seconds"].clone();
    let of = |key: &str| seconds[key].as_f64().expect("a time");
    assert!(of("textures") + of("geometry") + of("acceleration") <= of("build"), "{seconds}");
    assert!((of("load") + of("build") - of("total")).abs() < 1e-6, "{seconds}");
}

/// A grid of triangles over `side` by `side` squares.
fn hills(side: usize) -> String {
    let (mut points, mut indices) = (String::new(), String::new());
    for y in 0..=side {
        (0..=side).for_each(|x| points.push_str(&format!("{x} {y} {} ", (x * y) % 7)));
    }
    for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
        let i = y * (side + 1) + x;
        indices.push_str(&format!("{i} {} {} ", i + 1, i + side + 2));
    }
    format!("Shape \"trianglemesh\" \"point3 P\" [{points}] \"integer indices\" [{indices}]\n")
}

#[test]
fn the_expected_size_of_the_hierarchy_is_somewhat_above_the_real_one() {
    let placed = |what: &str| {
        let one = |i| format!("AttributeBegin\nTranslate {i} {} 0\n{what}AttributeEnd\n", i * i % 17);
        (0..400).map(one).collect::<String>()
    };
    let shared = format!("ObjectBegin \"o\"\n{}ObjectEnd\n{}", hills(2), placed("ObjectInstance \"o\"\n"));
    let scenes = [hills(60), placed(&hills(1)), placed("Shape \"sphere\" \"float radius\" 0.5\n"), shared];
    for scene in scenes {
        let place = Place::new().with("scene.pbrt", &format!("WorldBegin\n{scene}"));
        let memory = place.done("info scene.pbrt --json").json()["memory"].clone();
        let of = |key: &str| memory[key].as_f64().expect("bytes");
        let ratio = of("hierarchy_expected") / of("hierarchy");
        assert!((1.0..2.5).contains(&ratio), "{ratio} {memory}");
        assert!(of("hierarchy_building") > of("hierarchy_expected"), "{memory}");
        if cfg!(target_os = "linux") {
            assert!(of("peak") > of("hierarchy") + of("meshes"), "{memory}");
        }
    }
}

#[test]
fn nothing_to_draw_is_an_error_of_render_and_a_warning_of_info() {
    let gltf =
        r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "a"}]}"#;
    let light = "WorldBegin\nLightSource \"point\"\n";
    let place = Place::new().with("empty.gltf", gltf).with("lamp.pbrt", light);
    for scene in ["empty.gltf", "lamp.pbrt"] {
        let ran = place.run(&format!("render {scene} --width 8 --spp 1"));
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{}", ran.stderr);
        let said = format!("error: {scene}: nothing to draw");
        assert!(ran.stderr.starts_with(&said), "{}", ran.stderr);
        let info = place.done(&format!("info {scene} --json")).json();
        assert_eq!((&info["complaints"]["errors"], &info["bounds"]), (&0.into(), &Value::Null));
        assert!(info["diagnostics"].to_string().contains("nothing to draw"), "{info}");
    }
    assert!(place.holds_only(&["empty.gltf", "lamp.pbrt"]));
}

#[test]
fn a_sky_alone_is_a_picture_with_a_warning() {
    let place = Place::new().with("sky.pbrt", "WorldBegin\nLightSource \"infinite\"\n");
    let ran = place.done("render sky.pbrt --width 8 --spp 1");
    assert!(ran.stderr.contains("only its sky"), "{}", ran.stderr);
    let dark = Place::new().with("dark.pbrt", "WorldBegin\nLightSource \"infinite\" \"rgb L\" [0 0 0]\n");
    assert_eq!(dark.run("render dark.pbrt --width 8 --spp 1").code, 1);
}
