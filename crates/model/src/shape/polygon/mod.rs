//! Planar polygon: concave, self-intersecting or with holes.
//!
//! The plane's normal is Newell's sum over the first loop, `n = sum (p_i - p_0) x (p_{i+1} - p_0)` (Sutherland, Sproull,
//! Schumacker 1974); `t = -(D + n.o) / (n.d)` as for a plane. Inside or outside is a question in 2D (lecture,
//! "Point in Polygon"): the vertices are sheared along the ray and the ray's dominant axis is dropped, so the ray
//! becomes the point (0, 0), see [`crossing_number`]. Projecting along the ray rather than along the normal lets any two polygons
//! that share an edge decide by the same numbers, also where they meet at an angle: a ray passes one of them exactly.
mod area;
mod inside;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Point2, Point3, Ray},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

pub use inside::{FillRule, crossing_number, winding_number};

use super::{Geometry, Outline, Shape, ShapeHit, flat, plane::Carrier};
use crate::Surface;

/// A planar polygon; the outside is where the first loop is seen counter-clockwise. `uv` is the position in the bounding
/// rectangle along the plane's axes (those of [`super::plane::Plane`]), in `[0, 1]²`.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    carrier: Carrier,
    /// Closed loops of vertices; the edge from the last to the first is implied.
    loops: Vec<Vec<DVec3>>,
    fill_rule: FillRule,
    bounds: Bounds3,
    /// Smallest plane coordinates, and extent, of the bounding rectangle.
    corner: [f64; 2],
    size: [f64; 2],
}

/// Largest distance of a vertex from the plane, as a fraction of the largest coordinate: a file that prints six digits
/// loses a little less.
const PLANARITY: f64 = 1.0 / 65_536.0;

impl Polygon {
    /// From closed loops of vertices.
    ///
    /// # Errors
    /// What is wrong with them: too few or non-finite vertices, a first loop without area, a vertex off the plane.
    pub fn new(loops: &[Vec<Point3>], fill_rule: FillRule) -> Result<Self, String> {
        let points = || loops.iter().flatten();
        if let Some(i) = points().position(|p| !p.is_finite()) {
            return Err(format!("vertex {i} is not finite"));
        }
        if let Some(i) = loops.iter().position(|l| l.len() < 3) {
            return Err(format!("loop {i} has {} vertices, expected 3 or more", loops[i].len()));
        }
        let largest = points().fold(0.0f32, |m, p| m.max((*p - Point3::ZERO).abs().max_component()));
        let carrier = newell(loops.first().map_or(&[], Vec::as_slice), largest.into())?;
        let limit = PLANARITY * f64::from(largest);
        for (i, p) in points().enumerate() {
            let off = carrier.height(p.to_f64()).abs();
            if off > limit {
                return Err(format!(
                    "vertex {i} lies {off:.3e} m off the plane of the first loop; at most {limit:.3e} m is taken for \
                     rounding"
                ));
            }
        }
        let flat: Vec<[f64; 2]> = points().map(|p| carrier.coordinates(p.to_f64())).collect();
        let extreme =
            |axis: usize, pick: fn(f64, f64) -> f64| flat.iter().map(|c| c[axis]).reduce(pick).unwrap_or(0.0);
        let corner = [extreme(0, f64::min), extreme(1, f64::min)];
        let size = [extreme(0, f64::max) - corner[0], extreme(1, f64::max) - corner[1]];
        // Hits lie on the plane, from which vertices may stray by rounding.
        let bounds = Bounds3::around(points().copied().flat_map(|p| {
            let on_plane = p.to_f64() - carrier.n * carrier.height(p.to_f64());
            [p, Point3::from_f64(on_plane)]
        }));
        let loops = loops.iter().map(|l| l.iter().map(|p| p.to_f64()).collect()).collect();
        Ok(Self { carrier, loops, fill_rule, bounds, corner, size })
    }

    fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> {
        self.loops.iter().flat_map(|l| (0..l.len()).map(move |i| [l[i], l[(i + 1) % l.len()]]))
    }

    /// Whether the line of `ray` passes through the polygon as seen along it.
    fn is_pierced(&self, ray: &Ray) -> bool {
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        let axis = ray.d.max_axis();
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let shear = [d[a] / d[axis], d[b] / d[axis]];
        let project = |p: DVec3| {
            let q = p - o;
            [q[a] - shear[0] * q[axis], q[b] - shear[1] * q[axis]]
        };
        let edges = self.edges().map(|e| e.map(project));
        self.fill_rule.contains([0.0; 2], edges)
    }
}

