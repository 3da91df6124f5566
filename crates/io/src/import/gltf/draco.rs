//! KHR_draco_mesh_compression: primitives whose vertices and triangles are packed together in a buffer view. What their
//! accessors would hold is unpacked before anything is read, in each accessor's own type; then nobody needs to know.
//!
//! What a stream may unpack to is bounded by what its accessors announce, and that by the file: nothing is allocated on its
//! word.
use std::collections::HashMap;

use draco_core::{DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder, PointAttribute};
use durer_scene::counted;
use rayon::prelude::*;

use super::{
    accessor::Announced,
    buffer::Buffers,
    document::Document,
    element::{Checked, Element, Fault},
};

/// The name of the extension.
pub(super) const NAME: &str = "KHR_draco_mesh_compression";
/// What all streams of a file may unpack to, by their length: what is the same all over packs to next to nothing.
const BEST_RATIO: u64 = 1 << 12;
/// Unpacked bytes that any file may promise.
const HARMLESS: u64 = 64 << 20;
/// Attributes of a stream that no accessor asks for may take so many times as much as the others.
const UNASKED: u64 = 4;

/// What accessors hold that are packed, by their index.
pub(super) type Columns = HashMap<usize, Checked<Vec<u8>>>;

/// A packed primitive.
struct Job<'b, 'a> {
    /// The extension object.
    element: Element<'a>,
    bytes: Checked<&'b [u8]>,
    /// Accessor of the indices.
    indices: Column<'a>,
    /// It announces a strip, not three corners for each triangle.
    is_strip: bool,
    /// Accessors of attributes, and the numbers that the stream knows these by.
    attributes: Vec<(Column<'a>, u32)>,
}

/// An accessor to be filled.
struct Column<'a> {
    index: usize,
    announced: Announced<'a>,
}

impl<'a> Column<'a> {
    fn of(document: &Document<'a>, reference: &Element<'a>) -> Checked<Self> {
        let announced = Announced::read(document.item("accessors", reference)?)?;
        Ok(Self { index: reference.index()?, announced })
    }
}

/// Unpacks all primitives of a document that are packed.
///
/// # Errors
/// If the document is wrong. What is wrong with a stream is a fault of each accessor that it would fill.
pub(super) fn unpack<'a>(document: &Document<'a>, buffers: &Buffers) -> Checked<Columns> {
    let mut jobs: Vec<Job<'_, 'a>> = Vec::new();
    for mesh in document.root.list("meshes")? {
        for primitive in mesh.list("primitives")? {
            if let Some(element) = primitive.extension(NAME)? {
                jobs.push(Job::of(document, buffers, (&primitive, element))?);
            }
        }
    }
    let packed: u64 = jobs.iter().flat_map(|job| &job.bytes).map(|bytes| bytes.len() as u64).sum();
    let mut left = packed.saturating_mul(BEST_RATIO).max(HARMLESS);
    for job in &jobs {
        left = left.checked_sub(job.announced()).ok_or_else(|| {
            let packed = counted(packed as usize, "byte");
            job.element.fault(format!("its accessors announce far more than {packed} can be unpacked to"))
        })?;
    }
    let filled: Vec<_> = jobs.into_par_iter().map(|job| job.fill()).collect();
    Ok(filled.into_iter().flatten().collect())
}

impl<'b, 'a> Job<'b, 'a> {
    fn of(
        document: &Document<'a>,
        buffers: &'b Buffers,
        (primitive, element): (&Element<'a>, Element<'a>),
    ) -> Checked<Self> {
        let indices = primitive.get("indices")?.ok_or_else(|| {
            primitive
                .fault("a primitive that is packed by Draco needs \"indices\", which say how many there are")
        })?;
        let mode = primitive.index_or("mode", 4)?;
        if !matches!(mode, 4 | 5) {
            let message = "what is packed by Draco is triangles (4) or a strip (5)";
            return Err(primitive.fault_at("mode", message));
        }
        let (asked, known) = (primitive.required("attributes")?, element.required("attributes")?);
        let mut attributes = Vec::new();
        for name in known.keys() {
            let number = known.required(name)?;
            let reference =
                asked.get(name)?.ok_or_else(|| number.fault("the primitive has no such attribute"))?;
            let id = u32::try_from(number.index()?).map_err(|e| number.fault(e.to_string()))?;
            attributes.push((Column::of(document, &reference)?, id));
        }
        let bytes = buffers.view(document, &element.required("bufferView")?)?.bytes;
        let indices = Column::of(document, &indices)?;
        Ok(Self { bytes, indices, is_strip: mode == 5, attributes, element })
    }

    /// The bytes that its accessors announce.
    fn announced(&self) -> u64 {
        let attributes = self.attributes.iter().map(|(column, _)| column.announced.bytes());
        attributes.fold(self.indices.announced.bytes(), u64::saturating_add)
    }

    fn fill(self) -> Vec<(usize, Checked<Vec<u8>>)> {
        let unpacked = self.unpacked();
        let all = std::iter::once((&self.indices, None))
            .chain(self.attributes.iter().map(|(c, id)| (c, Some(*id))));
        all.map(|(column, id)| {
            let mesh = unpacked.as_ref().map_err(Fault::clone);
            let bytes = mesh.and_then(|mesh| match id {
                None => indices(mesh, &column.announced, self.is_strip),
                Some(id) => attribute(mesh, id, &column.announced),
            });
            (column.index, bytes)
        })
        .collect()
    }

    fn unpacked(&self) -> Checked<Mesh> {
        let mut limits = DecodeLimits::default();
        let corners = self.indices.announced.count as u64;
        limits.max_faces = if self.is_strip { corners.saturating_sub(2) } else { corners / 3 };
        limits.max_decoded_bytes = self.announced().saturating_mul(UNASKED).max(1 << 20);
        let mut buffer = DecoderBuffer::new(self.bytes.clone()?).with_limits(limits);
        let mut mesh = Mesh::new();
        match MeshDecoder::new().decode(&mut buffer, &mut mesh) {
            Ok(()) => Ok(mesh),
            Err(error) => Err(self.element.fault(match error.kind() {
                ErrorKind::LimitExceeded | ErrorKind::AllocationExceedsInput => {
                    "the Draco stream holds more than its accessors announce"
                }
                _ => "the Draco stream is damaged; copy the file again, or pack it again",
            })),
        }
    }
}

/// The corners of all triangles. The stream has them one by one also where the file announces a strip of them, in which there
/// may be more that join its parts.
fn indices(mesh: &Mesh, announced: &Announced<'_>, is_strip: bool) -> Checked<Vec<u8>> {
    let corners = mesh.faces().as_flattened();
    announced.expect(if is_strip { announced.count } else { corners.len() }, 1)?;
    let mut bytes = Vec::with_capacity(corners.len() * announced.component.size());
    corners.iter().for_each(|corner| announced.component.put_index(corner.0, &mut bytes));
    Ok(bytes)
}

/// The values of an attribute at all vertices.
fn attribute(mesh: &Mesh, id: u32, announced: &Announced<'_>) -> Checked<Vec<u8>> {
    let attribute: &PointAttribute = mesh
        .attribute_by_unique_id(id)
        .ok_or_else(|| announced.element.fault(format!("the Draco stream has no attribute {id}")))?;
    let lanes = usize::from(attribute.num_components());
    announced.expect(mesh.num_points(), lanes)?;
    let mut bytes = Vec::with_capacity(announced.bytes() as usize);
    let values = attribute.read_f32s(mesh.num_points(), lanes);
    values.into_iter().for_each(|value| announced.component.put(value, &mut bytes));
    Ok(bytes)
}
