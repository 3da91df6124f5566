//! Buffer views of glTF that EXT_meshopt_compression packs: the first bytes say how, the others are what is packed.
#![no_main]

use serde_json::json;

const MODES: [&str; 3] = ["ATTRIBUTES", "TRIANGLES", "INDICES"];
const FILTERS: [&str; 4] = ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"];

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some(([mode, filter, stride, count], packed)) = data.split_first_chunk() else { return };
    let (stride, count) = (usize::from(*stride), 3 * usize::from(*count));
    let mode = MODES[usize::from(*mode) % MODES.len()];
    let filter = FILTERS[usize::from(*filter) % FILTERS.len()];
    let extension = json!({
        "buffer": 0, "byteLength": packed.len(), "byteStride": stride, "count": count, "mode": mode, "filter": filter,
    });
    let accessor = match (mode, filter) {
        ("ATTRIBUTES", "OCTAHEDRAL" | "QUATERNION") => {
            json!({"componentType": 5122, "type": "VEC4", "normalized": true})
        }
        ("ATTRIBUTES", _) => json!({"componentType": 5126, "type": "VEC3"}),
        _ => json!({"componentType": if stride == 2 { 5123 } else { 5125 }, "type": "SCALAR"}),
    };
    let mut accessor = accessor;
    accessor["bufferView"] = json!(0);
    accessor["count"] = json!(count);
    let three = json!({"componentType": 5126, "type": "VEC3", "count": 3});
    let primitive = match (mode, filter) {
        ("ATTRIBUTES", "OCTAHEDRAL") => json!({"attributes": {"POSITION": 1, "TANGENT": 0}}),
        ("ATTRIBUTES", _) => json!({"attributes": {"POSITION": 0}}),
        _ => json!({"attributes": {"POSITION": 1}, "indices": 0}),
    };
    let document = json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
        "extensionsRequired": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [accessor, three],
        "bufferViews": [{"buffer": 1, "byteLength": stride * count, "byteStride": stride.clamp(4, 252),
            "extensions": {"EXT_meshopt_compression": extension}}],
        "buffers": [{"uri": "packed.bin", "byteLength": packed.len()},
            {"byteLength": stride * count, "extensions": {"EXT_meshopt_compression": {"fallback": true}}}],
    });
    durer_fuzz::put("packed.bin", packed);
    durer_fuzz::scene("meshopt.gltf", document.to_string().as_bytes());
});
