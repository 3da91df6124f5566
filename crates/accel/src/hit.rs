//! What a query returns.

/// The nearest meeting of a ray and the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, in multiples of the ray's direction.
    pub t: f32,
    /// Which instance, in the order they were added.
    pub instance: u32,
    /// Which triangle or box of the instance's geometry, in the order they were given.
    pub prim: u32,
    /// Triangles: weight of vertex 1. User geometry: whatever its callback returned.
    pub u: f32,
    /// Triangles: weight of vertex 2; vertex 0 has `1 - u - v`. User geometry: whatever its callback returned.
    pub v: f32,
}

impl Hit {
    /// "Nothing yet": a hit at `t_max` with the largest ids, so that any real one wins the tie.
    pub(crate) fn nothing(t_max: f32) -> Self {
        Self { t: t_max, instance: u32::MAX, prim: u32::MAX, u: 0.0, v: 0.0 }
    }
    /// The hit, unless it is still `nothing`.
    pub(crate) fn found(self) -> Option<Self> {
        (self.instance != u32::MAX).then_some(self)
    }
    /// Replaces `self` by `other` if that is nearer, or as near with smaller ids.
    #[inline]
    pub(crate) fn offer(&mut self, other: Self) {
        let smaller = (other.instance, other.prim) < (self.instance, self.prim);
        if other.t < self.t || (other.t == self.t && smaller) {
            *self = other;
        }
    }
}

/// What a shape's own intersection routine returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimitiveHit {
    /// Ray parameter, in multiples of the ray's direction.
    pub t: f32,
    /// Free for the shape's use; handed on in [`Hit::u`].
    pub u: f32,
    /// Free for the shape's use; handed on in [`Hit::v`].
    pub v: f32,
}
