//! What bends or multiplies a glTF mesh: skins, morph targets, instances, and a long chain of nodes.
mod assets_shared;
mod gltf_document;

use assets_shared::folder;
use durer_core::{
    glam::DVec3,
    math::{Normal3, Point2, Point3},
};
use durer_io::import::open;
use durer_scene::{Limits, SceneDesc, Severity, ShapeSource};
use gltf_document::{first, floats, import, import_well};
use serde_json::{Value, json};

/// One triangle with normals along x, and a buffer for more: views 0 positions, 1 normals, 2 joints, 3 weights, then
/// whatever `more` holds as view 4.
fn document(attributes: Value, more: &[u8]) -> (Value, Vec<u8>) {
    let mut bytes = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    bytes.extend(floats(&[1., 0., 0., 1., 0., 0., 1., 0., 0.]));
    bytes.extend([0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]);
    bytes.extend(floats(&[1., 0., 0., 0., 1., 0., 0., 0., 0.25, 0.25, 0., 0.]));
    bytes.extend(more);
    let view =
        |offset: usize, length: usize| json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
    let accessor = |view: u32, component: u32, kind: &str| json!({"bufferView": view, "componentType": component, "type": kind, "count": 3});
    let document = json!({
        "meshes": [{"primitives": [{"attributes": attributes}]}],
        "accessors": [accessor(0, 5126, "VEC3"), accessor(1, 5126, "VEC3"), accessor(2, 5121, "VEC4"),
                      accessor(3, 5126, "VEC4")],
        "bufferViews": [view(0, 36), view(36, 36), view(72, 12), view(84, 48), view(132, more.len())],
    });
    (document, bytes)
}

/// Adds accessor 4, 5, and so on.
fn push(document: &mut Value, accessor: Value) {
    document["accessors"].as_array_mut().expect("accessors").push(accessor);
}

/// A bone at (10, 0, 0), one above it turned by 90 degrees about z, and a skinned mesh whose own place must not count.
fn skinned() -> (Value, Vec<u8>) {
    let turn = std::f64::consts::FRAC_1_SQRT_2;
    let mut binds = vec![0f32; 32];
    (0..8).for_each(|i| binds[5 * (i % 4) + 16 * (i / 4)] = 1.0);
    binds[12] = -1.0;
    let (mut d, bytes) =
        document(json!({"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}), &floats(&binds));
    push(&mut d, json!({"bufferView": 4, "componentType": 5126, "type": "MAT4", "count": 2}));
    d["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": 4}]);
    d["nodes"] = json!([{"children": [1, 3]}, {"translation": [10, 0, 0], "children": [2]},
        {"translation": [0, 2, 0], "rotation": [0, 0, turn, turn]},
        {"mesh": 0, "skin": 0, "translation": [100, 0, 0]}]);
    (d, bytes)
}

fn world(desc: &SceneDesc) -> Vec<DVec3> {
    let placed = |shape: &durer_scene::ShapeDesc| {
        let ShapeSource::Mesh(id) = &shape.source else { panic!("a mesh") };
        let m = shape.world_from_object.at(0.0);
        desc.meshes[id.index()].positions.iter().map(|p| m.transform_point3(p.to_f64())).collect::<Vec<_>>()
    };
    desc.shapes.iter().flat_map(placed).collect()
}

fn assert_near(found: &[DVec3], expected: &[[f64; 3]]) {
    let near = |(a, b): (&DVec3, &[f64; 3])| (*a - DVec3::from(*b)).length() < 1e-5;
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(near), "{found:?}");
}

#[test]
fn vertices_follow_the_weighted_mean_of_their_joints() {
    let (d, bytes) = skinned();
    let imported = import_well(d, &bytes);
    // Joint 0 moves by 10 - 1; joint 1 turns and moves to (10, 2). The weights of the last vertex sum up to a half.
    assert_near(&world(&imported.desc), &[[9., 0., 0.], [10., 3., 0.], [9., 1.5, 0.]]);
    let normals = &imported.desc.meshes[0].normals;
    let near = |a: Normal3, b: [f32; 3]| (a - Normal3::from(b)).length() < 1e-6;
    let half = std::f32::consts::FRAC_1_SQRT_2;
    assert!(near(normals[0], [1., 0., 0.]) && near(normals[1], [0., 1., 0.]), "{normals:?}");
    assert!(near(normals[2], [half, half, 0.]), "{normals:?}");
}

#[test]
fn normals_of_stretched_and_mirrored_joints_stay_upright_on_their_surface() {
    for (scale, expected) in [([2., 1., 1.], [1., 2., 0.]), ([-1., 1., 1.], [-1., 1., 0.])] {
        let (mut d, mut bytes) = skinned();
        d["nodes"][1] = json!({"scale": scale, "children": [2]});
        bytes.splice(36..48, floats(&[1., 1., 0.]));
        let normal = import_well(d, &bytes).desc.meshes[0].normals[0];
        assert!((normal - Normal3::from(expected).normalize()).length() < 1e-6, "{normal:?}");
    }
}

