//! Small animated glTF documents: formulas of the curves, what pointers change, which moments a blurred picture needs,
//! variants, and what is said of animations that cannot be played.
mod gltf_document;

use durer_core::{
    glam::{DQuat, DVec3},
    math::Interval,
};
use durer_io::import::{Imported, Moment, Play, Reading};
use durer_scene::{SceneDesc, Severity};
use gltf_document::{first, floats, import_as, numbers};
use serde_json::{Value, json};

/// The times 1, 2 and 4 s in accessor 1, then `values` as accessor 2 of `kind`; accessor 0 is a triangle.
fn document(values: &[f32], kind: &str, count: usize) -> (Value, Vec<u8>) {
    let mut bytes = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    bytes.extend(floats(&[1., 2., 4.]));
    bytes.extend(floats(values));
    let accessor = |view: usize, kind: &str, count: usize| json!({"bufferView": view, "componentType": 5126, "type": kind, "count": count});
    let mut document = json!({
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [accessor(0, "VEC3", 3), accessor(1, "SCALAR", 3), accessor(2, kind, count)],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12},
            {"buffer": 0, "byteOffset": 48, "byteLength": 4 * values.len()}],
    });
    document["accessors"][1]["min"] = json!([1]);
    document["accessors"][1]["max"] = json!([4]);
    (document, bytes)
}

/// One animation with one channel.
fn animation(path: &str, way: &str) -> Value {
    json!([{"name": "Walking", "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
        "samplers": [{"input": 1, "output": 2, "interpolation": way}]}])
}

fn pointing(to: &str, way: &str) -> Value {
    let target = json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": to}}});
    json!([{"channels": [{"sampler": 0, "target": target}],
        "samplers": [{"input": 1, "output": 2, "interpolation": way}]}])
}

fn during(document: &Value, bytes: &[u8], shutter: Interval) -> Imported {
    let moment = Moment { time: shutter.min, shutter };
    import_as(document.clone(), bytes, Reading { play: Play::First, moment, ..Reading::default() })
}

fn at(document: &Value, bytes: &[u8], time: f32) -> SceneDesc {
    let imported = during(document, bytes, Interval::point(time));
    assert!(!imported.diagnostics.has_errors(), "{:#?}", imported.diagnostics);
    imported.desc
}

fn place(desc: &SceneDesc) -> DVec3 {
    desc.shapes[0].world_from_object.at(0.0).translation
}

#[test]
fn translations_step_go_straight_or_follow_hermite_splines() {
    let (mut d, bytes) = document(&[0., 0., 0., 6., 0., 0., 6., 4., 0.], "VEC3", 3);
    for (way, time, expected) in [
        ("STEP", 0.0, [0., 0., 0.]),
        ("STEP", 1.999, [0., 0., 0.]),
        ("STEP", 2.0, [6., 0., 0.]),
        ("STEP", 9.0, [6., 4., 0.]),
        ("LINEAR", 1.25, [1.5, 0., 0.]),
        ("LINEAR", 3.0, [6., 2., 0.]),
        ("LINEAR", 4.5, [6., 4., 0.]),
    ] {
        d["animations"] = animation("translation", way);
        let found = place(&at(&d, &bytes, time));
        assert!((found - DVec3::from(expected)).length() < 1e-9, "{way} {time}: {found}");
    }
    // In, value, out of three keys, all along x.
    let rows = [[0., 0., 3.], [-1., 2., 0.5], [0., -1., 0.]];
    let all: Vec<f32> = rows.as_flattened().iter().flat_map(|v| [*v as f32, 0., 0.]).collect();
    let (mut d, bytes) = document(&all, "VEC3", 9);
    d["animations"] = animation("translation", "CUBICSPLINE");
    let hermite = |t: f64, d: f64, [p, m, n, q]: [f64; 4]| {
        let (a, b) = (2. * t.powi(3) - 3. * t * t + 1., 3. * t * t - 2. * t.powi(3));
        a * p + b * q + d * (t.powi(3) - 2. * t * t + t) * m + d * (t.powi(3) - t * t) * n
    };
    for (time, expected) in [
        (1.0, 0.0),
        (1.25, hermite(0.25, 1.0, [0., 3., -1., 2.])),
        (1.5, hermite(0.5, 1.0, [0., 3., -1., 2.])),
        (3.5, hermite(0.75, 2.0, [2., 0.5, 0., -1.])),
        (4.0, -1.0),
    ] {
        let found = place(&at(&d, &bytes, time)).x;
        assert!((found - expected).abs() < 1e-9, "{time}: {found} {expected}");
    }
}

