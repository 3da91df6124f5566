//! The shape of a light in its place: which piece, which point of it, with which density.
//!
//! Of several pieces one is chosen by a tree, so that of a lamp of ten thousand triangles the near ones and those that face
//! the point are asked; what is left of the random number goes on to the piece, so that strata of the number are strata of
//! the light.
use std::borrow::Cow;

use durer_core::{
    glam::{DAffine3, DVec3},
    math::Point3,
};

use super::{
    super::{LightBounds, LightTree, Track},
    Sides,
    form::{Form, mesh_corners, mesh_turns},
    known::{self, Place},
    looked,
    placed::{Chosen, Placed, choose_triangle, mirrors, triangle_by_area, triangle_density},
    triangle,
};
use crate::{shape::Geometry, texture::TextureAt};

/// A shape that shines.
#[derive(Debug)]
pub(super) struct Emitter {
    geometry: Geometry,
    form: Form,
    /// The pieces in their place if they stand still.
    placed: Vec<Placed>,
    /// `None` if there is but one.
    tree: Option<LightTree>,
    /// What is known of all of it at once, for a radiance of 1.
    pub(super) known: LightBounds,
    track: Track,
    /// The outside is inside.
    reversed: bool,
    /// The largest product of a coordinate and a coefficient of the placement: what its rounding is measured by.
    magnitude: f64,
    /// In square metres, at the first moment.
    pub(super) area: f64,
}

