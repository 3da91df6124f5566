//! A tree whose triangles, shapes or instances have moved: leaves are written anew, boxes follow from the leaves up. The
//! tree keeps its form, and with it costs more the further things have moved apart.
use std::ops::Range;

use durer_core::math::{Bounds3, Point3};
use rayon::prelude::*;

use super::subject::{Part, Stretch, slackened};
use crate::{
    grow,
    layout::{Link, MovingNode, MovingPacket, Node, NodeWriter, Packet, PacketRecord, Target},
    slab::extent,
    tree::{Tree, Trees, rows_of},
};

/// What has changed in a tree.
pub(super) struct Changes<'a> {
    /// Triangles, and the numbers by which the tree knows them.
    pub(super) triangles: Option<(&'a Part<'a>, Range<u32>)>,
    /// The new box of a shape or an instance; `None` if it has not changed.
    pub(super) shapes: &'a (dyn Fn(Target) -> Option<Bounds3> + Sync),
    /// Box around everything finite, for a tree without nodes.
    pub(super) whole: Bounds3,
}

/// Brings tree number `at` up to date; `width` is that of its nodes.
pub(super) fn refit(trees: &mut Trees, at: usize, width: usize, changes: &Changes<'_>) {
    match (trees, width) {
        (Trees::Still(tree), 16) => refit_as::<Node<16>, Packet>(tree, changes, false),
        (Trees::Still(tree), _) => refit_as::<Node<8>, Packet>(tree, changes, false),
        (Trees::Moving { trees, .. }, 16) => {
            refit_as::<MovingNode<16>, MovingPacket>(&mut trees[at], changes, true);
        }
        (Trees::Moving { trees, .. }, _) => {
            refit_as::<MovingNode<8>, MovingPacket>(&mut trees[at], changes, true);
        }
    }
}

fn refit_as<N: NodeWriter, R: PacketRecord>(tree: &mut Tree, changes: &Changes<'_>, moves: bool) {
    let first = tree.nodes * tree.node_rows;
    let has_packets = tree.rows() > first as usize;
    if let Some((part, ids)) = changes.triangles.as_ref().filter(|_| has_packets) {
        let packets = tree.pages.slice_mut::<R>(first);
        packets.par_iter_mut().filter(|packet| has_any(*packet, ids)).for_each(|packet| {
            *packet = rewritten(packet, part, ids);
        });
    }
    if tree.nodes == 0 {
        tree.bounds = changes.whole;
        return;
    }
    // The new boxes of nodes; `None` of those in which nothing has changed.
    let mut around: Vec<Option<Stretch>> = vec![None; tree.nodes as usize];
    let mut changed = Vec::with_capacity(N::WIDTH);
    // Children come after their parents.
    for number in (0..tree.nodes).rev() {
        let node: &N = tree.pages.get(number * tree.node_rows);
        let fresh = |link: u32| match Link(link).target() {
            Target::Node(row) => around[(row / tree.node_rows) as usize],
            _ => leaf::<R>(tree, Link(link), changes, moves),
        };
        let lanes = || (0..N::WIDTH).filter_map(|lane| Some((lane, node.lane(lane, 0.0)?)));
        changed.extend(lanes().filter_map(|(lane, (_, link))| Some((lane, link, fresh(link)?))));
        if changed.is_empty() {
            continue;
        }
        let mut all = [Bounds3::EMPTY; 2];
        let mut new = changed.iter().peekable();
        for (lane, (start, _)) in lanes() {
            let boxes = new.next_if(|(at, ..)| *at == lane).map_or_else(
                || {
                    let end = node.lane(lane, 1.0).map_or(start, |(end, _)| end);
                    [start, end].map(|[min, max]| Bounds3 { min: min.into(), max: max.into() })
                },
                |(.., boxes)| *boxes,
            );
            all = std::array::from_fn(|end| all[end].union(boxes[end]));
        }
        around[number as usize] = Some(all);
        let node: &mut N = tree.pages.get_mut(number * tree.node_rows);
        for (lane, link, boxes) in changed.drain(..) {
            node.set(lane, &boxes.map(|b| [b.min.to_array(), b.max.to_array()]), link);
        }
    }
    if let Some(all) = around[0] {
        tree.bounds = all[0].union(all[1]);
    }
}

fn has_any<R: PacketRecord>(packet: &R, ids: &Range<u32>) -> bool {
    packet.ids().iter().any(|id| ids.contains(id))
}

/// Numbers and corners of a packet's triangles at both ends of the stretch.
fn triangles<R: PacketRecord>(packet: &R) -> impl Iterator<Item = (u32, [[Point3; 3]; 2])> + '_ {
    let both = |lane: usize| [packet.triangle(lane, 0.0), packet.triangle(lane, 1.0)];
    (0..packet.len()).map(move |lane| (packet.ids()[lane], both(lane)))
}

