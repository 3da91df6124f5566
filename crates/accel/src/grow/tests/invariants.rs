//! Checks a tree against its contract.
use durer_core::math::{Bounds3, Point3};

use super::{
    super::{Child, DEPTH_MAX, PACKET, Primitives, WideTree},
    meshes::Mesh,
};

impl WideTree {
    pub(super) fn children_of(&self, node: u32) -> &[Child] {
        let node = node as usize;
        &self.children[self.nodes[node] as usize..self.nodes[node + 1] as usize]
    }
}

fn inside(inner: &Bounds3, outer: &Bounds3) -> bool {
    outer.contains(inner.min) && outer.contains(inner.max)
}

/// Panics unless `tree` keeps the promises of `grow` over a mesh.
pub(super) fn check(tree: &WideTree, mesh: &Mesh, width: usize) {
    let mut boxes = vec![Vec::new(); mesh.len()];
    for child in tree.children.iter().filter(|c| c.count > 0) {
        let leaf = &tree.order[child.first as usize..][..child.count as usize];
        assert!(leaf.len() == 1 || leaf.iter().all(|&p| mesh.packs(p)) && leaf.len() <= PACKET, "{leaf:?}");
        leaf.iter().for_each(|&prim| boxes[prim as usize].push(child.bounds));
    }
    for (prim, boxes) in boxes.iter().enumerate() {
        match boxes.as_slice() {
            [] => panic!("{prim} is in no leaf"),
            [one] => assert!(inside(&mesh.bounds(prim as u32), one), "{prim} sticks out of its leaf"),
            many => assert!(covered(&mesh.triangles[prim], many), "a part of {prim} is in no leaf"),
        }
    }
    assert_eq!(tree.order.len(), boxes.iter().map(Vec::len).sum::<usize>(), "each entry is in one leaf");
    check_nodes(tree, width);
}

/// Whether many points of a triangle each lie in a box, but for their own rounding.
fn covered(triangle: &[Point3; 3], boxes: &[Bounds3]) -> bool {
    let size = triangle.iter().flat_map(|p| p.to_array()).fold(0f32, |m, x| m.max(x.abs()));
    let slack = 1e-15 * f64::from(size);
    let lies_in = |b: &Bounds3, p: [f64; 3]| {
        (0..3).all(|a| f64::from(b.min[a]) - slack <= p[a] && p[a] <= f64::from(b.max[a]) + slack)
    };
    let mut points = (0..=24).flat_map(|i| (0..=24 - i).map(move |j| [i, j, 24 - i - j]));
    points.all(|weights| {
        let at = |a: usize| (0..3).map(|k| f64::from(triangle[k][a]) * f64::from(weights[k]) / 24.0).sum();
        let point = [at(0), at(1), at(2)];
        boxes.iter().any(|b| lies_in(b, point))
    })
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
