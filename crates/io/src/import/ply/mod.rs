//! PLY, the Stanford triangle format (Turk 1994): text and both byte orders, with vertices, faces and triangle strips.
//!
//! Faces turn counter-clockwise seen from outside. Colours in whole numbers are sRGB, in floats linear. Without normals
//! the mesh is faceted, as in pbrt. `tangent_x` to `tangent_w`, `u2` and `v2` are columns of ours: tangents with handedness,
//! a second set of texture coordinates.

mod body;
mod header;
mod numbers;
mod row;

use std::path::Path;

use durer_core::{
    Id,
    glam::{DAffine3, DVec3},
    math::{Motion, Point2, Point3},
};
use durer_scene::{
    AssetError, MaterialRef, Mesh, NamedNode, Node, Params, Severity, ShapeDesc, ShapeSource, TextureDesc,
    TextureValue,
};

use self::row::Rows;
use super::{
    Imported,
    polygon::Triangulator,
    text::{Complaint, tell},
    unify::Unifier,
};
use crate::assets::read_file;

/// What a file holds.
struct Read {
    mesh: Mesh,
    /// The image that a comment names.
    texture: Option<String>,
    warnings: Vec<Complaint>,
}

/// Reads the file at `path`.
pub(super) fn read(path: &Path, imported: &mut Imported) {
    let file = path.display().to_string();
    let bytes = match read_file(path, &file, imported.assets.limits()) {
        Ok(bytes) => match header::with_line_feeds(&bytes) {
            Some(bytes) => bytes,
            None => bytes,
        },
        Err(error) => {
            imported.diagnostics.error(durer_scene::Location::None, error.to_string());
            return;
        }
    };
    let mut complaints = Vec::new();
    match parse(&bytes, Paint::Vertices) {
        Ok(read) => {
            complaints = read.warnings;
            if read.mesh.indices.is_empty() {
                complaints.push(no_faces(&read.mesh));
            } else {
                place(read.mesh, read.texture, &mut complaints, imported);
            }
        }
        Err(complaint) => complaints.push(complaint),
    }
    tell(complaints, &file, &bytes, imported);
}

fn no_faces(mesh: &Mesh) -> Complaint {
    let message = match mesh.positions.len() {
        0 => "the file holds no vertices and no faces: there is nothing to see".to_owned(),
        n => format!("the file holds {n} points but no faces: there is nothing to see"),
    };
    Complaint::whole(message).warning().hint("durer draws surfaces; make a mesh of a point cloud first")
}

/// The triangles in `bytes`, which messages call `name`.
pub(crate) fn mesh(bytes: &[u8], name: &str) -> Result<Mesh, AssetError> {
    painted(bytes, name, Paint::Vertices)
}

/// Whose colours a mesh gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Paint {
    /// Those of its vertices.
    Vertices,
    /// Those of its faces, which share no vertices then.
    Faces,
}

/// The triangles in `bytes`, which messages call `name`, with the colours of their vertices or faces.
pub(crate) fn painted(bytes: &[u8], name: &str, paint: Paint) -> Result<Mesh, AssetError> {
    let fail = |reason| AssetError::Format { path: name.to_owned(), reason };
    let converted = header::with_line_feeds(bytes);
    let bytes = converted.as_deref().unwrap_or(bytes);
    let read = parse(bytes, paint).map_err(|c| fail(c.line(bytes)))?;
    if read.mesh.indices.is_empty() {
        return Err(fail(no_faces(&read.mesh).message));
    }
    Ok(read.mesh)
}

fn parse(bytes: &[u8], paint: Paint) -> Result<Read, Complaint> {
    let header = header::parse(bytes)?;
    let mut rows = body::read(&header, bytes)?;
    if paint == Paint::Faces {
        paint_faces(&mut rows);
    }
    let mut warnings = header.warnings;
    let mesh = assemble(rows, &mut warnings);
    mesh.validate().map_err(|e| Complaint::whole(e.to_string()))?;
    Ok(Read { mesh, texture: header.texture, warnings })
}

