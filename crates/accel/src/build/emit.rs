//! From a grown tree to memory that walks read.
use durer_core::math::{Bounds3, Point3};
use rayon::prelude::*;

use super::subject::{Stretch, Subject, Triangle, around, slackened};
use crate::{
    BuildError,
    grow::{self, Child, Preset, Primitives, WideTree},
    layout::{Link, NodeWriter, PacketRecord, Target},
    simd::{Pages, ROW},
    slab::{extent, greater},
    tree::{Tree, rows_of},
};

/// Subtrees of fewer nodes than this are written by one thread.
const SHARED: usize = 256;

/// Grows a tree over `subject` and lays it out.
pub(crate) fn tree<N: NodeWriter, R: PacketRecord>(
    subject: &Subject<'_>,
    preset: Preset,
) -> Result<Tree, BuildError> {
    let wide = grow::grow(subject, N::WIDTH, preset);
    lay_out::<N, R>(subject, &wide)
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
    let plan =
        Plan { subject, wide, node_rows, packet_rows: rows_of::<R>(), packets: packets(subject, wide) };
    let rows =
        nodes as u64 * u64::from(node_rows) + u64::from(plan.packets[nodes]) * u64::from(plan.packet_rows);
    if rows > u64::from(Link::LIMIT) {
        let limit = (Link::LIMIT as usize * ROW) >> 30;
        return Err(BuildError::TreeTooLarge { primitives: subject.len(), gigabytes: limit });
    }
    let mut pages = Pages::zeroed(rows as usize);
    let (records, packets) = pages.split_mut::<N, R>(nodes);
    let written = plan.write(Subtree { name: 0, nodes: records, packets });
    let bounds = written.boxes[0].union(written.boxes[1]);
    let root = Some(Link::new(Target::Node(0)));
    let is_cut = wide.order.len() != subject.len();
    let depth = written.levels;
    let sole = match wide.children.as_slice() {
        [only] if only.count == 1 && !is_packet(subject, wide, only) => {
            match subject.link(wide.order[only.first as usize]).target() {
                Target::Item(item) => Some(item),
                _ => None,
            }
        }
        _ => None,
    };
    Ok(Tree { pages, root, sole, nodes: nodes as u32, node_rows, is_cut, bounds, depth, ..Tree::empty() })
}

/// How many packets lie in front of those below each node, then how many there are.
fn packets(subject: &Subject<'_>, wide: &WideTree) -> Vec<u32> {
    let mut total = 0;
    let mut counted = 0;
    let before = wide.nodes.iter().map(|&end| {
        let more = &wide.children[counted..end as usize];
        counted = end as usize;
        total += more.iter().filter(|child| is_packet(subject, wide, child)).count() as u32;
        total
    });
    before.collect()
}

/// Whether a child is a leaf of triangles.
fn is_packet(subject: &Subject<'_>, wide: &WideTree, child: &Child) -> bool {
    child.count > 0 && subject.packs(wide.order[child.first as usize])
}

/// Where everything goes.
struct Plan<'a> {
    subject: &'a Subject<'a>,
    wide: &'a WideTree,
    node_rows: u32,
    packet_rows: u32,
    /// See [`packets`].
    packets: Vec<u32>,
}

/// A node, which is the first of `nodes`, and all below it.
struct Subtree<'a, N, R> {
    name: u32,
    nodes: &'a mut [N],
    packets: &'a mut [R],
}

fn put<N: NodeWriter>(record: &mut N, lane: usize, boxes: &Stretch, link: Link) {
    record.set(lane, &boxes.map(|b| [b.min.to_array(), b.max.to_array()]), link.0);
}

fn joined(a: &Stretch, b: &Stretch) -> Stretch {
    [a[0].union(b[0]), a[1].union(b[1])]
}

/// What is known of a subtree when it is written.
struct Written {
    boxes: Stretch,
    levels: u32,
}

