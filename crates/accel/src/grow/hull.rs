//! Boxes in two vector registers, and their areas.
use durer_core::math::Bounds3;
use wide::f32x4;

/// A box; the fourth lanes mean nothing, or hold words of an `Item`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hull {
    pub(super) lo: f32x4,
    pub(super) hi: f32x4,
}

impl Hull {
    /// Contains nothing; the neutral element of `joined`.
    pub(super) const EMPTY: Self =
        Self { lo: f32x4::new([f32::INFINITY; 4]), hi: f32x4::new([f32::NEG_INFINITY; 4]) };

    pub(super) fn new(bounds: &Bounds3) -> Self {
        let ([a, b, c], [d, e, f]) = (bounds.min.to_array(), bounds.max.to_array());
        Self { lo: f32x4::new([a, b, c, 0.0]), hi: f32x4::new([d, e, f, 0.0]) }
    }

    /// The smallest box around both.
    #[inline(always)]
    pub(super) fn joined(self, o: Self) -> Self {
        Self { lo: self.lo.fast_min(o.lo), hi: self.hi.fast_max(o.hi) }
    }

    /// This box grown to contain a point.
    #[inline(always)]
    pub(super) fn with(self, p: f32x4) -> Self {
        Self { lo: self.lo.fast_min(p), hi: self.hi.fast_max(p) }
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let ([a, b, c, _], [d, e, f, _]) = (self.lo.to_array(), self.hi.to_array());
        Bounds3 { min: [a, b, c].into(), max: [d, e, f].into() }
    }

    /// Edge lengths; they may overflow to infinity and are negative for an empty box.
    pub(super) fn extent(&self) -> [f32; 3] {
        let [x, y, z, _] = (self.hi - self.lo).to_array();
        [x, y, z]
    }
}

/// Measures areas in a unit in which those of a scene neither overflow nor vanish: coordinates are scaled by a power of
/// two that brings the scene's longest edge near 4.
#[derive(Clone, Copy, Debug)]
pub(super) struct AreaUnit(f32x4);

impl AreaUnit {
    /// For boxes inside `whole`.
    pub(super) fn new(whole: &Hull) -> Self {
        let [x, y, z, _] = (whole.hi * 0.25 - whole.lo * 0.25).to_array();
        let exponent = x.max(y).max(z).to_bits() >> 23;
        Self(f32x4::splat(f32::from_bits(254u32.saturating_sub(exponent).max(1) << 23)))
    }

    /// Quarters first, for the difference of finite coordinates may be infinite.
    #[inline(always)]
    fn extent(&self, hull: &Hull) -> f32x4 {
        ((hull.hi * 0.25 - hull.lo * 0.25) * self.0).fast_max(f32x4::ZERO)
    }

    /// Half the surface area; 0 for an empty box.
    #[inline(always)]
    pub(super) fn area(&self, hull: &Hull) -> f32 {
        let [x, y, z, _] = self.extent(hull).to_array();
        x * y + (y * z + z * x)
    }

    /// Those of three boxes in the first three lanes; the fourth is that of the last box again.
    #[inline(always)]
    pub(super) fn areas(&self, [a, b, c]: &[Hull; 3]) -> f32x4 {
        let last = self.extent(c);
        let [x, y, z, _] = f32x4::transpose([self.extent(a), self.extent(b), last, last]);
        x * y + (y * z + z * x)
    }
}
