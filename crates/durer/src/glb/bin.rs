//! The binary part of a GLB file, what tells where things lie in it, and the file around both.
use serde_json::{Value, json};

/// Bytes, and the views and accessors that describe them.
#[derive(Default)]
pub(crate) struct Bin {
    pub(crate) bytes: Vec<u8>,
    pub(crate) views: Vec<Value>,
    pub(crate) accessors: Vec<Value>,
}

/// Of vertices.
const ARRAY_BUFFER: u32 = 34962;
/// Of indices.
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

impl Bin {
    /// Adds positions with their bounds; the number of their accessor.
    pub(crate) fn positions(&mut self, points: &[[f32; 3]]) -> usize {
        let bound = |start: f32, pick: fn(f32, f32) -> f32| -> [f32; 3] {
            std::array::from_fn(|i| points.iter().map(|p| p[i]).fold(start, pick))
        };
        let (min, max) = (bound(f32::INFINITY, f32::min), bound(f32::NEG_INFINITY, f32::max));
        let accessor = self.vectors(points);
        // Bounds must be those of the stored numbers: every digit.
        self.accessors[accessor]["min"] = json!(min.map(f64::from));
        self.accessors[accessor]["max"] = json!(max.map(f64::from));
        accessor
    }

    /// Adds a vector of each vertex; the number of the accessor.
    pub(crate) fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let view = self.view(vectors.iter().flatten().flat_map(|v| v.to_le_bytes()), Some(ARRAY_BUFFER));
        let ty = format!("VEC{N}");
        self.accessor(
            json!({ "bufferView": view, "componentType": 5126, "count": vectors.len(), "type": ty }),
        )
    }

    /// Adds indices; the number of their accessor.
    pub(crate) fn indices(&mut self, indices: impl Iterator<Item = u32>) -> usize {
        let start = self.bytes.len();
        let view = self.view(indices.flat_map(u32::to_le_bytes), Some(ELEMENT_ARRAY_BUFFER));
        let count = (self.bytes.len() - start) / 4;
        self.accessor(json!({ "bufferView": view, "componentType": 5125, "count": count, "type": "SCALAR" }))
    }

    /// Adds a stretch of bytes, beginning at a multiple of four; its number.
    pub(crate) fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// The file: a header, the JSON part, the binary part, each padded to four bytes. `None` beyond 4 GiB.
pub(crate) fn container(document: &Value, bytes: &[u8]) -> Option<Vec<u8>> {
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
