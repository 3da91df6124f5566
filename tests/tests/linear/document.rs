//! glTF files with many of one thing.
use serde_json::{Value, json};

use super::{Case, alone, model::grid};

/// A PNG file of one grey pixel.
const PIXEL: &str =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==";

pub(crate) fn cases() -> Vec<Case> {
    let case = |name, suffix, size, write| Case { name, suffix, size, write };
    vec![
        case("glTF, triangles of a mesh", "glb", 8000, |n| alone(glb(mesh(n)))),
        case("glTF, nodes with one mesh", "gltf", 2000, |n| alone(nodes(n).to_string())),
        case("glTF, nodes below one another", "gltf", 200, |n| alone(chains(n).to_string())),
        case("glTF, meshes and materials", "gltf", 500, |n| alone(meshes(n).to_string())),
        case("glTF, textures and images", "gltf", 400, |n| alone(textures(n).to_string())),
    ]
}

/// A scene of one triangle whose buffer is in the file.
fn triangle() -> Value {
    // Nine floats of which the fourth and the eighth are 1.
    let mut bytes = [0u8; 36];
    for at in [3, 7] {
        bytes[4 * at..4 * at + 4].copy_from_slice(&1.0f32.to_le_bytes());
    }
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0],
        }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": format!("data:application/octet-stream;base64,{}", base64(&bytes)) }],
    })
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    assert!(bytes.len().is_multiple_of(3), "no padding is written");
    let group = |b: &[u8]| u32::from(b[0]) << 16 | u32::from(b[1]) << 8 | u32::from(b[2]);
    let letters =
        bytes.chunks(3).map(group).flat_map(|v| [18, 12, 6, 0].map(|shift| (v >> shift) as usize & 63));
    letters.map(|i| char::from(LETTERS[i])).collect()
}

fn list(n: usize, item: impl Fn(usize) -> Value) -> Value {
    (0..n).map(item).collect()
}

fn nodes(n: usize) -> Value {
    let mut scene = triangle();
    scene["nodes"] = list(n, |i| json!({ "name": format!("node {i}"), "mesh": 0, "translation": [i, 0, 0] }));
    scene["scenes"][0]["nodes"] = list(n, |i| json!(i));
    scene
}

/// Chains of eight nodes, each the child of the one before.
fn chains(n: usize) -> Value {
    const LONG: usize = 8;
    let mut scene = triangle();
    scene["nodes"] = list(n * LONG, |i| {
        let mut node = json!({ "translation": [1, 0, 0] });
        if i % LONG == LONG - 1 {
            node["mesh"] = json!(0);
        } else {
            node["children"] = json!([i + 1]);
        }
        node
    });
    scene["scenes"][0]["nodes"] = list(n, |i| json!(i * LONG));
    scene
}

fn meshes(n: usize) -> Value {
    let mut scene = nodes(n);
    scene["nodes"] = list(n, |i| json!({ "mesh": i }));
    scene["meshes"] =
        list(n, |i| json!({ "primitives": [{ "attributes": { "POSITION": 0 }, "material": i }] }));
    scene["materials"] = list(n, |i| json!({ "name": format!("material {i}") }));
    scene
}

fn textures(n: usize) -> Value {
    let mut scene = meshes(n);
    scene["materials"] =
        list(n, |i| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": i } } }));
    scene["textures"] = list(n, |i| json!({ "source": i }));
    scene["images"] = list(n, |_| json!({ "uri": format!("data:image/png;base64,{PIXEL}") }));
    scene
}

/// A mesh of so many triangles, and its buffer.
fn mesh(n: usize) -> (Value, Vec<u8>) {
    let mesh = grid(n);
    let points: Vec<u8> = mesh.points.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let indices: Vec<u8> = mesh.triangles.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let mut scene = triangle();
    scene["meshes"][0]["primitives"][0]["indices"] = json!(1);
    scene["bufferViews"] = json!([
        { "buffer": 0, "byteLength": points.len() },
        { "buffer": 0, "byteOffset": points.len(), "byteLength": indices.len() },
    ]);
    let count = 3 * mesh.triangles.len();
    scene["accessors"] = json!([
        { "bufferView": 0, "componentType": 5126, "count": mesh.points.len(), "type": "VEC3" },
        { "bufferView": 1, "componentType": 5125, "count": count, "type": "SCALAR" },
    ]);
    scene["buffers"] = json!([{ "byteLength": points.len() + indices.len() }]);
    (scene, [points, indices].concat())
}

/// A binary glTF file.
fn glb((scene, binary): (Value, Vec<u8>)) -> Vec<u8> {
    let mut text = scene.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let word = |v: usize| (v as u32).to_le_bytes();
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let parts: [&[u8]; 9] = [
        b"glTF",
        &word(2),
        &word(length),
        &word(text.len()),
        b"JSON",
        &text,
        &word(binary.len()),
        b"BIN\0",
        &binary,
    ];
    parts.concat()
}