#[test]
fn rotations_take_the_short_way_round() {
    let turn = |angle: f64| DQuat::from_rotation_z(angle).as_quat().to_array();
    // The second quaternion is that of 1.2 radians, from the other side.
    let second = turn(1.2).map(|v| -v);
    let all = [turn(0.4), second, turn(1.2)].concat();
    let (mut d, bytes) = document(&all, "VEC4", 3);
    d["animations"] = animation("rotation", "LINEAR");
    let x = at(&d, &bytes, 1.25).shapes[0].world_from_object.at(0.0).matrix3.x_axis;
    assert!((x - DVec3::new(0.6f64.cos(), 0.6f64.sin(), 0.0)).length() < 1e-6, "{x}");
}

#[test]
fn a_shutter_gets_as_many_moments_as_the_way_needs() {
    // Straight: two moments. A jump: one just before it.
    let (mut d, bytes) = document(&[0., 0., 0., 6., 0., 0., 6., 4., 0.], "VEC3", 3);
    d["animations"] = animation("translation", "LINEAR");
    let keys = |d: &Value, bytes: &[u8], from, to| {
        let desc = during(d, bytes, Interval::new(from, to)).desc;
        desc.shapes[0].world_from_object.keys().to_vec()
    };
    assert_eq!(keys(&d, &bytes, 1.0, 1.5).len(), 2);
    assert_eq!(keys(&d, &bytes, 1.0, 3.0).iter().map(|k| k.0).collect::<Vec<_>>(), [1.0, 2.0, 3.0]);
    assert_eq!(keys(&d, &bytes, 5.0, 6.0).len(), 1, "behind the last key nothing moves");
    d["animations"] = animation("translation", "STEP");
    let jump = keys(&d, &bytes, 1.5, 2.5);
    let times: Vec<f64> = jump.iter().map(|k| k.0).collect();
    assert_eq!(times, [1.5, f64::from(2.0f32.next_down()), 2.0, 2.5]);
    assert_eq!((jump[1].1.translation.x, jump[2].1.translation.x), (0.0, 6.0));
    // A turn by half a circle: what lies at its edge strays from the circle by a 500th of the way at most.
    let turn = |angle: f64| DQuat::from_rotation_z(angle).as_quat().to_array();
    let (mut d, bytes) = document(&[turn(0.0), turn(1.5), turn(3.0)].concat(), "VEC4", 3);
    d["animations"] = animation("rotation", "LINEAR");
    let turned = keys(&d, &bytes, 1.0, 4.0);
    assert!((9..40).contains(&turned.len()), "{}", turned.len());
}

#[test]
fn flat_moments_of_a_growing_node_are_drawn() {
    let (mut d, bytes) = document(&[0., 0., 0., 2., 2., 2., -1., 1., 1.], "VEC3", 3);
    d["animations"] = animation("scale", "LINEAR");
    let imported = during(&d, &bytes, Interval::new(1.0, 2.0));
    assert!(!imported.diagnostics.has_errors(), "{:#?}", imported.diagnostics);
    let mesh = &imported.desc.meshes[1];
    let corner = mesh.corners([1, 1, 1], 1.5)[0];
    assert!((corner.x - 1.0).abs() < 1e-6 && mesh.keys() == 2, "{corner:?} {}", mesh.keys());
    // It is turned inside out on the way.
    let desc = during(&d, &bytes, Interval::new(3.0, 4.0)).desc;
    let corner = desc.meshes[1].corners([1, 1, 1], 3.5)[0];
    assert!((corner.x - (2.0 - 3.0 * 0.75)).abs() < 1e-5, "{corner:?}");
}

