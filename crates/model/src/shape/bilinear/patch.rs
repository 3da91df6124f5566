//! One bilinear patch.
//!
//! For a fixed `u` the patch is a straight line from `a = (1-u) p00 + u p10` along `w = (1-u)(p01-p00) + u (p11-p10)`. The ray
//! `o + t d` meets it where the four are in one plane, `d . (w x (a - o)) = 0`, a quadratic equation in `u` (Reshetov 2019,
//! "Cool Patches", Ray Tracing Gems chapter 8; Physically Based Rendering, 4th edition, section 6.6). With
//! `n = d x w`, `t = ((a - o) x w) . n / n.n` and `v = ((a - o) x d) . n / n.n`.
//!
//! All in f64 from f32 numbers. What that computes is exact for corners and a ray that are off by some roundings of their
//! coordinates; this height over the patch, divided by the sine under which the ray meets it, bounds the error of `t`, and
//! of the point along the patch: a ray that passes the edge by less counts as a hit, so nothing leaks between neighbours.
use durer_core::{
    glam::DVec3,
    math::{Bounds3, Frame, Normal3, Point2, Point3, Ray, Vector3, error::gamma},
};

use super::super::{AreaPoint, Outline, Shape, ShapeHit, accept, flat};
use crate::{Surface, texture::Footprint};

/// A patch over `(u, v)` in the unit square. The outside is towards `dP/du x dP/dv`.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// At (0, 0), (1, 0), (0, 1) and (1, 1).
    p: [DVec3; 4],
    normals: Option<[Normal3; 4]>,
    uvs: Option<[Point2; 4]>,
    /// Its number.
    face: u32,
}

/// Where a line meets the patch, in f64.
struct Meeting {
    t: f64,
    u: f64,
    v: f64,
    /// Bound on what is wrong with `t`.
    error: f64,
}

impl Patch {
    /// From the corners at (0, 0), (1, 0), (0, 1) and (1, 1), all finite.
    pub fn new(corners: [Point3; 4]) -> Self {
        Self { p: corners.map(Point3::to_f64), normals: None, uvs: None, face: 0 }
    }
    /// The same, as the face of this number.
    #[must_use]
    pub fn numbered(self, face: u32) -> Self {
        Self { face, ..self }
    }
    /// The same with shading normals, which also say where the outside is.
    #[must_use]
    pub fn with_normals(self, normals: [Normal3; 4]) -> Self {
        Self { normals: Some(normals), ..self }
    }
    /// The same with texture coordinates, which are interpolated too.
    #[must_use]
    pub fn with_uvs(self, uvs: [Point2; 4]) -> Self {
        Self { uvs: Some(uvs), ..self }
    }

    fn at(&self, u: f64, v: f64) -> DVec3 {
        let [p00, p10, p01, p11] = self.p;
        (p00 * (1.0 - u) + p10 * u) * (1.0 - v) + (p01 * (1.0 - u) + p11 * u) * v
    }
    /// The derivatives by `u` and `v`.
    fn partials(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let [p00, p10, p01, p11] = self.p;
        ((p10 - p00) * (1.0 - v) + (p11 - p01) * v, (p01 - p00) * (1.0 - u) + (p11 - p10) * u)
    }

    /// Both places where the line of `ray` meets the patch, as far as there are any.
    fn meetings(&self, ray: &Ray) -> [Option<Meeting>; 2] {
        let [p00, p10, p01, p11] = self.p;
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        let (q0, q1) = (p00 - o, p10 - o);
        let (w0, w1) = (p01 - p00, p11 - p10);
        // f(u) = d . ((w0 + u (w1 - w0)) x (q0 + u (q1 - q0))) = a u^2 + b u + c.
        let a = d.dot((w1 - w0).cross(p10 - p00));
        let c = d.dot(w0.cross(q0));
        let b = d.dot(w1.cross(q1)) - (a + c);
        let discriminant = b * b - 4.0 * a * c;
        // NaN for rays that are not finite.
        if discriminant.is_nan() || discriminant < 0.0 {
            return [None, None];
        }
        // The stable pair of roots; a flat patch (a = 0) has the second only.
        let half = -0.5 * (b + discriminant.sqrt().copysign(b));
        [half / a, c / half].map(|u| self.meeting(u, o, d))
    }

