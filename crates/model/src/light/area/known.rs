//! What is known of the pieces of a light, by which one is chosen.
use std::f32::consts::FRAC_PI_2;

use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Bounds3, Point2, Point3, Vector3, float::cos},
};

use super::{
    super::{Cone, LightBounds, Track},
    Sides,
    form::{Form, mesh_corners, mesh_turns},
    piece::Piece,
    placed::mirrors,
    triangle,
};
use crate::shape::Shape;

/// Where a light is.
pub(super) struct Place<'a> {
    pub(super) track: &'a Track,
    /// The outside is inside.
    pub(super) reversed: bool,
    pub(super) sides: Sides,
}

impl Place<'_> {
    /// The cone of outward normal `n` at the first moment; all directions if it does not keep it.
    fn normals(&self, n: Option<DVec3>) -> Cone {
        let first = self.track.at(f32::NEG_INFINITY);
        let keeps = self.track.stations().all(|m| m.matrix3 == first.matrix3);
        n.filter(|_| keeps).map_or(Cone::ALL, |n| {
            Cone::direction(Vector3::from_f64(if self.reversed { -n } else { n }).normalize())
        })
    }
    /// A box around points of the light's own space, at all times.
    fn bounds(&self, points: impl Iterator<Item = DVec3> + Clone) -> Bounds3 {
        let moved = |m: &DAffine3, p: DVec3| Point3::from_f64(m.transform_point3(p));
        let stations = self.track.stations();
        Bounds3::around(stations.flat_map(|m| points.clone().map(move |p| moved(m, p))))
    }
    fn known(&self, bounds: Bounds3, normals: Cone, intensity: f64) -> LightBounds {
        let both_sides = self.sides == Sides::Both;
        LightBounds { bounds, normals, end: FRAC_PI_2, both_sides, intensity: intensity as f32 }
    }
}

/// What is known of each piece or triangle, for a radiance of 1; `areas` are theirs.
pub(super) fn pieces(form: &Form, areas: &[f64], place: &Place<'_>) -> Vec<LightBounds> {
    let first = place.track.at(f32::NEG_INFINITY);
    let turned = |n: DVec3| if mirrors(&first) { -n } else { n };
    match form {
        Form::Mesh(mesh) => {
            let triangle = |(i, area): (usize, &f64)| {
                let times = std::iter::once(f32::NEG_INFINITY).chain(mesh.later.iter().map(|key| key.time));
                let bounds = place.bounds(times.flat_map(|time| mesh_corners(mesh, i, time)));
                let own = mesh_corners(mesh, i, f32::NEG_INFINITY);
                let n = triangle::normal(own.map(|p| first.transform_point3(p)));
                let n = n.map(|n| if mesh_turns(mesh, i, own) { -n } else { n }).map(turned);
                place.known(bounds, place.normals(n.filter(|_| mesh.is_still())), *area)
            };
            areas.iter().enumerate().map(triangle).collect()
        }
        Form::Pieces(pieces, _) => {
            let one = |(piece, area): (&Piece, &f64)| {
                let bounds = place.bounds(piece.corners().into_iter());
                match piece {
                    Piece::Parallelogram(corner, [e, f]) => {
                        let corners =
                            [*corner, *corner + *e, *corner + *f].map(|p| first.transform_point3(p));
                        place.known(bounds, place.normals(triangle::normal(corners).map(turned)), *area)
                    }
                    Piece::Triangle(corners) => {
                        let n = triangle::normal(corners.map(|p| first.transform_point3(p)));
                        place.known(bounds, place.normals(n.map(turned)), *area)
                    }
                    // What a convex body shows of its surface is a quarter of it on average (Cauchy).
                    Piece::Sphere { .. } => place.known(bounds, Cone::ALL, 0.25 * area),
                    Piece::Curved(shape) => match flat_normal(&**shape) {
                        Some(n) => {
                            let n = (first.matrix3.inverse().transpose() * n).normalize_or_zero();
                            // It may be folded, so that both of its sides are on either.
                            LightBounds {
                                both_sides: true,
                                ..place.known(bounds, place.normals(Some(n)), *area)
                            }
                        }
                        None => place.known(bounds, Cone::ALL, 0.5 * area),
                    },
                }
            };
            pieces.iter().zip(areas).map(one).collect()
        }
    }
}

/// The normal of a shape that lies in a plane of coordinates.
fn flat_normal(shape: &dyn Shape) -> Option<DVec3> {
    let size = shape.bounds().diagonal();
    let is_flat = size.x == 0.0 || size.y == 0.0 || size.z == 0.0;
    shape.by_area(Point2::new(0.5, 0.5)).filter(|_| is_flat).map(|point| point.n)
}

/// What is known of all pieces together: their intensity is that of what shows of them at once.
pub(super) fn whole(pieces: &[LightBounds]) -> LightBounds {
    let Some((first, others)) = pieces.split_first() else { return LightBounds::NOTHING };
    let all = others.iter().fold(*first, |all, piece| all.union(*piece));
    let shows = if others.is_empty() { 1.0 } else { (0.5 + 0.5 * cos(all.normals.angle)).max(0.25) };
    LightBounds { intensity: all.intensity * shows, ..all }
}