impl Plan<'_> {
    /// The row of a packet.
    fn row(&self, packet: u32) -> u32 {
        (self.packets.len() as u32 - 1) * self.node_rows + packet * self.packet_rows
    }

    /// The children of a node.
    fn children(&self, name: u32) -> &[Child] {
        &self.wide.children
            [self.wide.nodes[name as usize] as usize..self.wide.nodes[name as usize + 1] as usize]
    }

    /// Writes a subtree.
    fn write<N: NodeWriter, R: PacketRecord>(&self, subtree: Subtree<'_, N, R>) -> Written {
        let Subtree { name, nodes, mut packets } = subtree;
        let all = nodes.len();
        let Some((record, mut nodes)) = nodes.split_first_mut() else { unreachable!("a subtree has a node") };
        *record = N::EMPTY;
        let mut boxes = self.leaves(name, record, &mut packets);
        let children = self.children(name);
        let mut inner = children.iter().enumerate().filter(|(_, child)| child.count == 0).peekable();
        let mut below = Vec::with_capacity(children.len());
        while let Some((lane, child)) = inner.next() {
            // Subtrees lie one behind the other.
            let end = inner.peek().map_or(name + all as u32, |(_, next)| next.first);
            let count = self.packets[end as usize] - self.packets[child.first as usize];
            let nodes = nodes.split_off_mut(..(end - child.first) as usize);
            let packets = packets.split_off_mut(..count as usize);
            let (nodes, packets) = nodes.zip(packets).expect("as many records as were counted");
            below.push((lane, Subtree { name: child.first, nodes, packets }));
        }
        let write = |(lane, subtree)| (lane, self.write(subtree));
        let written: Vec<(usize, Written)> = match all >= SHARED {
            true => below.into_par_iter().map(write).collect(),
            false => below.into_iter().map(write).collect(),
        };
        let mut levels = 0;
        for (lane, written) in written {
            levels = levels.max(written.levels);
            let link = Link::new(Target::Node(children[lane].first * self.node_rows));
            put(record, lane, &written.boxes, link);
            boxes = joined(&boxes, &written.boxes);
        }
        Written { boxes, levels: levels + 1 }
    }

    /// Writes the leaves of a node; returns the box around them.
    #[inline(never)]
    fn leaves<N: NodeWriter, R: PacketRecord>(
        &self,
        name: u32,
        record: &mut N,
        packets: &mut &mut [R],
    ) -> Stretch {
        let leaves = || self.children(name).iter().enumerate().filter(|(_, child)| child.count > 0);
        let mut around: Stretch = [Bounds3::EMPTY; 2];
        let Some((_, first)) = leaves().next() else { return around };
        // PERF: all of them together, so that memory is waited for once (bench kernel, build).
        let mut triangles = [(0, [[Point3::ZERO; 3]; 2]); grow::WIDEST * grow::PACKET];
        let count = leaves().map(|(_, child)| child.count).sum::<u32>();
        let prims = &self.wide.order[first.first as usize..(first.first + count) as usize];
        self.subject.triangles(prims, &mut triangles);
        let mut packet = self.packets[name as usize];
        for (lane, child) in leaves() {
            let at = (child.first - first.first) as usize;
            let (boxes, link) = if self.subject.packs(prims[at]) {
                let triangles = &triangles[at..at + child.count as usize];
                let place = packets.split_off_first_mut().expect("as many packets as were counted");
                *place = R::of(triangles);
                packet += 1;
                (self.leaf(child, triangles), Link::new(Target::Packet(self.row(packet - 1))))
            } else {
                let own = self.subject.boxes(prims[at]);
                let size = extent(&own[0]).max(extent(&own[1]));
                let own = if self.subject.moves { own } else { [child.bounds; 2] };
                (slackened(&own, size, self.subject.moves), self.subject.link(prims[at]))
            };
            put(record, lane, &boxes, link);
            around = joined(&around, &boxes);
        }
        around
    }

    /// The box of a leaf of triangles is that of its fragments, with the slack of the whole triangles.
    fn leaf(&self, child: &Child, triangles: &[Triangle]) -> Stretch {
        let moves = self.subject.moves;
        let mut size = 0.0f32;
        let mut all: Stretch = [Bounds3::EMPTY; 2];
        for (_, corners) in triangles {
            for end in 0..=usize::from(moves) {
                let b = around(&corners[end]);
                size = greater(size, extent(&b));
                if moves {
                    all[end] = all[end].union(b);
                }
            }
        }
        slackened(&if moves { all } else { [child.bounds; 2] }, size, moves)
    }
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