    /// Where the line `o + t d`, which meets the line of the patch at `u`, does so; `None` beyond the edges.
    fn meeting(&self, u: f64, o: DVec3, d: DVec3) -> Option<Meeting> {
        if !u.is_finite() {
            return None;
        }
        let [p00, p10, p01, p11] = self.p;
        let start = p00 * (1.0 - u) + p10 * u;
        let w = (p01 - p00) * (1.0 - u) + (p11 - p10) * u;
        let n = d.cross(w);
        let inverse = 1.0 / n.length_squared();
        let t = (start - o).cross(w).dot(n) * inverse;
        let v = (start - o).cross(d).dot(n) * inverse;
        let sum = |v: DVec3| v.abs().element_sum();
        let (inside_u, inside_v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let (dpdu, dpdv) = self.partials(inside_u, inside_v);
        // By how much the computed patch and line miss the given ones.
        let height =
            32.0 * f64::EPSILON * (self.p.iter().map(|p| sum(*p)).fold(sum(o), f64::max) + t.abs() * sum(d));
        let normal = self.normal(inside_u, inside_v);
        let slope = normal.dot(d).abs();
        let error = height / slope;
        if !(slope > 16.0 * f64::EPSILON * sum(d) && t.is_finite() && error.is_finite()) {
            return None;
        }
        let slack = height + error * d.length();
        let near = |x: f64, inside: f64, per_unit: DVec3| {
            // Exactly inside, also where the derivative vanishes.
            x == inside || (x - inside).abs() * per_unit.length() <= slack && (x - inside).abs() < 0.5
        };
        (near(u, inside_u, dpdu) && near(v, inside_v, dpdv)).then_some(Meeting {
            t,
            u: inside_u,
            v: inside_v,
            error,
        })
    }

    /// The unit normal at `(u, v)`; where an edge has no length, that a little further inside; zero if all is a line.
    fn normal(&self, u: f64, v: f64) -> DVec3 {
        let of = |u: f64, v: f64| {
            let (dpdu, dpdv) = self.partials(u, v);
            // Normalised first, so that tiny patches do not underflow.
            dpdu.normalize_or_zero().cross(dpdv.normalize_or_zero()).normalize_or_zero()
        };
        let inwards = |x: f64| x + (0.5 - x) / 1024.0;
        let normal = of(u, v);
        if normal == DVec3::ZERO { of(inwards(u), inwards(v)) } else { normal }
    }

    /// Derivatives by the texture coordinates, if these span an area: those by `(u, v)` times the inverse of the matrix
    /// of the derivatives of one by the other.
    fn textured(
        &self,
        uvs: &[Point2; 4],
        [u, v]: [f64; 2],
        (dpdu, dpdv): (DVec3, DVec3),
    ) -> Option<(DVec3, DVec3)> {
        let [c00, c10, c01, c11] = uvs.map(|c| (f64::from(c.x), f64::from(c.y)));
        let by_u = |x: fn(&(f64, f64)) -> f64| (x(&c10) - x(&c00)) * (1.0 - v) + (x(&c11) - x(&c01)) * v;
        let by_v = |x: fn(&(f64, f64)) -> f64| (x(&c01) - x(&c00)) * (1.0 - u) + (x(&c11) - x(&c10)) * u;
        let (su, sv, tu, tv) = (by_u(|c| c.0), by_v(|c| c.0), by_u(|c| c.1), by_v(|c| c.1));
        let inverse = 1.0 / (su * tv - sv * tu);
        let (dpds, dpdt) = ((dpdu * tv - dpdv * tu) * inverse, (dpdv * su - dpdu * sv) * inverse);
        let spans = dpds.cross(dpdt).length_squared() > 0.0;
        (spans && dpds.is_finite() && dpdt.is_finite()).then_some((dpds, dpdt))
    }
}

impl Patch {
    /// Whether shading normals, weighted for a point, say that the outside is away from `n`.
    fn turns(&self, n: DVec3, weights: [f64; 4]) -> bool {
        let mean = |normals: &[Normal3; 4]| (0..4).map(|i| normals[i].to_f64() * weights[i]).sum::<DVec3>();
        self.normals.as_ref().is_some_and(|normals| mean(normals).dot(n) < 0.0)
    }
}

impl Shape for Patch {
    fn bounds(&self) -> Bounds3 {
        Bounds3::around(self.p.iter().map(|p| Point3::from_f64(*p)))
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let hits = self.meetings(ray).into_iter().flatten().filter_map(|m| {
            let t = accept(ray, m.t, m.error)?;
            Some(ShapeHit { t, u: m.u as f32, v: m.v as f32 })
        });
        hits.min_by(|a, b| a.t.total_cmp(&b.t))
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        // Solved again: rounding u and v to f32 would slide the point.
        let off = |m: &Meeting| (m.t - f64::from(hit.t)).abs();
        let solved = self.meetings(ray).into_iter().flatten().min_by(|a, b| off(a).total_cmp(&off(b)));
        let (u, v) = solved.map_or((hit.u.into(), hit.v.into()), |m| (m.u, m.v));
        let exact = self.at(u, v);
        let p = Point3::from_f64(exact);
        let largest = self.p.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
        let mix = |values: [DVec3; 4]| (0..4).map(|i| values[i] * weights[i]).sum::<DVec3>();
        let normal = match self.normal(u, v) {
            DVec3::ZERO => DVec3::Z,
            n => n,
        };
        let shading = self.normals.map(|n| mix(n.map(|n| n.to_f64())).normalize_or_zero());
        let shading = shading.filter(|n| *n != DVec3::ZERO && n.is_finite());
        let normal = if shading.is_some_and(|s| s.dot(normal) < 0.0) { -normal } else { normal };
        let n_g = Normal3::from_f64(normal);
        let uv = self
            .uvs
            .map_or(DVec3::new(u, v, 0.0), |c| mix(c.map(|c| DVec3::new(c.x.into(), c.y.into(), 0.0))));
        let uv = Point2::new(uv.x as f32, uv.y as f32);
        let partials = self.partials(u, v);
        let (dpdu, dpdv) = self.uvs.and_then(|c| self.textured(&c, [u, v], partials)).unwrap_or(partials);
        let (dpdu, dpdv) = (Vector3::from_f64(dpdu), Vector3::from_f64(dpdv));
        let (dpdu, dpdv) = if dpdu.cross(dpdv).length_squared() > 0.0 {
            (dpdu, dpdv)
        } else {
            let frame = Frame::from_z(n_g);
            (frame.x, frame.y)
        };
        Surface {
            p,
            // One rounding to f32, and those of f64.
            p_error: (p - Point3::ZERO).abs() * gamma(2)
                + Vector3::new(1.0, 1.0, 1.0) * (largest * f64::EPSILON * 64.0) as f32,
            n_g,
            n_s: shading.map_or(n_g, Normal3::from_f64),
            uv,
            second_uv: uv,
            face: self.face,
            dpdu,
            dpdv,
            vertex_color: [1.0; 4],
            footprint: Footprint::POINT,
        }
    }

