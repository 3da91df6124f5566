//! A set of registers, and the walks compiled for it.
use wide::f32x8;

use super::{Best, Cx, Level, blocked, nearest};
use crate::{
    lanes::{Lanes, Portable},
    layout::{BoxNode, MovingNode, Node, NodeWriter, PACKET},
    probe::Watch,
};

/// A token of the processor's abilities, with what to do with them.
pub(crate) trait Kernel: Copy {
    /// As many lanes as a node has children.
    type Boxes: Lanes<Token = Self>;
    /// As many lanes as a packet has triangles.
    type Packets: Lanes<Token = Self, Array = [f32; PACKET]>;
    type Node: BoxNode<Self::Boxes> + NodeWriter;
    type Moving: BoxNode<Self::Boxes> + NodeWriter;

    /// Offers the hits in a tree to `best`.
    fn nearest<W: Watch, const ROBUST: bool>(
        self,
        cx: &Cx<'_>,
        level: &Level<'_>,
        best: &mut Best,
        watch: &mut W,
    );
    /// Whether anything in a tree is hit with `t` up to `t_max`.
    fn blocked<W: Watch, const ROBUST: bool>(
        self,
        cx: &Cx<'_>,
        level: &Level<'_>,
        t_max: f32,
        watch: &mut W,
    ) -> bool;
    /// Asks for the first lines of a record, soon to be read.
    fn prefetch(self, address: *const u8);
}

impl Kernel for Portable {
    type Boxes = f32x8;
    type Packets = f32x8;
    type Node = Node<8>;
    type Moving = MovingNode<8>;

    fn nearest<W: Watch, const ROBUST: bool>(
        self,
        cx: &Cx<'_>,
        level: &Level<'_>,
        best: &mut Best,
        watch: &mut W,
    ) {
        nearest::<Self, W, ROBUST>(self, cx, level, best, watch);
    }
    fn blocked<W: Watch, const ROBUST: bool>(
        self,
        cx: &Cx<'_>,
        level: &Level<'_>,
        t_max: f32,
        watch: &mut W,
    ) -> bool {
        blocked::<Self, W, ROBUST>(self, cx, level, t_max, watch)
    }
    #[inline(always)]
    fn prefetch(self, _: *const u8) {}
}
