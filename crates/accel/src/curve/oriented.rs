//! Oriented curves: a ribbon with normals, that does not turn with the ray.
//!
//! The ribbon is `P(u, w) = c(u) + w b(u)` with `b` the unit vector along `n x c'` and `|w| <= r(u)`; the normals `n` are
//! control values of the same basis as the points. In the frame of the ray `c + w b` is 0 in x and y where
//! `k = x b_y - y b_x = 0`; with `b` not normalised that is a polynomial of degree 8, whose roots are all found. Then
//! `w = -(c . b) / (b . b)`, both projected, and `t = z + w b_z`.
use durer_core::glam::DVec3;

use super::{
    CurveHit, Curves,
    bernstein::{Bernstein, Cubic},
    ray_frame::RayFrame,
    strand::Strand,
};

/// How far beside the line a ray passes at a true root, at most: rounding as a fraction of the radius.
const BESIDE: f64 = 1e-6;

/// The normals' cubics in the frame of the ray.
struct Turning<'a> {
    strand: &'a Strand,
    n: [Cubic; 3],
}

/// A meeting of the ray and a line across the ribbon.
#[derive(Clone, Copy)]
struct Meeting {
    t: f32,
    s: f64,
    /// Along `b`.
    w: f64,
}

/// The nearest meeting with a parameter in `[t_min, t_max]`.
pub(super) fn intersect(
    curves: &Curves,
    segment: u32,
    strand: &Strand,
    frame: &RayFrame,
    t_max: f32,
) -> Option<CurveHit> {
    let n = curves.bezier_normals(segment, |n| frame.turn(n)).map(|n| strand.same_part(&Bernstein(n)));
    let ribbon = Turning { strand, n };
    let roots = ribbon.polynomial().roots();
    let at_ends = [0.0, 1.0].into_iter().filter(|s| ribbon.is_on_edge(*s));
    let nearest = roots
        .as_slice()
        .iter()
        .copied()
        .chain(at_ends)
        .filter_map(|s| ribbon.meeting(frame, s))
        .reduce(|a, b| if b.t < a.t { b } else { a })?;
    (nearest.t <= t_max).then(|| ribbon.hit(frame, nearest))
}

impl Turning<'_> {
    /// `k`.
    fn polynomial(&self) -> Bernstein<9> {
        let Strand { x, y, z, .. } = self.strand;
        let [x1, y1, z1]: [Bernstein<3>; 3] = [x.derivative(), y.derivative(), z.derivative()];
        let [nx, ny, nz] = &self.n;
        let product = |a: &Cubic, b: &Bernstein<3>| -> Bernstein<6> { a.times(b) };
        let b_x = product(ny, &z1).plus(-1.0, &product(nz, &y1));
        let b_y = product(nz, &x1).plus(-1.0, &product(nx, &z1));
        x.times::<6, 9>(&b_y).plus(-1.0, &y.times::<6, 9>(&b_x))
    }

    fn normal(&self, s: f64) -> DVec3 {
        DVec3::new(self.n[0].at(s), self.n[1].at(s), self.n[2].at(s))
    }
    /// `b`, if the curve's direction and the normal make one.
    fn across(&self, s: f64) -> Option<DVec3> {
        self.normal(s).cross(self.strand.heading(s)).try_normalize()
    }

    /// Whether the ray meets the line across the end at `s` within rounding: closes the seam to the next segment, as
    /// with flat curves.
    fn is_on_edge(&self, s: f64) -> bool {
        let center = self.strand.center(s);
        self.across(s).is_some_and(|b| {
            let length = b.truncate().length();
            (center.x * b.y - center.y * b.x).abs() <= self.strand.own_error * length
        })
    }

    fn meeting(&self, frame: &RayFrame, s: f64) -> Option<Meeting> {
        let (center, r, b) = (self.strand.center(s), self.strand.r.at(s), self.across(s)?);
        let seen = b.x * b.x + b.y * b.y;
        let w = -(center.x * b.x + center.y * b.y) / seen;
        // Where normals and curve are parallel `k` is 0 wherever the ray is: it has to pass the line, too.
        let beside = (center.x * b.y - center.y * b.x).abs() / seen.sqrt();
        let meets = beside <= self.strand.own_error + BESIDE * r;
        // False for the NaN of a ribbon seen along its width.
        if !(r > 0.0 && w.abs() <= r && meets) {
            return None;
        }
        let error = (self.strand.own_error + frame.start_error()) * (1.0 + self.steepness(s, b, w));
        let t = frame.t_ahead(center.z + w * b.z, error)?;
        Some(Meeting { t, s, w })
    }

    /// Normal of the surface at `(s, w)`, not normalised: `dP/dw x dP/du`. The change of `b` along itself, which is
    /// what makes it a unit vector, falls out of the product.
    fn surface_normal(&self, s: f64, b: DVec3, w: f64) -> DVec3 {
        let jets = [self.strand.x.jet(s), self.strand.y.jet(s), self.strand.z.jet(s)];
        let n1 = DVec3::from_array(std::array::from_fn(|a| self.n[a].with_slope(s).1));
        let (c1, c2) = (
            DVec3::from_array(std::array::from_fn(|a| jets[a][1])),
            DVec3::from_array(std::array::from_fn(|a| jets[a][2])),
        );
        let n = self.normal(s);
        let turn = (n1.cross(c1) + n.cross(c2)) * (w / n.cross(c1).length());
        let moved = if turn.is_finite() { c1 + turn } else { self.strand.heading(s) };
        moved.cross(b)
    }

    /// By how much more a sideways error moves the meeting along the ray: the tangent of its angle to the normal.
    fn steepness(&self, s: f64, b: DVec3, w: f64) -> f64 {
        let n = self.surface_normal(s, b, w);
        n.truncate().length() / n.z.abs()
    }

    fn hit(&self, frame: &RayFrame, meeting: Meeting) -> CurveHit {
        let Meeting { t, s, w } = meeting;
        let b = self.across(s).unwrap_or(DVec3::X);
        let n_g = self.surface_normal(s, b, w).try_normalize().unwrap_or(-DVec3::Z);
        // Which of both sides is the front does not depend on the ray.
        let n_g = if n_g.dot(self.normal(s)) < 0.0 { -n_g } else { n_g };
        let v = (w / self.strand.r.at(s)).clamp(-1.0, 1.0) as f32;
        CurveHit { t, u: self.strand.along(s) as f32, v, n_g: frame.turn_back(n_g) }
    }
}
