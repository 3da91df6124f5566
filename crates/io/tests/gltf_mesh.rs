//! What glTF primitives become: triangles, attributes, instances, and refusals that point at their cause.
mod gltf_document;

use durer_core::{glam::DVec3, math::Point3};
use durer_scene::{Severity, ShapeSource};
use gltf_document::{first, floats, import, import_well};
use serde_json::{Value, json};

/// Five vertices on a zigzag, then the indices 0 to 4 as bytes.
fn zigzag() -> Vec<u8> {
    let mut bytes = floats(&[0., 0., 0., 0., 1., 0., 1., 0., 0., 1., 1., 0., 2., 0., 0.]);
    bytes.extend([0, 1, 2, 3, 4]);
    bytes
}

fn document(primitive: Value) -> Value {
    json!({
        "nodes": [{"mesh": 0, "name": "thing"}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 5},
            {"bufferView": 1, "componentType": 5121, "type": "SCALAR", "count": 5},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 60}, {"buffer": 0, "byteOffset": 60, "byteLength": 5}],
    })
}

#[test]
fn strips_turn_every_second_triangle_and_fans_keep_their_hub() {
    for (mode, expected) in [
        (5, vec![[0, 1, 2], [1, 3, 2], [2, 3, 4]]),
        (6, vec![[1, 2, 0], [2, 3, 0], [3, 4, 0]]),
        (4, vec![[0, 1, 2]]),
    ] {
        for indexed in [false, true] {
            let mut primitive = json!({"attributes": {"POSITION": 0}, "mode": mode});
            if indexed {
                primitive["indices"] = json!(1);
            }
            let imported = import_well(document(primitive), &zigzag());
            assert_eq!(imported.desc.meshes[0].indices, expected, "mode {mode}");
            assert_eq!(imported.diagnostics.iter().any(|d| d.message.contains("multiple of 3")), mode == 4);
        }
    }
}

#[test]
fn lines_and_points_are_skipped_with_one_warning_each() {
    let mut d = document(json!({"attributes": {"POSITION": 0}, "mode": 1}));
    let primitive = d["meshes"][0]["primitives"][0].clone();
    d["meshes"][0]["primitives"] = json!([primitive, primitive, {"attributes": {"POSITION": 0}, "mode": 0}]);
    let imported = import_well(d, &zigzag());
    assert!(imported.desc.shapes.is_empty());
    let said: Vec<_> = imported.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert_eq!(
        said,
        ["lines are not drawn: they have no surface", "points are not drawn: they have no surface"]
    );
    assert_eq!(first(&imported, Severity::Warning).0, "/meshes/0/primitives/0");
}

#[test]
fn vertices_that_no_triangle_uses_are_left_out() {
    let mut d = document(json!({"attributes": {"POSITION": 0}, "indices": 1}));
    d["accessors"][1] =
        json!({"bufferView": 1, "byteOffset": 2, "componentType": 5121, "type": "SCALAR", "count": 3});
    let imported = import_well(d, &zigzag());
    let mesh = &imported.desc.meshes[0];
    assert_eq!(mesh.indices, [[0, 1, 2]]);
    assert_eq!(mesh.positions[0], Point3::new(1., 0., 0.));
    assert_eq!(mesh.positions.len(), 3);
}

