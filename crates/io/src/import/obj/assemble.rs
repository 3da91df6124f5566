//! Faces to meshes: one for each object, group and material, in the order of their first faces; faces with and without
//! texture coordinates or normals apart, as a mesh has them everywhere or nowhere.
use std::{collections::HashMap, ops::Range, sync::Arc};

use durer_core::{
    Id,
    glam::{DAffine3, DVec3},
    math::{Motion, Normal3, Point2},
};
use durer_scene::{MaterialRef, Mesh, NamedNode, Node, Params, ShapeDesc, ShapeSource};
use rayon::prelude::*;

use super::{corner::NONE, library::Library, model::Model, piece::Event};
use crate::import::{
    Imported, polygon,
    polygon::Triangulator,
    text::{Complaint, Part},
    unify::Unifier,
};

/// Faces of a piece that belong together.
struct Run {
    piece: usize,
    faces: Range<usize>,
}

/// Object, group and material by name.
#[derive(Clone, Default, PartialEq, Eq, Hash)]
struct Key {
    object: String,
    group: String,
    material: String,
}

/// A mesh in the making: which corners its vertices come from.
#[derive(Default)]
struct Patch {
    corners: Vec<[u32; 3]>,
    indices: Vec<[u32; 3]>,
}

/// Appends the shapes of `model` to the scene.
pub(super) fn shapes(
    text: Part<'_>,
    model: Model,
    library: &Library,
    complaints: &mut Vec<Complaint>,
    imported: &mut Imported,
) {
    let groups = groups(text, &model);
    if groups.is_empty() {
        let message = "the file holds no faces: there is nothing to see";
        complaints.push(Complaint::whole(message).warning());
    }
    let mut builder = Builder::new(&model);
    let mut parts: Vec<(Key, Patch)> = Vec::new();
    for (key, runs) in groups {
        builder.unifier.next_group();
        parts.extend(builder.group(&runs).into_iter().map(|part| (key.clone(), part)));
    }
    if builder.flat > 0 {
        let message = format!("{} faces without area are left out", builder.flat);
        complaints.push(Complaint::whole(message).warning());
    }
    if builder.split.hasty > 0 {
        complaints.push(Complaint::whole(polygon::hasty(builder.split.hasty)).warning());
    }
    let meshes: Vec<_> = parts.par_iter().map(|(_, part)| Arc::new(mesh(&model, part))).collect();
    let default = (!model.colors.is_empty()).then(|| colored(imported));
    for ((key, _), mesh) in parts.into_iter().zip(meshes) {
        let desc = &mut imported.desc;
        desc.meshes.push(mesh);
        desc.shapes.push(ShapeDesc {
            name: name(&key, &desc.name),
            source: ShapeSource::Mesh(Id::new(desc.meshes.len() as u32 - 1)),
            world_from_object: Motion::still(DAffine3::IDENTITY),
            material: library.get(&key.material).or(default),
            reverse_orientation: false,
            area_light: None,
            media: None,
        });
    }
}

fn name(key: &Key, file: &str) -> String {
    match (key.object.as_str(), key.group.as_str()) {
        ("", "") => file.to_owned(),
        ("", name) | (name, "") => name.to_owned(),
        (object, group) => format!("{object}/{group}"),
    }
}

/// What shows the colours of vertices that no material is given to.
fn colored(imported: &mut Imported) -> MaterialRef {
    let params = Params::new().rgb("basecolor", [1.0; 3]).float("roughness", 1.0).float("eta", 1.0);
    let node = Node::new("principled", params);
    let materials = &mut imported.desc.materials;
    materials.push(NamedNode { name: "vertex colours".to_owned(), node });
    Id::new(materials.len() as u32 - 1)
}

/// Which faces belong to which object, group and material.
fn groups(text: Part<'_>, model: &Model) -> Vec<(Key, Vec<Run>)> {
    // Ranges count from the file's beginning, which a byte order mark may come before.
    let words = |range: &Range<usize>| {
        let bytes = text.bytes.get(range.start - text.at..range.end - text.at).unwrap_or_default();
        Part { bytes, at: range.start }.text()
    };
    let mut groups: Vec<(Key, Vec<Run>)> = Vec::new();
    let mut known: HashMap<Key, usize> = HashMap::new();
    let mut key = Key::default();
    for (piece, content) in model.pieces.iter().enumerate() {
        let mut close = |key: &Key, faces: Range<usize>| {
            if !faces.is_empty() {
                let index = *known.entry(key.clone()).or_insert_with(|| {
                    groups.push((key.clone(), Vec::new()));
                    groups.len() - 1
                });
                groups.get_mut(index).into_iter().for_each(|g| g.1.push(Run { piece, faces: faces.clone() }));
            }
        };
        let mut start = 0;
        for (face, event) in &content.events {
            close(&key, start..*face);
            start = *face;
            match event {
                Event::Object(range) => key = Key { object: words(range), group: String::new(), ..key },
                Event::Group(range) => key.group = words(range),
                Event::Material(range) => key.material = words(range),
                Event::Smooth(_) | Event::Library(_) => {}
            }
        }
        close(&key, start..content.ends.len());
    }
    groups
}

