//! The triangle test in lanes: see the parent for the method. This is the only place that computes hits of triangles.
use durer_core::math::{Point3, error::gamma};

use super::{Shear, exact};
use crate::{
    lanes::{LaneMask, Lanes},
    layout::{PACKET, PacketRecord},
    slab::greater,
};

/// Least product of two edge functions of which neither lost anything to underflow.
const TINY: f32 = 1e-36;

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

/// The triangles of a group. Read again where few come, so that registers stay free where all go (bench kernel).
pub(crate) trait Corners<V: Lanes>: Copy {
    /// A coordinate of a vertex relative to the ray's origin, by the ray's own axes.
    fn coordinate(self, token: V::Token, shear: &Shear, vertex: usize, axis: usize) -> V;
    /// One triangle as it is.
    fn triangle(self, lane: usize) -> [Point3; 3];
    /// Bit `i`: lane `i` holds a triangle.
    fn lanes(self) -> u32;
    /// The same group, without what the compiler knows of it.
    fn anew(self) -> Self;
}

/// Twice the areas between the ray and each edge, and what they say.
struct Edges<V: Lanes> {
    e: [V; 3],
    least: V,
    most: V,
    /// The ray passes on the same side of all three, or through some.
    inside: V::Mask,
}

/// The product of two edges less that of the other two: twice an area.
#[inline(always)]
fn cross<V: Lanes>(a: [V; 2], b: [V; 2]) -> V {
    a[0].mul(b[1]).sub(a[1].mul(b[0]))
}

/// A vertex across the ray: its first two coordinates, sheared.
#[inline(always)]
fn across<V: Lanes>(token: V::Token, shear: &Shear, group: impl Corners<V>, vertex: usize, z: V) -> [V; 2] {
    let x = group.coordinate(token, shear, vertex, 0);
    let y = group.coordinate(token, shear, vertex, 1);
    [x.sub(V::splat(token, shear.x).mul(z)), y.sub(V::splat(token, shear.y).mul(z))]
}

/// Bit `i` of the result: lane `i` is hit, as `found` says.
#[inline(always)]
pub(crate) fn test<V: Lanes, const ROBUST: bool>(
    token: V::Token,
    shear: &Shear,
    reach: Reach,
    group: impl Corners<V>,
    found: &mut Found<V::Array>,
) -> u32 {
    if ROBUST && shear.huge == 0.0 {
        // Sums may be no numbers: nothing they say counts.
        return settle(shear, reach, (0, group.lanes()), |lane| group.triangle(lane), found);
    }
    let z0 = group.coordinate(token, shear, 0, 2);
    let z1 = group.coordinate(token, shear, 1, 2);
    let z2 = group.coordinate(token, shear, 2, 2);
    let a = across(token, shear, group, 0, z0);
    let b = across(token, shear, group, 1, z1);
    let c = across(token, shear, group, 2, z2);
    let e = [cross(b, c), cross(c, a), cross(a, b)];
    let (least, most) = (e[0].min(e[1]).min(e[2]), e[0].max(e[1]).max(e[2]));
    // A sign that is not 0 is right; two different ones settle it whatever the third is.
    let zero = V::splat(token, 0.0);
    let inside = zero.le(least).or(most.le(zero));
    if inside.bits() == 0 {
        return 0;
    }
    let edges = Edges { e, least, most, inside };
    meet::<V, ROBUST>(token, shear, reach, group.anew(), [z0, z1, z2], &edges, found)
}