/// The plane of one loop; `largest` is the largest coordinate in magnitude.
fn newell(outline: &[Point3], largest: f64) -> Result<Carrier, String> {
    let points: Vec<DVec3> = outline.iter().map(|p| p.to_f64()).collect();
    let Some(first) = points.first().copied() else {
        return Err("there are no vertices".to_owned());
    };
    let twice_area: DVec3 = points.windows(2).map(|w| (w[0] - first).cross(w[1] - first)).sum();
    let extent = points.iter().map(|p| (*p - first).length()).fold(0.0, f64::max);
    // Rounding vertices to f32 alone can make this much area.
    let noise = 4.0 * f64::from(f32::EPSILON) * extent * largest;
    if twice_area.length() <= noise {
        return Err("the first loop encloses no area: its vertices lie on one line, or its windings cancel"
            .to_owned());
    }
    let mean = points.iter().map(|p| *p - first).sum::<DVec3>() / points.len() as f64;
    Ok(Carrier::new(first + mean, twice_area))
}

impl Shape for Polygon {
    fn bounds(&self) -> Bounds3 {
        self.bounds
    }
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (t, _) = self.carrier.hit(ray)?;
        self.is_pierced(ray).then_some(ShapeHit { t, u: 0.0, v: 0.0 })
    }
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let p = self.carrier.point_near(ray, hit.t);
        let at = self.carrier.coordinates(p);
        let unit = |axis: usize| ((at[axis] - self.corner[axis]) / self.size[axis]).clamp(0.0, 1.0) as f32;
        self.carrier.surface(p, Point2::new(unit(0), unit(1)), self.size)
    }
    fn area(&self) -> f32 {
        let flat = self.edges().map(|e| e.map(|p| self.carrier.coordinates(p))).collect();
        area::filled_area(flat, self.fill_rule) as f32
    }
    fn outline(&self) -> Outline {
        if let [one] = self.loops.as_slice()
            && let Ok(corners) = <[DVec3; 4]>::try_from(one.as_slice())
            && let Some((corner, edges)) = flat::parallelogram(corners)
        {
            return Outline::Parallelogram(corner, edges);
        }
        let Carrier { origin, n, u, v } = self.carrier;
        let on_plane = |[x, y]: [f64; 2]| origin + u * x + v * y;
        let flat = self.edges().map(|e| e.map(|p| self.carrier.coordinates(p))).collect();
        // The axes of the plane may make a left-handed frame with the normal.
        let turns = u.cross(v).dot(n) < 0.0;
        let seen = |[a, b, c]: [[f64; 2]; 3]| if turns { [a, c, b] } else { [a, b, c] };
        let triangles = area::triangles(flat, self.fill_rule);
        Outline::Triangles(triangles.into_iter().map(|t| seen(t).map(on_plane)).collect())
    }
}

impl Kind for Polygon {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "polygon",
        aliases: &[],
        doc: "A planar polygon of one or more closed loops: concave, self-intersecting or with holes. The outside is \
              where the first loop is seen counter-clockwise.",
        params: &[
            ParamSpec::new(
                "P",
                ParamType::Point3s,
                ParamDefault::Required,
                "Vertices of all loops, one after another.",
            )
            .unit("m"),
            ParamSpec::new(
                "counts",
                ParamType::Ints,
                ParamDefault::Unset,
                "Number of vertices of each loop; default: all vertices make one loop.",
            )
            .range(3.0, f32::INFINITY),
            ParamSpec::new(
                "fillrule",
                ParamType::Choice(&["evenodd", "nonzero"]),
                ParamDefault::Text("evenodd"),
                "Where loops overlap: evenodd (a loop within a loop is a hole) or nonzero (it is one if it turns the \
                 other way).",
            ),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        if !args.is_sound() {
            return None;
        }
        let points: Vec<Point3> = args.triples("P").into_iter().map(Point3::from).collect();
        let counts: Vec<usize> = match args.ints("counts") {
            [] => vec![points.len()],
            given => given.iter().map(|&n| n.max(0) as usize).collect(),
        };
        let total = counts.iter().fold(0usize, |sum, n| sum.saturating_add(*n));
        if total != points.len() {
            args.error(
                "counts",
                format!("\"counts\" adds up to {total}, but \"P\" has {} vertices", points.len()),
            );
            return None;
        }
        let mut rest = points.as_slice();
        let loops: Vec<Vec<Point3>> = counts
            .iter()
            .map(|n| {
                let (these, others) = rest.split_at(*n);
                rest = others;
                these.to_vec()
            })
            .collect();
        let fill_rule =
            if args.text("fillrule") == "nonzero" { FillRule::NonZero } else { FillRule::EvenOdd };
        match Self::new(&loops, fill_rule) {
            Ok(polygon) => Some(Geometry::shape(polygon)),
            Err(message) => {
                args.error("P", format!("no polygon: {message}"));
                None
            }
        }
    }
}
