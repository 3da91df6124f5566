//! The shape of a light in its place: which piece, which point of it, with which density.
//!
//! A piece is chosen in proportion to its area, by bisection of the sums; what is left of the random number goes on to the
//! piece, so that strata of the number are strata of the light.
use std::{borrow::Cow, sync::Arc};

use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Normal3, Point3},
};
use durer_scene::Mesh;

use super::{
    super::Track,
    piece::Piece,
    placed::{Chosen, Placed, choose_triangle, mirrors, triangle_density},
    triangle,
};
use crate::shape::{Geometry, flat};

/// A shape that shines.
#[derive(Debug)]
pub(super) struct Emitter {
    form: Form,
    /// The pieces in their place if they stand still.
    placed: Vec<Placed>,
    choice: Choice,
    track: Track,
    /// The outside is inside.
    reversed: bool,
    /// The largest product of a coordinate and a coefficient of the placement: what its rounding is measured by.
    magnitude: f64,
    /// In square metres, at the first moment.
    pub(super) area: f64,
}

#[derive(Debug)]
enum Form {
    /// Pieces, and where those of each part of the shape begin.
    Pieces(Vec<Piece>, Vec<u32>),
    /// Triangles.
    Mesh(Arc<Mesh>),
}

impl Emitter {
    /// What `geometry` becomes.
    ///
    /// # Errors
    /// Why it cannot shine.
    pub(super) fn new(geometry: &Geometry, track: Track, reversed: bool) -> Result<Self, &'static str> {
        let form = Form::of(geometry).ok_or("an infinite shape cannot be an area light")?;
        let first = track.at(f32::NEG_INFINITY);
        let areas = form.areas(&track);
        let choice = Choice::of(&areas).ok_or("the shape has no area: it gives no light")?;
        let extent = form.extent();
        let largest = |m: &DAffine3| {
            let row = |r: usize| m.matrix3.row(r).abs().element_sum() * extent + m.translation[r].abs();
            row(0).max(row(1)).max(row(2))
        };
        let magnitude = track.stations().map(largest).fold(0.0, f64::max);
        let area = form.areas_at(&first).sum();
        let placed = match &form {
            Form::Pieces(pieces, _) if track.is_still() => pieces.iter().map(|p| p.placed(&first)).collect(),
            _ => Vec::new(),
        };
        Ok(Self { form, placed, choice, track, reversed, magnitude, area })
    }

    /// A point of the light and how far, at most, each coordinate of its shape may be off as rays find it.
    pub(super) fn choose(&self, from: DVec3, time: f32, u: [f64; 2]) -> Option<(Chosen, f64)> {
        let (index, rest, share) = self.choice.pick(u[0]);
        let u = [rest, u[1]];
        let chosen = match &self.form {
            Form::Pieces(pieces, _) => match self.placed.get(index) {
                Some(placed) => placed.choose(from, u)?,
                None => pieces[index].placed(&self.track.at(time)).choose(from, u)?,
            },
            Form::Mesh(mesh) => {
                let m = self.track.at(time);
                let corners = mesh_corners(mesh, index, time);
                let chosen = choose_triangle(corners.map(|p| m.transform_point3(p)), from, u)?;
                let turned = mesh_turns(mesh, index, corners) != mirrors(&m);
                Chosen { n: if turned { -chosen.n } else { chosen.n }, ..chosen }
            }
        };
        let n = if self.reversed { -chosen.n } else { chosen.n };
        Some((Chosen { n, density: chosen.density * share, ..chosen }, self.magnitude))
    }

    /// The density with which [`Emitter::choose`] gives the direction of a point of part `part`.
    pub(super) fn density(&self, from: DVec3, time: f32, (p, n, part): (DVec3, DVec3, u32)) -> f64 {
        let part = part as usize;
        match &self.form {
            Form::Mesh(mesh) => {
                let m = self.track.at(time);
                let corners = mesh_corners(mesh, part, time).map(|p| m.transform_point3(p));
                self.choice.share(part) * triangle_density(corners, from, p)
            }
            Form::Pieces(pieces, starts) => {
                let m = self.track.at(time);
                let placed = |i: usize| match self.placed.get(i) {
                    Some(placed) => Cow::Borrowed(placed),
                    None => Cow::Owned(pieces[i].placed(&m)),
                };
                let first = starts.get(part).map_or(0, |i| *i as usize);
                let end = starts.get(part + 1).map_or(pieces.len(), |i| *i as usize);
                // A flat part of several triangles: the one that holds the point.
                let index = (first..end).find(|&i| i + 1 == end || placed(i).holds(p)).unwrap_or(first);
                self.choice.share(index) * placed(index).density(from, p, n)
            }
        }
    }
}

