//! Packed buffer views (EXT_meshopt_compression). The streams were made by meshoptimizer 0.2.30 (the encoder, through
//! Python) from the numbers that the tests compute.
mod gltf_document;

use base64::{Engine, engine::general_purpose::STANDARD};
use durer_core::math::Point3;
use durer_io::import::Imported;
use durer_scene::Severity;
use gltf_document::{first, import_buffers};
use serde_json::{Value, json};

/// Vertex i of 63: u16 (i % 9, i / 9, i * i % 977, 0).
const POSITIONS: &str = "oFUqqrqqD66qq6oPD6rqqroPD6quqqgPAFUAACAACAACAACAACAACAAAAP8AAgYKDhIWGh4iJiouMjY6PkJGSk5SVlpeYmZqbnJ2etyChoqOkpaanqKmqq7vtrq+wsbKztLWx97i5uru8vYAVIACAIDAgggwBQWIIyIgBQAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA=";
/// The same by version 1 (level 3 of its encoder), with differences of 16 bits in one channel.
const POSITIONS_1: &str = "oZmjVSqquqoPrqqrqg8Pquqqug8Pqq6qqA8AAAICBAgCAhAgAgJAAAIAAgYKDhIWGh4iJiouMjY6PkJGSk5SVlpeYmZqbnJ2eiOChoqOkpaanqKmqq7vtrq+wsbKztLWx97i5uru8vZQASAHBoAABgAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAQ==";
/// Two triangles for each cell of a grid of 8 x 6, and two that join what is far apart.
const TRIANGLES: &str = "4f4eEA4QDhAOEA4QDhAOEA7+HhAOEA4QDhAOEA4QDhAO/h4QDhAOEA4QDhAOEA4QDv4eEA4QDhAOEA4QDhAOEA7+HhAOEA4QDhAOEA4QDhAO/h4QDhAOEA4QDhAOEA4QDv//DxIPAg8CDwIPAg8C/wN3Qr83HgB2h1ZneKmGZYlomAFpAAA=";
/// The indices of three triangles.
const SEQUENCE: &str = "0QwEBPEBBQgEBCsAAAAA";

fn triangles() -> Vec<[u32; 3]> {
    let cell = |x: u32, y: u32| {
        let a = 9 * y + x;
        [[a, a + 1, a + 9], [a + 9, a + 1, a + 10]]
    };
    let grid = (0..6).flat_map(|y| (0..8).flat_map(move |x| cell(x, y)));
    grid.chain([[60, 0, 33], [5, 50, 20]]).collect()
}

/// A document whose positions and indices are packed, and its bytes.
fn document(indices: &str, count: usize, mode: &str) -> (Value, Vec<u8>) {
    let (positions, indices) = (STANDARD.decode(POSITIONS), STANDARD.decode(indices));
    let (positions, indices) = (positions.expect("base64"), indices.expect("base64"));
    let packed = |offset: usize, length: usize, stride: usize, count: usize, mode: &str| {
        json!({"buffer": 1, "byteLength": stride * count, "extensions": {"EXT_meshopt_compression": {
            "buffer": 0, "byteOffset": offset, "byteLength": length, "byteStride": stride, "count": count, "mode": mode}}})
    };
    let mut view = packed(0, positions.len(), 8, 63, "ATTRIBUTES");
    view["byteStride"] = json!(8);
    let document = json!({
        "extensionsUsed": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
        "extensionsRequired": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5123, "type": "VEC3", "count": 63},
            {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": count}],
        "bufferViews": [view, packed(positions.len(), indices.len(), 4, count, mode)],
    });
    (document, [positions, indices].concat())
}

fn read(document: Value, bytes: &[u8]) -> Imported {
    let fallback = json!({"byteLength": 8 * 63 + 4 * 294, "extensions": {"EXT_meshopt_compression": {"fallback": true}}});
    import_buffers(document, bytes, json!([{"byteLength": bytes.len()}, fallback]))
}

