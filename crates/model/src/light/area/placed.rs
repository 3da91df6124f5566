//! A piece of a light in its place, sampled in the best way known for it.
//!
//! Everything is in f64 and in render space: corners are placed where there are corners; other shapes are sampled by area in
//! their own space, and their density is divided by what the placement does to an element of area: with the cofactors `C
//! = det M M^-T`, it is `|C n|`.
use std::sync::Arc;

use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::Point2,
};

use super::{
    cone::Cone,
    rectangle::{Rectangle, SphericalRectangle},
    triangle::{self, SphericalTriangle},
};
use crate::shape::{AreaPoint, Shape};

/// A point chosen on a light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chosen {
    /// The point.
    pub(super) p: DVec3,
    /// Unit normal there, on the outside.
    pub(super) n: DVec3,
    /// Density of its direction, 1/sr; of points chosen by area, over that, 1/m².
    pub(super) density: f64,
}

/// A piece in its place.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    form: Form,
    /// Corners that a mirroring placed are seen the other way round; other shapes bring their normals along.
    turned: bool,
}

#[derive(Clone, Debug)]
enum Form {
    /// What is left a sphere, for points outside of it.
    Sphere {
        center: DVec3,
        radius: f64,
        inside: Curved,
    },
    Rectangle(Rectangle),
    /// The halves of a parallelogram, of the same area.
    Halves([[DVec3; 3]; 2]),
    Triangle([DVec3; 3]),
    Curved(Curved),
}

/// A shape that is sampled by area in its own space.
#[derive(Clone, Debug)]
struct Curved {
    shape: Arc<dyn Shape>,
    m: DAffine3,
    cofactors: DMat3,
    /// -1 if the placement mirrors, else 1.
    sign: f64,
}

/// How far from a shape it is looked at along its normal, by its size.
const ASIDE: f64 = 1e-3;

/// How far what keeps its proportions may be off.
const PROPORTIONAL: f64 = 1e-6;

impl Placed {
    /// A sphere around the origin.
    pub(super) fn sphere(radius: f64, shape: &Arc<dyn Shape>, m: &DAffine3) -> Self {
        let curved = Curved::new(shape, m);
        let form = match similarity(m) {
            Some(scale) => Form::Sphere { center: m.translation, radius: radius * scale, inside: curved },
            None => Form::Curved(curved),
        };
        Self { form, turned: false }
    }
    /// A corner and two edges.
    pub(super) fn parallelogram(corner: DVec3, edges: &[DVec3; 2], m: &DAffine3) -> Self {
        let (corner, edges) = (m.transform_point3(corner), edges.map(|e| m.transform_vector3(e)));
        let rectangle = Rectangle::new(corner, edges);
        let halves = || Form::Halves(halves(corner, edges));
        Self { form: rectangle.map_or_else(halves, Form::Rectangle), turned: mirrors(m) }
    }
    /// Three corners.
    pub(super) fn triangle(corners: [DVec3; 3], m: &DAffine3) -> Self {
        Self { form: Form::Triangle(corners.map(|p| m.transform_point3(p))), turned: mirrors(m) }
    }
    /// Anything that can be sampled by area.
    pub(super) fn curved(shape: &Arc<dyn Shape>, m: &DAffine3) -> Self {
        Self { form: Form::Curved(Curved::new(shape, m)), turned: false }
    }

    /// A point of it, chosen for `from`; `u` in `[0, 1)²`.
    pub(super) fn choose(&self, from: DVec3, u: [f64; 2]) -> Option<Chosen> {
        let chosen = match &self.form {
            Form::Sphere { center, radius, inside } => match Cone::of(*center, *radius, from) {
                Some(cone) => {
                    let p = cone.point(u);
                    Some(Chosen { p, n: (p - *center).normalize_or_zero(), density: cone.density() })
                }
                None => inside.choose(from, u),
            },
            Form::Curved(curved) => curved.choose(from, u),
            Form::Triangle(corners) => choose_triangle(*corners, from, u),
            Form::Halves(halves) => choose_half(halves, from, u),
            Form::Rectangle(rectangle) => match SphericalRectangle::of(rectangle, from) {
                Some(seen) => {
                    Some(Chosen { p: seen.point(u), n: rectangle.normal(), density: seen.density() })
                }
                None => choose_half(&halves(rectangle.corner, rectangle.edges), from, u),
            },
        }?;
        Some(if self.turned { Chosen { n: -chosen.n, ..chosen } } else { chosen })
    }

