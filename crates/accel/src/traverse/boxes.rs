//! A ray against all boxes of a node.
use crate::{
    lanes::{LaneMask, Lanes},
    layout::BoxNode,
    slab::Slab,
};

/// A ray's constants for boxes, in lanes.
pub(crate) struct BoxRay<V> {
    near_r: [V; 3],
    near_c: [V; 3],
    far_r: [V; 3],
    far_c: [V; 3],
    near_side: [usize; 3],
    t_min: V,
    /// How far the stretch of time has gone.
    u: V,
}

impl<V: Lanes> BoxRay<V> {
    #[inline(always)]
    pub(crate) fn new(token: V::Token, slab: &Slab, t_min: f32, u: f32) -> Self {
        let splat = |x: f32| V::splat(token, x);
        Self {
            near_r: slab.near_r.map(splat),
            near_c: slab.near_c.map(splat),
            far_r: slab.far_r.map(splat),
            far_c: slab.far_c.map(splat),
            near_side: slab.near_side,
            t_min: splat(t_min),
            u: splat(u),
        }
    }

    /// Bit `i` of the result: the ray enters the box of lane `i` before `t_max`; and where.
    #[inline(always)]
    pub(crate) fn enter<N: BoxNode<V>>(&self, token: V::Token, node: &N, t_max: f32) -> (u32, V) {
        let near = |axis: usize| {
            let plane = node.plane(token, axis, self.near_side[axis], self.u);
            plane.fused(self.near_r[axis], self.near_c[axis])
        };
        let far = |axis: usize| {
            let plane = node.plane(token, axis, self.near_side[axis] ^ 1, self.u);
            plane.fused(self.far_r[axis], self.far_c[axis])
        };
        let entry = near(0).max(near(1)).max(near(2).max(self.t_min));
        let exit = far(0).min(far(1)).min(far(2).min(V::splat(token, t_max)));
        (entry.le(exit).bits(), entry)
    }
}
