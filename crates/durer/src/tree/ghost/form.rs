//! Forms as triangles: what a mesh has, what the outline of a shape says, a grid of points chosen by area.
use crate::{
    Form, Piece,
    glam::{DAffine3, DVec3},
    math::{Bounds3, Point2, Point3, Ray, Vector3},
    model::shape::{Outline, Shape},
    scene::Mesh,
};

use super::{GhostSphere, Ghostly, Soup};
use crate::tree::number::{Number, place};

/// Squares along each edge of the grid of a curved shape.
const GRID: u32 = 16;
/// The part of an endless plane that is drawn, by the size of what is finite.
const PLANE: f64 = 3.0;

/// The mesh of a piece, if it is one.
pub(super) fn mesh<'a>(piece: &Piece<'a>) -> Option<&'a Mesh> {
    match piece.form {
        Form::Mesh(mesh) => Some(mesh),
        Form::Shape(_) => None,
    }
}

/// A mesh at a moment.
pub(super) fn soup(mesh: &Mesh, time: f32) -> Soup {
    if mesh.is_still() {
        let positions = mesh.positions.iter().map(|p| p.to_f64()).collect();
        return Soup { positions, indices: mesh.indices.clone() };
    }
    let mut soup = Soup::default();
    for triangle in &mesh.indices {
        let first = soup.positions.len() as u32;
        let corners = mesh.corners(triangle.map(|i| i as usize), time);
        soup.positions.extend(corners.map(|p| p.to_f64()));
        soup.indices.push([first, first + 1, first + 2]);
    }
    soup
}

/// A whole sphere that is still round where it is placed by `m`.
pub(super) fn sphere(piece: &Piece<'_>, m: &DAffine3) -> Option<GhostSphere> {
    let Form::Shape(shape) = piece.form else { return None };
    let Outline::Sphere { radius } = shape.outline() else { return None };
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| m.transform_vector3(axis));
    let scale = x.length();
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-5 * scale;
    let round = same(y.length(), scale) && same(z.length(), scale);
    let square = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|d| d.abs() <= 1e-5 * scale * scale);
    let center = m.translation.to_array();
    (round && square).then(|| GhostSphere { center: place(center), radius: Number((radius * scale) as f32) })
}

/// Triangles of a shape in its own space, and whether it goes on without end.
pub(super) fn tessellated(piece: &Piece<'_>, bounds: &Bounds3) -> Option<(Soup, bool)> {
    let Form::Shape(shape) = piece.form else { return None };
    match shape.outline() {
        Outline::Parallelogram(corner, [a, b]) => {
            let positions = vec![corner, corner + a, corner + a + b, corner + b];
            Some((Soup { positions, indices: vec![[0, 1, 2], [0, 2, 3]] }, false))
        }
        Outline::Triangles(triangles) | Outline::Near(triangles) => {
            let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            Some((Soup { positions: triangles.into_iter().flatten().collect(), indices }, false))
        }
        Outline::Sphere { .. } | Outline::Curved => Some((grid(shape)?, false)),
        Outline::Infinite => Some((plane(piece, shape, bounds)?, true)),
    }
}

/// Points by area are continuous in their two numbers: neighbours among these are neighbours on the shape.
fn grid(shape: &dyn Shape) -> Option<Soup> {
    let mut soup = Soup::default();
    for j in 0..=GRID {
        for i in 0..=GRID {
            let u = [i, j].map(|i| (i as f32 / GRID as f32).min(1.0f32.next_down()));
            soup.positions.push(shape.by_area(Point2::new(u[0], u[1]))?.p);
        }
    }
    for j in 0..GRID {
        for i in 0..GRID {
            let corner = j * (GRID + 1) + i;
            let (below, right) = (corner + GRID + 1, corner + 1);
            soup.indices.extend([[corner, right, below + 1], [corner, below + 1, below]]);
        }
    }
    Some(soup)
}

/// A square of an endless plane, below what is finite. The plane itself is found by a ray along an axis.
fn plane(piece: &Piece<'_>, shape: &dyn Shape, bounds: &Bounds3) -> Option<Soup> {
    let object_from_render = piece.render_from_object.inverse();
    let finite = !bounds.is_empty();
    let middle = object_from_render.point(if finite { bounds.center() } else { Point3::ZERO });
    let axes = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)];
    let rays = axes.into_iter().flat_map(|d| [Ray::new(middle, d), Ray::new(middle, -d)]);
    let met = rays.filter_map(|ray| Some((ray, shape.intersect(&ray)?)));
    let (ray, hit) = met.min_by(|a, b| a.1.t.total_cmp(&b.1.t))?;
    let surface = shape.surface(&ray, &hit);
    let n = DVec3::new(surface.n_g.x.into(), surface.n_g.y.into(), surface.n_g.z.into());
    let foot = middle.to_f64() - n * n.dot(middle.to_f64() - surface.p.to_f64());
    let off = (foot - middle.to_f64()).length();
    // Of nothing finite the page finds the size by its rays; here the corners must only be apart, however far it is.
    let span = if finite { f64::from(bounds.diagonal().length()).max(off * 1e-3) } else { off.max(10.0) };
    let (u, v) = n.any_orthonormal_pair();
    let (u, v) = (u * span * PLANE / 2.0, v * span * PLANE / 2.0);
    let positions = vec![foot - u - v, foot + u - v, foot + u + v, foot - u + v];
    Some(Soup { positions, indices: vec![[0, 1, 2], [0, 2, 3]] })
}

/// Everything finite, in render space.
pub(super) fn bounds(pieces: &[Piece<'_>], time: f32) -> Bounds3 {
    let mut all = Bounds3::EMPTY;
    for piece in pieces {
        let own = match piece.form {
            Form::Shape(shape) => shape.bounds(),
            Form::Mesh(mesh) if mesh.is_still() => Bounds3::around(mesh.positions.iter().copied()),
            Form::Mesh(mesh) => {
                Bounds3::around(soup(mesh, time).positions.iter().map(|p| Point3::from_f64(*p)))
            }
        };
        if own.is_finite() && !own.is_empty() {
            let corners = own.corners().map(|c| piece.render_from_object.point(c));
            all = all.union(Bounds3::around(corners));
        }
    }
    all
}

/// How large a thing looks: the diagonal of its box.
pub(super) fn size(form: &Ghostly, copies: &[DAffine3]) -> f64 {
    match form {
        Ghostly::Sphere(sphere) => 2.0 * f64::from(sphere.radius.0),
        Ghostly::Soup(soup) => {
            let m = copies.first().copied().unwrap_or_default();
            let points = soup.positions.iter().map(|p| m.transform_point3(*p));
            let (low, high) =
                points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
            (high - low).length()
        }
    }
}
