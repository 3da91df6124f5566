//! From a grown tree to memory that walks read.
use durer_core::math::{Bounds3, Point3};
use rayon::prelude::*;

use super::subject::{Stretch, Subject, slackened};
use crate::{
    BuildError,
    grow::{self, Preset, Primitives, WideTree},
    layout::{Link, NodeWriter, PacketRecord, Target},
    simd::{Pages, ROW},
    slab::extent,
    tree::{Tree, rows_of},
};

/// Leaves that a task writes.
const CHUNK: usize = 1024;

/// A leaf: its box, and its packet unless it is a single thing that is not a triangle.
struct Leaf<R> {
    boxes: Stretch,
    packet: Option<R>,
}

/// Grows a tree over `subject` and lays it out.
pub(crate) fn tree<N: NodeWriter, R: PacketRecord>(
    subject: &Subject<'_>,
    preset: Preset,
) -> Result<Tree, BuildError> {
    let wide = grow::grow(subject, N::WIDTH, preset);
    lay_out::<N, R>(subject, &wide)
}

/// Memory with all packets in place, and by child the row of its packet and its box if it is a leaf.
struct Laid {
    pages: Pages,
    rows: Vec<u32>,
    boxes: Vec<Stretch>,
}

/// Writes the leaves of a tree with this many nodes.
fn leaves<N: NodeWriter, R: PacketRecord>(
    subject: &Subject<'_>,
    wide: &WideTree,
    nodes: usize,
) -> Result<Laid, BuildError> {
    let node_rows = rows_of::<N>();
    let is_packet = |first: u32| subject.packs(wide.order[first as usize]);
    // The row of each leaf's packet, by child.
    let mut row = nodes as u64 * u64::from(node_rows);
    let mut rows = Vec::with_capacity(wide.children.len());
    for child in &wide.children {
        rows.push(row as u32);
        if child.count > 0 && is_packet(child.first) {
            row += u64::from(rows_of::<R>());
        }
    }
    if row > u64::from(Link::LIMIT) {
        let limit = (Link::LIMIT as usize * ROW) >> 30;
        return Err(BuildError::TreeTooLarge { primitives: subject.len(), gigabytes: limit });
    }
    let mut pages = Pages::zeroed(row as usize);
    let mut boxes: Vec<Stretch> = vec![[Bounds3::EMPTY; 2]; wide.children.len()];
    let write = |(child, boxes): (&grow::Child, &mut Stretch)| {
        if child.count == 0 {
            return None;
        }
        let leaf: Leaf<R> = leaf(subject, wide, child);
        *boxes = leaf.boxes;
        leaf.packet
    };
    let first_packet = nodes as u32 * node_rows;
    let packets = pages.slice_mut::<R>(first_packet);
    let mut rest = packets;
    // One task for each run of children, with the packets that are theirs.
    let mut tasks = Vec::new();
    for (children, boxes) in wide.children.chunks(CHUNK).zip(boxes.chunks_mut(CHUNK)) {
        let own = children.iter().filter(|c| c.count > 0 && is_packet(c.first)).count();
        let (mine, others) = rest.split_at_mut(own);
        rest = others;
        tasks.push((children, boxes, mine));
    }
    tasks.into_par_iter().for_each(|(children, boxes, mine)| {
        let mut free = mine.iter_mut();
        for packet in children.iter().zip(boxes).filter_map(write) {
            *free.next().expect("as many packets as were counted") = packet;
        }
    });
    Ok(Laid { pages, rows, boxes })
}

