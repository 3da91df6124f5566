//! The walk to the first hit: nearest child first, the others put aside with where the ray enters them.
use super::{Best, Cx, Kernel, Level, leaf::Leaves};
use crate::{
    lanes::Lanes,
    layout::{BoxNode, Link, MovingPacket, Packet, PacketRecord, Target},
    probe::Watch,
    simd::{Slots, Stack},
    space::enter_space,
    tree::{Tree, Trees},
};

/// Offers the hits in a tree to `best`.
#[inline(always)]
pub(crate) fn nearest<K: Kernel, W: Watch, const ROBUST: bool>(
    kernel: K,
    cx: &Cx<'_>,
    level: &Level<'_>,
    best: &mut Best,
    watch: &mut W,
) {
    enter_space!(space, ROBUST, level.ray, level.region());
    let (mut forest, mut movers) = (level.forest, level.movers);
    loop {
        let tree = forest.tree(level.ray.time);
        let at = (level, &space);
        match &forest.trees {
            Trees::Still(_) => {
                let mut leaves = Leaves::<K, Packet, W, ROBUST>::new(kernel, cx, at, tree, watch);
                walk::<K, K::Node, Packet, W, ROBUST>(kernel, tree.0, &mut leaves, best);
            }
            Trees::Moving { .. } => {
                let mut leaves = Leaves::<K, MovingPacket, W, ROBUST>::new(kernel, cx, at, tree, watch);
                walk::<K, K::Moving, MovingPacket, W, ROBUST>(kernel, tree.0, &mut leaves, best);
            }
        }
        let Some(next) = movers.take() else { return };
        forest = next;
    }
}

/// Where a ray enters a box, and the box: sorts by the first. PERF: a sort in integer registers lets the processor guess
/// the next node while it goes on; one in vector registers does not (bench kernel).
#[inline(always)]
fn entry(near: f32, link: u32) -> u64 {
    u64::from(near.to_bits()) << 32 | u64::from(link)
}

#[inline(always)]
fn walk<K: Kernel, N: BoxNode<K::Boxes>, R: PacketRecord, W: Watch, const ROBUST: bool>(
    kernel: K,
    tree: &Tree,
    leaves: &mut Leaves<'_, K, R, W, ROBUST>,
    best: &mut Best,
) {
    for &link in &tree.unbounded {
        leaves.nearest(link, best);
    }
    let Some(mut link) = tree.root else { return };
    let (ray, shift) = leaves.box_ray();
    let mut nears = <K::Boxes as Lanes>::ZEROS;
    let mut slots = Slots::new();
    let mut stack = Stack::new(&mut slots);
    loop {
        if let Target::Node(row) = link.target() {
            if W::ACTIVE {
                leaves.watch.node(tree.name(row));
            }
            let node: &N = tree.pages.get(row);
            let (mut hit, near) = ray.enter(kernel, node, best.t + shift);
            if hit != 0 {
                let first = hit.trailing_zeros();
                hit &= hit - 1;
                link = Link(node.link(first));
                if hit == 0 {
                    continue;
                }
                kernel.prefetch(tree.pages.address(link));
                near.store(&mut nears);
                link = put_aside(kernel, tree, node, &nears, (first, hit), &mut stack);
                continue;
            }
        } else {
            leaves.nearest(link, best);
        }
        link = loop {
            let Some(top) = stack.pop() else { return };
            // A nearer hit may have been found since this was put aside.
            if f32::from_bits((top >> 32) as u32) <= best.t + shift {
                break Link(top as u32);
            }
        };
    }
}

/// Two or more children are entered: all but the nearest go onto the stack, the nearest of them on top.
#[inline(always)]
fn put_aside<K: Kernel, N: BoxNode<K::Boxes>>(
    kernel: K,
    tree: &Tree,
    node: &N,
    nears: &<K::Boxes as Lanes>::Array,
    (first, mut hit): (u32, u32),
    stack: &mut Stack<'_>,
) -> Link {
    let child = |lane: u32| entry(nears.as_ref()[lane as usize], node.link(lane));
    let a = child(first);
    let second = hit.trailing_zeros();
    hit &= hit - 1;
    let b = child(second);
    kernel.prefetch(tree.pages.address(Link(b as u32)));
    if hit == 0 {
        if b < a {
            stack.push(a);
            return Link(b as u32);
        }
        stack.push(b);
        return Link(a as u32);
    }
    let mut nearest = a;
    if b < a {
        stack.push(a);
        nearest = b;
    } else {
        stack.push(b);
    }
    let mut count = 1;
    loop {
        let lane = hit.trailing_zeros();
        hit &= hit - 1;
        let c = child(lane);
        kernel.prefetch(tree.pages.address(Link(c as u32)));
        if c < nearest {
            stack.push(nearest);
            nearest = c;
        } else {
            stack.insert(c, count);
        }
        count += 1;
        if hit == 0 {
            return Link(nearest as u32);
        }
    }
}