#[test]
fn vertices_and_triangles_are_those_that_were_packed() {
    let (document, bytes) = document(TRIANGLES, 294, "TRIANGLES");
    let imported = read(document, &bytes);
    assert!(imported.diagnostics.iter().all(|d| d.severity == Severity::Note), "{:?}", imported.diagnostics);
    let mesh = &imported.desc.meshes[0];
    let vertex = |i: u16| Point3::new((i % 9).into(), (i / 9).into(), (u32::from(i).pow(2) % 977) as f32);
    assert_eq!(mesh.positions, (0..63).map(vertex).collect::<Vec<_>>());
    // Packing may begin a triangle at another of its corners.
    let expected = triangles();
    assert_eq!(mesh.indices.len(), expected.len());
    for (found, expected) in mesh.indices.iter().zip(&expected) {
        let [a, b, c] = *expected;
        assert!([[a, b, c], [b, c, a], [c, a, b]].contains(found), "{found:?} {expected:?}");
    }
}

#[test]
fn vertices_of_version_1_are_those_that_were_packed() {
    let (mut document, bytes) = document(TRIANGLES, 294, "TRIANGLES");
    let positions = STANDARD.decode(POSITIONS_1).expect("base64");
    let own = json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": positions.len(), "byteStride": 8, "count": 63,
        "mode": "ATTRIBUTES"});
    document["bufferViews"][0]["extensions"] = json!({"KHR_meshopt_compression": own});
    document["extensionsUsed"] =
        json!(["EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_mesh_quantization"]);
    let newer = read(document, &[bytes, positions].concat());
    assert!(newer.diagnostics.iter().all(|d| d.severity == Severity::Note), "{:?}", newer.diagnostics);
    let (document, bytes) = self::document(TRIANGLES, 294, "TRIANGLES");
    assert_eq!(newer.desc.meshes[0].positions, read(document, &bytes).desc.meshes[0].positions);
}

#[test]
fn sequences_of_indices_are_those_that_were_packed() {
    let (document, bytes) = document(SEQUENCE, 9, "INDICES");
    let mesh = &read(document, &bytes).desc.meshes[0];
    let place = |i: u32| Point3::new((i % 9) as f32, (i / 9) as f32, (i * i % 977) as f32);
    let corners: Vec<Point3> = mesh.indices.iter().flatten().map(|i| mesh.positions[*i as usize]).collect();
    assert_eq!(corners, [3, 4, 5, 60, 61, 7, 8, 9, 50].map(place));
}

#[test]
fn damaged_streams_are_errors_with_their_place() {
    let (good, bytes) = document(TRIANGLES, 294, "TRIANGLES");
    let said = |change: &dyn Fn(&mut Value, &mut Vec<u8>)| {
        let (mut document, mut bytes) = (good.clone(), bytes.clone());
        change(&mut document, &mut bytes);
        first(&read(document, &bytes), Severity::Error)
    };
    let at = |view: usize, key: &str| format!("/bufferViews/{view}/extensions/EXT_meshopt_compression{key}");
    let extension = |d: &mut Value, view: usize, key: &str, value: Value| {
        d["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
    };
    let found = said(&|_, b| b[0] = 0xa2);
    assert!(found.0 == at(0, "") && found.1.contains("as attributes do"), "{found:?}");
    let found = said(&|d, _| extension(d, 0, "count", json!(4_000_000_000u64)));
    assert!(found.0 == at(0, "") && found.1.contains("too early"), "{found:?}");
    let found = said(&|d, _| extension(d, 1, "count", json!(3)));
    assert!(found.0 == at(1, "") && found.1.contains("behind its end"), "{found:?}");
    let found = said(&|d, _| extension(d, 1, "mode", json!("LINES")));
    assert!(found.0 == at(1, "/mode") && found.1.contains("found \"LINES\""), "{found:?}");
    let found = said(&|d, _| extension(d, 0, "filter", json!("QUATERNIONS")));
    assert!(found.0 == at(0, "/filter"), "{found:?}");
    let found = said(&|d, _| extension(d, 0, "byteStride", json!(7)));
    assert!(found.0 == at(0, "/byteStride"), "{found:?}");
    let found = said(&|d, _| extension(d, 0, "byteLength", json!(1 << 20)));
    assert!(found.1.contains("reaches beyond its buffer"), "{found:?}");
    // Any byte may be any other: an error or another mesh, but no panic.
    for place in 0..bytes.len() {
        let mut bytes = bytes.clone();
        bytes[place] ^= 0x5a;
        drop(read(good.clone(), &bytes));
    }
}