/// Where the lanes that the ray passes through are met.
#[inline(always)]
fn meet<V: Lanes, const ROBUST: bool>(
    token: V::Token,
    shear: &Shear,
    reach: Reach,
    group: impl Corners<V>,
    z: [V; 3],
    edges: &Edges<V>,
    found: &mut Found<V::Array>,
) -> u32 {
    let Edges { e, least, most, inside } = edges;
    let sz = V::splat(token, shear.z);
    let z = [z[0].mul(sz), z[1].mul(sz), z[2].mul(sz)];
    let reciprocal = V::splat(token, 1.0).div(e[0].add(e[1]).add(e[2]));
    let (t_min, t_max) = (V::splat(token, reach.t_min), V::splat(token, reach.t_max));
    let (u, v) = (e[1].mul(reciprocal), e[2].mul(reciprocal));
    u.store(&mut found.u);
    v.store(&mut found.v);
    let floor = V::splat(token, reach.floor);
    if !ROBUST {
        let zero = V::splat(token, 0.0);
        let strictly = zero.lt(*least).or(most.lt(zero));
        let met = e[0].mul(reciprocal).mul(z[0]).add(u.mul(z[1])).add(v.mul(z[2]));
        let t = met.max(floor);
        t.store(&mut found.t);
        return strictly.and(t_min.le(met)).and(t.le(t_max)).bits();
    }
    // PERF: sums first, while the division is under way. Their products must not overflow (bench kernel).
    let met = e[0].mul(z[0]).add(e[1].mul(z[1])).add(e[2].mul(z[2])).mul(reciprocal);
    // An edge exactly on the ray, or numbers so small or large that products may lose it all, are for f64.
    let spread = V::splat(token, TINY).le(least.mul(*most));
    let ordinary = spread.and(least.abs().max(most.abs()).le(V::splat(token, shear.huge)));
    let t = met.max(entry(token, shear, group)).max(floor);
    t.store(&mut found.t);
    let hits = inside.and(ordinary).and(t_min.le(met)).and(t.le(t_max));
    // In front with all its vertices: so is the hit, whatever the rounding.
    let front = V::splat(token, greater(reach.t_min, 0.0)).lt(z[0].min(z[1]).min(z[2]));
    let (bits, ahead) = (hits.bits(), front.bits());
    let odd = inside.bits() & !ordinary.bits();
    if bits & !ahead | odd == 0 {
        return bits;
    }
    let kept = keep::<V>(token, shear, reach.t_min, group.anew(), e, reciprocal, met);
    settle(shear, reach, (bits & (ahead | kept), odd), |lane| group.triangle(lane), found)
}

/// Of triangles that reach back beyond where the ray begins: which hits at `t` are farther than the bound on their error, on
/// triangles whose box the ray has not left before it begins.
#[inline(always)]
fn keep<V: Lanes>(
    token: V::Token,
    shear: &Shear,
    t_min: f32,
    group: impl Corners<V>,
    e: &[V; 3],
    reciprocal: V,
    t: V,
) -> u32 {
    let z0 = group.coordinate(token, shear, 0, 2);
    let z1 = group.coordinate(token, shear, 1, 2);
    let z2 = group.coordinate(token, shear, 2, 2);
    let a = Corner::new(token, across(token, shear, group, 0, z0), z0);
    let b = Corner::new(token, across(token, shear, group, 1, z1), z1);
    let c = Corner::new(token, across(token, shear, group, 2, z2), z2);
    let sz = V::splat(token, shear.z);
    let (z0, z1, z2) = (z0.mul(sz), z1.mul(sz), z2.mul(sz));
    let edges = b.edge_error(token, &c).mul(z0.sub(t).abs());
    let edges = edges.add(c.edge_error(token, &a).mul(z1.sub(t).abs()));
    let edges = edges.add(a.edge_error(token, &b).mul(z2.sub(t).abs()));
    let sums = e[0].mul(z0).abs().add(e[1].mul(z1).abs()).add(e[2].mul(z2).abs());
    let bound = edges.add(sums.mul(V::splat(token, gamma(SUM_ROUNDINGS)))).mul(reciprocal.abs());
    let exit = exit(token, shear, group);
    bound.lt(t.abs()).and(V::splat(token, t_min).le(exit)).bits()
}

/// Roundings of a term of the weighted mean: of its depth 3, its product 1, the sums 4, the quotient 2.
pub(super) const SUM_ROUNDINGS: u32 = 10;
/// Roundings of a vertex on its way across the ray: its difference from the origin, shear, product, difference.
pub(super) const CORNER_ROUNDINGS: u32 = 5;
/// Roundings of an edge function: products and their difference; one more for what is of second order.
pub(super) const EDGE_ROUNDINGS: u32 = 3;

/// A vertex across the ray in magnitude, and the error of that.
struct Corner<V> {
    size: [V; 2],
    error: [V; 2],
}

impl<V: Lanes> Corner<V> {
    #[inline(always)]
    fn new(token: V::Token, [x, y]: [V; 2], z: V) -> Self {
        let g = V::splat(token, gamma(CORNER_ROUNDINGS));
        let (x, y, z) = (x.abs(), y.abs(), z.abs());
        Self { size: [x, y], error: [x.add(z).mul(g), y.add(z).mul(g)] }
    }

