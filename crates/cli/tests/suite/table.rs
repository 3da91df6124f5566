//! What `durer info` prints for people.
use crate::run::Place;

/// A strip of forty triangles and one without area, with a texture, as `x.gltf`.
fn place() -> Place {
    let json = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"doubleSided": true, 
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": "dot.png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 42, "type": "VEC3", "min": [0, 0, 0], "max": [41, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 42, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5125, "count": 123, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 504}, {"buffer": 0, "byteOffset": 504, "byteLength": 336},
            {"buffer": 0, "byteOffset": 840, "byteLength": 492}],
        "buffers": [{"byteLength": 1332, "uri": "x.bin"}]}"#;
    let points = (0..42u8).flat_map(|i| [f32::from(i), f32::from(i % 2), 0.0]);
    let triangles = (0..40u32).flat_map(|i| [i, i + 1, i + 2]).chain([0, 1, 1]);
    let mut bytes: Vec<u8> = points.chain([0.0; 84]).flat_map(f32::to_le_bytes).collect();
    bytes.extend(triangles.flat_map(u32::to_le_bytes));
    let place = Place::new().with("x.gltf", json);
    std::fs::write(place.path("x.bin"), bytes).expect("a file");
    place.done("render whitted --width 3 --height 2 --spp 1 -o dot.png");
    place
}

/// A scene that says everything about its picture, with textures and two kinds of shapes.
const SAID: &str = r#"
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 60
WorldBegin
LightSource "infinite"
Texture "a" "spectrum" "imagemap" "string filename" "dot.png"
Texture "b" "spectrum" "imagemap" "string filename" "dot.png"
Texture "c" "spectrum" "checkerboard"
Shape "disk"
Shape "sphere"
"#;

/// The lines of a row, without its name.
fn row<'a>(table: &'a str, name: &str) -> Vec<&'a str> {
    let mut lines = table.lines().skip_while(|line| line.split(' ').next() != Some(name));
    let first = lines.next().unwrap_or_else(|| panic!("no row {name} in\n{table}"));
    let rest = lines.take_while(|line| line.starts_with(' '));
    std::iter::once(first.strip_prefix(name).unwrap_or(first)).chain(rest).map(str::trim).collect()
}

#[test]
fn rows_say_what_there_is_and_leave_out_what_there_is_not() {
    let place = place().with("said.pbrt", SAID);
    let table = place.done("info x.gltf").stdout;
    assert_eq!(row(&table, "shapes"), ["1 mesh"]);
    assert_eq!(row(&table, "triangles"), ["41, with 42 vertices"]);
    assert_eq!(row(&table, "textures"), ["1, 1 image", "dot.png, 3 x 2 pixels"]);
    assert!(row(&table, "cameras")[0].starts_with("none; an automatic one"), "{table}");
    assert_eq!(row(&table, "picture"), ["1280 x 720 pixels by default, 64 samples per pixel by default"]);
    assert_eq!(row(&table, "integrator"), ["path by default"]);
    assert_eq!(row(&table, "bounds"), ["from 0 0 0 to 41 1 0, size 41 x 1 x 0 (metres)"]);
    assert!(!table.contains("hierarchy") && !table.contains("node"), "{table}");
    assert!(place.done("info x.gltf -v").stdout.contains("hierarchy"), "{table}");

    let table = place.done("info said.pbrt").stdout;
    assert_eq!(row(&table, "shapes"), ["2 shapes without mesh (disk, sphere)"]);
    let camera =
        "0  perspective, at 0 0 -4, looking along 0 0 1, fov 60 deg (of the shorter side)  <- default";
    assert_eq!(row(&table, "cameras"), ["1", camera]);
    assert_eq!(row(&table, "picture"), ["32 x 24 pixels, 64 samples per pixel by default"]);
    assert!(!table.contains("triangles"), "{table}");

    let twice = "WorldBegin\nObjectBegin \"a\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \
                 \"integer indices\" [0 1 2]\nObjectEnd\nObjectInstance \"a\"\nTranslate 2 0 0\nObjectInstance \"a\"\n";
    let table = place.with("twice.pbrt", twice).done("info twice.pbrt").stdout;
    assert_eq!(row(&table, "shapes"), ["2 placements of 1 mesh"]);
    assert_eq!(row(&table, "triangles"), ["2 as placed; 1 as stored, with 3 vertices"]);
}

#[test]
fn the_number_of_diagnostics_is_that_of_those_listed_and_none_is_said_twice() {
    let place = place();
    let table = place.done("info x.gltf").stdout;
    let listed = |word: &str| table.lines().filter(|line| line.starts_with(word)).count();
    assert_eq!(row(&table, "diagnostics"), ["3 notes"], "{table}");
    assert_eq!((listed("error: "), listed("warning: "), listed("note: ")), (0, 0, 3), "{table}");
    assert!(table.contains("note: 1 triangle has no area, so nothing can hit it: harmless"), "{table}");
    let json = place.done("info x.gltf --json").json();
    assert_eq!(json["complaints"]["notes"], 3);
    assert_eq!(json["diagnostics"].as_array().map(Vec::len), Some(3));
    assert_eq!(json["doctor"].as_array().map(Vec::len), Some(1));
}

#[test]
fn only_a_camera_of_the_file_can_stand_inside_something() {
    let place = Place::new()
        .with("free.pbrt", "WorldBegin\nReverseOrientation\nShape \"sphere\"\n")
        .with("within.pbrt", "Camera \"perspective\"\nWorldBegin\nShape \"sphere\"\n");
    assert!(place.done("info within.pbrt").stdout.contains("warning: 100 % of what the camera sees"));
    assert!(!place.done("info free.pbrt").stdout.contains("from its inside"));
}

#[test]
fn many_textures_are_counted_after_the_first_twenty() {
    let textures: String =
        (0..23).map(|i| format!("Texture \"t{i}\" \"spectrum\" \"checkerboard\"\n")).collect();
    let place = Place::new().with("x.pbrt", &format!("WorldBegin\n{textures}Shape \"sphere\"\n"));
    let brief = place.done("info x.pbrt").stdout;
    let lines = row(&brief, "textures");
    assert_eq!((lines.len(), lines.last()), (22, Some(&"... and 3 more (-v lists all)")), "{brief}");
    assert_eq!(row(&place.done("info x.pbrt -v").stdout, "textures").len(), 24);
}

#[test]
fn what_a_picture_lacks_is_said_when_it_is_rendered() {
    let gltf = r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_pbrSpecularGlossiness", "KHR_xmp"],
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": 1, "output": 0}]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    let place = Place::new().with("x.gltf", gltf);
    let said = place.done("render x.gltf --width 8 --spp 1").stderr;
    assert!(said.contains("warning: ") && said.contains("KHR_materials_pbrSpecularGlossiness"), "{said}");
    assert!(said.contains("1 animation is not played"), "{said}");
    assert!(!said.contains("KHR_xmp"), "metadata is no loss: {said}");
}
