//! STL (3D Systems 1989): triangles as text or as bytes, told apart by content.
//!
//! Corners with the same bits become one vertex, so that meshes are small; there are no normals to them: surfaces are
//! faceted. The normals in the file are ignored, the order of corners says where outside is. So are the colours that
//! some programs keep in the two spare bytes of a triangle: they disagree about what these mean.

mod binary;
mod text;

use std::{collections::HashMap, path::Path, sync::Arc};

use durer_core::{
    Id,
    glam::DAffine3,
    math::{Motion, Point3},
};
use durer_scene::{Location, Mesh, ShapeDesc, ShapeSource};

use super::{
    Imported,
    text::{Complaint, tell, with_line_feeds},
};
use crate::assets::read_file;

/// A body.
#[derive(Debug, Default, PartialEq)]
struct Solid {
    name: String,
    triangles: Vec<[[f32; 3]; 3]>,
}

/// Reads the file at `path`.
pub(super) fn read(path: &Path, imported: &mut Imported) {
    let file = path.display().to_string();
    let bytes = match read_file(path, &file, imported.assets.limits()) {
        Ok(bytes) => plain(bytes),
        Err(error) => {
            imported.diagnostics.error(Location::None, error.to_string());
            return;
        }
    };
    let mut complaints = Vec::new();
    match parse(&bytes, &mut complaints) {
        Ok(solids) => {
            if solids.iter().all(|s| s.triangles.is_empty()) {
                complaints
                    .push(Complaint::whole("the file holds no triangles: there is nothing to see").warning());
            }
            solids.iter().filter(|s| !s.triangles.is_empty()).for_each(|s| place(s, imported));
        }
        Err(complaint) => complaints.push(complaint),
    }
    tell(complaints, &file, &bytes, imported);
}

/// A text with line ends as ours, without byte order mark; bytes as they are.
fn plain(bytes: Vec<u8>) -> Vec<u8> {
    if binary::fits(&bytes) {
        return bytes;
    }
    let mut bytes = bytes;
    if let Some(mark) = bytes.get_mut(..3).filter(|mark| **mark == *b"\xef\xbb\xbf") {
        mark.fill(b' ');
    }
    if text::looks_like(&bytes) { with_line_feeds(bytes) } else { bytes }
}

fn parse(bytes: &[u8], warnings: &mut Vec<Complaint>) -> Result<Vec<Solid>, Complaint> {
    if binary::fits(bytes) {
        return binary::read(bytes, warnings);
    }
    if text::looks_like(bytes) {
        return text::read(bytes, warnings);
    }
    if matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]) {
        return Err(Complaint::whole("this is UTF-16; save it as UTF-8"));
    }
    // A binary file of the wrong length.
    binary::read(bytes, warnings)
}

fn place(solid: &Solid, imported: &mut Imported) {
    let desc = &mut imported.desc;
    desc.meshes.push(Arc::new(merged(&solid.triangles)));
    let name = if solid.name.is_empty() { desc.name.clone() } else { solid.name.clone() };
    desc.shapes.push(ShapeDesc {
        name,
        source: ShapeSource::Mesh(Id::new(desc.meshes.len() as u32 - 1)),
        world_from_object: Motion::still(DAffine3::IDENTITY),
        material: None,
        reverse_orientation: false,
        area_light: None,
        media: None,
    });
}

/// One vertex for each position.
fn merged(triangles: &[[[f32; 3]; 3]]) -> Mesh {
    // The table's keys are random, so that no file can make it slow.
    let mut known: HashMap<[u32; 3], u32> = HashMap::with_capacity(triangles.len() / 2 + 3);
    let mut mesh = Mesh::default();
    mesh.indices = triangles
        .iter()
        .map(|triangle| {
            triangle.map(|p| {
                // -0 is 0.
                let p = p.map(|c| c + 0.0);
                *known.entry(p.map(f32::to_bits)).or_insert_with(|| {
                    mesh.positions.push(Point3::from(p));
                    mesh.positions.len() as u32 - 1
                })
            })
        })
        .collect();
    mesh
}

/// Complains about a corner that is infinite or no number.
fn check(corners: &[[f32; 3]; 3]) -> Result<(), &'static str> {
    match corners.iter().flatten().all(|c| c.is_finite()) {
        true => Ok(()),
        false => Err("a coordinate is nan or infinite"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_with_the_same_bits_are_one_vertex() {
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-0.0, 1.0, 0.0]];
        let mesh = merged(&[[a, b, c], [[-0.0, 0.0, 0.0], c, d]]);
        assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions.len(), 4);
        assert!(mesh.normals.is_empty());
    }
}
