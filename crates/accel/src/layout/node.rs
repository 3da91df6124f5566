//! Nodes: the boxes of `N` children, plane by plane.
use crate::{
    lanes::Lanes,
    simd::{Record, flat},
};

/// `N` boxes. An empty lane has its lower planes at infinity and its upper ones at minus infinity: no ray enters it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Node<const N: usize> {
    /// By axis, then lower or upper.
    planes: [[[f32; N]; 2]; 3],
    links: [u32; N],
}

/// The lower planes, or the upper ones if `side` is `N`.
#[inline(always)]
fn planes_at<const N: usize>(planes: &[[f32; N]; 2], side: usize) -> &[f32; N] {
    // PERF: an offset in numbers is part of an address; which of two arrays is two instructions more (bench kernel).
    let side = side & N;
    match flat(planes)[side..side + N].first_chunk() {
        Some(planes) => planes,
        None => &planes[0],
    }
}

/// `N` boxes that move: their planes at the start of a stretch of time, and how far they go until its end.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct MovingNode<const N: usize> {
    planes: [[[f32; N]; 2]; 3],
    ways: [[[f32; N]; 2]; 3],
    links: [u32; N],
}

/// How walks read nodes.
pub(crate) trait BoxNode<V: Lanes>: Record {
    /// The planes of an axis at the fraction `u` of the stretch: the lower ones, or the upper ones if `side` is the
    /// number of lanes.
    fn plane(&self, token: V::Token, axis: usize, side: usize, u: V) -> V;
    /// What a lane holds.
    fn link(&self, lane: u32) -> u32;
}

impl<const N: usize, V: Lanes<Array = [f32; N]>> BoxNode<V> for Node<N>
where
    Self: Record,
{
    #[inline(always)]
    fn plane(&self, token: V::Token, axis: usize, side: usize, _: V) -> V {
        V::load(token, planes_at(&self.planes[axis], side))
    }
    #[inline(always)]
    fn link(&self, lane: u32) -> u32 {
        self.links[lane as usize % N]
    }
}

impl<const N: usize, V: Lanes<Array = [f32; N]>> BoxNode<V> for MovingNode<N>
where
    Self: Record,
{
    #[inline(always)]
    fn plane(&self, token: V::Token, axis: usize, side: usize, u: V) -> V {
        let way = V::load(token, planes_at(&self.ways[axis], side));
        way.fused(u, V::load(token, planes_at(&self.planes[axis], side)))
    }
    #[inline(always)]
    fn link(&self, lane: u32) -> u32 {
        self.links[lane as usize % N]
    }
}

/// How all planes of a node are read at once.
pub(crate) trait NodePlanes<const N: usize>: Record {
    /// By axis, then lower or upper, at the fraction `u` of the stretch.
    fn planes(&self, u: f32) -> [[[f32; N]; 2]; 3];
    /// What the lanes hold.
    fn links(&self) -> &[u32; N];
}

impl<const N: usize> NodePlanes<N> for Node<N>
where
    Self: Record,
{
    #[inline(always)]
    fn planes(&self, _: f32) -> [[[f32; N]; 2]; 3] {
        self.planes
    }
    #[inline(always)]
    fn links(&self) -> &[u32; N] {
        &self.links
    }
}

impl<const N: usize> NodePlanes<N> for MovingNode<N>
where
    Self: Record,
{
    fn planes(&self, u: f32) -> [[[f32; N]; 2]; 3] {
        let mut planes = self.planes;
        for (planes, ways) in planes.iter_mut().flatten().zip(self.ways.iter().flatten()) {
            planes.iter_mut().zip(ways).for_each(|(plane, way)| *plane += way * u);
        }
        planes
    }
    fn links(&self) -> &[u32; N] {
        &self.links
    }
}

/// How nodes are written and looked at one lane at a time. Boxes come in pairs: at the start and the end of the stretch.
pub(crate) trait NodeWriter: Record + Send + Sync {
    /// Lanes.
    const WIDTH: usize;
    /// No lane holds anything.
    const EMPTY: Self;
    /// Puts a box around something into a lane.
    fn set(&mut self, lane: usize, boxes: &[[[f32; 3]; 2]; 2], link: u32);
    /// The box of a lane at the fraction `u` of the stretch, and what it holds; `None` for an empty lane.
    fn lane(&self, lane: usize, u: f32) -> Option<([[f32; 3]; 2], u32)>;
}

impl<const N: usize> NodeWriter for Node<N>
where
    Self: Record,
{
    const WIDTH: usize = N;
    const EMPTY: Self = Self { planes: [[[f32::INFINITY; N], [f32::NEG_INFINITY; N]]; 3], links: [0; N] };

    fn set(&mut self, lane: usize, [start, end]: &[[[f32; 3]; 2]; 2], link: u32) {
        for axis in 0..3 {
            self.planes[axis][0][lane] = start[0][axis].min(end[0][axis]);
            self.planes[axis][1][lane] = start[1][axis].max(end[1][axis]);
        }
        self.links[lane] = link;
    }
    fn lane(&self, lane: usize, _: f32) -> Option<([[f32; 3]; 2], u32)> {
        let side = |s: usize| std::array::from_fn(|axis| self.planes[axis][s][lane]);
        let filled = lane < N && self.planes[0][0][lane] <= self.planes[0][1][lane];
        filled.then(|| ([side(0), side(1)], self.links[lane]))
    }
}

impl<const N: usize> NodeWriter for MovingNode<N>
where
    Self: Record,
{
    const WIDTH: usize = N;
    const EMPTY: Self = Self {
        planes: [[[f32::INFINITY; N], [f32::NEG_INFINITY; N]]; 3],
        ways: [[[0.0; N]; 2]; 3],
        links: [0; N],
    };

    fn set(&mut self, lane: usize, [start, end]: &[[[f32; 3]; 2]; 2], link: u32) {
        for axis in 0..3 {
            for side in 0..2 {
                self.planes[axis][side][lane] = start[side][axis];
                self.ways[axis][side][lane] = end[side][axis] - start[side][axis];
            }
        }
        self.links[lane] = link;
    }
    fn lane(&self, lane: usize, u: f32) -> Option<([[f32; 3]; 2], u32)> {
        let plane = |axis: usize, s: usize| self.planes[axis][s][lane] + self.ways[axis][s][lane] * u;
        let side = |s: usize| std::array::from_fn(|axis| plane(axis, s));
        let filled = lane < N && self.planes[0][0][lane] <= self.planes[0][1][lane];
        filled.then(|| ([side(0), side(1)], self.links[lane]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_have_the_size_they_were_designed_for() {
        assert_eq!((size_of::<Node<8>>(), size_of::<Node<16>>()), (7 * 32, 7 * 64));
        assert_eq!((size_of::<MovingNode<8>>(), size_of::<MovingNode<16>>()), (13 * 32, 13 * 64));
    }

    #[test]
    fn lanes_keep_their_boxes_and_empty_ones_have_none() {
        let mut node = Node::<8>::EMPTY;
        node.set(3, &[[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], [[0.0, 2.0, 3.0], [4.0, 7.0, 6.0]]], 9);
        assert_eq!(node.lane(3, 0.0), Some(([[0.0, 2.0, 3.0], [4.0, 7.0, 6.0]], 9)));
        assert_eq!((node.lane(2, 0.0), node.lane(8, 0.0)), (None, None));
    }
}