#[test]
fn skins_at_fault_say_where() {
    for (pointer, value, at, text) in [
        ("/skins/0/joints", json!([1]), "/accessors/2", "follows joint 1, but the skin has 1 joint"),
        ("/skins/0/joints", json!([1, 9]), "/skins/0/joints/1", "refers to /nodes/9"),
        ("/skins/0/joints", json!([]), "/skins/0/joints", "at least one joint"),
        (
            "/skins/0/joints",
            json!([1, 2, 0]),
            "/skins/0/inverseBindMatrices",
            "2 inverse bind matrices for 3",
        ),
        ("/accessors/4/type", json!("VEC4"), "/accessors/4", "expected 16 numbers per element, found 4"),
        ("/nodes/3/skin", json!(1), "/nodes/3/skin", "there is only 1 skin"),
        ("/meshes/0/primitives/0/attributes/JOINTS_1", json!(2), "/accessors/2", "must come together"),
        ("/accessors/2/componentType", json!(5120), "/accessors/2", "unsigned"),
    ] {
        let (mut d, bytes) = skinned();
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        d.pointer_mut(parent).expect("a parent")[key] = value;
        let found = first(&import(d, &bytes), Severity::Error);
        assert!(found.0 == at && found.1.contains(text), "{pointer}: {found:?}");
    }
}

