//! The triangle test in lanes: see the parent for the method. This is the only place that computes hits of triangles.
use durer_core::math::error::gamma;

use super::{Shear, exact};
use crate::{
    lanes::{LaneMask, Lanes},
    layout::{PACKET, PacketRecord},
};

/// Where a ray may end: `[t_min, t_max]`, and the least `t` anything may count with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    pub(crate) t_min: f32,
    pub(crate) t_max: f32,
    /// Hits nearer than this count as if they were here: where the ray enters an instance.
    pub(crate) floor: f32,
}

/// Hits of a group of triangles, lane by lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<A> {
    pub(crate) t: A,
    /// Weights of vertices 1 and 2.
    pub(crate) u: A,
    pub(crate) v: A,
}

/// Coordinates of the three vertices by the ray's own axes.
pub(crate) type Corners<V> = [[V; 3]; 3];

/// A ray's constants, in lanes.
struct Constants<V> {
    zero: V,
    sx: V,
    sy: V,
    sz: V,
}

/// Bit `i` of the result: lane `i` is hit, as `found` says. `corner(vertex, axis)` is given along the ray's axes, not yet
/// relative to its origin. `again(lane)` gives the triangle of a lane that needs f64.
#[inline(always)]
pub(crate) fn test<V: Lanes, const ROBUST: bool>(
    token: V::Token,
    shear: &Shear,
    reach: &Reach,
    corner: impl Fn(usize, usize) -> V,
    again: impl FnMut(usize) -> [durer_core::math::Point3; 3],
    found: &mut Found<V::Array>,
) -> u32 {
    let splat = |x: f32| V::splat(token, x);
    let o = shear.o.map(splat);
    let k = Constants { zero: splat(0.0), sx: splat(shear.x), sy: splat(shear.y), sz: splat(shear.z) };
    let v: Corners<V> = std::array::from_fn(|i| std::array::from_fn(|axis| corner(i, axis).sub(o[axis])));
    // Along the ray: z; across: sheared x and y.
    let across: [[V; 2]; 3] = v.map(|[x, y, z]| [x.sub(k.sx.mul(z)), y.sub(k.sy.mul(z))]);
    let [a, b, c] = across;
    let e0 = b[0].mul(c[1]).sub(b[1].mul(c[0]));
    let e1 = c[0].mul(a[1]).sub(c[1].mul(a[0]));
    let e2 = a[0].mul(b[1]).sub(a[1].mul(b[0]));
    let (least, most) = (e0.min(e1).min(e2), e0.max(e1).max(e2));
    // A sign that is not 0 is right; two different ones settle it whatever the third is.
    let inside = k.zero.le(least).or(most.le(k.zero));
    if inside.bits() == 0 {
        return 0;
    }
    let sum = e0.add(e1).add(e2);
    let reciprocal = splat(1.0).div(sum);
    let size = sum.abs();
    let no_edge = k.zero.lt(least).or(most.lt(k.zero));
    let ordinary = no_edge.and(splat(f32::MIN_POSITIVE).le(size)).and(size.le(splat(f32::MAX)));
    let w = [e0, e1, e2].map(|e| e.mul(reciprocal));
    let z = v.map(|[_, _, z]| z);
    let mut t = w[0].mul(z[0]).add(w[1].mul(z[1])).add(w[2].mul(z[2])).mul(k.sz);
    let (t_min, t_max) = (splat(reach.t_min), splat(reach.t_max));
    let mut hits = inside.and(ordinary).and(t_min.le(t)).and(t.le(t_max));
    let odd = if ROBUST { inside.bits() & !ordinary.bits() } else { 0 };
    if hits.bits() | odd == 0 {
        return 0;
    }
    let mut odd = odd;
    if ROBUST {
        let bound = error_bound(token, &across, z, reciprocal, k.sz);
        // A bound that overflowed says nothing.
        odd |= hits.bits() & !bound.le(splat(f32::MAX)).bits();
        hits = hits.and(bound.lt(t.abs()));
        let [entry, exit] = window(token, shear, &v);
        t = t.max(entry.max(splat(reach.floor)));
        hits = hits.and(t_min.le(exit)).and(t.le(t_max));
    }
    t.store(&mut found.t);
    w[1].store(&mut found.u);
    w[2].store(&mut found.v);
    let mut bits = hits.bits();
    if odd != 0 {
        bits = mend(shear, reach, odd, bits, again, found);
    }
    bits
}

