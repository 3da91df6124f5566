//! The shape of a light in its place: which piece, which point of it, with which density.
//!
//! A piece is chosen in proportion to its area, by bisection of the sums; what is left of the random number goes on to the
//! piece, so that strata of the number are strata of the light.
use std::borrow::Cow;

use durer_core::glam::{DAffine3, DVec3};

use super::{
    super::Track,
    form::{Form, mesh_corners, mesh_turns},
    placed::{Chosen, Placed, choose_triangle, mirrors, triangle_density},
};
use crate::shape::Geometry;

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
    /// Centre and radius of a sphere around it at all times.
    sphere: (DVec3, f64),
    /// In square metres, at the first moment.
    pub(super) area: f64,
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
        let corners = form.corners();
        let extent = corners.iter().fold(0.0, |extent: f64, p| p.abs().max_element().max(extent));
        let largest = |m: &DAffine3| {
            let row = |r: usize| m.matrix3.row(r).abs().element_sum() * extent + m.translation[r].abs();
            row(0).max(row(1)).max(row(2))
        };
        let magnitude = track.stations().map(largest).fold(0.0, f64::max);
        let everywhere = || track.stations().flat_map(|m| corners.map(|p| m.transform_point3(p)));
        let low = everywhere().fold(DVec3::INFINITY, DVec3::min);
        let high = everywhere().fold(DVec3::NEG_INFINITY, DVec3::max);
        let sphere = ((low + high) / 2.0, (high - low).length() / 2.0);
        let area = form.areas_at(&first).sum();
        let placed = match &form {
            Form::Pieces(pieces, _) if track.is_still() => pieces.iter().map(|p| p.placed(&first)).collect(),
            _ => Vec::new(),
        };
        Ok(Self { form, placed, choice, track, reversed, magnitude, sphere, area })
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

    /// A cheap estimate of the solid angle in which `from` sees it, less what is turned away; 0 only where it cannot be seen.
    pub(super) fn size_from(&self, from: DVec3, both_sides: bool) -> f32 {
        let (center, radius) = self.sphere;
        let away = from - center;
        let squared = away.length_squared().max(radius * radius);
        // What is flat and stands still is seen at an angle.
        let cos = match self.placed.as_slice() {
            [flat] => flat.normal().map_or(1.0, |n| {
                let cos = away.dot(if self.reversed { -n } else { n }) / squared.sqrt();
                if both_sides { cos.abs() } else { cos.max(0.0) }
            }),
            _ => 1.0,
        };
        (self.area * cos / squared) as f32
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
