//! Small glTF documents written by tests, with one `data:` buffer.
#![allow(dead_code, reason = "each test target uses some of it")]
use base64::{Engine, engine::general_purpose::STANDARD};
use durer_io::import::{Imported, Reading, open};
use durer_scene::{Data, Limits, Location, Node, Severity};
use serde_json::{Value, json};

/// Bytes of little-endian floats.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// Imports `document`, with `asset` and a buffer holding `bytes` added. Sets the scene to node 0 if there is none.
pub(crate) fn import(document: Value, bytes: &[u8]) -> Imported {
    import_buffers(document, bytes, json!([{"byteLength": bytes.len()}]))
}

/// [`import`] with these `buffers`, the first of which gets the bytes.
pub(crate) fn import_buffers(document: Value, bytes: &[u8], buffers: Value) -> Imported {
    written(document, bytes, (buffers, Limits::default().into()))
}

/// [`import`] as `reading` asks.
pub(crate) fn import_as(document: Value, bytes: &[u8], reading: Reading) -> Imported {
    written(document, bytes, (json!([{"byteLength": bytes.len()}]), reading))
}

fn written(mut document: Value, bytes: &[u8], (buffers, reading): (Value, Reading)) -> Imported {
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes));
    document["asset"] = json!({"version": "2.0"});
    document["buffers"] = buffers;
    document["buffers"][0]["uri"] = json!(uri);
    if document.get("scenes").is_none() {
        document["scenes"] = json!([{"nodes": [0]}]);
    }
    let place = tempfile::tempdir().expect("temporary folder");
    let path = place.path().join("test.gltf");
    std::fs::write(&path, document.to_string()).expect("written");
    open(&path, reading)
}

/// [`import`], which must go without errors.
pub(crate) fn import_well(document: Value, bytes: &[u8]) -> Imported {
    let imported = import(document, bytes);
    assert!(!imported.diagnostics.has_errors(), "{:#?}", imported.diagnostics);
    imported
}

/// Pointer and message of the first complaint of a severity.
pub(crate) fn first(imported: &Imported, severity: Severity) -> (String, String) {
    let found = imported.diagnostics.iter().find(|d| d.severity == severity).expect("a complaint");
    let Location::Path { pointer, .. } = &found.at else { panic!("no path") };
    (pointer.clone(), found.message.clone())
}

/// The numbers of a parameter.
pub(crate) fn numbers(node: &Node, name: &str) -> Vec<f32> {
    match node.params.get(name).map(|p| &p.data) {
        Some(Data::Floats(v)) => v.clone(),
        other => panic!("{name}: {other:?}"),
    }
}

/// The word of a parameter.
pub(crate) fn word(node: &Node, name: &str) -> String {
    match node.params.get(name).map(|p| &p.data) {
        Some(Data::Strings(v)) => v[0].clone(),
        other => panic!("{name}: {other:?}"),
    }
}