#[test]
fn pointers_change_materials_lights_cameras_and_textures() {
    let (mut d, bytes) = document(&[1., 2., 3., 0., 0., 0., 0., 0., 0.], "SCALAR", 3);
    d["materials"] = json!([{"pbrMetallicRoughness": {}, "emissiveFactor": [0.5, 0, 0]}]);
    d["meshes"][0]["primitives"][0]["material"] = json!(0);
    d["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.5}}]);
    d["nodes"][0]["camera"] = json!(0);
    d["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 1, 1]}]}});
    d["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    let mut read = |to: &str, time: f32| {
        d["animations"] = pointing(to, "LINEAR");
        at(&d, &bytes, time)
    };
    let lit = read("/extensions/KHR_lights_punctual/lights/0/intensity", 1.5);
    assert_eq!(numbers(&lit.lights[0].node, "I"), [1.5; 3]);
    let seen = read("/cameras/0/perspective/yfov", 2.0);
    assert!((numbers(&seen.cameras[0].node, "fov")[0] - 2f32.to_degrees()).abs() < 1e-4);
    let (mut d, bytes) = document(&[0.25, 0.75, 0.5], "SCALAR", 3);
    d["materials"] = json!([{"pbrMetallicRoughness": {}}]);
    d["meshes"][0]["primitives"][0]["material"] = json!(0);
    d["animations"] = pointing("/materials/0/pbrMetallicRoughness/roughnessFactor", "LINEAR");
    assert_eq!(numbers(&at(&d, &bytes, 1.5).materials[0].node, "roughness"), [0.5]);
    d["animations"] = pointing("/nodes/0/extensions/KHR_node_visibility/visible", "STEP");
    d["nodes"][0]["extensions"] = json!({"KHR_node_visibility": {}});
    assert_eq!(at(&d, &bytes, 1.5).shapes.len(), 1, "0.25 is true");
}

#[test]
fn a_pointer_into_a_texture_transform_moves_the_texture() {
    let png =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==";
    let (mut d, bytes) = document(&[0., 0., 0.5, 0.25, 1., 1.], "VEC2", 3);
    let info = json!({"index": 0, "extensions": {"KHR_texture_transform": {}}});
    d["images"] = json!([{"uri": format!("data:image/png;base64,{png}")}]);
    d["textures"] = json!([{"source": 0}]);
    d["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": info}}]);
    d["meshes"][0]["primitives"][0]["material"] = json!(0);
    let to = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset";
    d["animations"] = pointing(to, "LINEAR");
    // v grows upwards here: the matrix moves it the other way.
    let matrix = numbers(&at(&d, &bytes, 2.0).textures[0].node, "uvmatrix");
    assert_eq!(matrix, [1., 0., 0.5, 0., 1., -0.25]);
}

