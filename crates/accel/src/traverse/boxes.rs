//! A ray against all boxes of a node.
//!
//! PERF: no closures and no `array::map` with vectors here and in `triangle::lanes`: the compiler may leave them as calls of
//! functions that lack the features of the walk, ten times slower (bench kernel).
use wide::f32x4;

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
    /// Of the planes it enters and leaves by, in numbers from the lower ones.
    near_side: [usize; 3],
    far_side: [usize; 3],
    t_min: V,
    /// How far the stretch of time has gone.
    u: V,
}

#[inline(always)]
fn splat<V: Lanes>(token: V::Token, v: f32x4) -> [V; 3] {
    let [x, y, z, _] = v.to_array();
    [V::splat(token, x), V::splat(token, y), V::splat(token, z)]
}

impl<V: Lanes> BoxRay<V> {
    #[inline(always)]
    pub(crate) fn new(token: V::Token, slab: &Slab, t_min: f32, u: f32) -> Self {
        let upper = V::ZEROS.as_ref().len();
        let [x, y, z] = slab.enters_above;
        let near_side = [usize::from(x) * upper, usize::from(y) * upper, usize::from(z) * upper];
        Self {
            near_r: splat(token, slab.near_r),
            near_c: splat(token, slab.near_c),
            far_r: splat(token, slab.far_r),
            far_c: splat(token, slab.far_c),
            near_side,
            far_side: [near_side[0] ^ upper, near_side[1] ^ upper, near_side[2] ^ upper],
            t_min: V::splat(token, t_min),
            u: V::splat(token, u),
        }
    }

    #[inline(always)]
    fn near<N: BoxNode<V>>(&self, token: V::Token, node: &N, axis: usize) -> V {
        let plane = node.plane(token, axis, self.near_side[axis], self.u);
        plane.fused(self.near_r[axis], self.near_c[axis])
    }

    #[inline(always)]
    fn far<N: BoxNode<V>>(&self, token: V::Token, node: &N, axis: usize) -> V {
        let plane = node.plane(token, axis, self.far_side[axis], self.u);
        plane.fused(self.far_r[axis], self.far_c[axis])
    }

    /// Bit `i` of the result: the ray enters the box of lane `i` before `t_max`; and where. Both are moved by `Slab::shift`,
    /// so that neither they nor `t_max` are negative.
    #[inline(always)]
    pub(crate) fn enter<N: BoxNode<V>>(&self, token: V::Token, node: &N, t_max: f32) -> (u32, V) {
        let (x, y) = (self.near(token, node, 0), self.near(token, node, 1));
        let entry = x.max_bits(y).max_bits(self.near(token, node, 2).max_bits(self.t_min));
        let (x, y) = (self.far(token, node, 0), self.far(token, node, 1));
        let exit = x.min_bits(y).min_bits(self.far(token, node, 2).min_bits(V::splat(token, t_max)));
        (entry.le_bits(exit).bits(), entry)
    }
}