    fn outline(&self) -> Outline {
        let [p00, p10, p01, p11] = self.p;
        let Some((corner, [e, f])) = flat::parallelogram([p00, p10, p11, p01]) else {
            return Outline::Curved;
        };
        let turns = self.turns(self.normal(0.5, 0.5), [0.25; 4]);
        Outline::Parallelogram(corner, if turns { [f, e] } else { [e, f] })
    }

    fn by_area(&self, u: Point2) -> Option<AreaPoint> {
        let (u, v) = (f64::from(u.x), f64::from(u.y));
        let (dpdu, dpdv) = self.partials(u, v);
        let (n, element) = (self.normal(u, v), dpdu.cross(dpdv).length());
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
        let n = if self.turns(n, weights) { -n } else { n };
        (element > 0.0).then(|| AreaPoint { p: self.at(u, v), n, density: 1.0 / element })
    }

    /// Where the ray meets the patch nearest to `p`, `u` and `v` are uniform.
    fn area_density(&self, from: DVec3, p: DVec3) -> f64 {
        let (o, d) = (Point3::from_f64(from), Vector3::from_f64(p - from));
        let meetings = self.meetings(&Ray::new(o, d)).into_iter().flatten();
        let nearest = meetings.min_by(|a, b| (a.t - 1.0).abs().total_cmp(&(b.t - 1.0).abs()));
        nearest.map_or(0.0, |Meeting { u, v, .. }| {
            let (dpdu, dpdv) = self.partials(u, v);
            1.0 / dpdu.cross(dpdv).length()
        })
    }

    /// By Gauss' three-point rule in 8 x 8 cells.
    fn area(&self) -> f32 {
        const CELLS: u32 = 8;
        let points = [
            (-0.774_596_669_241_483_4, 5.0 / 18.0),
            (0.0, 8.0 / 18.0),
            (0.774_596_669_241_483_4, 5.0 / 18.0),
        ];
        let abscissae = || {
            (0..CELLS).flat_map(move |cell| {
                points.map(|(x, weight)| {
                    ((f64::from(cell) + 0.5 + 0.5 * x) / f64::from(CELLS), weight / f64::from(CELLS))
                })
            })
        };
        let element = |u: f64, v: f64| {
            let (dpdu, dpdv) = self.partials(u, v);
            dpdu.cross(dpdv).length()
        };
        let row = |(u, wu): (f64, f64)| abscissae().map(|(v, wv)| element(u, v) * wu * wv).sum::<f64>();
        abscissae().map(row).sum::<f64>() as f32
    }
}