#[test]
fn what_cannot_be_played_is_told_with_its_place() {
    let base = || {
        let (mut d, bytes) = document(&[0., 0., 0., 6., 0., 0., 6., 4., 0.], "VEC3", 3);
        d["animations"] = animation("translation", "LINEAR");
        (d, bytes)
    };
    type Break = fn(&mut Value, &mut Vec<u8>);
    let cases: [(Break, &str, &str); 16] = [
        (
            |_, b| b[40..44].copy_from_slice(&1f32.to_le_bytes()),
            "/accessors/1",
            "times must rise: key 0 is at 1 s",
        ),
        (
            |_, b| b[40..44].copy_from_slice(&f32::NAN.to_le_bytes()),
            "/accessors/1",
            "time of key 1 is infinite or NaN",
        ),
        (|_, b| b[52..56].copy_from_slice(&f32::INFINITY.to_le_bytes()), "/accessors/2", "infinite or NaN"),
        (
            |d, _| d["animations"][0]["samplers"][0]["interpolation"] = json!("CUBIC"),
            "/animations/0/samplers/0/interpolation",
            "expected LINEAR, STEP or CUBICSPLINE, found \"CUBIC\"",
        ),
        (
            |d, _| d["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE"),
            "/accessors/2",
            "3 values for 3 keys with two tangents each",
        ),
        (
            |d, _| d["animations"][0]["channels"][0]["sampler"] = json!(7),
            "/animations/0/channels/0/sampler",
            "there is only 1 sampler",
        ),
        (
            |d, _| d["animations"][0]["channels"][0]["target"]["path"] = json!("colour"),
            "/animations/0/channels/0/target/path",
            "found \"colour\"",
        ),
        (
            |d, _| d["animations"][0]["channels"][0]["target"]["path"] = json!("rotation"),
            "/accessors/2",
            "expected 4 numbers per element",
        ),
        (
            |d, _| d["animations"][0]["channels"][0]["target"]["path"] = json!("weights"),
            "/accessors/2",
            "expected 1 number per element",
        ),
        (
            |d, _| d["animations"][0]["channels"][0]["target"]["node"] = json!(9),
            "/animations/0/channels/0/target/node",
            "there is only 1 node",
        ),
        (
            |d, _| d["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
            "/animations/0/channels/0/target/path",
            "has a matrix",
        ),
        (|d, _| d["accessors"][1]["count"] = json!(4_000_000_000u64), "/accessors/1", "do not fit"),
        (|d, _| d["accessors"][1]["count"] = json!(0), "/accessors/1", "at least one key"),
        (
            |d, _| {
                d["animations"][0]["channels"] =
                    json!([d["animations"][0]["channels"][0], d["animations"][0]["channels"][0]])
            },
            "/animations/0/channels/1",
            "already changes the same",
        ),
        (
            |d, _| d["animations"] = pointing("/materials/0/alphaCutoff", "LINEAR"),
            "/animations/0/channels/0/target/extensions/KHR_animation_pointer/pointer",
            "leads to nothing",
        ),
        (
            |d, _| d["animations"][0]["channels"][0]["target"]["path"] = json!("pointer"),
            "/animations/0/channels/0/target",
            "needs the extension KHR_animation_pointer",
        ),
    ];
    for (number, (break_it, pointer, message)) in cases.into_iter().enumerate() {
        let (mut d, mut bytes) = base();
        break_it(&mut d, &mut bytes);
        let imported = during(&d, &bytes, Interval::new(1.0, 2.0));
        let found = first(&imported, Severity::Error);
        assert!(found.0 == pointer && found.1.contains(message), "case {number}: {found:?}");
    }
}

#[test]
fn an_animation_is_chosen_by_name_or_index() {
    let (mut d, bytes) = document(&[0., 0., 0., 6., 0., 0., 6., 4., 0.], "VEC3", 3);
    d["animations"] = animation("translation", "LINEAR");
    let read = |play: Play| {
        let moment = Moment { time: 2.0, shutter: Interval::point(2.0) };
        import_as(d.clone(), &bytes, Reading { play, moment, ..Reading::default() })
    };
    for play in
        [Play::First, Play::Named("Walking".into()), Play::Named("0".into()), Play::Named("all".into())]
    {
        assert_eq!(place(&read(play).desc).x, 6.0);
    }
    assert_eq!(place(&read(Play::Rest).desc).x, 0.0);
    let wrong = read(Play::Named("Walkng".into()));
    let error = wrong.diagnostics.iter().find(|d| d.severity == Severity::Error).expect("an error");
    assert_eq!(error.hint.as_deref(), Some("did you mean \"Walking\"?"));
    let told = wrong.desc.animations.first().map(|a| (a.name.as_str(), a.start, a.end));
    assert_eq!(told, Some(("Walking", 1.0, 4.0)));
}

#[test]
fn a_variant_wears_its_materials() {
    let (mut d, bytes) = document(&[], "SCALAR", 0);
    d["accessors"].as_array_mut().expect("accessors").pop();
    d["materials"] = json!([{"name": "own"}, {"name": "red"}, {"name": "blue"}]);
    d["extensions"] = json!({"KHR_materials_variants": {"variants": [{"name": "Fire"}, {"name": "Ocean"}]}});
    let mappings = json!([{"material": 1, "variants": [0]}, {"material": 2, "variants": [1]}]);
    d["meshes"][0]["primitives"][0]["material"] = json!(0);
    d["meshes"][0]["primitives"][0]["extensions"] = json!({"KHR_materials_variants": {"mappings": mappings}});
    let read = |variant: Option<&str>| {
        let variant = variant.map(str::to_owned);
        import_as(d.clone(), &bytes, Reading { variant, ..Reading::default() })
    };
    for (variant, index) in [(None, 0), (Some("Fire"), 1), (Some("Ocean"), 2), (Some("1"), 2)] {
        let desc = read(variant).desc;
        assert_eq!(desc.shapes[0].material.map(|m| m.index()), Some(index), "{variant:?}");
        assert_eq!(desc.variants, ["Fire", "Ocean"]);
    }
    let wrong = read(Some("Ocen"));
    let error = wrong.diagnostics.iter().find(|d| d.severity == Severity::Error).expect("an error");
    assert_eq!(error.hint.as_deref(), Some("did you mean \"Ocean\"?"));
}
