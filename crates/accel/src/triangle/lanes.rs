//! The triangle test in lanes: see the parent for the method. This is the only place that computes hits of triangles.
use durer_core::math::{Point3, error::gamma};

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

/// The product of two edges less that of the other two: twice an area.
#[inline(always)]
fn cross<V: Lanes>(a: [V; 2], b: [V; 2]) -> V {
    a[0].mul(b[1]).sub(a[1].mul(b[0]))
}

/// A vertex across the ray: its first two coordinates, sheared.
#[inline(always)]
fn across<V: Lanes>([x, y, z]: [V; 3], sx: V, sy: V) -> [V; 2] {
    [x.sub(sx.mul(z)), y.sub(sy.mul(z))]
}

/// Bit `i` of the result: lane `i` is hit, as `found` says. `v` holds the vertices relative to the ray's origin, along its
/// axes; `again(lane)` gives the triangle of a lane that needs f64.
#[inline(always)]
pub(crate) fn test<V: Lanes, const ROBUST: bool>(
    token: V::Token,
    shear: &Shear,
    reach: &Reach,
    v: &Corners<V>,
    again: impl FnMut(usize) -> [Point3; 3],
    found: &mut Found<V::Array>,
) -> u32 {
    let (sx, sy) = (V::splat(token, shear.x), V::splat(token, shear.y));
    let a = across(v[0], sx, sy);
    let b = across(v[1], sx, sy);
    let c = across(v[2], sx, sy);
    let (e0, e1, e2) = (cross(b, c), cross(c, a), cross(a, b));
    let (least, most) = (e0.min(e1).min(e2), e0.max(e1).max(e2));
    // A sign that is not 0 is right; two different ones settle it whatever the third is.
    let zero = V::splat(token, 0.0);
    let inside = zero.le(least).or(most.le(zero));
    if inside.bits() == 0 {
        return 0;
    }
    let sum = e0.add(e1).add(e2);
    let reciprocal = V::splat(token, 1.0).div(sum);
    let size = sum.abs();
    let no_edge = zero.lt(least).or(most.lt(zero));
    let is_number = V::splat(token, f32::MIN_POSITIVE).le(size).and(size.le(V::splat(token, f32::MAX)));
    let ordinary = no_edge.and(is_number);
    let (w0, w1, w2) = (e0.mul(reciprocal), e1.mul(reciprocal), e2.mul(reciprocal));
    let sz = V::splat(token, shear.z);
    let mut t = w0.mul(v[0][2]).add(w1.mul(v[1][2])).add(w2.mul(v[2][2])).mul(sz);
    let (t_min, t_max) = (V::splat(token, reach.t_min), V::splat(token, reach.t_max));
    let mut hits = inside.and(ordinary).and(t_min.le(t)).and(t.le(t_max));
    let mut odd = if ROBUST { inside.bits() & !ordinary.bits() } else { 0 };
    if hits.bits() | odd == 0 {
        return 0;
    }
    if ROBUST {
        let bound = error_bound(token, [a, b, c], [v[0][2], v[1][2], v[2][2]], reciprocal, sz);
        // A bound that overflowed says nothing.
        odd |= hits.bits() & !bound.le(V::splat(token, f32::MAX)).bits();
        hits = hits.and(bound.lt(t.abs()));
        let [entry, exit] = window(token, shear, v);
        t = t.max(entry.max(V::splat(token, reach.floor)));
        hits = hits.and(t_min.le(exit)).and(t.le(t_max));
    }
    t.store(&mut found.t);
    w1.store(&mut found.u);
    w2.store(&mut found.v);
    if odd != 0 { mend(shear, reach, odd, hits.bits(), again, found) } else { hits.bits() }
}

/// Tests the lanes of `odd` in f64.
#[cold]
#[inline(never)]
fn mend<A: AsMut<[f32]>>(
    shear: &Shear,
    reach: &Reach,
    odd: u32,
    mut bits: u32,
    mut again: impl FnMut(usize) -> [Point3; 3],
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

/// The largest magnitude.
#[inline(always)]
fn largest<V: Lanes>(a: V, b: V, c: V) -> V {
    a.abs().max(b.abs()).max(c.abs())
}

/// Bound on the absolute error of `t` (Physically Based Rendering, 4th edition, section 6.8.7): the roundings of the
/// projection, at most 5 of each coordinate, carried through edge functions and weighted mean.
#[inline(always)]
fn error_bound<V: Lanes>(token: V::Token, [a, b, c]: [[V; 2]; 3], z: [V; 3], reciprocal: V, sz: V) -> V {
    let (x, y) = (largest(a[0], b[0], c[0]), largest(a[1], b[1], c[1]));
    let z = largest(z[0], z[1], z[2]);
    // d_edge = 2 (g2 x y + dy x + dx y) with dx = g5 (x + z), dy = g5 (y + z); weights are at most 1.
    let (g1, g5, g12) = (V::splat(token, gamma(1)), V::splat(token, gamma(5)), V::splat(token, gamma(12)));
    let products = x.mul(y).mul(g12).add(x.add(y).mul(z).mul(g5));
    let weights = products.mul(reciprocal.abs()).add(g1);
    weights.mul(z).mul(sz.abs()).mul(V::splat(token, 6.0))
}

/// Where the ray meets the planes around the triangle along one of its first two axes.
#[inline(always)]
fn along<V: Lanes>(token: V::Token, shear: &Shear, v: &Corners<V>, axis: usize) -> [V; 2] {
    let r = V::splat(token, shear.reciprocal[axis]);
    let slack = V::splat(token, shear.slack[axis]);
    let (a, b, c) = (v[0][axis].mul(r), v[1][axis].mul(r), v[2][axis].mul(r));
    [a.min(b).min(c).sub(slack), a.max(b).max(c).add(slack)]
}

/// Where the ray enters and leaves the box around the triangle, by the two axes that are not its main one. Seen edge-on,
/// rounding may take `t` out of the box, and a box that is culled would have held a hit: so hits count from the entry.
/// Along the ray's main axis the weighted mean sees to it; along an axis that the ray hardly moves along no box excludes
/// anything.
#[inline(always)]
fn window<V: Lanes>(token: V::Token, shear: &Shear, v: &Corners<V>) -> [V; 2] {
    let [x0, x1] = along(token, shear, v, 0);
    let [y0, y1] = along(token, shear, v, 1);
    [x0.max(y0), x1.min(y1)]
}

/// One vertex of all triangles of a packet, relative to the ray's origin.
#[inline(always)]
fn vertex<V, R>(token: V::Token, packet: &R, shear: &Shear, moment: f32, vertex: usize) -> [V; 3]
where
    V: Lanes<Array = [f32; PACKET]>,
    R: PacketRecord,
{
    let [x, y, z] = shear.axes;
    [
        packet.coordinate::<V>(token, vertex, x, moment).sub(V::splat(token, shear.o[0])),
        packet.coordinate::<V>(token, vertex, y, moment).sub(V::splat(token, shear.o[1])),
        packet.coordinate::<V>(token, vertex, z, moment).sub(V::splat(token, shear.o[2])),
    ]
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
    let v = [
        vertex(token, packet, shear, moment, 0),
        vertex(token, packet, shear, moment, 1),
        vertex(token, packet, shear, moment, 2),
    ];
    test::<V, ROBUST>(token, shear, reach, &v, |lane| packet.triangle(lane, moment), found)
}
