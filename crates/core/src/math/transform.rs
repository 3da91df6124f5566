//! Affine maps with their inverses, and the rounding errors they add (Physically Based Rendering, section 6.8.4).
use glam::{DAffine3, DMat3, DVec3};

use super::{Bounds3, Normal3, Point3, Ray, Vector3, error::gamma};

/// Rows of a 3 x 4 affine matrix.
type Rows = [[f32; 4]; 3];

/// An affine map and its inverse, rounded once from f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    m: Rows,
    inverse: Rows,
    /// The linear part is the identity. PERF: most things in hand-written scenes are only moved (bench render).
    only_moves: bool,
}

fn rows(a: &DAffine3) -> Rows {
    let (m, t) = (&a.matrix3, a.translation);
    let row = |x: f64, y: f64, z: f64, t: f64| [x as f32, y as f32, z as f32, t as f32];
    [
        row(m.x_axis.x, m.y_axis.x, m.z_axis.x, t.x),
        row(m.x_axis.y, m.y_axis.y, m.z_axis.y, t.y),
        row(m.x_axis.z, m.y_axis.z, m.z_axis.z, t.z),
    ]
}

/// `f` of every row. PERF: without link-time optimisation `array::map` stays a call (callgrind).
#[inline(always)]
fn by_row(m: &Rows, f: impl Fn(&[f32; 4]) -> f32) -> [f32; 3] {
    [f(&m[0]), f(&m[1]), f(&m[2])]
}

#[inline(always)]
fn dot3(row: &[f32; 4], v: [f32; 3]) -> f32 {
    row[0] * v[0] + row[1] * v[1] + row[2] * v[2]
}

#[inline(always)]
fn mapped(m: &Rows, only_moves: bool, p: Point3) -> Point3 {
    if only_moves {
        return Point3::new(p.x + m[0][3], p.y + m[1][3], p.z + m[2][3]);
    }
    let v = p.to_array();
    let [x, y, z] = by_row(m, |r| dot3(r, v) + r[3]);
    Point3::new(x, y, z)
}

/// A position known to within `error` per coordinate, mapped, and the error of the result.
#[inline(always)]
fn mapped_with_error(m: &Rows, only_moves: bool, p: Point3, error: Vector3) -> (Point3, Vector3) {
    if only_moves {
        let q = mapped(m, true, p);
        // One rounding of the sum.
        return (q, error + (q - Point3::ZERO).abs() * gamma(1));
    }
    let (v, e) = (p.to_array(), error.to_array());
    let [x, y, z] = by_row(m, |r| {
        let magnitude = (r[0] * v[0]).abs() + (r[1] * v[1]).abs() + (r[2] * v[2]).abs() + r[3].abs();
        let carried = r[0].abs() * e[0] + r[1].abs() * e[1] + r[2].abs() * e[2];
        gamma(4) * magnitude + (gamma(4) + 1.0) * carried
    });
    (mapped(m, false, p), Vector3::new(x, y, z))
}

impl Transform {
    /// The map that leaves everything where it is.
    pub const IDENTITY: Self = {
        let i = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        Self { m: i, inverse: i, only_moves: true }
    };