#[test]
fn morph_targets_move_positions_normals_coordinates_and_colours() {
    let mut more = floats(&[0., 0., 0., 0., 2., 0., 0., 0., 4.]);
    more.extend(floats(&[0., 0., 0., 0., 0.25, 0.125, 0.5, 0., 0.]));
    let (mut d, bytes) = document(json!({"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 4, "COLOR_0": 5}), &more);
    let add = |d: &mut Value, offset: u32, kind: &str| {
        push(
            d,
            json!({"bufferView": 4, "byteOffset": offset, "componentType": 5126, "type": kind, "count": 3}),
        );
    };
    add(&mut d, 36, "VEC2");
    add(&mut d, 36, "VEC3");
    add(&mut d, 0, "VEC3");
    d["meshes"][0]["primitives"][0]["targets"] =
        json!([{"POSITION": 6, "NORMAL": 6}, {"TEXCOORD_0": 4}, {"COLOR_0": 5, "POSITION": 6}]);
    d["meshes"][0]["weights"] = json!([0.5, 2, 0]);
    d["nodes"] = json!([{"mesh": 0, "children": [1]}, {"mesh": 0, "weights": [0, 0, 1]}]);
    let desc = import_well(d, &bytes).desc;
    let [rest, own] = &desc.meshes[..] else { panic!("two poses of one mesh") };
    assert_eq!(rest.positions, [[0., 0., 0.], [1., 1., 0.], [0., 1., 2.]].map(Point3::from));
    assert_eq!(rest.normals[1], Normal3::new(1., 1., 0.));
    // (0.25, 0.125) is moved by twice itself; v grows upwards afterwards.
    assert_eq!(rest.uvs[2], Point2::new(0.75, 0.625));
    assert_eq!(rest.colors[1][1], 0.25);
    assert_eq!(own.positions[1], Point3::new(1., 2., 0.));
    // 0.5 + 0.5 of the second colour's red; alpha stays 1.
    assert_eq!(own.colors[2], [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(own.normals[1], Normal3::new(1., 0., 0.));
}

#[test]
fn targets_of_another_length_are_refused() {
    let (mut d, bytes) = document(json!({"POSITION": 0}), &floats(&[0.; 6]));
    push(&mut d, json!({"bufferView": 4, "componentType": 5126, "type": "VEC3", "count": 2}));
    d["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 4}]);
    d["nodes"] = json!([{"mesh": 0, "weights": [1]}]);
    let (pointer, message) = first(&import(d, &bytes), Severity::Error);
    assert_eq!(
        (pointer.as_str(), message.as_str()),
        ("/accessors/4", "POSITION has 2 elements for 3 vertices")
    );
}

#[test]
fn instances_are_placed_by_translation_quantised_rotation_and_scale() {
    let half = (32767.0 * std::f32::consts::FRAC_1_SQRT_2).round() as i16;
    let mut more = floats(&[1., 2., 3., 4., 5., 6.]);
    more.extend(floats(&[1., 1., 1., 2., 3., -1.]));
    for q in [[0, 0, 0, 32767], [0, 0, half, half]] {
        more.extend(q.iter().flat_map(|v: &i16| v.to_le_bytes()));
    }
    let (mut d, bytes) = document(json!({"POSITION": 0}), &more);
    for (offset, component, kind) in [(0, 5126, "VEC3"), (48, 5122, "VEC4"), (24, 5126, "VEC3")] {
        push(
            &mut d,
            json!({"bufferView": 4, "byteOffset": offset, "componentType": component, "type": kind,
            "count": 2, "normalized": component == 5122}),
        );
    }
    let attributes = json!({"TRANSLATION": 4, "ROTATION": 5, "SCALE": 6});
    d["nodes"] = json!([{"mesh": 0, "translation": [100, 0, 0],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}]);
    let desc = import_well(d.clone(), &bytes).desc;
    assert_eq!((desc.meshes.len(), desc.shapes.len()), (1, 2));
    assert_near(
        &world(&desc),
        &[[101., 2., 3.], [102., 2., 3.], [101., 3., 3.], [104., 5., 6.], [104., 7., 6.], [101., 5., 6.]],
    );
    d["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = json!({"_ID": 4});
    let (pointer, message) = first(&import(d, &bytes), Severity::Error);
    assert!(pointer.ends_with("/attributes") && message.contains("TRANSLATION"), "{pointer}: {message}");
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes_is_one_long_transform() {
    let (mut d, bytes) = document(json!({"POSITION": 0}), &[]);
    let last = 99_999;
    let link = |i: usize| json!({"translation": [1, 0, 0], "children": [i + 1]});
    let chain = (0..last).map(link).chain([json!({"mesh": 0})]);
    d["nodes"] = chain.collect();
    let started = std::time::Instant::now();
    let desc = import_well(d, &bytes).desc;
    assert!(started.elapsed().as_secs_f64() < 10.0, "{:?}", started.elapsed());
    assert_eq!(world(&desc)[0], DVec3::new(last as f64, 0.0, 0.0));
}

/// Boxes and means of the posed vertices, computed apart from this code by products of 4 by 4 matrices in double
/// precision over the files' bytes.
#[test]
fn real_files_stand_as_their_bones_and_weights_say() {
    let Some(shared) = folder("gltf") else { return };
    for (file, low, high, mean) in [
        (
            "CesiumMan.glb",
            [-0.569_137, 0.0, -0.131],
            [0.569_137, 1.506_55, 0.180_954],
            [-2.055e-5, 1.075_585, 0.006_429],
        ),
        (
            "Fox.glb",
            [-12.592_719, -0.121_744, -88.095_01],
            [12.592_717, 78.907_198, 66.624_86],
            [-0.007_822, 33.827_295, -3.586_796],
        ),
        ("RiggedSimple.glb", [-1.0, -4.575_077, -1.0], [1.0, 4.575_078, 1.0], [0.0; 3]),
        ("SimpleSkin/SimpleSkin.gltf", [-0.5, 0.0, 0.0], [0.5, 2.0, 0.0], [0.0, 1.0, 0.0]),
        ("SimpleMorph/SimpleMorph.gltf", [0.0; 3], [1.0, 1.5, 0.0], [0.5, 0.5, 0.0]),
        ("MorphPrimitivesTest.glb", [-0.5, 0.0, -0.5], [0.5, 0.1, 0.5], [0.025, 0.04, -0.025]),
        ("AnimatedMorphCube.glb", [-1.0; 3], [1.0; 3], [0.0; 3]),
    ] {
        let imported = open(&shared.join(file), Limits::default());
        let points = world(&imported.desc);
        let found = [
            points.iter().copied().reduce(DVec3::min).expect("vertices"),
            points.iter().copied().reduce(DVec3::max).expect("vertices"),
            points.iter().sum::<DVec3>() / points.len() as f64,
        ];
        let near = |(a, b): (&DVec3, [f64; 3])| (*a - DVec3::from(b)).length() < 2e-5 * (1.0 + a.length());
        assert!(found.iter().zip([low, high, mean]).all(near), "{file}: {found:?}");
    }
}

/// A scale of zero in z leaves a square that lies in that plane, or the shadow of one that does not.
#[test]
fn nodes_flattened_in_one_direction_are_drawn_and_those_in_two_are_not() {
    let scene = |scale: [f64; 3]| {
        let document = json!({
            "nodes": [{"mesh": 0, "scale": scale, "translation": [5, 0, 0]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
        });
        import_well(document, &floats(&[1., 0., 3., 2., 0., 4., 0., 2., 5.]))
    };
    let flat = scene([2.0, 1.0, 0.0]);
    assert!(flat.diagnostics.is_empty(), "{:?}", flat.diagnostics);
    let ShapeSource::Mesh(id) = flat.desc.shapes[0].source else { panic!("no mesh") };
    let mesh = &flat.desc.meshes[id.index()];
    assert_eq!(mesh.positions, [[2.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 2.0, 0.0]].map(Point3::from));
    assert!(mesh.normals.is_empty());
    let place = flat.desc.shapes[0].world_from_object.at(0.0);
    assert_eq!((place.translation, place.matrix3.determinant()), (DVec3::new(5.0, 0.0, 0.0), 1.0));
    for scale in [[1.0, 0.0, 0.0], [0.0; 3]] {
        let nothing = scene(scale);
        assert!(nothing.desc.shapes.is_empty());
        assert!(first(&nothing, Severity::Warning).1.ends_with("nothing of it is left; it is not drawn"));
    }
}
