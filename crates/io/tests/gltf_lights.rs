//! Lights of extensions that bring files: luminaires (EXT_lights_ies) and pictures all around (EXT_lights_image_based).
mod gltf_document;

use base64::{Engine, engine::general_purpose::STANDARD};
use durer_core::glam::DVec3;
use durer_io::{image::encode_png_rgba, import::Imported};
use durer_scene::{Assets, Data, ImageData, LightDesc, Severity};
use gltf_document::{first, import, import_well, numbers};
use serde_json::{Value, json};

const LAMP: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 50 0\n";

fn word(light: &LightDesc, name: &str) -> String {
    match light.node.params.get(name).map(|p| &p.data) {
        Some(Data::Strings(v)) => v[0].clone(),
        other => panic!("{name}: {other:?}"),
    }
}

fn luminaires(node: Value) -> Value {
    let uri = format!("data:application/x-ies-lm-63;base64,{}", STANDARD.encode(LAMP));
    json!({
        "extensionsUsed": ["EXT_lights_ies"], "extensionsRequired": ["EXT_lights_ies"],
        "extensions": {"EXT_lights_ies": {"lights": [{"uri": uri}, {"uri": "hall.ies"},
            {"bufferView": 0, "mimeType": "application/x-ies-lm-63"}]}},
        "bufferViews": [{"buffer": 0, "byteLength": LAMP.len()}],
        "nodes": [{"translation": [1, 2, 3], "scale": [5, 5, 5], "extensions": {"EXT_lights_ies": node}}],
    })
}

