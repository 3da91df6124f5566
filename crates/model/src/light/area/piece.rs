//! A piece of a light: what is chosen as a whole. See [`Placed`] for how it is sampled.
use std::sync::Arc;

use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Point2, Point3},
};

use super::{
    placed::{Placed, similarity},
    triangle,
};
use crate::shape::{AreaPoint, Outline, Shape};

/// A piece in its own space.
#[derive(Clone, Debug)]
pub(super) enum Piece {
    /// A whole sphere around the origin.
    Sphere {
        /// Its radius.
        radius: f64,
        /// For placements that make it no sphere, and points inside.
        shape: Arc<dyn Shape>,
    },
    /// A corner and two edges; the outside is towards their cross product.
    Parallelogram(DVec3, [DVec3; 2]),
    /// The outside is where the corners are seen counter-clockwise.
    Triangle([DVec3; 3]),
    /// Anything that can be sampled by area.
    Curved(Arc<dyn Shape>),
}

impl Piece {
    /// The pieces of a shape; `None` if no point of it can be chosen.
    pub(super) fn of(shape: &Arc<dyn Shape>) -> Option<Vec<Self>> {
        Some(match shape.outline() {
            Outline::Sphere { radius } => vec![Self::Sphere { radius, shape: Arc::clone(shape) }],
            Outline::Parallelogram(corner, edges) => vec![Self::Parallelogram(corner, edges)],
            Outline::Triangles(triangles) => triangles.into_iter().map(Self::Triangle).collect(),
            Outline::Curved => vec![Self::Curved(Arc::clone(shape))],
            Outline::Near(_) | Outline::Infinite => return None,
        })
    }

    /// Area where `m` places it.
    pub(super) fn area(&self, m: &DAffine3) -> f64 {
        match self {
            Self::Sphere { shape, .. } | Self::Curved(shape) => similarity(m)
                .map_or_else(|| area_by_quadrature(&**shape, m), |s| f64::from(shape.area()) * s * s),
            Self::Parallelogram(_, [e, f]) => m.transform_vector3(*e).cross(m.transform_vector3(*f)).length(),
            Self::Triangle(corners) => triangle::area(corners.map(|p| m.transform_point3(p))),
        }
    }

    /// Corners of something around it, in its own space.
    pub(super) fn corners(&self) -> Vec<DVec3> {
        match self {
            Self::Sphere { radius, .. } => vec![DVec3::splat(-radius), DVec3::splat(*radius)],
            Self::Parallelogram(p, [e, f]) => vec![*p, *p + *e, *p + *f, *p + *e + *f],
            Self::Triangle(corners) => corners.to_vec(),
            Self::Curved(shape) => shape.bounds().corners().map(Point3::to_f64).to_vec(),
        }
    }

    /// The piece where `m` places it.
    pub(super) fn placed(&self, m: &DAffine3) -> Placed {
        match self {
            Self::Sphere { radius, shape } => Placed::sphere(*radius, shape, m),
            Self::Parallelogram(corner, edges) => Placed::parallelogram(*corner, edges, m),
            Self::Triangle(corners) => Placed::triangle(*corners, m),
            Self::Curved(shape) => Placed::curved(shape, m),
        }
    }
}

/// The mean over a grid of what an element of area becomes.
fn area_by_quadrature(shape: &dyn Shape, m: &DAffine3) -> f64 {
    const CELLS: u32 = 64;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(CELLS);
    let turned = m.matrix3.inverse().transpose();
    let det = m.matrix3.determinant().abs();
    let cell = |i: u32| {
        let of = |point: AreaPoint| det * (turned * point.n).length() / point.density;
        shape.by_area(point2([at(i % CELLS), at(i / CELLS)])).map_or(0.0, of)
    };
    (0..CELLS * CELLS).map(cell).sum::<f64>() / f64::from(CELLS * CELLS)
}

fn point2([x, y]: [f64; 2]) -> Point2 {
    Point2::new(x as f32, y as f32)
}