    /// A point of it with its normal, and the density of that over its area, 1/m²; `u` in `[0, 1)²`.
    pub(super) fn by_area(&self, u: [f64; 2]) -> Option<Chosen> {
        let chosen = match &self.form {
            Form::Sphere { inside: curved, .. } | Form::Curved(curved) => curved.by_area(u)?,
            Form::Triangle(corners) => triangle_by_area(*corners, u)?,
            Form::Halves([[corner, a, b], _]) => {
                parallelogram_by_area(*corner, [*a - *corner, *b - *corner], u)?
            }
            Form::Rectangle(rectangle) => parallelogram_by_area(rectangle.corner, rectangle.edges, u)?,
        };
        Some(if self.turned { Chosen { n: -chosen.n, ..chosen } } else { chosen })
    }

    /// The density of [`Placed::by_area`] at `p`, a point of it with unit normal `n`.
    pub(super) fn area_density(&self, p: DVec3, n: DVec3) -> f64 {
        match &self.form {
            Form::Sphere { inside: curved, .. } | Form::Curved(curved) => curved.area_density(p, n),
            Form::Triangle(corners) => 1.0 / triangle::area(*corners),
            Form::Halves([half, _]) => 0.5 / triangle::area(*half),
            Form::Rectangle(rectangle) => 1.0 / rectangle.edges[0].cross(rectangle.edges[1]).length(),
        }
    }

    /// The density with which [`Placed::choose`] gives, for `from`, the direction of `p`, a point of it with unit normal
    /// `n`. 1/sr.
    pub(super) fn density(&self, from: DVec3, p: DVec3, n: DVec3) -> f64 {
        match &self.form {
            Form::Sphere { center, radius, inside } => {
                let Some(cone) = Cone::of(*center, *radius, from) else { return inside.density(from, p, n) };
                // The far side is hidden by the near one.
                let is_near = (p - *center).dot(from - p) > 0.0;
                if is_near { cone.density() } else { 0.0 }
            }
            Form::Curved(curved) => curved.density(from, p, n),
            Form::Triangle(corners) => triangle_density(*corners, from, p),
            Form::Halves(halves) => density_of_half(halves, from, p),
            Form::Rectangle(rectangle) => match SphericalRectangle::of(rectangle, from) {
                Some(seen) => seen.density(),
                None => density_of_half(&halves(rectangle.corner, rectangle.edges), from, p),
            },
        }
    }

    /// Whether a point of the plane of a triangle lies in it; true for all else.
    pub(super) fn holds(&self, p: DVec3) -> bool {
        let Form::Triangle(corners) = &self.form else { return true };
        in_triangle(corners, p)
    }
}

impl Curved {
    fn new(shape: &Arc<dyn Shape>, m: &DAffine3) -> Self {
        let [a, b, c] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
        let cofactors = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let sign = if mirrors(m) { -1.0 } else { 1.0 };
        Self { shape: Arc::clone(shape), m: *m, cofactors, sign }
    }

    fn choose(&self, from: DVec3, u: [f64; 2]) -> Option<Chosen> {
        let Chosen { p, n, density } = self.by_area(u)?;
        by_angle(p, n, density, from)
    }