fn assemble(mut rows: Rows, warnings: &mut Vec<Complaint>) -> Mesh {
    let mut dropped = |what: &str| {
        let message = format!("{what} hold infinite or NaN numbers; they are ignored");
        warnings.push(Complaint::whole(message).warning());
    };
    if rows.normals.iter().any(|n| !n.is_finite()) {
        rows.normals.clear();
        dropped("the normals");
    }
    if rows.tangents.iter().flatten().any(|t| !t.is_finite()) {
        rows.tangents.clear();
        dropped("the tangents");
    }
    if rows
        .uvs
        .iter()
        .chain(&rows.coords)
        .chain(&rows.second_uvs)
        .any(|p| !(p.x.is_finite() && p.y.is_finite()))
    {
        rows.uvs.clear();
        rows.coords.clear();
        rows.second_uvs.clear();
        dropped("the texture coordinates");
    }
    if rows.colors.iter().flatten().any(|c| !c.is_finite()) {
        rows.colors.clear();
        dropped("the colours");
    }
    if !rows.faces.is_empty() && rows.uvs.is_empty() && rows.coords.is_empty() {
        span_faces(&mut rows);
    }
    if !rows.coords.is_empty() && rows.uvs.is_empty() {
        split_vertices(&mut rows);
    }
    let long = std::mem::take(&mut rows.long);
    warnings.extend(
        long.warn(|n| format!("{n} lines hold more numbers than the header says; the last are ignored")),
    );
    let (indices, faces) = triangles(&rows, warnings);
    let Rows { positions, normals, uvs, colors, tangents, second_uvs, .. } = rows;
    Mesh { positions, indices, normals, uvs, second_uvs, faces, tangents, colors, ..Mesh::default() }
}

/// Gives the corners of each numbered face the coordinates that pbrt takes where a file has none.
fn span_faces(rows: &mut Rows) {
    const SQUARE: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let (mut start, corners) = (0, rows.corners.len());
    let triangles = (1..=corners / 3).map(|i| 3 * i);
    let ends = if rows.ends.is_empty() { triangles.collect() } else { rows.ends.clone() };
    for end in ends {
        // Of faces with more corners nobody says.
        rows.coords.extend(SQUARE.into_iter().cycle().take(end - start).map(Point2::from));
        start = end;
    }
}

/// Gives corners with texture coordinates of their own vertices of their own.
fn split_vertices(rows: &mut Rows) {
    let coords = std::mem::take(&mut rows.coords);
    let mut unifier = Unifier::new(rows.positions.len());
    let (mut sources, mut uvs) = (Vec::new(), Vec::new());
    for (i, corner) in rows.corners.iter_mut().enumerate() {
        let uv: Point2 = coords.get(i).copied().unwrap_or_default();
        let id = unifier.id(*corner, [uv.x.to_bits(), uv.y.to_bits()], sources.len() as u32);
        if id as usize == sources.len() {
            sources.push(*corner as usize);
            uvs.push(uv);
        }
        *corner = id;
    }
    rows.positions = gather(&rows.positions, &sources);
    rows.normals = gather(&rows.normals, &sources);
    rows.colors = gather(&rows.colors, &sources);
    rows.tangents = gather(&rows.tangents, &sources);
    rows.second_uvs = gather(&rows.second_uvs, &sources);
    rows.uvs = uvs;
}

/// Gives all corners vertices of their own, in the colour of their face.
fn paint_faces(rows: &mut Rows) {
    let sources: Vec<usize> = rows.corners.iter().map(|&v| v as usize).collect();
    let face_of = |corner: usize| match rows.ends.is_empty() {
        true => corner / 3,
        false => rows.ends.partition_point(|&end| end <= corner),
    };
    let color = |corner: usize| rows.face_colors.get(face_of(corner)).copied().unwrap_or([1.0; 4]);
    rows.colors = (0..sources.len()).map(color).collect();
    rows.positions = gather(&rows.positions, &sources);
    rows.normals = gather(&rows.normals, &sources);
    rows.uvs = gather(&rows.uvs, &sources);
    rows.tangents = gather(&rows.tangents, &sources);
    rows.second_uvs = gather(&rows.second_uvs, &sources);
    rows.corners = (0..sources.len() as u32).collect();
}

