//! Primitives to triangle meshes. Primitives with the same accessors share one mesh, whatever their materials.
use std::{collections::HashMap, sync::Arc};

use durer_core::{
    Id,
    math::{Normal3, Point2, Point3},
};
use durer_scene::Mesh;

use super::{
    accessor::Accessor,
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
};

/// Attributes we read, in the order of the cache key.
const ATTRIBUTES: [&str; 5] = ["POSITION", "NORMAL", "TEXCOORD_0", "TANGENT", "COLOR_0"];

/// Meshes made so far.
pub(super) struct Meshes<'b, 'a> {
    document: &'b Document<'a>,
    buffers: &'b Buffers<'a>,
    made: HashMap<String, Option<Id<Mesh>>>,
    /// The meshes, by id.
    pub(super) list: Vec<Arc<Mesh>>,
}

/// How indices become triangles.
#[derive(Clone, Copy)]
enum Mode {
    Triangles,
    Strip,
    Fan,
}

impl<'b, 'a> Meshes<'b, 'a> {
    /// None yet.
    pub(super) fn new(document: &'b Document<'a>, buffers: &'b Buffers<'a>) -> Self {
        Self { document, buffers, made: HashMap::new(), list: Vec::new() }
    }

    /// The mesh of a primitive; `None` if there is nothing to draw.
    pub(super) fn mesh(&mut self, primitive: &Element<'a>) -> Checked<Option<Id<Mesh>>> {
        let mode = match primitive.index_or("mode", 4)? {
            0..=3 => {
                self.document.warn(primitive, "points and lines are not drawn");
                return Ok(None);
            }
            4 => Mode::Triangles,
            5 => Mode::Strip,
            6 => Mode::Fan,
            other => return Err(primitive.fault_at("mode", format!("expected 0 to 6, found {other}"))),
        };
        let attributes = primitive.required("attributes")?;
        let mut key = format!("{}", mode as u8);
        for name in ATTRIBUTES {
            key += &attributes.get(name)?.map_or(Ok("-".to_owned()), |e| Ok(format!(" {}", e.index()?)))?;
        }
        key += &primitive.get("indices")?.map_or(Ok(String::new()), |e| Ok(format!(" {}", e.index()?)))?;
        if let Some(made) = self.made.get(&key) {
            return Ok(*made);
        }
        if !primitive.list("targets")?.is_empty() {
            self.document.warn(primitive, "morph targets are not applied yet: the mesh is drawn at rest");
        }
        let made = self.build(primitive, &attributes, mode)?.map(|mesh| {
            self.list.push(Arc::new(mesh));
            Id::new(self.list.len() as u32 - 1)
        });
        self.made.insert(key, made);
        Ok(made)
    }

    fn attribute(&self, attributes: &Element<'a>, name: &str) -> Checked<Option<Accessor<'b, 'a>>> {
        let Some(reference) = attributes.get(name)? else {
            return Ok(None);
        };
        Accessor::open(self.document, self.buffers, &reference).map(Some)
    }

    /// The vertices in the order in which the primitive visits them.
    fn corners(&self, primitive: &Element<'a>, positions: &Accessor<'_, 'a>) -> Checked<Vec<u32>> {
        if let Some(reference) = primitive.get("indices")? {
            let accessor = Accessor::open(self.document, self.buffers, &reference)?;
            let corners = accessor.indices(self.document)?;
            check_corners(&accessor, &corners, positions.count)?;
            return Ok(corners);
        }
        self.document.spend(&positions.element, positions.count, 4)?;
        let count = u32::try_from(positions.count).map_err(|e| positions.element.fault(e.to_string()))?;
        Ok((0..count).collect())
    }

