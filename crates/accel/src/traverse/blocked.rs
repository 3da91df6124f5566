//! The walk to any hit: no order, no distances, gone at the first.
use super::{Cx, Kernel, Level, leaf::Leaves};
use crate::{
    layout::{BoxNode, Link, MovingPacket, Packet, PacketRecord, Target},
    probe::Watch,
    simd::{Slots, Stack},
    space::enter_space,
    tree::{Tree, Trees},
};

/// Whether anything in a tree is hit with `t` up to `t_max`.
#[inline(always)]
pub(crate) fn blocked<K: Kernel, W: Watch, const ROBUST: bool>(
    kernel: K,
    cx: &Cx<'_>,
    level: &Level<'_>,
    t_max: f32,
    watch: &mut W,
) -> bool {
    enter_space!(space, ROBUST, level.ray, level.region());
    let (mut forest, mut movers) = (level.forest, level.movers);
    loop {
        let tree = forest.tree(level.ray.time);
        let at = (level, &space);
        let is_blocked = match &forest.trees {
            Trees::Still(_) => {
                let mut leaves = Leaves::<K, Packet, W, ROBUST>::new(kernel, cx, at, tree, watch);
                walk::<K, K::Node, Packet, W, ROBUST>(kernel, tree.0, &mut leaves, t_max)
            }
            Trees::Moving { .. } => {
                let mut leaves = Leaves::<K, MovingPacket, W, ROBUST>::new(kernel, cx, at, tree, watch);
                walk::<K, K::Moving, MovingPacket, W, ROBUST>(kernel, tree.0, &mut leaves, t_max)
            }
        };
        match movers.take() {
            Some(next) if !is_blocked => forest = next,
            _ => return is_blocked,
        }
    }
}

#[inline(always)]
fn walk<K: Kernel, N: BoxNode<K::Boxes>, R: PacketRecord, W: Watch, const ROBUST: bool>(
    kernel: K,
    tree: &Tree,
    leaves: &mut Leaves<'_, K, R, W, ROBUST>,
    t_max: f32,
) -> bool {
    for &link in &tree.unbounded {
        if leaves.blocked(link, t_max) {
            return true;
        }
    }
    let Some(mut link) = tree.root else { return false };
    let (ray, shift) = leaves.box_ray();
    let end = t_max + shift;
    let mut slots = Slots::new();
    let mut stack = Stack::new(&mut slots);
    loop {
        if let Target::Node(row) = link.target() {
            if W::ACTIVE {
                leaves.watch.node(tree.name(row));
            }
            let node: &N = tree.pages.get(row);
            let (mut hit, _) = ray.enter(kernel, node, end);
            if hit != 0 {
                link = Link(node.link(hit.trailing_zeros()));
                kernel.prefetch(tree.pages.address(link));
                hit &= hit - 1;
                while hit != 0 {
                    let other = Link(node.link(hit.trailing_zeros()));
                    kernel.prefetch(tree.pages.address(other));
                    stack.push(u64::from(other.0));
                    hit &= hit - 1;
                }
                continue;
            }
        } else if leaves.blocked(link, t_max) {
            return true;
        }
        let Some(top) = stack.pop() else { return false };
        link = Link(top as u32);
    }
}
