//! Cost from parameters alone, where every hit branches alike: a tree of `depth` bounces in which each hit has `b` rays that
//! hit again and `e` that leave the scene has `h(d) = (b^(d + 1) - 1) / (b - 1)` hits and `h(d) + e h(d - 1)` rays.
use durer_render::probe::{RayKind, RayTree, TreeNode};

use crate::Prepared;

/// A tree in which nothing is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FullTree {
    /// Rays that follow each hit, and hit something.
    pub branches: u32,
    /// Rays that follow each hit, and leave the scene: two in all before a glass plate, of which one stays within.
    pub escapes: u32,
    /// Bounces.
    pub depth: u32,
    /// Shadow rays of each hit.
    pub shadow_rays: u32,
}

/// What follows a ray.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct Children {
    hits: u32,
    escapes: u32,
    shadows: u32,
}

impl FullTree {
    /// Rays without shadow rays; infinite if a float cannot hold it.
    pub fn rays(self) -> f64 {
        let within = self.depth.checked_sub(1).map_or(0.0, |depth| self.hits(depth));
        self.hits(self.depth) + f64::from(self.escapes) * within
    }
    /// Shadow rays.
    pub fn rays_to_lights(self) -> f64 {
        f64::from(self.shadow_rays) * self.hits(self.depth)
    }
    fn hits(self, depth: u32) -> f64 {
        (0..=depth).map(|k| f64::from(self.branches).powi(k as i32)).sum()
    }

    /// The tree that all of these pixels' first samples have; `None` if they differ, or if something is missing in one.
    pub(super) fn of(prepared: &Prepared, pixels: &[[u32; 2]]) -> Option<Self> {
        let depth = prepared.integrator.facts().depth_limit?;
        let mut trees = pixels.iter().map(|&pixel| Self::recorded(&prepared.job().record(pixel, 0).0, depth));
        let first = trees.next()??;
        trees.all(|tree| tree == Some(first)).then_some(first)
    }

    fn recorded(tree: &RayTree, depth: u32) -> Option<Self> {
        let is_traced = |node: &TreeNode| node.stop.is_none_or(|stop| !stop.is_untraced());
        let mut children = vec![Children::default(); tree.nodes.len()];
        for node in tree.nodes.iter().filter(|node| is_traced(node)) {
            if let Some(parent) = node.parent {
                let count = &mut children[parent as usize];
                *match (node.kind, node.hit) {
                    (RayKind::Shadow, _) => &mut count.shadows,
                    (_, Some(_)) => &mut count.hits,
                    (_, None) => &mut count.escapes,
                } += 1;
            }
        }
        let root = tree.nodes.first().filter(|node| node.hit.is_some())?;
        let each = *children.first()?;
        let expected = |node: &TreeNode| match node.hit {
            None => Children::default(),
            Some(_) if node.depth < depth => each,
            Some(_) => Children { hits: 0, escapes: 0, ..each },
        };
        let is_full = |(node, &own): (&TreeNode, &Children)| {
            node.kind == RayKind::Shadow || !is_traced(node) || own == expected(node)
        };
        let Children { hits: branches, escapes, shadows: shadow_rays } = each;
        let is_deep = root.depth < depth || (branches, escapes) == (0, 0);
        let full = tree.nodes.iter().zip(&children).all(is_full) && is_deep;
        full.then_some(Self { branches, escapes, depth, shadow_rays })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_trees_have_the_rays_of_the_formula_i17() {
        for (depth, rays) in [(0, 1.0), (3, 15.0), (5, 63.0), (8, 511.0)] {
            assert_eq!(FullTree { branches: 2, escapes: 0, depth, shadow_rays: 0 }.rays(), rays);
        }
        assert_eq!(FullTree { branches: 1, escapes: 0, depth: 7, shadow_rays: 0 }.rays(), 8.0);
        assert_eq!(FullTree { branches: 0, escapes: 0, depth: 7, shadow_rays: 3 }.rays(), 1.0);
    }
    #[test]
    fn rays_that_leave_the_scene_are_counted_but_do_not_branch() {
        let plate = FullTree { branches: 1, escapes: 1, depth: 3, shadow_rays: 2 };
        // Four hits; three of them send one ray away.
        assert_eq!((plate.rays(), plate.rays_to_lights()), (7.0, 8.0));
        assert_eq!(FullTree { depth: 0, ..plate }.rays(), 1.0);
    }
}