fn rewritten<R: PacketRecord>(packet: &R, part: &Part<'_>, ids: &Range<u32>) -> R {
    let mut list = [(0, [[Point3::ZERO; 3]; 2]); grow::PACKET];
    let mut count = 0;
    for (id, old) in triangles(packet) {
        let new = ids.contains(&id).then(|| part.triangle((id - ids.start) as usize)).flatten();
        list[count] = (id, new.unwrap_or(old));
        count += 1;
    }
    R::of(&list[..count])
}

/// The box of a leaf, if something in it has changed: around whole triangles, even where the builder cut them.
fn leaf<R: PacketRecord>(tree: &Tree, link: Link, changes: &Changes<'_>, moves: bool) -> Option<Stretch> {
    let Target::Packet(row) = link.target() else {
        let own = (changes.shapes)(link.target())?;
        return Some(slackened(&[own; 2], extent(&own), moves));
    };
    let packet: &R = tree.pages.get(row);
    let (_, ids) = changes.triangles.as_ref()?;
    if !has_any(packet, ids) {
        return None;
    }
    let mut size = 0.0f32;
    let mut all = [Bounds3::EMPTY; 2];
    for (_, ends) in triangles(packet) {
        for (all, corners) in all.iter_mut().zip(ends) {
            let b = Bounds3::around(corners);
            size = size.max(extent(&b));
            *all = all.union(b);
        }
    }
    Some(slackened(&all, size, moves))
}

/// All triangles in a tree that stands still, each once.
pub(super) fn contents(tree: &Tree) -> Vec<(u32, [Point3; 3])> {
    let first = (tree.nodes * tree.node_rows) as usize;
    let rows = (first..tree.rows()).step_by(rows_of::<Packet>() as usize);
    let packets = rows.map(|row| tree.pages.get::<Packet>(row as u32));
    let mut list: Vec<_> =
        packets.flat_map(|p| triangles(p).map(|(id, [corners, _])| (id, corners))).collect();
    // The builder may have cut a triangle: then several leaves hold it.
    list.sort_by_key(|(id, _)| *id);
    list.dedup_by_key(|(id, _)| *id);
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{build::emit, build::subject::Subject, grow::Preset};

    /// Long slanted triangles among small ones.
    fn mesh(seed: u64) -> Vec<[Point3; 3]> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 23) as f32 - 1.0
        };
        let mut vector =
            |size: f32| durer_core::math::Vector3::new(next() * size, next() * size, next() * size);
        let triangle = |i: u32| {
            let long = if i.is_multiple_of(8) { 1.0 } else { 0.04 };
            let (p, d) = (Point3::ZERO + vector(1.0), vector(long));
            [p - d, p + d, p + d + vector(0.02)]
        };
        (0..1500).map(triangle).collect()
    }

    fn numbered(list: &[[Point3; 3]]) -> Part<'static> {
        Part::Loose((10..).zip(list.iter().copied()).collect())
    }

    #[test]
    fn boxes_contain_whole_triangles_even_where_they_were_cut() {
        let (first, second) = (mesh(1), mesh(2));
        let subject = Subject::new(vec![numbered(&first)], false);
        let mut tree = emit::tree::<Node<8>, Packet>(&subject, Preset::High).expect("within limits");
        let lanes = |tree: &Tree| {
            let first = (tree.nodes * tree.node_rows) as usize;
            let rows = (first..tree.rows()).step_by(rows_of::<Packet>() as usize);
            rows.map(|row| tree.pages.get::<Packet>(row as u32).len()).sum::<usize>()
        };
        assert!(lanes(&tree) > first.len(), "nothing was cut: the test means nothing");
        let held = |list: &[[Point3; 3]]| -> Vec<_> { (10..).zip(list.iter().copied()).collect() };
        assert_eq!(contents(&tree), held(&first));
        let part = numbered(&second);
        let triangles = Some((&part, 10..10 + second.len() as u32));
        refit_as::<Node<8>, Packet>(
            &mut tree,
            &Changes { triangles, shapes: &|_| None, whole: Bounds3::EMPTY },
            false,
        );
        assert_eq!(contents(&tree), held(&second));
        let mut leaves = 0;
        for number in 0..tree.nodes {
            let node: &Node<8> = tree.pages.get(number * tree.node_rows);
            for ([min, max], link) in (0..8).filter_map(|lane| node.lane(lane, 0.0)) {
                let Target::Packet(row) = Link(link).target() else { continue };
                let b = Bounds3 { min: min.into(), max: max.into() };
                let packet: &Packet = tree.pages.get(row);
                assert!(self::triangles(packet).all(|(_, [t, _])| t.into_iter().all(|p| b.contains(p))));
                leaves += 1;
            }
        }
        assert!(leaves > second.len() / 8, "{leaves}");
    }
}
