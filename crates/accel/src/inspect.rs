//! Looking at trees box by box, for pictures of what a ray went through.
use durer_core::math::{Bounds3, Segment};

use crate::{
    Accel, GeometryId,
    layout::{Link, MovingNode, Node, NodeWriter, Target},
    tree::{Tree, Trees},
};

/// A box that a node holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChildBox {
    /// In the space of the node's tree.
    pub bounds: Bounds3,
    /// What lies in it.
    pub holds: Held,
}

/// What lies in a box of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// Another node of the same tree, by its name.
    Node(u32),
    /// Primitives.
    Primitives,
    /// An instance.
    Instance(u32),
}

impl Accel {
    /// The boxes of a node named by a probe, as they are at `time` seconds, and whose tree it belongs to: `None` for the
    /// trees of the whole scene. No boxes if there is no such node.
    pub fn child_boxes(&self, bvh_node: u32, time: f32) -> (Option<GeometryId>, Vec<ChildBox>) {
        let inside = |tree: &Tree| (tree.base..tree.base + tree.nodes).contains(&bvh_node);
        let Some((geometry, forest, tree)) = self.trees().find(|(_, _, tree)| inside(tree)) else {
            return (None, Vec::new());
        };
        let index = bvh_node - tree.base;
        let boxes = match (&forest.trees, self.registers.width()) {
            (Trees::Still(_), 16) => boxes::<Node<16>>(tree, index, 0.0),
            (Trees::Still(_), _) => boxes::<Node<8>>(tree, index, 0.0),
            (Trees::Moving { times, .. }, width) => {
                let at = Segment::at(time, times.len(), |i| times[i]).u;
                match width {
                    16 => boxes::<MovingNode<16>>(tree, index, at),
                    _ => boxes::<MovingNode<8>>(tree, index, at),
                }
            }
        };
        (geometry, boxes)
    }
}

fn boxes<N: NodeWriter>(tree: &Tree, index: u32, at: f32) -> Vec<ChildBox> {
    let node: &N = tree.pages.get(index * tree.node_rows);
    let lanes = (0..N::WIDTH).filter_map(|lane| node.lane(lane, at));
    let held = |link: u32| match Link(link).target() {
        Target::Node(row) => Held::Node(tree.name(row)),
        Target::Packet(_) | Target::Item(_) => Held::Primitives,
        Target::Instance(instance) => Held::Instance(instance),
    };
    lanes
        .map(|([min, max], link)| ChildBox {
            bounds: Bounds3 { min: min.into(), max: max.into() },
            holds: held(link),
        })
        .collect()
}
