//! Checks a tree against its contract.
use durer_core::math::Bounds3;

use super::super::{Child, DEPTH_MAX, PACKET, Primitives, WideTree};

impl WideTree {
    pub(super) fn children_of(&self, node: u32) -> &[Child] {
        let node = node as usize;
        &self.children[self.nodes[node] as usize..self.nodes[node + 1] as usize]
    }
}

fn inside(inner: &Bounds3, outer: &Bounds3) -> bool {
    outer.contains(inner.min) && outer.contains(inner.max)
}

/// Panics unless `tree` keeps the promises of `grow` over `prims` that are not cut.
pub(super) fn check(tree: &WideTree, prims: &impl Primitives, width: usize) {
    let mut seen = vec![0u32; prims.len()];
    for child in tree.children.iter().filter(|c| c.count > 0) {
        let leaf = &tree.order[child.first as usize..][..child.count as usize];
        assert!(leaf.len() == 1 || leaf.iter().all(|&p| prims.packs(p)) && leaf.len() <= PACKET, "{leaf:?}");
        for &prim in leaf {
            seen[prim as usize] += 1;
            assert!(inside(&prims.bounds(prim), &child.bounds), "{prim} sticks out of its leaf");
        }
    }
    assert!(seen.iter().all(|&times| times == 1), "each primitive lies in one leaf");
    assert_eq!(tree.order.len(), prims.len());
    check_nodes(tree, width);
}

/// The part of `check` that is about nodes.
pub(super) fn check_nodes(tree: &WideTree, width: usize) {
    assert_eq!(tree.nodes.last().copied(), Some(tree.children.len() as u32), "an end mark");
    let mut pending = vec![(0u32, 1u32)];
    let mut next = 0;
    while let Some((node, level)) = pending.pop() {
        assert_eq!(node, next, "nodes are numbered depth first");
        next += 1;
        assert!(level <= DEPTH_MAX, "level {level}");
        let children = tree.children_of(node);
        assert!(!children.is_empty() && children.len() <= width, "{} children", children.len());
        for child in children.iter().rev().filter(|c| c.count == 0) {
            let below = tree.children_of(child.first);
            assert!(below.iter().all(|c| inside(&c.bounds, &child.bounds)), "a grandchild sticks out");
            pending.push((child.first, level + 1));
        }
    }
    assert_eq!(next as usize + 1, tree.nodes.len(), "all nodes are below the root");
}

/// Expected visits of nodes and packets for a ray that meets the whole.
pub(super) fn sah_cost(tree: &WideTree) -> f64 {
    let area = |b: &Bounds3| {
        let [x, y, z] = [0, 1, 2].map(|a| f64::from(b.max[a]) - f64::from(b.min[a]));
        x * y + y * z + z * x
    };
    let all = tree.children_of(0).iter().fold(Bounds3::EMPTY, |b, c| b.union(c.bounds));
    1.0 + tree.children.iter().map(|c| area(&c.bounds)).sum::<f64>() / area(&all)
}