#[test]
fn interleaved_and_normalised_attributes_are_read_and_v_is_turned_up() {
    // Per vertex: position (3 floats), uv (2 normalised u16), colour (4 normalised u8), normal (3 normalised i8), pad.
    let mut bytes = Vec::new();
    for i in 0..3u16 {
        bytes.extend(floats(&[f32::from(i), f32::from(i * i), 0.0]));
        bytes.extend([i * 21845, 65535 - i * 21845].iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend([255, 51, 0, 102]);
        bytes.extend([0, 0x80, 127, 0]);
    }
    let accessor = |offset: u32, component: u32, kind: &str| {
        json!({"bufferView": 0, "byteOffset": offset, "componentType": component, "type": kind, "count": 3,
               "normalized": component != 5126})
    };
    let d = json!({
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes":
            {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2, "NORMAL": 3}}]}],
        "accessors": [accessor(0, 5126, "VEC3"), accessor(12, 5123, "VEC2"), accessor(16, 5121, "VEC4"),
                      accessor(20, 5120, "VEC3")],
        "bufferViews": [{"buffer": 0, "byteLength": 72, "byteStride": 24}],
    });
    let imported = import_well(d, &bytes);
    let mesh = &imported.desc.meshes[0];
    assert_eq!(mesh.positions[2], Point3::new(2., 4., 0.));
    let uv = mesh.uvs[1];
    assert!((uv.x - 1.0 / 3.0).abs() < 1e-6 && (uv.y - 1.0 / 3.0).abs() < 1e-6, "{uv:?}");
    assert!(mesh.colors[0].iter().zip([1.0, 0.2, 0.0, 0.4]).all(|(a, b)| (a - b).abs() < 1e-6));
    // -128 / 127 is clamped to -1.
    assert_eq!(mesh.normals[0].to_array(), [0.0, -1.0, 1.0]);
}

