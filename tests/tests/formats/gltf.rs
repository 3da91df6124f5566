//! glTF 2.0: extensions and parts of the core, each in a document of one triangle.
use base64::{Engine, prelude::BASE64_STANDARD};
use serde_json::{Value, json};

use super::trial::{Bench, Outcome, remark};

/// Extensions of materials with something to say.
const OF_MATERIALS: &[(&str, &str)] = &[
    ("KHR_materials_anisotropy", r#"{"anisotropyStrength": 0.5}"#),
    ("KHR_materials_clearcoat", r#"{"clearcoatFactor": 1}"#),
    ("KHR_materials_diffuse_transmission", r#"{"diffuseTransmissionFactor": 0.5}"#),
    ("KHR_materials_dispersion", r#"{"dispersion": 1}"#),
    ("KHR_materials_emissive_strength", r#"{"emissiveStrength": 2}"#),
    ("KHR_materials_ior", r#"{"ior": 1.4}"#),
    ("KHR_materials_iridescence", r#"{"iridescenceFactor": 1}"#),
    ("KHR_materials_pbrSpecularGlossiness", r#"{"diffuseFactor": [1, 0, 0, 1]}"#),
    ("KHR_materials_sheen", r#"{"sheenColorFactor": [1, 1, 1]}"#),
    ("KHR_materials_specular", r#"{"specularFactor": 0.5}"#),
    ("KHR_materials_transmission", r#"{"transmissionFactor": 1}"#),
    ("KHR_materials_unlit", "{}"),
    ("KHR_materials_volume", r#"{"thicknessFactor": 1}"#),
];

/// Extensions of other parts; where they stand does not matter to whether durer knows them.
const OTHERS: &[&str] = &[
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "EXT_mesh_manifold",
    "EXT_meshopt_compression",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Parts of the core: name, JSON pointer, value.
const PARTS: &[(&str, &str, &str)] = &[
    ("points", "/meshes/0/primitives/0/mode", "0"),
    ("lines", "/meshes/0/primitives/0/mode", "1"),
    ("line loops", "/meshes/0/primitives/0/mode", "2"),
    ("line strips", "/meshes/0/primitives/0/mode", "3"),
    ("triangles", "/meshes/0/primitives/0/mode", "4"),
    ("triangle strips", "/meshes/0/primitives/0/mode", "5"),
    ("triangle fans", "/meshes/0/primitives/0/mode", "6"),
    (
        "perspective cameras",
        "/cameras",
        r#"[{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]"#,
    ),
    (
        "orthographic cameras",
        "/cameras",
        r#"[{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}}]"#,
    ),
    ("alpha mode MASK", "/materials/0/alphaMode", r#""MASK""#),
    ("alpha mode BLEND", "/materials/0/alphaMode", r#""BLEND""#),
    ("double sides", "/materials/0/doubleSided", "true"),
    ("emission", "/materials/0/emissiveFactor", "[1, 1, 1]"),
    ("base colour textures", "/materials/0/pbrMetallicRoughness/baseColorTexture", r#"{"index": 0}"#),
    (
        "metallic-roughness textures",
        "/materials/0/pbrMetallicRoughness/metallicRoughnessTexture",
        r#"{"index": 0}"#,
    ),
    ("normal textures", "/materials/0/normalTexture", r#"{"index": 0}"#),
    ("occlusion textures", "/materials/0/occlusionTexture", r#"{"index": 0}"#),
    ("emissive textures", "/materials/0/emissiveTexture", r#"{"index": 0}"#),
    (
        "animations",
        "/animations",
        r#"[{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 3, "output": 4}]}]"#,
    ),
    ("morph targets", "/meshes/0/primitives/0/targets", r#"[{"POSITION": 0}]"#),
    ("skins", "/nodes/0/skin", "0"),
    (
        "sparse accessors",
        "/accessors/0/sparse",
        r#"{"count": 1, "indices": {"bufferView": 2, "componentType": 5125}, "values": {"bufferView": 0}}"#,
    ),
    (
        "pictures as KTX 2, packed by Basis Universal",
        "/images/0/uri",
        r#""data:image/ktx2;base64,q0tUWCAyMLsNChoKAAAAAAEAAAAQAAAAEAAAAAAAAAAAAAAAAQAAAAEAAAACAAAAaAAAACwAAACUAAAAJAAAAAAAAAAAAAAAAAAAAAAAAAC4AAAAAAAAAI0AAAAAAAAAAAEAAAAAAAAsAAAAAAAAAAIAKACmAQIAAwMAAAAAAAAAAAAAAAB/AwAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDEuMTYAACi1L/1gAAAdBADEBQBQiUpNkblHETJUdpi63P5dkrnfEgCJam6TubcTUIlqvpO5OxIJT00ZuhhQCU9dGroYAAlvbhu6GFAJb74buslMTSG7XSK7yWxuI7vJbL4juxCxu12yELO7ELO7FSiQ4wIPEFAhuR0QlrdBQAxEIZT5Yd8Az0IzGGUG9HhzVxvwlw==""#,
    ),
    (
        "pictures as KTX 2, not packed",
        "/images/0/uri",
        r#""data:image/ktx2;base64,q0tUWCAyMLsNChoKHQAAAAEAAAABAAAAAQAAAAAAAAAAAAAAAQAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAABoAAAAAAAAAAMAAAAAAAAAAwAAAAAAAAAQIDA=""#,
    ),
    (
        "pictures as KTX 2, packed as BC7",
        "/images/0/uri",
        r#""data:image/ktx2;base64,q0tUWCAyMLsNChoKkQAAAAEAAAABAAAAAQAAAAAAAAAAAAAAAQAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAABoAAAAAAAAABAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA""#,
    ),
    (
        "pictures as WebP",
        "/images/0/uri",
        r#""data:image/webp;base64,UklGRjwAAABXRUJQVlA4TC8AAAAvAUAAEB8gEEiS2B91DSEBQfX/L4EAwYj/SwIBwroHvwJvWayCkgABUJSRiP4HAwA=""#,
    ),
    ("matrices of nodes", "/nodes/0/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]"),
    ("mirroring nodes", "/nodes/0/scale", "[-1, 1, 1]"),
];

/// A triangle with a material, a texture, and what the parts refer to.
fn document() -> Value {
    let floats: Vec<f32> = vec![0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 1.];
    let mut bytes: Vec<u8> = floats.iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0u32, 1, 2].iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend([0f32, 1.0].iter().flat_map(|v| v.to_le_bytes()));
    let length = bytes.len();
    let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&bytes));
    json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {}}], "textures": [{"source": 0}], "images": [{"uri": "pixel.png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5125, "count": 3, "type": "SCALAR"},
            {"bufferView": 3, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
            {"buffer": 0, "byteOffset": 60, "byteLength": 12}, {"buffer": 0, "byteOffset": 72, "byteLength": 8}
        ],
        "buffers": [{"uri": uri, "byteLength": length}]
    })
}

/// Puts a value where a pointer says, on the way to which objects are made.
fn put(document: &mut Value, pointer: &str, value: Value) {
    let mut place = document;
    for key in pointer.split('/').skip(1) {
        place = match key.parse::<usize>() {
            Ok(index) => &mut place[index],
            Err(_) => &mut place[key],
        };
    }
    *place = value;
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

fn part(pointer: &str, value: &str) -> Value {
    let mut document = document();
    put(&mut document, pointer, parsed(value));
    if pointer.ends_with("/skin") {
        document["skins"] = json!([{"joints": [0]}]);
        document["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(5);
        document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(6);
        let accessors = document["accessors"].as_array_mut().expect("a list");
        accessors.push(json!({"componentType": 5121, "count": 3, "type": "VEC4"}));
        accessors.push(json!({"componentType": 5126, "count": 3, "type": "VEC4"}));
    }
    if pointer.ends_with("/cameras") {
        document["nodes"] = json!([{"mesh": 0}, {"camera": 0}]);
        document["scenes"] = json!([{"nodes": [0, 1]}]);
    }
    if pointer.starts_with("/images/0/") || pointer.ends_with("Texture") {
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
    }
    if pointer == "/images/0/mimeType" {
        document["images"][0] = json!({"bufferView": 0, "mimeType": parsed(value)});
    }
    document
}

pub(crate) fn write(out: &mut String) {
    let bench = Bench::new();
    let mut tried: Vec<(String, Outcome)> = Vec::new();
    let try_it = |document: &Value| bench.try_file("x.gltf", document.to_string());
    for (name, pointer, value) in PARTS {
        tried.push(((*name).to_owned(), try_it(&part(pointer, value))));
    }
    section(out, "## glTF 2.0", &tried);
    tried.clear();
    for (name, body) in OF_MATERIALS {
        let mut document = document();
        document["extensionsUsed"] = json!([name]);
        document["materials"][0]["extensions"] = json!({*name: parsed(body)});
        tried.push(((*name).to_owned(), try_it(&document)));
    }
    for name in OTHERS {
        let mut document = document();
        document["extensionsUsed"] = json!([name]);
        document["extensionsRequired"] = json!([name]);
        tried.push(((*name).to_owned(), try_it(&document)));
    }
    section(out, "### Extensions", &tried);
}

fn section(out: &mut String, title: &str, tried: &[(String, Outcome)]) {
    let read = tried.iter().filter(|(_, o)| *o == Outcome::Read).map(|(f, _)| format!("`{f}`"));
    out.push_str(&format!("\n{title}\n\nRead: {}.\n\n", read.collect::<Vec<_>>().join(", ")));
    tried.iter().filter_map(|(f, o)| remark(f, o)).for_each(|line| out.push_str(&line));
}
