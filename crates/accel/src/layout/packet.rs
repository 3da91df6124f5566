//! Leaves: up to eight triangles, vertex by vertex and axis by axis.
use durer_core::math::Point3;

use crate::{
    lanes::Lanes,
    simd::{Record, flat},
};

/// Triangles per packet.
pub(crate) const PACKET: usize = 8;

/// Coordinates of eight points, by axis.
type Points = [[f32; PACKET]; 3];

/// Eight triangles. A lane that is not used has no place (NaN), so that no test finds it hit, and no name.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Packet {
    vertices: [Points; 3],
    ids: [u32; PACKET],
}

/// Eight triangles whose vertices move on straight lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct MovingPacket {
    start: [Points; 3],
    end: [Points; 3],
    ids: [u32; PACKET],
}

/// What packets of both sorts can be asked.
pub(crate) trait PacketRecord: Record + Send + Sync {
    /// Coordinate `axis` of vertex `vertex` of all eight, at the fraction `u` of the stretch of time.
    fn coordinate<V: Lanes<Array = [f32; PACKET]>>(
        &self,
        token: V::Token,
        vertex: usize,
        axis: Axis,
        u: f32,
    ) -> V;
    fn ids(&self) -> &[u32; PACKET];
    /// One triangle.
    fn triangle(&self, lane: usize, u: f32) -> [Point3; 3];
    /// Lanes that are used.
    fn len(&self) -> usize {
        self.ids().iter().position(|id| *id == NOBODY).unwrap_or(PACKET)
    }
    /// Writes the triangles `(id, vertices at the start, at the end)`, 1 to 8 of them.
    fn of(triangles: &[(u32, [[Point3; 3]; 2])]) -> Self;
}

/// x, y or z: where they begin in [`Points`]. An enum, so that the compiler knows there is no fourth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(crate) enum Axis {
    X,
    Y = PACKET,
    Z = 2 * PACKET,
}

impl Axis {
    /// 0, 1 or 2.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        self as usize / PACKET
    }
    /// One coordinate of eight points. PERF: an offset in numbers is part of an address, which of three arrays is not.
    #[inline(always)]
    fn of(self, points: &Points) -> &[f32; PACKET] {
        let first = self as usize;
        match flat(points)[first..first + PACKET].first_chunk() {
            Some(coordinates) => coordinates,
            None => &points[0],
        }
    }
}

/// The name of a lane that is not used.
const NOBODY: u32 = u32::MAX;

fn points(triangles: &[(u32, [[Point3; 3]; 2])], key: usize) -> [Points; 3] {
    let mut points = [[[f32::NAN; PACKET]; 3]; 3];
    for (lane, (_, keys)) in triangles.iter().enumerate() {
        for (vertex, corner) in keys[key].iter().enumerate() {
            for axis in 0..3 {
                points[vertex][axis][lane] = corner[axis];
            }
        }
    }
    points
}

fn ids(triangles: &[(u32, [[Point3; 3]; 2])]) -> [u32; PACKET] {
    std::array::from_fn(|i| triangles.get(i).map_or(NOBODY, |triangle| triangle.0))
}

#[inline(always)]
fn corner(points: &Points, lane: usize) -> Point3 {
    let lane = lane % PACKET;
    Point3::new(points[0][lane], points[1][lane], points[2][lane])
}

impl PacketRecord for Packet {
    #[inline(always)]
    fn coordinate<V: Lanes<Array = [f32; PACKET]>>(
        &self,
        token: V::Token,
        vertex: usize,
        axis: Axis,
        _: f32,
    ) -> V {
        V::load(token, axis.of(&self.vertices[vertex]))
    }
    #[inline(always)]
    fn ids(&self) -> &[u32; PACKET] {
        &self.ids
    }
    #[inline(always)]
    fn triangle(&self, lane: usize, _: f32) -> [Point3; 3] {
        let [a, b, c] = &self.vertices;
        [corner(a, lane), corner(b, lane), corner(c, lane)]
    }
    fn of(triangles: &[(u32, [[Point3; 3]; 2])]) -> Self {
        Self { vertices: points(triangles, 0), ids: ids(triangles) }
    }
}

impl PacketRecord for MovingPacket {
    /// `Segment::point` of the core, in lanes: it never leaves the box around the two ends.
    #[inline(always)]
    fn coordinate<V: Lanes<Array = [f32; PACKET]>>(
        &self,
        token: V::Token,
        vertex: usize,
        axis: Axis,
        u: f32,
    ) -> V {
        let a = V::load(token, axis.of(&self.start[vertex]));
        let b = V::load(token, axis.of(&self.end[vertex]));
        let x = a.mul(V::splat(token, 1.0 - u)).add(b.mul(V::splat(token, u)));
        x.max(a.min(b)).min(a.max(b))
    }
    #[inline(always)]
    fn ids(&self) -> &[u32; PACKET] {
        &self.ids
    }
    fn triangle(&self, lane: usize, u: f32) -> [Point3; 3] {
        let segment = durer_core::math::Segment { key: 0, u };
        std::array::from_fn(|i| segment.point(corner(&self.start[i], lane), corner(&self.end[i], lane)))
    }
    fn of(triangles: &[(u32, [[Point3; 3]; 2])]) -> Self {
        Self { start: points(triangles, 0), end: points(triangles, 1), ids: ids(triangles) }
    }
}