#[test]
fn sparse_accessors_replace_and_may_stand_alone() {
    let mut bytes = floats(&[7., 8., 9.]);
    bytes.extend(2u16.to_le_bytes());
    let d = json!({
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {"count": 1,
            "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}}],
        "bufferViews": [{"buffer": 0, "byteLength": 12}, {"buffer": 0, "byteOffset": 12, "byteLength": 2}],
    });
    let positions = &import_well(d.clone(), &bytes).desc.meshes[0].positions;
    assert_eq!(positions[..], [Point3::ZERO, Point3::ZERO, Point3::new(7., 8., 9.)]);
    bytes[12] = 3;
    let (pointer, message) = first(&import(d, &bytes), Severity::Error);
    assert_eq!(
        (pointer.as_str(), message.as_str()),
        ("/accessors/0/sparse/indices", "index 3 in a list of 3 elements")
    );
}

#[test]
fn nodes_share_meshes_and_compose_transforms_in_double_precision() {
    let mut d = document(json!({"attributes": {"POSITION": 0}, "mode": 5, "material": 1}));
    d["materials"] = json!([{}, {"name": "red"}]);
    d["meshes"] = json!([d["meshes"][0], {"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}]);
    d["nodes"] = json!([
        {"translation": [1e6, 0, 0], "scale": [2, 2, 2], "children": [1, 2]},
        {"name": "a", "mesh": 0, "rotation": [0, 0, 1, 1]},
        {"name": "b", "mesh": 1, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0.125,0.25,0.5,1]},
    ]);
    let desc = import_well(d, &zigzag()).desc;
    assert_eq!(desc.meshes.len(), 1, "both meshes use the same accessors");
    let [a, b] = &desc.shapes[..] else { panic!("two shapes") };
    assert_eq!((a.name.as_str(), b.name.as_str()), ("a", "b"));
    assert_eq!(a.source, b.source);
    assert!(matches!(a.source, ShapeSource::Mesh(_)) && b.material.is_none());
    assert_eq!(desc.materials[a.material.expect("a material").index()].name, "red");
    let p = |s: &durer_scene::ShapeDesc| s.world_from_object.at(0.0).transform_point3(DVec3::X);
    assert!((p(a) - DVec3::new(1e6, 2.0, 0.0)).length() < 1e-9);
    assert!((p(b) - DVec3::new(1e6 + 2.25, 0.5, 1.0)).length() < 1e-9);
}

#[test]
fn cycles_and_second_parents_are_refused_whether_or_not_a_scene_draws_them() {
    for (nodes, pointer, text) in [
        (
            json!([{"children": [1]}, {"children": [0]}]),
            "/nodes/0/children",
            "cycles: /nodes/0 -> /nodes/1 -> /nodes/0",
        ),
        (json!([{"children": [0]}]), "/nodes/0/children", "without cycles: /nodes/0 -> /nodes/0"),
        (json!([{}, {"children": [2]}, {"children": [1]}]), "/nodes/1/children", "without cycles"),
        (json!([{"children": [1, 1]}, {}]), "/nodes/0/children/1", "already a child of /nodes/0"),
        (
            json!([{"children": [2]}, {"children": [2]}, {}]),
            "/nodes/1/children/0",
            "already a child of /nodes/0",
        ),
        (json!([{"children": [7]}]), "/nodes/0/children", "there is only 1 node"),
    ] {
        let found = first(&import(json!({"nodes": nodes}), &[]), Severity::Error);
        assert!(found.0.starts_with(pointer) && found.1.contains(text), "{found:?}");
    }
}

#[test]
fn a_scene_that_names_a_node_below_another_draws_it_once_and_in_its_place() {
    let mut d = document(json!({"attributes": {"POSITION": 0}, "mode": 5}));
    d["nodes"] = json!([{"translation": [1, 0, 0], "children": [1]}, {"mesh": 0}]);
    d["scenes"] = json!([{"nodes": [1, 0]}]);
    let desc = import_well(d, &zigzag()).desc;
    let [shape] = &desc.shapes[..] else { panic!("one shape") };
    assert_eq!(shape.world_from_object.at(0.0).translation, DVec3::X);
}

#[test]
fn one_of_several_scenes_is_drawn_and_said() {
    let mut d = document(json!({"attributes": {"POSITION": 0}, "mode": 5}));
    d["nodes"] = json!([{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0}]);
    d["scenes"] = json!([{"nodes": [0]}, {"nodes": [1]}]);
    d["scene"] = json!(1);
    let imported = import_well(d, &zigzag());
    assert_eq!(imported.desc.shapes[0].name, "b");
    let (pointer, message) = first(&imported, Severity::Note);
    assert_eq!(
        (pointer.as_str(), message.as_str()),
        ("/scenes/1", "the file holds 2 scenes; scene 1 is drawn")
    );
}

#[test]
fn buffers_that_are_missing_matter_to_those_who_use_them() {
    let mut d = document(json!({"attributes": {"POSITION": 0}, "mode": 5}));
    d["bufferViews"][1]["buffer"] = json!(1);
    let buffers = json!([{"byteLength": 65}, {"byteLength": 65, "uri": "gone.bin"}]);
    let read = |d: &Value| gltf_document::import_buffers(d.clone(), &zigzag(), buffers.clone());
    let imported = read(&d);
    assert!(!imported.diagnostics.has_errors() && imported.desc.shapes.len() == 1);
    let (pointer, message) = first(&imported, Severity::Warning);
    assert!(pointer == "/buffers/1" && message.contains("gone.bin") && message.contains("nothing uses"));
    d["meshes"][0]["primitives"][0]["indices"] = json!(1);
    let (pointer, message) = first(&read(&d), Severity::Error);
    assert!(pointer == "/buffers/1/uri" && message.contains("gone.bin"), "{pointer}: {message}");
}

#[test]
fn hidden_nodes_are_left_out() {
    let mut d = document(json!({"attributes": {"POSITION": 0}, "mode": 5}));
    d["nodes"][0]["extensions"] = json!({"KHR_node_visibility": {"visible": false}});
    assert!(import_well(d, &zigzag()).desc.shapes.is_empty());
}

#[test]
fn faults_point_at_their_cause() {
    let edit = |pointer: &str, value: Value| {
        let mut d = document(json!({"attributes": {"POSITION": 0}, "indices": 1, "mode": 5}));
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        d.pointer_mut(parent).expect("a parent")[key] = value;
        first(&import(d, &zigzag()), Severity::Error)
    };
    for (at, value, pointer, text) in [
        ("/accessors/0/count", json!(6), "/accessors/0", "do not fit /bufferViews/0, which has 60 bytes"),
        ("/accessors/0/count", json!(u64::MAX), "/accessors/0", "do not fit"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "/accessors/0", "do not fit"),
        ("/accessors/0/bufferView", json!(9), "/accessors/0/bufferView", "there are only 2 bufferViews"),
        ("/accessors/0/componentType", json!(5124), "/accessors/0/componentType", "found 5124"),
        ("/accessors/0/type", json!("VEC2"), "/accessors/0", "expected 3 numbers per element, found 2"),
        ("/accessors/0/type", json!("MAT3"), "/accessors/0", "5 elements of 36 bytes"),
        ("/accessors/0/type", json!("MAT5"), "/accessors/0/type", "found \"MAT5\""),
        ("/accessors/1/componentType", json!(5120), "/accessors/1", "unsigned"),
        ("/bufferViews/0/byteLength", json!(1000), "/bufferViews/0", "reaches to byte 1000"),
        ("/bufferViews/0/byteStride", json!(4), "/bufferViews/0/byteStride", "less than the 12 bytes"),
        ("/bufferViews/0/buffer", json!(1), "/bufferViews/0/buffer", "only 1 buffer"),
        ("/nodes/0", json!({"mesh": 5}), "/nodes/0/mesh", "there is only 1 mesh"),
        ("/nodes/0", json!({"rotation": [0, 0, 0, 0]}), "/nodes/0/rotation", "length 0"),
        ("/nodes/0", json!({"scale": [1, 1]}), "/nodes/0/scale", "expected 3 numbers, found 2"),
    ] {
        let edited = if at == "/nodes/0" {
            let mut d = document(json!({"attributes": {"POSITION": 0}}));
            d["nodes"][0] = value;
            first(&import(d, &zigzag()), Severity::Error)
        } else {
            edit(at, value)
        };
        assert!(edited.0 == pointer && edited.1.contains(text), "{at}: {edited:?}");
    }
}

#[test]
fn small_files_cannot_unpack_to_gigabytes() {
    let d = json!({
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "type": "VEC3", "count": 4_000_000_000u64}],
    });
    let (_, message) = first(&import(d, &[0]), Severity::Error);
    assert!(message.contains("unpacks to far more"), "{message}");
}

#[test]
fn required_extensions_that_durer_lacks_are_refused_and_optional_ones_noted() {
    let (pointer, message) = first(
        &import(json!({"extensionsRequired": ["KHR_light_punctual"], "nodes": [{}]}), &[]),
        Severity::Error,
    );
    assert!(pointer == "/extensionsRequired/0" && message.contains("KHR_light_punctual"), "{message}");
    let used = json!({"extensionsUsed": ["KHR_texture_transform", "XYZ_a", "XYZ_b"], "nodes": [{}]});
    let (pointer, message) = first(&import_well(used, &[]), Severity::Note);
    assert!(pointer == "/extensionsUsed" && message.ends_with("XYZ_a, XYZ_b"), "{message}");
}

#[test]
fn a_glb_of_a_million_triangles_imports_in_seconds() {
    const SIDE: u32 = 708;
    let grid =
        || (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| [x as f32, y as f32, (x * y) as f32 * 1e-4]));
    let mut bin: Vec<u8> = floats(&grid().flatten().collect::<Vec<f32>>());
    let vertices = (SIDE + 1) * (SIDE + 1);
    bin.extend(floats(&grid().flatten().collect::<Vec<f32>>()));
    let positions = bin.len() / 2;
    for y in 0..SIDE {
        for x in 0..SIDE {
            let a = y * (SIDE + 1) + x;
            bin.extend(
                [a, a + 1, a + SIDE + 1, a + 1, a + SIDE + 2, a + SIDE + 1]
                    .iter()
                    .flat_map(|i| i.to_le_bytes()),
            );
        }
    }
    let vector = |offset: usize| json!({"bufferView": 0, "byteOffset": offset, "componentType": 5126, "type": "VEC3", "count": vertices});
    let mut text = json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "accessors": [vector(0), vector(positions), {"bufferView": 1, "componentType": 5125, "type": "SCALAR",
            "count": 6 * SIDE * SIDE}],
        "bufferViews": [{"buffer": 0, "byteLength": 2 * positions},
            {"buffer": 0, "byteOffset": 2 * positions, "byteLength": bin.len() - 2 * positions}],
        "buffers": [{"byteLength": bin.len()}],
    })
    .to_string();
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend((28 + text.len() as u32 + bin.len() as u32).to_le_bytes());
    for (kind, data) in [(b"JSON", text.as_bytes()), (b"BIN\0", &bin)] {
        glb.extend((data.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(data);
    }
    let place = tempfile::tempdir().expect("temporary folder");
    let path = place.path().join("grid.GLB");
    std::fs::write(&path, glb).expect("written");
    let started = std::time::Instant::now();
    let imported = durer_io::import::open(&path, durer_scene::Limits::default());
    let time = started.elapsed();
    assert!(!imported.diagnostics.has_errors(), "{:?}", imported.diagnostics);
    assert_eq!(imported.desc.meshes[0].indices.len() as u32, 2 * SIDE * SIDE);
    println!("{} triangles in {time:?}", 2 * SIDE * SIDE);
    assert!(time.as_secs() < 5, "{time:?}");
}

/// A thousand nodes that show a mesh of a thousand primitives are a million shapes, made one by one; more are refused
/// before the first.
#[test]
fn nodes_times_primitives_are_limited() {
    let scene = |nodes: usize, primitives: usize| {
        let mut document = document(json!({"attributes": {"POSITION": 0}}));
        let primitive = document["meshes"][0]["primitives"][0].clone();
        document["meshes"][0]["primitives"] = json!(vec![primitive; primitives]);
        document["nodes"] = json!(vec![json!({"mesh": 0}); nodes]);
        document["scenes"] = json!([{"nodes": (0..nodes).collect::<Vec<_>>()}]);
        import(document, &zigzag())
    };
    let many = scene(300, 400);
    assert!(!many.diagnostics.has_errors(), "{:?}", many.diagnostics);
    assert_eq!((many.desc.shapes.len(), many.desc.meshes.len()), (120_000, 1));
    let bomb = scene(2000, 2000);
    assert_eq!(bomb.diagnostics.error_count(), 1);
    let (_, message) = first(&bomb, Severity::Error);
    assert!(message.starts_with("this file makes 4000000 shapes (nodes times primitives)"), "{message}");
    assert!(bomb.desc.shapes.is_empty());
}

/// What would be unpacked is told once, not once for each primitive.
#[test]
fn arrays_of_zeros_that_need_no_bytes_are_limited_and_told_once() {
    let mut document = document(json!({"attributes": {"POSITION": 0}}));
    document["accessors"] =
        json!(vec![json!({"componentType": 5126, "type": "VEC3", "count": 900_000_000}); 30]);
    let all: Vec<Value> = (0..30).map(|i| json!({"attributes": {"POSITION": i}})).collect();
    document["meshes"][0]["primitives"] = json!(all);
    let bomb = import(document, &zigzag());
    assert_eq!(bomb.diagnostics.error_count(), 1, "{:?}", bomb.diagnostics);
    assert!(first(&bomb, Severity::Error).1.contains("unpacks to far more than its buffers hold"));
}

#[test]
fn primitives_without_area_are_told() {
    let mut document = document(json!({"attributes": {"POSITION": 0}}));
    document["accessors"] = json!([{"componentType": 5126, "type": "VEC3", "count": 6}]);
    let flat = import_well(document, &zigzag());
    let (pointer, message) = first(&flat, Severity::Warning);
    assert_eq!(pointer, "/meshes/0/primitives/0");
    assert!(message.starts_with("no triangle of this primitive has an area"), "{message}");
}
