//! Surfaces given by distances on a grid: below 0 inside, above 0 outside, and the surface where they are 0.
//!
//! Distances stand at the corners of cells, so that the outermost ones lie on the sides of the box; the surface is where what
//! is trilinear between them is 0. Where it leaves the box it is open. It has no texture coordinates, and no point of it can be
//! chosen: it cannot shine.
mod cells;
mod tetrahedra;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Normal3, Point2, Point3, Ray, Vector3, error::gamma},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use self::cells::{Cells, Line, corner};
use super::{ALPHA, Geometry, Outline, Shape, ShapeHit, accept};
use crate::{Surface, texture::Footprint};

/// A surface between distances.
#[derive(Clone, Debug, PartialEq)]
pub struct SdfGrid {
    cells: Cells,
    low: DVec3,
    /// Cells in a metre along each axis.
    scale: DVec3,
    bounds: Bounds3,
    /// Shading normals are those of the cells, without what smooths the steps between these.
    is_faceted: bool,
    /// What rounding does to distances at most.
    error: f64,
}

impl SdfGrid {
    /// In a box with these corners; `None` if the values are not as many as the size says or nowhere change their sign.
    pub fn new(
        size: [usize; 3],
        distances: Vec<f32>,
        [low, high]: [DVec3; 2],
        is_faceted: bool,
    ) -> Option<Self> {
        let cells = Cells::new(size, distances)?;
        let scale = cells.end() / (high - low);
        let ends = cells.filled().flat_map(|cell| [corner(cell), corner(cell) + 1.0]);
        let (least, most) =
            ends.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let [least, most] = [least, most].map(|p| low + p / scale);
        // Rounded outwards.
        let bounds = Bounds3::new(
            Point3::from(Point3::from_f64(least).to_array().map(f32::next_down)),
            Point3::from(Point3::from_f64(most).to_array().map(f32::next_up)),
        );
        let error = 64.0 * f64::EPSILON * cells.largest();
        Some(Self { cells, low, scale, bounds, is_faceted, error })
    }
    fn line(&self, ray: &Ray) -> Line {
        Line { o: (ray.o.to_f64() - self.low) * self.scale, d: ray.d.to_f64() * self.scale }
    }
}

impl Shape for SdfGrid {
    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let line = self.line(ray);
        if !(line.o.is_finite() && line.d.is_finite() && line.d != DVec3::ZERO) {
            return None;
        }
        // What rounding of the way moves, in cells.
        let moved = 8.0 * f64::EPSILON * (line.o.abs().max_element() + self.cells.end().max_element());
        let span = [f64::from(ray.t_min), f64::from(ray.t_max.next_up())];
        let t = self.cells.first_zero(line, span, |t, slope| {
            let speed = line.d.length();
            let error = (self.error / slope.abs() + moved / speed).min(1e-3 / speed);
            accept(ray, t, error)
        })?;
        Some(ShapeHit { t, u: 0.0, v: 0.0 })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let Line { o, d } = self.line(ray);
        let mut p = (o + d * f64::from(hit.t)).clamp(DVec3::ZERO, self.cells.end());
        // Rounding t to f32 slid the point along the ray: back onto the surface.
        for _ in 0..4 {
            let (value, gradient) = self.cells.look(p);
            let step = gradient * (value / gradient.length_squared());
            if step.is_finite() && step.length_squared() < 1.0 {
                p = (p - step).clamp(DVec3::ZERO, self.cells.end());
            }
        }
        let (_, gradient) = self.cells.look(p);
        let back = -ray.d.to_f64().normalize_or_zero();
        let n = (gradient * self.scale).try_normalize().unwrap_or(back);
        let smooth = if self.is_faceted { n } else { self.cells.smooth(p, self.scale).normalize_or_zero() };
        let n_s = if smooth.dot(n) > 1e-3 { smooth } else { n };
        let exact = self.low + p / self.scale;
        let (dpdu, dpdv) = n.any_orthonormal_pair();
        let p = Point3::from_f64(exact);
        Surface {
            p,
            p_error: (p - Point3::ZERO).abs() * gamma(2)
                + Vector3::from_f64((self.low.abs() + exact.abs()) * 1e-12),
            n_g: Normal3::from_f64(n),
            n_s: Normal3::from_f64(n_s),
            uv: Point2::new(0.0, 0.0),
            second_uv: Point2::new(0.0, 0.0),
            dpdu: Vector3::from_f64(dpdu),
            dpdv: Vector3::from_f64(dpdv),
            face: 0,
            vertex_color: [1.0; 4],
            footprint: Footprint::POINT,
        }
    }

    /// That of the triangles near it.
    fn area(&self) -> f32 {
        let twice = |[a, b, c]: [DVec3; 3]| ((b - a) / self.scale).cross((c - a) / self.scale).length();
        (0.5 * tetrahedra::triangles(&self.cells).into_iter().map(twice).sum::<f64>()) as f32
    }

    fn outline(&self) -> Outline {
        let placed = |p: DVec3| self.low + p / self.scale;
        Outline::Near(tetrahedra::triangles(&self.cells).into_iter().map(|t| t.map(placed)).collect())
    }
}

const fn along(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Int, ParamDefault::Required, doc).range(2.0, 65_536.0)
}

impl Kind for SdfGrid {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "sdfgrid",
        aliases: &[],
        doc: "A surface given by distances on a grid: below 0 inside, above 0 outside. It is where what is trilinear between them \
              is 0; at the sides of the box it is open. It has no texture coordinates and cannot shine.",
        params: &[
            ParamSpec::new(
                "distance",
                ParamType::Floats,
                ParamDefault::Required,
                "nx ny nz distances, of which x changes fastest. The first and the last ones lie on the sides of the box.",
            ),
            along("nx", "Distances along x."),
            along("ny", "Distances along y."),
            along("nz", "Distances along z."),
            ParamSpec::new("p0", ParamType::Point3, ParamDefault::Triple([0.0; 3]), "A corner of the box.")
                .unit("m"),
            ParamSpec::new("p1", ParamType::Point3, ParamDefault::Triple([1.0; 3]), "The opposite corner.")
                .unit("m"),
            ParamSpec::new(
                "normals",
                ParamType::Choice(&["smooth", "analytic"]),
                ParamDefault::Text("smooth"),
                "Shading normals: analytic are those of each cell, smooth ones change without steps from cell to cell.",
            ),
            ALPHA,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        let size = ["nx", "ny", "nz"].map(|name| args.int(name).unsigned_abs() as usize);
        let [a, b] = ["p0", "p1"].map(|name| DVec3::from(args.triple(name).map(f64::from)));
        let (low, high) = (a.min(b), a.max(b));
        if args.is_sound() && (high - low).min_element() <= 0.0 {
            args.error("p1", "\"p0\" and \"p1\" span no box: it is flat");
        }
        let values = args.floats("distance");
        let [nx, ny, nz] = size;
        let wanted = nx.checked_mul(ny).and_then(|n| n.checked_mul(nz));
        if args.is_sound() && wanted != Some(values.len()) {
            let message = format!("\"distance\" has {} values, expected {nx} x {ny} x {nz}", values.len());
            args.error("distance", message);
        }
        if !args.is_sound() {
            return None;
        }
        let made = Self::new(size, values.to_vec(), [low, high], args.text("normals") == "analytic");
        if made.is_none() {
            args.error(
                "distance",
                "there is no surface: nowhere is a distance below 0 beside one that is not",
            );
        }
        made.map(Geometry::shape)
    }
}