impl Emitter {
    /// What `geometry` becomes.
    ///
    /// # Errors
    /// Why it cannot shine.
    pub(super) fn new(
        geometry: &Geometry,
        track: Track,
        sides: Sides,
        reversed: bool,
    ) -> Result<Self, &'static str> {
        let form = Form::of(geometry).ok_or(match geometry {
            Geometry::Strands(_) => "a curve cannot be an area light",
            _ => "a shape without end, or between distances (sdfgrid), cannot be an area light",
        })?;
        let first = track.at(f32::NEG_INFINITY);
        let areas = form.areas(&track);
        let total: f64 = areas.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return Err("the shape has no area: it gives no light");
        }
        let place = Place { track: &track, reversed, sides };
        let pieces = known::pieces(&form, &areas, &place);
        let known = known::whole(&pieces);
        let tree = if pieces.len() > 1 { LightTree::new(pieces.into_iter()) } else { None };
        let corners = form.corners();
        let extent = corners.iter().fold(0.0, |extent: f64, p| p.abs().max_element().max(extent));
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
        Ok(Self { geometry: geometry.clone(), form, placed, tree, known, track, reversed, magnitude, area })
    }

    /// How far, at most, each coordinate of the shape may be off as rays find it.
    pub(super) fn magnitude(&self) -> f64 {
        self.magnitude
    }

    /// A point of the light, and which piece or triangle it is on.
    pub(super) fn choose(&self, from: DVec3, time: f32, u: [f64; 2]) -> Option<(Chosen, usize)> {
        let (index, rest, share) = match &self.tree {
            Some(tree) => {
                let picked = tree.choose(Point3::from_f64(from), None, u[0])?;
                (picked.index, picked.rest, picked.chance)
            }
            None => (0, u[0], 1.0),
        };
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
        Some((Chosen { n, density: chosen.density * share, ..chosen }, index))
    }

    /// A point of piece or triangle `index` chosen by area, with its density over that, 1/m².
    pub(super) fn point_of(&self, index: usize, time: f32, u: [f64; 2]) -> Option<Chosen> {
        let m = self.track.at(time);
        let chosen = match &self.form {
            Form::Pieces(pieces, _) => match self.placed.get(index) {
                Some(placed) => placed.by_area(u)?,
                None => pieces[index].placed(&m).by_area(u)?,
            },
            Form::Mesh(mesh) => {
                let corners = mesh_corners(mesh, index, time);
                let chosen = triangle_by_area(corners.map(|p| m.transform_point3(p)), u)?;
                let turned = mesh_turns(mesh, index, corners) != mirrors(&m);
                Chosen { n: if turned { -chosen.n } else { chosen.n }, ..chosen }
            }
        };
        Some(if self.reversed { Chosen { n: -chosen.n, ..chosen } } else { chosen })
    }

    /// The density of [`Emitter::point_of`] at a point of part `part`, and the piece or triangle that it is on.
    pub(super) fn density_of(&self, time: f32, (p, n, part): (DVec3, DVec3, u32)) -> (f64, usize) {
        let m = self.track.at(time);
        match &self.form {
            Form::Mesh(mesh) => {
                let corners = mesh_corners(mesh, part as usize, time).map(|p| m.transform_point3(p));
                (1.0 / triangle::area(corners), part as usize)
            }
            Form::Pieces(pieces, _) => {
                let index = self.piece_at(part, time, p);
                let placed = match self.placed.get(index) {
                    Some(placed) => Cow::Borrowed(placed),
                    None => Cow::Owned(pieces[index].placed(&m)),
                };
                (placed.area_density(p, n), index)
            }
        }
    }

    /// The part of the shape that a piece or triangle belongs to.
    pub(super) fn part_of(&self, index: usize) -> u32 {
        match &self.form {
            Form::Mesh(_) => index as u32,
            Form::Pieces(_, starts) => {
                starts.partition_point(|start| *start as usize <= index).saturating_sub(1) as u32
            }
        }
    }

    /// The areas by which pieces are chosen for particles.
    pub(super) fn areas(&self) -> Vec<f64> {
        self.form.areas(&self.track)
    }

    /// Of the pieces of a part the one that holds a point: a flat part may have several triangles.
    fn piece_at(&self, part: u32, time: f32, p: DVec3) -> usize {
        let (part, Form::Pieces(pieces, starts)) = (part as usize, &self.form) else { return part as usize };
        let m = self.track.at(time);
        let holds = |i: usize| match self.placed.get(i) {
            Some(placed) => placed.holds(p),
            None => pieces[i].placed(&m).holds(p),
        };
        let first = starts.get(part).map_or(0, |i| *i as usize);
        let end = starts.get(part + 1).map_or(pieces.len(), |i| *i as usize);
        (first..end).find(|&i| i + 1 == end || holds(i)).unwrap_or(first)
    }

    /// Where textures are looked up at point `p`, with normal `n`, of a piece or triangle.
    pub(super) fn texture_at(&self, time: f32, (p, n): (DVec3, DVec3), piece: usize) -> TextureAt {
        let m = self.track.at(time);
        let (back, normal) = (m.inverse(), m.matrix3.transpose() * n);
        let own = (back.transform_point3(p), normal.normalize_or_zero());
        let at = match (&self.geometry, &self.form) {
            (Geometry::Mesh(mesh), _) => looked::on_mesh(mesh, piece, own.0, time),
            (Geometry::Shapes(parts), Form::Pieces(_, starts)) => {
                let part = starts.partition_point(|start| *start as usize <= piece).saturating_sub(1);
                looked::on_shape(&*parts[part], own)
            }
            (Geometry::Shapes(parts), Form::Mesh(_)) => looked::on_shape(&*parts[piece], own),
            // No strand shines.
            (Geometry::Strands(_), _) => looked::somewhere(own.0, own.1),
        };
        TextureAt { p: Point3::from_f64(p), ..at }
    }

    /// Points spread over all of it where it first is: `(share of the area, point, normal, piece)`.
    pub(super) fn spread(&self) -> Vec<(f64, DVec3, DVec3, usize)> {
        let first = self.track.at(f32::NEG_INFINITY);
        let areas: Vec<f64> = self.form.areas_at(&first).collect();
        let mut all = Vec::new();
        for (index, area) in areas.iter().enumerate() {
            let share = area / self.area;
            let count = (share * f64::from(looked::POINTS)).ceil() as u32;
            for i in 0..count {
                let (p, n) = looked::point(&self.form, index, looked::place(i));
                let n = (first.matrix3.inverse().transpose() * n).normalize_or_zero();
                all.push((share / f64::from(count), first.transform_point3(p), n, index));
            }
        }
        all
    }

    /// The chance with which a piece is chosen for `from`.
    fn share(&self, from: DVec3, piece: usize) -> f64 {
        self.tree.as_ref().map_or(1.0, |tree| tree.chance(Point3::from_f64(from), None, piece))
    }

    /// The density with which [`Emitter::choose`] gives the direction of a point of part `part`.
    pub(super) fn density(&self, from: DVec3, time: f32, (p, n, part): (DVec3, DVec3, u32)) -> f64 {
        let part = part as usize;
        match &self.form {
            Form::Mesh(mesh) => {
                let m = self.track.at(time);
                let corners = mesh_corners(mesh, part, time).map(|p| m.transform_point3(p));
                self.share(from, part) * triangle_density(corners, from, p)
            }
            Form::Pieces(pieces, _) => {
                let index = self.piece_at(part as u32, time, p);
                let density = match self.placed.get(index) {
                    Some(placed) => placed.density(from, p, n),
                    None => pieces[index].placed(&self.track.at(time)).density(from, p, n),
                };
                self.share(from, index) * density
            }
        }
    }
}
