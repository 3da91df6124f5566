//! Axis-aligned boxes.
use serde::Serialize;

use super::{Point3, Vector3};

/// An axis-aligned box; empty when `min > max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounds3 {
    /// Corner with the smallest coordinates.
    pub min: Point3,
    /// Corner with the largest coordinates.
    pub max: Point3,
}

impl Bounds3 {
    /// Contains nothing; the neutral element of `union`.
    pub const EMPTY: Self = Self { min: Point3::splat(f32::INFINITY), max: Point3::splat(f32::NEG_INFINITY) };
    /// All of space: the bounds of an infinite plane.
    pub const UNBOUNDED: Self =
        Self { min: Point3::splat(f32::NEG_INFINITY), max: Point3::splat(f32::INFINITY) };

    /// From two opposite corners in any order.
    #[inline]
    pub fn new(a: Point3, b: Point3) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }
    /// The smallest box around `points`.
    #[inline]
    pub fn around(points: impl IntoIterator<Item = Point3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }
    /// This box grown to contain `p`.
    #[inline]
    pub fn with(self, p: Point3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }
    /// The smallest box around both.
    #[inline]
    pub fn union(self, o: Self) -> Self {
        Self { min: self.min.min(o.min), max: self.max.max(o.max) }
    }
    /// True if no point lies inside.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }
    /// True if every face lies at a finite coordinate.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }
    /// Edge lengths.
    #[inline]
    pub fn diagonal(&self) -> Vector3 {
        self.max - self.min
    }
    /// Midpoint.
    #[inline]
    pub fn center(&self) -> Point3 {
        Point3::ZERO + ((self.min - Point3::ZERO) * 0.5 + (self.max - Point3::ZERO) * 0.5)
    }
    /// Half the surface area; 0 for an empty box. What SAH builders compare.
    #[inline]
    pub fn half_area(&self) -> f32 {
        let d = self.diagonal();
        if self.is_empty() { 0.0 } else { d.x * d.y + d.y * d.z + d.z * d.x }
    }
    /// Whether the box contains `p` (faces included).
    #[inline]
    pub fn contains(&self, p: Point3) -> bool {
        (0..3).all(|a| self.min[a] <= p[a] && p[a] <= self.max[a])
    }
    /// The eight corners.
    #[inline]
    pub fn corners(&self) -> [Point3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f32, hi: f32| if i & bit == 0 { lo } else { hi };
            Point3::new(
                pick(1, self.min.x, self.max.x),
                pick(2, self.min.y, self.max.y),
                pick(4, self.min.z, self.max.z),
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_empty_box_has_no_area_and_no_points() {
        assert!(Bounds3::EMPTY.is_empty() && Bounds3::EMPTY.half_area() == 0.0);
        assert!(!Bounds3::EMPTY.contains(Point3::ZERO));
    }

    #[test]
    fn union_and_corners_agree() {
        let b = Bounds3::new(Point3::new(1.0, -2.0, 3.0), Point3::new(-1.0, 2.0, 0.0));
        assert_eq!(Bounds3::around(b.corners()), b);
        assert_eq!(b.union(Bounds3::EMPTY), b);
        assert_eq!(b.center(), Point3::new(0.0, 0.0, 1.5));
    }
}
