//! A piece of a light: what is chosen as a whole, then sampled in the best way known for it.
//!
//! Everything is in f64 and in render space: a placement is applied to corners where there are corners; other shapes are
//! sampled by area in their own space, and their density is divided by what the placement does to an element of area, `|det M|
//! |M^-T n|`.
use std::sync::Arc;

use durer_core::{
    glam::{DAffine3, DVec3},
    math::Point2,
};

use super::{
    cone::Cone,
    rectangle::SphericalRectangle,
    triangle::{self, SphericalTriangle},
};
use crate::shape::{AreaPoint, Outline, Shape};

/// A point chosen on a light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chosen {
    /// The point.
    pub(super) p: DVec3,
    /// Unit normal there, on the outside.
    pub(super) n: DVec3,
    /// Density of its direction, 1/sr.
    pub(super) density: f64,
}

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

/// Cosine up to which edges count as perpendicular: what rounding makes of a right angle.
const PERPENDICULAR: f64 = 1e-6;

impl Piece {
    /// The pieces of a shape; `None` if it is infinite.
    pub(super) fn of(shape: &Arc<dyn Shape>) -> Option<Vec<Self>> {
        Some(match shape.outline() {
            Outline::Sphere { radius } => vec![Self::Sphere { radius, shape: Arc::clone(shape) }],
            Outline::Parallelogram(corner, edges) => vec![Self::Parallelogram(corner, edges)],
            Outline::Triangles(triangles) => triangles.into_iter().map(Self::Triangle).collect(),
            Outline::Curved => vec![Self::Curved(Arc::clone(shape))],
            Outline::Infinite => return None,
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

    /// The largest coordinate of any of its points, in its own space.
    pub(super) fn extent(&self) -> f64 {
        match self {
            Self::Sphere { radius, .. } => *radius,
            Self::Parallelogram(p, [e, f]) => [*p, *p + *e, *p + *f, *p + *e + *f]
                .into_iter()
                .fold(0.0, |m, p| p.abs().max_element().max(m)),
            Self::Triangle(corners) => corners.iter().fold(0.0, |m, p| p.abs().max_element().max(m)),
            Self::Curved(shape) => {
                let corners = shape.bounds().corners();
                corners.into_iter().fold(0.0, |m, p| p.to_f64().abs().max_element().max(m))
            }
        }
    }

    /// A point of it, chosen for `from`; `u` in `[0, 1)²`.
    pub(super) fn choose(&self, m: &DAffine3, from: DVec3, u: [f64; 2]) -> Option<Chosen> {
        match self {
            Self::Sphere { radius, shape } => match cone(*radius, m, from) {
                Some(cone) => {
                    let p = cone.point(u);
                    Some(Chosen { p, n: (p - m.translation).normalize_or_zero(), density: cone.density() })
                }
                None => choose_by_area(&**shape, m, from, u),
            },
            Self::Curved(shape) => choose_by_area(&**shape, m, from, u),
            Self::Triangle(corners) => choose_triangle(corners.map(|p| m.transform_point3(p)), from, u),
            Self::Parallelogram(corner, edges) => {
                let (corner, [e, f]) = placed(*corner, edges, m);
                match rectangle(corner, [e, f], from) {
                    Some(rectangle) => {
                        let n = e.cross(f).normalize();
                        Some(Chosen { p: rectangle.point(u), n, density: rectangle.density() })
                    }
                    None => choose_half(corner, [e, f], from, u),
                }
            }
        }
    }

    /// The density with which [`Piece::choose`] gives, for `from`, the direction of `p`, a point of it with unit normal
    /// `n`. 1/sr.
    pub(super) fn density(&self, m: &DAffine3, from: DVec3, p: DVec3, n: DVec3) -> f64 {
        match self {
            Self::Sphere { radius, shape } => {
                let Some(cone) = cone(*radius, m, from) else {
                    return density_by_area(&**shape, m, from, p, n);
                };
                // The far side is hidden by the near one.
                let is_near = (p - m.translation).dot(from - p) > 0.0;
                if is_near { cone.density() } else { 0.0 }
            }
            Self::Curved(shape) => density_by_area(&**shape, m, from, p, n),
            Self::Triangle(corners) => triangle_density(corners.map(|p| m.transform_point3(p)), from, p),
            Self::Parallelogram(corner, edges) => {
                let (corner, [e, f]) = placed(*corner, edges, m);
                if let Some(rectangle) = rectangle(corner, [e, f], from) {
                    return rectangle.density();
                }
                let n = e.cross(f);
                let along = |a: DVec3| (p - corner).cross(a).dot(n).abs() / n.length_squared();
                let half = usize::from(along(f) + along(e) > 1.0);
                0.5 * triangle_density(halves(corner, [e, f])[half], from, p)
            }
        }
    }
}

/// The factor by which `m` enlarges everything; `None` if it stretches.
fn similarity(m: &DAffine3) -> Option<f64> {
    let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
    let scale2 = x.length_squared();
    let is = |value: f64, expected: f64| (value - expected).abs() <= PERPENDICULAR * scale2;
    let uniform = is(y.length_squared(), scale2) && is(z.length_squared(), scale2);
    (uniform && is(x.dot(y), 0.0) && is(y.dot(z), 0.0) && is(z.dot(x), 0.0)).then(|| scale2.sqrt())
}

fn cone(radius: f64, m: &DAffine3, from: DVec3) -> Option<Cone> {
    Cone::of(m.translation, radius * similarity(m)?, from)
}

fn placed(corner: DVec3, edges: &[DVec3; 2], m: &DAffine3) -> (DVec3, [DVec3; 2]) {
    (m.transform_point3(corner), edges.map(|e| m.transform_vector3(e)))
}

fn rectangle(corner: DVec3, edges: [DVec3; 2], from: DVec3) -> Option<SphericalRectangle> {
    let [e, f] = edges;
    let is_rectangle = e.dot(f).abs() <= PERPENDICULAR * (e.length_squared() * f.length_squared()).sqrt();
    if is_rectangle { SphericalRectangle::of(corner, edges, from) } else { None }
}

fn halves(corner: DVec3, [e, f]: [DVec3; 2]) -> [[DVec3; 3]; 2] {
    [[corner, corner + e, corner + f], [corner + e, corner + e + f, corner + f]]
}

fn choose_half(corner: DVec3, edges: [DVec3; 2], from: DVec3, u: [f64; 2]) -> Option<Chosen> {
    let half = usize::from(u[0] >= 0.5);
    let u = [(2.0 * u[0] - half as f64).clamp(0.0, 1.0), u[1]];
    let chosen = choose_triangle(halves(corner, edges)[half], from, u)?;
    Some(Chosen { density: 0.5 * chosen.density, ..chosen })
}

/// A point of a triangle in render space.
pub(super) fn choose_triangle(corners: [DVec3; 3], from: DVec3, u: [f64; 2]) -> Option<Chosen> {
    let n = triangle::normal(corners)?;
    match SphericalTriangle::of(corners, from) {
        Some(seen) => Some(Chosen { p: seen.point(u)?, n, density: seen.density() }),
        None => {
            let p = triangle::point_by_area(corners, u);
            by_angle(p, n, 1.0 / triangle::area(corners), from)
        }
    }
}

/// The density with which [`choose_triangle`] gives the direction of `p`, a point of the triangle.
pub(super) fn triangle_density(corners: [DVec3; 3], from: DVec3, p: DVec3) -> f64 {
    match (SphericalTriangle::of(corners, from), triangle::normal(corners)) {
        (Some(seen), _) => seen.density(),
        (None, Some(n)) => {
            by_angle(p, n, 1.0 / triangle::area(corners), from).map_or(0.0, |chosen| chosen.density)
        }
        (None, None) => 0.0,
    }
}

/// A point that was chosen with a density over area, in 1/m²; `None` if it is seen edge on.
fn by_angle(p: DVec3, n: DVec3, by_area: f64, from: DVec3) -> Option<Chosen> {
    let d = p - from;
    let cos_times_distance = d.dot(n).abs();
    let density = by_area * d.length_squared() * d.length() / cos_times_distance;
    density.is_finite().then_some(Chosen { p, n, density })
}

fn choose_by_area(shape: &dyn Shape, m: &DAffine3, from: DVec3, u: [f64; 2]) -> Option<Chosen> {
    let AreaPoint { p, n, density } = shape.by_area(point2(u))?;
    let n = m.matrix3.inverse().transpose() * n;
    let growth = m.matrix3.determinant().abs() * n.length();
    by_angle(m.transform_point3(p), n.normalize_or_zero(), density / growth, from)
}

fn density_by_area(shape: &dyn Shape, m: &DAffine3, from: DVec3, p: DVec3, n: DVec3) -> f64 {
    let back = m.inverse();
    let density = shape.area_density(back.transform_point3(from), back.transform_point3(p));
    let growth = m.matrix3.determinant().abs() / (m.matrix3.transpose() * n).length();
    by_angle(p, n, density / growth, from).map_or(0.0, |chosen| chosen.density)
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