    /// Bound on the error of the edge function of two vertices, whose depths count by how far they are from the hit: the
    /// error of a quotient of sums `sum(e z) / sum(e)` is `sum(de (z - t)) / sum(e)` (Higham 2002, chapter 1). Bounds
    /// by the whole triangle's size instead would call every hit on a long sliver noise.
    #[inline(always)]
    fn edge_error(&self, token: V::Token, other: &Self) -> V {
        let (p, q) = (self, other);
        let products = p.size[0].mul(q.size[1]).add(p.size[1].mul(q.size[0]));
        let first = p.size[0].mul(q.error[1]).add(q.size[1].mul(p.error[0]));
        let second = p.size[1].mul(q.error[0]).add(q.size[0].mul(p.error[1]));
        products.mul(V::splat(token, gamma(EDGE_ROUNDINGS))).add(first).add(second)
    }
}

/// Tests the lanes of `odd` in f64; the others stay hit as `bits` says.
#[cold]
#[inline(never)]
fn settle<A: AsMut<[f32]>>(
    shear: &Shear,
    reach: Reach,
    (mut bits, odd): (u32, u32),
    triangle: impl Fn(usize) -> [Point3; 3],
    found: &mut Found<A>,
) -> u32 {
    for lane in (0..PACKET).filter(|lane| odd >> lane & 1 != 0) {
        bits &= !(1 << lane);
        if let Some(hit) = exact(shear, &triangle(lane), &reach) {
            bits |= 1 << lane;
            found.t.as_mut()[lane] = hit.t;
            found.u.as_mut()[lane] = hit.weights[1];
            found.v.as_mut()[lane] = hit.weights[2];
        }
    }
    bits
}

/// Where the ray meets the planes through each vertex along one of its first two axes; 0 along an axis that it hardly moves
/// along.
#[inline(always)]
fn planes<V: Lanes>(token: V::Token, shear: &Shear, group: impl Corners<V>, axis: usize) -> [V; 3] {
    let r = V::splat(token, shear.reciprocal[axis]);
    [
        group.coordinate(token, shear, 0, axis).mul(r),
        group.coordinate(token, shear, 1, axis).mul(r),
        group.coordinate(token, shear, 2, axis).mul(r),
    ]
}

/// Where the ray enters the box around the triangle, by the two axes that are not its main one. Seen edge-on, rounding may
/// take `t` out of the box, and a box that is culled would have held a hit: so hits count from the entry. Along the ray's
/// main axis the weighted mean sees to it; along an axis that the ray hardly moves along no box excludes anything.
#[inline(always)]
fn entry<V: Lanes>(token: V::Token, shear: &Shear, group: impl Corners<V>) -> V {
    let [a, b, c] = planes(token, shear, group, 0);
    let x = a.min(b).min(c).sub(V::splat(token, shear.slack[0]));
    let [a, b, c] = planes(token, shear, group, 1);
    x.max(a.min(b).min(c).sub(V::splat(token, shear.slack[1])))
}

/// Where it leaves that box.
#[inline(always)]
fn exit<V: Lanes>(token: V::Token, shear: &Shear, group: impl Corners<V>) -> V {
    let [a, b, c] = planes(token, shear, group, 0);
    let x = a.max(b).max(c).add(V::splat(token, shear.slack[0]));
    let [a, b, c] = planes(token, shear, group, 1);
    x.min(a.max(b).max(c).add(V::splat(token, shear.slack[1])))
}

/// A packet at a moment.
struct Packed<'p, R> {
    packet: &'p R,
    moment: f32,
}

impl<R> Clone for Packed<'_, R> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<R> Copy for Packed<'_, R> {}

impl<V: Lanes<Array = [f32; PACKET]>, R: PacketRecord> Corners<V> for Packed<'_, R> {
    #[inline(always)]
    fn coordinate(self, token: V::Token, shear: &Shear, vertex: usize, axis: usize) -> V {
        let x = self.packet.coordinate::<V>(token, vertex, shear.axes[axis], self.moment);
        x.sub(V::splat(token, shear.o[axis]))
    }
    fn triangle(self, lane: usize) -> [Point3; 3] {
        self.packet.triangle(lane, self.moment)
    }
    fn lanes(self) -> u32 {
        (1 << self.packet.len()) - 1
    }
    #[inline(always)]
    fn anew(self) -> Self {
        Self { packet: std::hint::black_box(self.packet), moment: self.moment }
    }
}

/// The hits of a packet of eight.
#[inline(always)]
pub(crate) fn packet<V, R, const ROBUST: bool>(
    token: V::Token,
    packet: &R,
    shear: &Shear,
    reach: Reach,
    moment: f32,
    found: &mut Found<[f32; PACKET]>,
) -> u32
where
    V: Lanes<Array = [f32; PACKET]>,
    R: PacketRecord,
{
    test::<V, ROBUST>(token, shear, reach, Packed { packet, moment }, found)
}
