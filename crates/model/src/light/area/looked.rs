//! Where textures are looked up at a point that was chosen on a light.
use durer_core::{
    glam::DVec3,
    math::{Normal3, Point2, Point3, Ray, Vector3},
};
use durer_scene::Mesh;

use super::{
    form::{Form, mesh_corners},
    piece::Piece,
    triangle,
};
use crate::{
    shape::{Shape, mesh_surface},
    texture::{Footprint, TextureAt},
};

/// Points by which a light is measured.
pub(super) const POINTS: u32 = 16_384;
/// Where a ray starts that meets a shape at a given point, as a share of the shape's size.
const STEP: f64 = 1e-3;

/// The `i`-th of points that are spread evenly over the unit square (Roberts 2018, the R2 sequence).
pub(super) fn place(i: u32) -> [f64; 2] {
    let g = 1.324_717_957_244_746;
    [1.0 / g, 1.0 / (g * g)].map(|step| (0.5 + f64::from(i) * step).fract())
}

/// A point of a piece or triangle of the light's own space, and its normal: `u` in `[0, 1)²` spreads evenly over its area.
pub(super) fn point(form: &Form, index: usize, u: [f64; 2]) -> (DVec3, DVec3) {
    let on = |corners: [DVec3; 3]| {
        (triangle::point_by_area(corners, u), triangle::normal(corners).unwrap_or(DVec3::Z))
    };
    match form {
        Form::Mesh(mesh) => on(mesh_corners(mesh, index, f32::NEG_INFINITY)),
        Form::Pieces(pieces, _) => match &pieces[index] {
            Piece::Triangle(corners) => on(*corners),
            Piece::Parallelogram(corner, [e, f]) => {
                (*corner + *e * u[0] + *f * u[1], e.cross(*f).normalize_or_zero())
            }
            Piece::Sphere { shape, .. } | Piece::Curved(shape) => {
                let point = shape.by_area(Point2::new(u[0] as f32, u[1] as f32));
                point.map_or((DVec3::ZERO, DVec3::Z), |point| (point.p, point.n))
            }
        },
    }
}

/// That of point `p` of triangle `index`, or of the triangle of those that make a rectangle which holds it.
pub(super) fn on_mesh(mesh: &Mesh, index: usize, p: DVec3, time: f32) -> TextureAt {
    let weights = |triangle: usize| {
        let [a, b, c] = mesh_corners(mesh, triangle, time);
        let n = (b - a).cross(c - a);
        let part = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(n) / n.length_squared();
        [part(b, c), part(c, a), part(a, b)]
    };
    let least = |triangle: &usize| weights(*triangle).into_iter().fold(f64::INFINITY, f64::min);
    let holds = |triangle: usize| {
        if mesh.indices.len() == 2 {
            [0, 1].into_iter().max_by(|a, b| least(a).total_cmp(&least(b))).unwrap_or(triangle)
        } else {
            triangle
        }
    };
    let triangle = holds(index);
    let [_, u, v] = weights(triangle).map(|w| w.clamp(0.0, 1.0) as f32);
    mesh_surface(mesh, triangle as u32, [u, v], time).texture_at()
}

/// That of point `p` of a shape, with unit normal `n`: where a ray from a little way out meets it.
pub(super) fn on_shape(shape: &dyn Shape, (p, n): (DVec3, DVec3)) -> TextureAt {
    let step = n * (STEP * f64::from(shape.bounds().diagonal().length()));
    let from = |side: f64| Ray::new(Point3::from_f64(p + step * side), Vector3::from_f64(step * -side));
    let met = [1.0, -1.0].map(from).into_iter().find_map(|ray| {
        let hit = shape.intersect(&Ray { t_max: 2.0, ..ray })?;
        Some(shape.surface(&ray, &hit).texture_at())
    });
    met.unwrap_or_else(|| somewhere(p, n))
}

/// A point of which no more is known.
pub(super) fn somewhere(p: DVec3, n: DVec3) -> TextureAt {
    TextureAt {
        uv: Point2::new(0.5, 0.5),
        second_uv: Point2::new(0.5, 0.5),
        face: 0,
        p: Point3::from_f64(p),
        n: Normal3::from_f64(n),
        vertex_color: [1.0; 4],
        footprint: Footprint::POINT,
    }
}