    /// A point with its density over the area, 1/m².
    fn by_area(&self, u: [f64; 2]) -> Option<Chosen> {
        let AreaPoint { p, n, density } = self.shape.by_area(Point2::new(u[0] as f32, u[1] as f32))?;
        let n = self.cofactors * n;
        let growth = n.length();
        let outside = if growth > 0.0 { n * (self.sign / growth) } else { DVec3::ZERO };
        Some(Chosen { p: self.m.transform_point3(p), n: outside, density: density / growth })
    }

    /// That density at `p`, where the unit normal is `n`: as one sees it who looks along the normal.
    fn area_density(&self, p: DVec3, n: DVec3) -> f64 {
        let back = self.m.inverse();
        let aside = f64::from(self.shape.bounds().diagonal().length()) * ASIDE;
        let own = back.transform_point3(p);
        let from = own + (self.m.matrix3.transpose() * n).normalize_or_zero() * aside;
        let growth = self.m.matrix3.determinant().abs() / (self.m.matrix3.transpose() * n).length();
        self.shape.area_density(from, own) / growth
    }

    fn density(&self, from: DVec3, p: DVec3, n: DVec3) -> f64 {
        let back = self.m.inverse();
        let density = self.shape.area_density(back.transform_point3(from), back.transform_point3(p));
        let growth = self.m.matrix3.determinant().abs() / (self.m.matrix3.transpose() * n).length();
        by_angle(p, n, density / growth, from).map_or(0.0, |chosen| chosen.density)
    }
}

/// The factor by which `m` enlarges everything; `None` if it stretches.
pub(super) fn similarity(m: &DAffine3) -> Option<f64> {
    let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
    let scale2 = x.length_squared();
    let is = |value: f64, expected: f64| (value - expected).abs() <= PROPORTIONAL * scale2;
    let uniform = is(y.length_squared(), scale2) && is(z.length_squared(), scale2);
    (uniform && is(x.dot(y), 0.0) && is(y.dot(z), 0.0) && is(z.dot(x), 0.0)).then(|| scale2.sqrt())
}

/// Whether left and right change places.
pub(super) fn mirrors(m: &DAffine3) -> bool {
    m.matrix3.determinant() < 0.0
}

/// Two triangles that make up a parallelogram, seen from the same side.
pub(super) fn halves(corner: DVec3, [e, f]: [DVec3; 2]) -> [[DVec3; 3]; 2] {
    [[corner, corner + e, corner + f], [corner + e, corner + e + f, corner + f]]
}

fn choose_half(halves: &[[DVec3; 3]; 2], from: DVec3, u: [f64; 2]) -> Option<Chosen> {
    let half = usize::from(u[0] >= 0.5);
    let u = [(2.0 * u[0] - half as f64).clamp(0.0, 1.0), u[1]];
    let chosen = choose_triangle(halves[half], from, u)?;
    Some(Chosen { density: 0.5 * chosen.density, ..chosen })
}

fn density_of_half(halves: &[[DVec3; 3]; 2], from: DVec3, p: DVec3) -> f64 {
    let half = usize::from(!in_triangle(&halves[0], p));
    0.5 * triangle_density(halves[half], from, p)
}

fn in_triangle(&[a, b, c]: &[DVec3; 3], p: DVec3) -> bool {
    let n = (b - a).cross(c - a);
    let inside = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(n) >= 0.0;
    inside(a, b) && inside(b, c) && inside(c, a)
}

/// A point of a triangle, by area.
pub(super) fn triangle_by_area(corners: [DVec3; 3], u: [f64; 2]) -> Option<Chosen> {
    let n = triangle::normal(corners)?;
    Some(Chosen { p: triangle::point_by_area(corners, u), n, density: 1.0 / triangle::area(corners) })
}

fn parallelogram_by_area(corner: DVec3, [e, f]: [DVec3; 2], u: [f64; 2]) -> Option<Chosen> {
    let across = e.cross(f);
    let density = 1.0 / across.length();
    density.is_finite().then(|| Chosen { p: corner + e * u[0] + f * u[1], n: across * density, density })
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