#[test]
fn luminaires_shine_along_the_z_axis_of_their_node() {
    for (index, file) in [(0, "luminaire:0"), (1, "hall.ies"), (2, "luminaire:2")] {
        let node = json!({"light": index, "multiplier": 2.5, "color": [1, 0.5, 0]});
        let imported = import_well(luminaires(node), LAMP.as_bytes());
        let light = &imported.desc.lights[0];
        assert_eq!((light.node.kind.as_str(), word(light, "filename")), ("ies", file.to_owned()));
        assert_eq!(
            (numbers(&light.node, "I"), numbers(&light.node, "scale")),
            (vec![1.0, 0.5, 0.0], vec![2.5])
        );
        assert_eq!(numbers(&light.node, "to"), [0.0, 0.0, -1.0]);
        // Its intensity does not change with the scale of its node, and angles across grow from x by y.
        let placed = light.world_from_light.at(0.0);
        assert_eq!(placed.transform_point3(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(placed.transform_vector3(DVec3::new(1.0, -1.0, -1.0)), DVec3::new(1.0, 1.0, -1.0));
        if index != 1 {
            assert_eq!(&*imported.assets.bytes(file).expect("embedded"), LAMP.as_bytes());
        }
    }
}

#[test]
fn luminaires_that_are_not_there_are_told() {
    let said = |node: Value| first(&import(luminaires(node), LAMP.as_bytes()), Severity::Error);
    let (place, message) = said(json!({"light": 3}));
    assert!(
        place == "/nodes/0/extensions/EXT_lights_ies/light" && message.contains("has 3"),
        "{place} {message}"
    );
    let (place, _) = said(json!({"light": 0, "multiplier": -1}));
    assert_eq!(place, "/nodes/0/extensions/EXT_lights_ies/multiplier");
    let mut nowhere = luminaires(json!({"light": 0}));
    nowhere["extensions"]["EXT_lights_ies"]["lights"][0] = json!({});
    let (place, _) = first(&import(nowhere, LAMP.as_bytes()), Severity::Error);
    assert!(place.starts_with("/extensions/EXT_lights_ies/lights/0"), "{place}");
}

/// A scene in the middle of six faces of two by two pixels.
fn cube(faces: [[[u8; 4]; 4]; 6], light: Value) -> Value {
    let image = |face: [[u8; 4]; 4]| {
        let png = encode_png_rgba(2, 2, face.as_flattened()).expect("in memory");
        json!({"uri": format!("data:image/png;base64,{}", STANDARD.encode(png))})
    };
    let mut own =
        json!({"irradianceCoefficients": [], "specularImageSize": 2, "specularImages": [[0, 1, 2, 3, 4, 5]]});
    light.as_object().expect("an object").iter().for_each(|(name, value)| own[name] = value.clone());
    json!({
        "extensionsUsed": ["EXT_lights_image_based"], "extensionsRequired": ["EXT_lights_image_based"],
        "extensions": {"EXT_lights_image_based": {"lights": [own]}},
        "images": faces.map(image), "nodes": [{}],
        "scenes": [{"nodes": [0], "extensions": {"EXT_lights_image_based": {"light": 0}}}],
    })
}

/// What the picture all around has in column x and row y.
fn seen(imported: &Imported, x: usize, y: usize) -> [f32; 3] {
    let picture = imported.assets.image("surroundings.pfm").expect("made");
    assert_eq!((picture.width, picture.height), (8, 4));
    let ImageData::F32(values) = &picture.data else { panic!("floats") };
    // Four equal corners may sum to a little less.
    [0, 1, 2].map(|c| (values[3 * (8 * y + x) + c] * 1e5).round() / 1e5)
}

#[test]
fn faces_of_a_cube_lie_where_they_are_seen() {
    let even = |r: u8, g: u8, b: u8| [[r, g, b, 255]; 4];
    let faces = [
        even(255, 0, 0),
        even(0, 255, 255),
        even(0, 255, 0),
        even(255, 0, 255),
        even(0, 0, 255),
        even(255, 255, 0),
    ];
    let imported =
        import_well(cube(faces, json!({"intensity": 3, "rotation": [0, 0, 1, 0], "name": "studio"})), &[]);
    let light = &imported.desc.lights[0];
    assert_eq!((light.name.as_str(), light.node.kind.as_str()), ("studio", "infinite"));
    assert_eq!((numbers(&light.node, "scale"), word(light, "layout")), (vec![3.0], "latlong".to_owned()));
    // Half a turn about z.
    let turned = light.world_from_light.at(0.0).transform_vector3(DVec3::X);
    assert!((turned + DVec3::X).length() < 1e-12, "{turned:?}");
    // Rows from +z down to -z, columns from +x by +y.
    assert_eq!((seen(&imported, 0, 0), seen(&imported, 5, 3)), ([0.0, 0.0, 1.0], [1.0, 1.0, 0.0]));
    let around = [0, 1, 2, 3, 4, 5, 6, 7].map(|x| seen(&imported, x, 1));
    assert_eq!((around[0], around[7]), ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), "+x");
    assert_eq!((around[1], around[2]), ([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]), "+y");
    assert_eq!((around[3], around[4]), ([0.0, 1.0, 1.0], [0.0, 1.0, 1.0]), "-x");
    assert_eq!((around[5], around[6]), ([1.0, 0.0, 1.0], [1.0, 0.0, 1.0]), "-y");
}

#[test]
fn faces_stand_upright_and_are_divided_by_alpha() {
    let dark = [[0, 0, 0, 255]; 4];
    // On the right above, five times as bright as white.
    let lit = [dark[0], [255, 255, 255, 51], dark[0], dark[0]];
    // Who looks along -z has +x on the right, along +y (up is -z) -x.
    let of = |face: usize| {
        let mut faces = [dark; 6];
        faces[face] = lit;
        import_well(cube(faces, json!({})), &[])
    };
    let down = of(5);
    let quadrants = [[0, 1], [2, 3], [4, 5], [6, 7]].map(|columns| columns.map(|x| seen(&down, x, 3)[0]));
    assert!(quadrants[0].iter().all(|v| *v > 1.0), "{quadrants:?}");
    assert!(quadrants[1..].iter().flatten().all(|v| *v < quadrants[0][0]), "{quadrants:?}");
    let side = of(2);
    // Column 2 is beside column 1 on the side of -x. Above, which is -z, are the rows 2 and 3.
    assert!(seen(&side, 2, 2)[0] > seen(&side, 1, 2)[0] && seen(&side, 2, 2)[0] > seen(&side, 2, 1)[0]);
    assert!(seen(&side, 2, 2)[0] > 1.0 && seen(&side, 2, 2)[0] <= 5.0 + 1e-4);
}

#[test]
fn pictures_all_around_that_are_wrong_are_told() {
    let even = [[[9, 9, 9, 255]; 4]; 6];
    let said = |light: Value| first(&import(cube(even, light), &[]), Severity::Error);
    let at = "/extensions/EXT_lights_image_based/lights/0";
    let (place, message) = said(json!({"specularImages": [[0, 1, 2]]}));
    assert!(place == format!("{at}/specularImages/0") && message.contains("found 3"), "{place} {message}");
    assert_eq!(said(json!({"specularImages": []})).0, format!("{at}/specularImages"));
    assert_eq!(said(json!({"intensity": -1})).0, format!("{at}/intensity"));
    assert_eq!(said(json!({"specularImages": [[0, 1, 2, 3, 4, 9]]})).0, format!("{at}/specularImages/0/5"));
    let mut other = cube(even, json!({}));
    other["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = json!(1);
    let (place, message) = first(&import(other, &[]), Severity::Error);
    assert!(
        place.ends_with("/EXT_lights_image_based/light") && message.contains("has 1"),
        "{place} {message}"
    );
}
