//! Primitives of glTF that KHR_draco_mesh_compression packs.
#![no_main]

use serde_json::json;

/// What the seeds hold: vertices and corners.
const COUNTS: [usize; 2] = [13 * 9, 3 * 12 * 8 * 2];

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let [vertices, corners] = COUNTS;
    let names = ["POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0", "JOINTS_0"];
    let attributes: serde_json::Map<_, _> =
        names.iter().enumerate().map(|(i, name)| ((*name).to_owned(), json!(i))).collect();
    let accessor =
        |component: u32, kind: &str| json!({"componentType": component, "type": kind, "count": vertices});
    let document = json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_draco_mesh_compression"],
        "extensionsRequired": ["KHR_draco_mesh_compression"],
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 5, "extensions":
            {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": attributes}}}]}],
        "accessors": [accessor(5126, "VEC3"), accessor(5126, "VEC3"), accessor(5126, "VEC2"), accessor(5121, "VEC4"),
            accessor(5123, "VEC4"), {"componentType": 5125, "type": "SCALAR", "count": corners}],
        "bufferViews": [{"buffer": 0, "byteLength": data.len()}],
        "buffers": [{"uri": "packed.bin", "byteLength": data.len()}],
    });
    durer_fuzz::put("packed.bin", data);
    durer_fuzz::scene("draco.gltf", document.to_string().as_bytes());
});