    fn build(&self, primitive: &Element<'a>, attributes: &Element<'a>, mode: Mode) -> Checked<Option<Mesh>> {
        let document = self.document;
        let Some(positions) = self.attribute(attributes, "POSITION")? else {
            document.warn(primitive, "a primitive without POSITION draws nothing");
            return Ok(None);
        };
        let corners = self.corners(primitive, &positions)?;
        document.spend(primitive, corners.len(), 12)?;
        if matches!(mode, Mode::Triangles) && corners.len() % 3 != 0 {
            document
                .warn(primitive, "the number of indices is not a multiple of 3; the last ones are ignored");
        }
        let mut indices = triangles(&corners, mode);
        if indices.is_empty() {
            document.warn(primitive, "a primitive without triangles draws nothing");
            return Ok(None);
        }
        let used = used_vertices(&corners, positions.count, &mut indices);
        let read = Columns { meshes: self, attributes, vertices: positions.count, which: used.as_deref() };
        let mesh = Mesh {
            positions: positions
                .floats::<3>(document, used.as_deref())?
                .into_iter()
                .map(Point3::from)
                .collect(),
            indices,
            normals: read.column::<3>("NORMAL")?.into_iter().map(Normal3::from).collect(),
            // v of glTF grows downwards, ours upwards.
            uvs: read.column("TEXCOORD_0")?.into_iter().map(|[u, v]| Point2::new(u, 1.0 - v)).collect(),
            tangents: read.column("TANGENT")?,
            colors: read.colors()?,
            ..Mesh::default()
        };
        mesh.validate().map_err(|e| primitive.fault(e.to_string()))?;
        Ok(Some(mesh))
    }
}

/// Optional attributes of one primitive.
struct Columns<'r, 'b, 'a> {
    meshes: &'r Meshes<'b, 'a>,
    attributes: &'r Element<'a>,
    vertices: usize,
    which: Option<&'r [u32]>,
}

impl<'b, 'a> Columns<'_, 'b, 'a> {
    fn open(&self, name: &str) -> Checked<Option<Accessor<'b, 'a>>> {
        let accessor = self.meshes.attribute(self.attributes, name)?;
        match accessor {
            Some(a) if a.count != self.vertices => {
                let message = format!("{name} has {} elements for {} vertices", a.count, self.vertices);
                Err(a.element.fault(message))
            }
            accessor => Ok(accessor),
        }
    }
    /// The attribute, or nothing if it is missing or holds infinities: a renderer could do nothing with them.
    fn column<const N: usize>(&self, name: &str) -> Checked<Vec<[f32; N]>> {
        let Some(accessor) = self.open(name)? else {
            return Ok(Vec::new());
        };
        let rows = accessor.floats::<N>(self.meshes.document, self.which)?;
        if rows.iter().flatten().all(|v| v.is_finite()) {
            return Ok(rows);
        }
        self.meshes
            .document
            .warn(&accessor.element, format!("{name} holds infinite or NaN numbers; ignored"));
        Ok(Vec::new())
    }
    /// Vertex colours with or without alpha.
    fn colors(&self) -> Checked<Vec<[f32; 4]>> {
        match self.open("COLOR_0")? {
            Some(a) if a.lanes == 3 => {
                Ok(self.column("COLOR_0")?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
            }
            _ => self.column("COLOR_0"),
        }
    }
}

fn check_corners(accessor: &Accessor<'_, '_>, corners: &[u32], vertices: usize) -> Checked<()> {
    match corners.iter().position(|&c| c as usize >= vertices) {
        None => Ok(()),
        Some(at) => {
            let index = corners.get(at).copied().unwrap_or_default();
            let message = format!("index {index} at position {at}, but there are only {vertices} vertices");
            Err(accessor.element.fault(message))
        }
    }
}

/// Triangles of a list of corners (glTF 2.0, section 3.7.2.1).
fn triangles(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::Triangles => corners.as_chunks::<3>().0.to_vec(),
        Mode::Strip => {
            let turn = |(i, w): (usize, &[u32])| match *w {
                [a, b, c] if i % 2 == 0 => Some([a, b, c]),
                [a, b, c] => Some([a, c, b]),
                _ => None,
            };
            corners.windows(3).enumerate().filter_map(turn).collect()
        }
        Mode::Fan => {
            let Some((&hub, rim)) = corners.split_first() else {
                return Vec::new();
            };
            rim.iter().zip(rim.iter().skip(1)).map(|(&a, &b)| [a, b, hub]).collect()
        }
    }
}

/// Many exporters let all primitives share one vertex array. The vertices that the triangles of this one use, if they
/// are clearly fewer than all, with `indices` renumbered to them; else `None`.
fn used_vertices(corners: &[u32], vertices: usize, indices: &mut [[u32; 3]]) -> Option<Vec<u32>> {
    if corners.len() >= vertices {
        return None;
    }
    let mut used = corners.to_vec();
    used.sort_unstable();
    used.dedup();
    for corner in indices.iter_mut().flatten() {
        *corner = used.binary_search(corner).ok()? as u32;
    }
    Some(used)
}