impl Form {
    fn of(geometry: &Geometry) -> Option<Self> {
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
        }
    }

    /// The areas by which pieces are chosen: the sums over all moments that differ.
    fn areas(&self, track: &Track) -> Vec<f64> {
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

    fn areas_at<'s>(&'s self, m: &'s DAffine3) -> Box<dyn Iterator<Item = f64> + 's> {
        match self {
            Self::Pieces(pieces, _) => Box::new(pieces.iter().map(|piece| piece.area(m))),
            Self::Mesh(mesh) => Box::new((0..mesh.indices.len()).map(|i| {
                triangle::area(mesh_corners(mesh, i, f32::NEG_INFINITY).map(|p| m.transform_point3(p)))
            })),
        }
    }

    fn extent(&self) -> f64 {
        match self {
            Self::Pieces(pieces, _) => pieces.iter().map(Piece::extent).fold(0.0, f64::max),
            Self::Mesh(mesh) => {
                let keys = (0..mesh.keys()).flat_map(|key| mesh.key(key).1);
                keys.fold(0.0, |largest, p| largest.max(p.to_f64().abs().max_element()))
            }
        }
    }
}

fn mesh_corners(mesh: &Mesh, triangle: usize, time: f32) -> [DVec3; 3] {
    let Some(vertices) = mesh.indices.get(triangle) else { return [DVec3::ZERO; 3] };
    mesh.corners(vertices.map(|i| i as usize), time).map(Point3::to_f64)
}

/// Whether the vertex normals of a triangle say that the outside is where it is seen clockwise.
fn mesh_turns(mesh: &Mesh, triangle: usize, [a, b, c]: [DVec3; 3]) -> bool {
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

/// Choice in proportion to weights.
#[derive(Debug)]
struct Choice {
    /// Sums of the weights up to and with each; the last is 1.
    sums: Vec<f64>,
}

impl Choice {
    /// `None` if no weight is positive, or their sum is not finite.
    fn of(weights: &[f64]) -> Option<Self> {
        let total: f64 = weights.iter().sum();
        let mut sum = 0.0;
        let mut upto = |w: &f64| {
            sum += w;
            sum / total
        };
        (total > 0.0 && total.is_finite()).then(|| Self { sums: weights.iter().map(&mut upto).collect() })
    }
    /// The index for `u` in `[0, 1)`, `u` within its share, and the share.
    fn pick(&self, u: f64) -> (usize, f64, f64) {
        if self.sums.len() == 1 {
            return (0, u, 1.0);
        }
        let index = self.sums.partition_point(|&sum| sum <= u).min(self.sums.len() - 1);
        let share = self.share(index);
        let before = if index == 0 { 0.0 } else { self.sums[index - 1] };
        (index, ((u - before) / share).clamp(0.0, 1.0 - f64::EPSILON), share)
    }
    fn share(&self, index: usize) -> f64 {
        let upto = |i: usize| self.sums.get(i).copied().unwrap_or(1.0);
        if index == 0 { upto(0) } else { upto(index) - upto(index - 1) }
    }
}
