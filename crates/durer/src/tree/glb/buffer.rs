//! The binary part of a GLB file and what tells where things lie in it.
use serde_json::{Value, json};

/// Bytes, and the views and accessors that describe them.
#[derive(Default)]
pub(super) struct Buffer {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

impl Buffer {
    /// Adds positions; the number of their accessor.
    pub(super) fn positions(&mut self, points: &[[f32; 3]]) -> usize {
        let bound = |start: f32, pick: fn(f32, f32) -> f32| -> [f32; 3] {
            std::array::from_fn(|i| points.iter().map(|p| p[i]).fold(start, pick))
        };
        let (min, max) = (bound(f32::INFINITY, f32::min), bound(f32::NEG_INFINITY, f32::max));
        let view = self.view(points.iter().flatten().flat_map(|v| v.to_le_bytes()), 34962);
        let count = points.len();
        self.accessor(json!({
            "bufferView": view, "componentType": 5126, "count": count, "type": "VEC3",
            "min": min.map(exact), "max": max.map(exact)
        }))
    }

    /// Adds indices; the number of their accessor.
    pub(super) fn indices(&mut self, indices: &[u32]) -> usize {
        let view = self.view(indices.iter().flat_map(|v| v.to_le_bytes()), 34963);
        self.accessor(json!({
            "bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR"
        }))
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: u32) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length, "target": target }));
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// Bounds must be those of the stored numbers: every digit.
fn exact(v: f32) -> f64 {
    v.into()
}

/// The file: a header, the JSON part, the binary part, each padded to four bytes. `None` beyond 4 GiB.
pub(super) fn container(document: &Value, bytes: &[u8]) -> Option<Vec<u8>> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let padded = bytes.len().next_multiple_of(4);
    let binary = if bytes.is_empty() { 0 } else { 8 + padded };
    let length = u32::try_from(12 + 8 + text.len() + binary).ok()?;
    let mut file = Vec::with_capacity(length as usize);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend(length.to_le_bytes());
    file.extend((text.len() as u32).to_le_bytes());
    file.extend(b"JSON");
    file.extend(text);
    if !bytes.is_empty() {
        file.extend((padded as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(bytes);
        file.resize(length as usize, 0);
    }
    Some(file)
}