/// Tests the lanes of `odd` in f64.
#[cold]
#[inline(never)]
fn mend<A: AsMut<[f32]>>(
    shear: &Shear,
    reach: &Reach,
    odd: u32,
    mut bits: u32,
    mut again: impl FnMut(usize) -> [durer_core::math::Point3; 3],
    found: &mut Found<A>,
) -> u32 {
    for lane in (0..PACKET).filter(|lane| odd >> lane & 1 != 0) {
        bits &= !(1 << lane);
        if let Some(hit) = exact(shear, &again(lane), reach) {
            bits |= 1 << lane;
            found.t.as_mut()[lane] = hit.t;
            found.u.as_mut()[lane] = hit.weights[1];
            found.v.as_mut()[lane] = hit.weights[2];
        }
    }
    bits
}

/// Bound on the absolute error of `t` (Physically Based Rendering, 4th edition, section 6.8.7): the roundings of the
/// projection, at most 5 of each coordinate, carried through edge functions and weighted mean.
#[inline(always)]
fn error_bound<V: Lanes>(token: V::Token, across: &[[V; 2]; 3], z: [V; 3], reciprocal: V, sz: V) -> V {
    let splat = |x: f32| V::splat(token, x);
    let most = |a: V, b: V, c: V| a.abs().max(b.abs()).max(c.abs());
    let [a, b, c] = across;
    let (x, y) = (most(a[0], b[0], c[0]), most(a[1], b[1], c[1]));
    let z = most(z[0], z[1], z[2]);
    // d_edge = 2 (g2 x y + dy x + dx y) with dx = g5 (x + z), dy = g5 (y + z); weights are at most 1.
    let products = x.mul(y).mul(splat(gamma(12))).add(x.add(y).mul(z).mul(splat(gamma(5))));
    let weights = products.mul(reciprocal.abs()).add(splat(gamma(1)));
    weights.mul(z).mul(sz.abs()).mul(splat(6.0))
}

/// Where the ray enters and leaves the box around the triangle, by the two axes that are not its main one. Seen edge-on,
/// rounding may take `t` out of the box, and a box that is culled would have held a hit: so hits count from the entry.
/// Along the ray's main axis the weighted mean sees to it; along an axis that the ray hardly moves along no box excludes
/// anything.
#[inline(always)]
fn window<V: Lanes>(token: V::Token, shear: &Shear, v: &Corners<V>) -> [V; 2] {
    let along = |axis: usize| {
        let r = V::splat(token, shear.reciprocal[axis]);
        let slack = V::splat(token, shear.slack[axis]);
        let [a, b, c] = [v[0][axis].mul(r), v[1][axis].mul(r), v[2][axis].mul(r)];
        [a.min(b).min(c).sub(slack), a.max(b).max(c).add(slack)]
    };
    let ([x0, x1], [y0, y1]) = (along(0), along(1));
    [x0.max(y0), x1.min(y1)]
}

/// The hits of a packet of eight.
#[inline(always)]
pub(crate) fn packet<V, R, const ROBUST: bool>(
    token: V::Token,
    packet: &R,
    shear: &Shear,
    reach: &Reach,
    moment: f32,
    found: &mut Found<[f32; PACKET]>,
) -> u32
where
    V: Lanes<Array = [f32; PACKET]>,
    R: PacketRecord,
{
    let corner = |vertex: usize, axis: usize| packet.coordinate::<V>(token, vertex, shear.axes[axis], moment);
    test::<V, ROBUST>(token, shear, reach, corner, |lane| packet.triangle(lane, moment), found)
}