/// Faces to triangles with shared vertices.
struct Builder<'m> {
    model: &'m Model,
    unifier: Unifier,
    split: Triangulator,
    /// Faces without area.
    flat: usize,
    points: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
}

impl<'m> Builder<'m> {
    fn new(model: &'m Model) -> Self {
        let corners = model.pieces.iter().map(|p| p.corners.len()).sum();
        Self {
            model,
            unifier: Unifier::new(model.positions.len()),
            split: Triangulator::new(corners),
            flat: 0,
            points: Vec::new(),
            triangles: Vec::new(),
        }
    }

    /// Up to four meshes: with and without texture coordinates, with and without normals.
    fn group(&mut self, runs: &[Run]) -> Vec<Patch> {
        let mut parts: [Patch; 4] = Default::default();
        for run in runs {
            let Some(piece) = self.model.pieces.get(run.piece) else {
                continue;
            };
            let ends = piece.ends.get(run.faces.clone()).unwrap_or_default();
            let before = run.faces.start.checked_sub(1).and_then(|i| piece.ends.get(i));
            let mut start = before.copied().unwrap_or(0);
            for &end in ends {
                let corners = piece.corners.get(start..end).unwrap_or_default();
                start = end;
                let kind = corners
                    .first()
                    .map_or(0, |[_, t, n]| usize::from(*t != NONE) + 2 * usize::from(*n != NONE));
                if let Some(part) = parts.get_mut(kind) {
                    self.face(corners, part);
                }
            }
        }
        parts.into_iter().filter(|p| !p.indices.is_empty()).collect()
    }

    fn face(&mut self, corners: &[[u32; 3]], part: &mut Patch) {
        let positions = &self.model.positions;
        let point = |c: &[u32; 3]| positions.get(c[0] as usize).map_or(DVec3::ZERO, |p| p.to_f64());
        self.points.clear();
        self.points.extend(corners.iter().map(point));
        self.triangles.clear();
        self.split.split(&self.points, &mut self.triangles);
        let points = &self.points;
        self.triangles.retain(|t| {
            let [a, b, c] = t.map(|i| points.get(i).copied().unwrap_or_default());
            (b - a).cross(c - a) != DVec3::ZERO
        });
        self.flat += usize::from(self.triangles.is_empty());
        for triangle in &self.triangles {
            let indices = triangle.map(|i| {
                let corner = corners.get(i).copied().unwrap_or_default();
                let [v, t, n] = corner;
                let id = self.unifier.id(v, [t, n], part.corners.len() as u32);
                if id as usize == part.corners.len() {
                    part.corners.push(corner);
                }
                id
            });
            part.indices.push(indices);
        }
    }
}

/// Brings the attributes together.
fn mesh(model: &Model, part: &Patch) -> Mesh {
    let with = |place: usize| part.corners.first().is_some_and(|c| c.get(place) != Some(&NONE));
    let uv = |c: &[u32; 3]| model.uvs.get(c[1] as usize).copied().unwrap_or_default();
    let normal = |c: &[u32; 3]| model.normals.get(c[2] as usize).copied().unwrap_or(Normal3::from([0.0; 3]));
    let corners = &part.corners;
    let position =
        |c: &[u32; 3]| model.positions.get(c[0] as usize).copied().unwrap_or(durer_core::math::Point3::ZERO);
    Mesh {
        positions: corners.iter().map(position).collect(),
        indices: part.indices.clone(),
        normals: if with(2) { corners.iter().map(normal).collect() } else { Vec::new() },
        uvs: if with(1) { corners.iter().map(uv).collect::<Vec<Point2>>() } else { Vec::new() },
        colors: match model.colors.is_empty() {
            true => Vec::new(),
            false => {
                corners.iter().map(|c| model.colors.get(c[0] as usize).copied().unwrap_or([1.0; 4])).collect()
            }
        },
        ..Mesh::default()
    }
}