    /// Rounds `a` and its f64 inverse. The inverse of a singular map holds infinities or NaN: see `is_invertible`.
    pub fn from_f64(a: &DAffine3) -> Self {
        let only_moves = a.matrix3 == DMat3::IDENTITY;
        Self { m: rows(a), inverse: rows(&a.inverse()), only_moves }
    }
    /// Translation by `v`.
    pub fn translate(v: Vector3) -> Self {
        Self::from_f64(&DAffine3::from_translation(v.to_f64()))
    }
    /// This map in double precision (of the rounded coefficients).
    pub fn to_f64(&self) -> DAffine3 {
        let c = |j: usize| DVec3::new(self.m[0][j].into(), self.m[1][j].into(), self.m[2][j].into());
        DAffine3 { matrix3: DMat3::from_cols(c(0), c(1), c(2)), translation: c(3) }
    }
    /// The inverse map.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self { m: self.inverse, inverse: self.m, only_moves: self.only_moves }
    }
    /// False if a coefficient of the map or its inverse is infinite or NaN.
    pub fn is_invertible(&self) -> bool {
        self.m.iter().chain(&self.inverse).flatten().all(|v| v.is_finite())
    }
    /// True if left- and right-handedness change places (odd number of mirrorings).
    pub fn swaps_handedness(&self) -> bool {
        self.to_f64().matrix3.determinant() < 0.0
    }
    /// Rows of the 3 x 4 matrix.
    pub fn rows(&self) -> &[[f32; 4]; 3] {
        &self.m
    }

    /// Maps a position.
    #[inline]
    pub fn point(&self, p: Point3) -> Point3 {
        mapped(&self.m, self.only_moves, p)
    }
    /// Maps a position known to within `error` per coordinate; also returns the error of the result.
    #[inline]
    pub fn point_with_error(&self, p: Point3, error: Vector3) -> (Point3, Vector3) {
        mapped_with_error(&self.m, self.only_moves, p, error)
    }
    /// Maps a position back, as `inverse().point_with_error(p, error)` does.
    #[inline]
    pub fn point_back_with_error(&self, p: Point3, error: Vector3) -> (Point3, Vector3) {
        mapped_with_error(&self.inverse, self.only_moves, p, error)
    }
    /// Maps a direction.
    #[inline]
    pub fn vector(&self, d: Vector3) -> Vector3 {
        if self.only_moves {
            return d;
        }
        let v = d.to_array();
        let [x, y, z] = by_row(&self.m, |r| dot3(r, v));
        Vector3::new(x, y, z)
    }
    /// Maps a normal by the inverse transpose; the length is not kept.
    #[inline]
    pub fn normal(&self, n: Normal3) -> Normal3 {
        if self.only_moves {
            return n;
        }
        let i = &self.inverse;
        let c = |j: usize| i[0][j] * n.x + i[1][j] * n.y + i[2][j] * n.z;
        Normal3::new(c(0), c(1), c(2))
    }
    /// Absolute values of the linear part times `v`: how far errors of `v` can reach.
    #[inline]
    pub fn reach(&self, v: Vector3) -> Vector3 {
        if self.only_moves {
            return v;
        }
        Vector3::from(by_row(&self.m, |r| r[0].abs() * v.x + r[1].abs() * v.y + r[2].abs() * v.z))
    }
    /// Maps a ray; the direction is not normalised, so `t` means the same on both sides.
    #[inline]
    pub fn ray(&self, r: &Ray) -> Ray {
        Ray { o: self.point(r.o), d: self.vector(r.d), ..*r }
    }
    /// Maps a ray back, as `inverse().ray(r)` does.
    #[inline]
    pub fn ray_back(&self, r: &Ray) -> Ray {
        let o = mapped(&self.inverse, self.only_moves, r.o);
        if self.only_moves {
            return Ray { o, ..*r };
        }
        let v = r.d.to_array();
        let [x, y, z] = by_row(&self.inverse, |row| dot3(row, v));
        Ray { o, d: Vector3::new(x, y, z), ..*r }
    }
    /// The box around the mapped corners, grown by the rounding error of mapping them.
    pub fn bounds(&self, b: &Bounds3) -> Bounds3 {
        if b.is_empty() || !b.is_finite() {
            return *b;
        }
        b.corners().into_iter().fold(Bounds3::EMPTY, |all, corner| {
            let (p, e) = self.point_with_error(corner, Vector3::ZERO);
            all.with(p - e).with(p + e)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn example() -> Transform {
        let q = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.8);
        Transform::from_f64(&DAffine3::from_scale_rotation_translation(
            DVec3::new(2.0, 0.5, -3.0),
            q,
            DVec3::new(10.0, -4.0, 0.3),
        ))
    }

    #[test]
    fn inverse_undoes_within_the_stated_error() {
        let t = example();
        let p = Point3::new(0.3, -7.0, 2.0);
        let (q, e) = t.point_with_error(p, Vector3::ZERO);
        let (back, e) = t.inverse().point_with_error(q, e);
        // The rounded inverse itself is off by half an ulp per coefficient: one more gamma(4) covers it.
        assert!((0..3).all(|a| (back[a] - p[a]).abs() <= 2.0 * e[a]), "{back:?} {e:?}");
    }

    #[test]
    fn normals_stay_perpendicular() {
        let t = example();
        let (n, v) = (Normal3::new(0.0, 1.0, 0.0), Vector3::new(1.0, 0.0, 0.7));
        assert!(t.normal(n).dot(t.vector(v)).abs() < 1e-6);
        assert!(t.swaps_handedness() && t.is_invertible());
    }

    #[test]
    fn singular_maps_are_reported() {
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        assert!(!Transform::from_f64(&flat).is_invertible());
    }

    #[test]
    fn bounds_contain_every_mapped_point() {
        let t = example();
        let b = Bounds3::new(Point3::new(-1.0, -2.0, -3.0), Point3::new(1.0, 0.0, 0.5));
        let mapped = t.bounds(&b);
        assert!(b.corners().into_iter().all(|c| mapped.contains(t.point(c))));
        assert!(mapped.contains(t.point(b.center())));
    }
}
