//! What the shape of a light consists of.
use std::sync::Arc;

use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Normal3, Point3},
};
use durer_scene::Mesh;

use super::{super::Track, piece::Piece, triangle};
use crate::shape::{Geometry, flat};

/// What the shape of a light consists of.
#[derive(Debug)]
pub(super) enum Form {
    /// Pieces, and where those of each part of the shape begin.
    Pieces(Vec<Piece>, Vec<u32>),
    /// Triangles.
    Mesh(Arc<Mesh>),
}

impl Form {
    /// That of `geometry`; `None` if it is infinite, or points of it cannot be chosen.
    pub(super) fn of(geometry: &Geometry) -> Option<Self> {
        match geometry {
            Geometry::Mesh(mesh) => Some(match rectangle(mesh) {
                // One piece, in as many parts as the mesh happens to have.
                Some(piece) => Self::Pieces(vec![piece], Vec::new()),
                None => Self::Mesh(Arc::clone(mesh)),
            }),
            Geometry::Shapes(parts) => {
                let (mut pieces, mut starts) = (Vec::new(), Vec::new());
                for part in parts {
                    starts.push(pieces.len() as u32);
                    pieces.extend(Piece::of(part)?);
                }
                Some(Self::Pieces(pieces, starts))
            }
            Geometry::Strands(_) => None,
        }
    }

    /// The areas by which pieces are chosen: the sums over all moments that differ.
    pub(super) fn areas(&self, track: &Track) -> Vec<f64> {
        let mut areas: Vec<f64> = self.areas_at(&track.at(f32::NEG_INFINITY)).collect();
        if let Self::Mesh(mesh) = self {
            for later in &mesh.later {
                let m = track.at(later.time);
                for (i, area) in areas.iter_mut().enumerate() {
                    let corners = mesh_corners(mesh, i, later.time);
                    *area += triangle::area(corners.map(|p| m.transform_point3(p)));
                }
            }
        }
        areas
    }

    /// The area of each piece or triangle where `m` places it.
    pub(super) fn areas_at<'s>(&'s self, m: &'s DAffine3) -> Box<dyn Iterator<Item = f64> + 's> {
        match self {
            Self::Pieces(pieces, _) => Box::new(pieces.iter().map(|piece| piece.area(m))),
            Self::Mesh(mesh) => Box::new((0..mesh.indices.len()).map(|i| {
                triangle::area(mesh_corners(mesh, i, f32::NEG_INFINITY).map(|p| m.transform_point3(p)))
            })),
        }
    }

    /// The corners of a box around it in its own space, at all times.
    pub(super) fn corners(&self) -> [DVec3; 8] {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut add = |p: DVec3| (low, high) = (low.min(p), high.max(p));
        match self {
            Self::Pieces(pieces, _) => {
                pieces.iter().for_each(|piece| piece.corners().into_iter().for_each(&mut add))
            }
            Self::Mesh(mesh) => {
                let keys = (0..mesh.keys()).flat_map(|key| mesh.key(key).1);
                keys.for_each(|p| add(p.to_f64()));
            }
        }
        let at = |i: usize, bit: usize| if i >> bit & 1 == 0 { low[bit] } else { high[bit] };
        std::array::from_fn(|i| DVec3::new(at(i, 0), at(i, 1), at(i, 2)))
    }
}

pub(super) fn mesh_corners(mesh: &Mesh, triangle: usize, time: f32) -> [DVec3; 3] {
    let Some(vertices) = mesh.indices.get(triangle) else { return [DVec3::ZERO; 3] };
    mesh.corners(vertices.map(|i| i as usize), time).map(Point3::to_f64)
}

/// Whether the vertex normals of a triangle say that the outside is where it is seen clockwise.
pub(super) fn mesh_turns(mesh: &Mesh, triangle: usize, [a, b, c]: [DVec3; 3]) -> bool {
    let Some(vertices) = mesh.indices.get(triangle).filter(|_| !mesh.normals.is_empty()) else {
        return false;
    };
    let normals = vertices.map(|i| mesh.normals.get(i as usize).copied().unwrap_or(Normal3::ZERO).to_f64());
    normals.iter().sum::<DVec3>().dot((b - a).cross(c - a)) < 0.0
}

/// The rectangle that two triangles make; `None` if they do not.
fn rectangle(mesh: &Mesh) -> Option<Piece> {
    let [first, second] = mesh.indices.as_slice() else { return None };
    if !mesh.is_still() {
        return None;
    }
    let lone = |t: &[u32; 3], other: &[u32; 3]| (0..3).find(|&i| !other.contains(&t[i]));
    let (i, j) = (lone(first, second)?, lone(second, first)?);
    let ([at, next, previous], far) = ([first[i], first[(i + 1) % 3], first[(i + 2) % 3]], second[j]);
    // The shared edge is run through in opposite senses.
    if second[(j + 1) % 3] != previous || second[(j + 2) % 3] != next {
        return None;
    }
    let vertex = |i: u32| mesh.positions.get(i as usize).copied().map(Point3::to_f64);
    let outline = flat::parallelogram([vertex(at)?, vertex(next)?, vertex(far)?, vertex(previous)?])?;
    let turned = |k: usize| mesh_turns(mesh, k, mesh_corners(mesh, k, 0.0));
    match (turned(0), turned(1)) {
        (false, false) => Some(Piece::Parallelogram(outline.0, outline.1)),
        (true, true) => Some(Piece::Parallelogram(outline.0, [outline.1[1], outline.1[0]])),
        _ => None,
    }
}