fn lay_out<N: NodeWriter, R: PacketRecord>(
    subject: &Subject<'_>,
    wide: &WideTree,
) -> Result<Tree, BuildError> {
    let nodes = wide.nodes.len().saturating_sub(1);
    if nodes == 0 {
        return Ok(Tree::empty());
    }
    let node_rows = rows_of::<N>();
    let Laid { mut pages, rows, boxes } = leaves::<N, R>(subject, wide, nodes)?;
    let mut depths = vec![0u32; nodes];
    let mut depth = 0;
    let mut around: Vec<Stretch> = vec![[Bounds3::EMPTY; 2]; nodes];
    // Children come after their parents.
    for node in (0..nodes).rev() {
        let range = wide.nodes[node] as usize..wide.nodes[node + 1] as usize;
        let mut record = N::EMPTY;
        for (lane, at) in range.enumerate() {
            let child = &wide.children[at];
            let (stretch, link) = match child.count {
                0 => {
                    depths[node] = depths[node].max(depths[child.first as usize] + 1);
                    (around[child.first as usize], Link::new(Target::Node(child.first * node_rows)))
                }
                _ if subject.packs(wide.order[child.first as usize]) => {
                    (boxes[at], Link::new(Target::Packet(rows[at])))
                }
                _ => (boxes[at], subject.link(wide.order[child.first as usize])),
            };
            let planes = stretch.map(|b| [b.min.to_array(), b.max.to_array()]);
            record.set(lane, &planes, link.0);
            around[node] = std::array::from_fn(|end| around[node][end].union(stretch[end]));
        }
        depth = depth.max(depths[node]);
        *pages.get_mut(node as u32 * node_rows) = record;
    }
    let bounds = around[0][0].union(around[0][1]);
    let root = Some(Link::new(Target::Node(0)));
    let cut = cut(subject, wide, &rows);
    Ok(Tree { pages, root, nodes: nodes as u32, node_rows, cut, bounds, depth: depth + 1, ..Tree::empty() })
}

/// Rows and lanes of the triangles that lie in several leaves; `rows` are those of packets, by child.
fn cut(subject: &Subject<'_>, wide: &WideTree, rows: &[u32]) -> Vec<(u32, u32)> {
    if wide.order.len() == subject.len() {
        return Vec::new();
    }
    let mut leaves = vec![0u32; subject.len()];
    wide.order.iter().for_each(|&prim| leaves[prim as usize] += 1);
    let mut found = Vec::new();
    for (child, &row) in wide.children.iter().zip(rows) {
        // `first` of an inner node is none of `order`.
        let first = if child.count > 0 { child.first as usize } else { 0 };
        for (lane, &prim) in (0..).zip(&wide.order[first..first + child.count as usize]) {
            if std::mem::take(&mut leaves[prim as usize]) > 1 {
                found.push((row, lane));
            }
        }
    }
    found
}

/// The box of a leaf is that of its fragments, with the slack of the whole primitives.
fn leaf<R: PacketRecord>(subject: &Subject<'_>, wide: &WideTree, child: &grow::Child) -> Leaf<R> {
    let prims = &wide.order[child.first as usize..(child.first + child.count) as usize];
    let mut size = 0.0f32;
    let mut all: Stretch = [Bounds3::EMPTY; 2];
    for &prim in prims {
        let boxes = subject.boxes(prim);
        for end in 0..2 {
            size = size.max(extent(&boxes[end]));
            all[end] = all[end].union(boxes[end]);
        }
    }
    if !subject.moves {
        all = [child.bounds; 2];
    }
    let boxes = slackened(&all, size, subject.moves);
    let mut corners = [(0, [[Point3::ZERO; 3]; 2]); grow::PACKET];
    let mut count = 0;
    for triangle in prims.iter().filter_map(|&prim| subject.triangle(prim)) {
        corners[count] = triangle;
        count += 1;
    }
    let packet = (count > 0).then(|| R::of(&corners[..count]));
    Leaf { boxes, packet }
}

/// All triangles and things of `subject` in leaves without a tree, for brute force.
pub(crate) fn list<R: PacketRecord>(subject: &Subject<'_>) -> Tree {
    let total = subject.len() as u32;
    let (packed, single): (Vec<u32>, Vec<u32>) = (0..total).partition(|&prim| subject.packs(prim));
    let groups: Vec<&[u32]> = packed.chunks(grow::PACKET).collect();
    let mut pages = Pages::zeroed(groups.len() * rows_of::<R>() as usize);
    let mut leaves = Vec::with_capacity(groups.len() + single.len());
    let mut bounds = Bounds3::EMPTY;
    for prim in 0..total {
        let boxes = subject.boxes(prim);
        bounds = bounds.union(boxes[0]).union(boxes[1]);
    }
    for (group, row) in groups.iter().zip((0..).step_by(rows_of::<R>() as usize)) {
        let triangles: Vec<_> = group.iter().filter_map(|&prim| subject.triangle(prim)).collect();
        *pages.get_mut(row) = R::of(&triangles);
        leaves.push(Link::new(Target::Packet(row)));
    }
    leaves.extend(single.iter().map(|&prim| subject.link(prim)));
    // A curve in several parts is tested once.
    leaves.dedup();
    Tree { pages, leaves, bounds, ..Tree::empty() }
}