fn gather<T: Copy>(list: &[T], which: &[usize]) -> Vec<T> {
    which.iter().filter_map(|&i| list.get(i).copied()).collect()
}

/// Triangles, and the number of the face of each if faces have numbers.
fn triangles(rows: &Rows, warnings: &mut Vec<Complaint>) -> (Vec<[u32; 3]>, Vec<u32>) {
    if rows.ends.is_empty() {
        return (rows.corners.as_chunks::<3>().0.to_vec(), rows.faces.clone());
    }
    let mut faces = Vec::new();
    let mut indices = Vec::with_capacity(rows.corners.len() / 2);
    let mut split = Triangulator::new(rows.corners.len());
    let (mut points, mut local, mut start, mut poor) = (Vec::new(), Vec::new(), 0, 0);
    for (number, &end) in rows.ends.iter().enumerate() {
        let polygon = rows.corners.get(start..end).unwrap_or_default();
        start = end;
        match *polygon {
            [a, b, c] => {
                indices.push([a, b, c]);
                faces.extend(rows.faces.get(number));
                continue;
            }
            [] | [_] | [_, _] => {
                poor += 1;
                continue;
            }
            _ => {}
        }
        points.clear();
        points.extend(
            polygon
                .iter()
                .map(|&v| rows.positions.get(v as usize).map_or(DVec3::ZERO, |p| Point3::to_f64(*p))),
        );
        local.clear();
        split.split(&points, &mut local);
        indices.extend(local.iter().map(|t| t.map(|i| polygon.get(i).copied().unwrap_or_default())));
        faces.extend(local.iter().filter_map(|_| rows.faces.get(number)));
    }
    if poor > 0 {
        warnings
            .push(Complaint::whole(format!("{poor} faces with fewer than 3 corners are left out")).warning());
    }
    if split.hasty > 0 {
        warnings.push(Complaint::whole(super::polygon::hasty(split.hasty)).warning());
    }
    (indices, faces)
}

/// The mesh as the one shape of the scene.
fn place(mesh: Mesh, texture: Option<String>, complaints: &mut Vec<Complaint>, imported: &mut Imported) {
    let colored = !mesh.colors.is_empty();
    let texture = texture.filter(|_| !mesh.uvs.is_empty()).filter(|name| {
        let found = durer_scene::Assets::image(&imported.assets, name);
        if let Err(error) = &found {
            let said = Complaint::whole(format!("{error}; drawn without this image")).warning();
            let hint = durer_scene::Assets::advice(&imported.assets, error);
            complaints.push(Complaint { hint, ..said });
        }
        found.is_ok()
    });
    let desc = &mut imported.desc;
    let matte = Params::new().float("roughness", 1.0).float("eta", 1.0);
    let params = match &texture {
        Some(filename) => {
            let node =
                Node::new("imagemap", Params::new().string("filename", filename).string("encoding", "sRGB"));
            desc.textures.push(TextureDesc {
                name: filename.clone(),
                value: TextureValue::Color,
                node,
                world_from_texture: DAffine3::IDENTITY,
            });
            matte.texture("basecolor", filename)
        }
        None => matte.rgb("basecolor", [1.0; 3]),
    };
    let mut material: Option<MaterialRef> = None;
    if colored || texture.is_some() {
        let name = if colored { "vertex colours" } else { "texture" };
        desc.materials.push(NamedNode { name: name.to_owned(), node: Node::new("principled", params) });
        material = Some(Id::new(0));
    }
    desc.meshes.push(std::sync::Arc::new(mesh));
    desc.shapes.push(ShapeDesc {
        name: desc.name.clone(),
        source: ShapeSource::Mesh(Id::new(0)),
        world_from_object: Motion::still(DAffine3::IDENTITY),
        material,
        reverse_orientation: false,
        area_light: None,
        media: None,
    });
    debug_assert!(complaints.iter().all(|c| c.severity != Severity::Error));
}
