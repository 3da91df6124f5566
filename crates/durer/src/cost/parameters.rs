//! Cost from parameters alone, where every ray meets something and every hit branches alike: a tree of `depth` bounces and
//! `branches` children has `(b^(d + 1) - 1) / (b - 1)` rays.
use durer_render::probe::{RayKind, RayTree, TreeNode};

use crate::Prepared;

/// A tree in which nothing is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FullTree {
    /// Rays that follow each hit.
    pub branches: u32,
    /// Bounces.
    pub depth: u32,
    /// Shadow rays of each hit.
    pub shadow_rays: u32,
}

impl FullTree {
    /// Rays without shadow rays; infinite if a float cannot hold it.
    pub fn rays(self) -> f64 {
        (0..=self.depth).map(|k| f64::from(self.branches).powi(k as i32)).sum()
    }

    /// The tree that all of these pixels' first samples have; `None` if they differ, or if something is missing in one.
    pub(super) fn of(prepared: &Prepared, pixels: &[[u32; 2]]) -> Option<Self> {
        let depth = prepared.integrator.facts().depth_limit?;
        let mut trees = pixels.iter().map(|&pixel| Self::recorded(&prepared.job().record(pixel, 0).0, depth));
        let first = trees.next()??;
        trees.all(|tree| tree == Some(first)).then_some(first)
    }

    fn recorded(tree: &RayTree, depth: u32) -> Option<Self> {
        let traced = |node: &&TreeNode| node.stop.is_none_or(|stop| !stop.is_untraced());
        let mut children = vec![(0u32, 0u32); tree.nodes.len()];
        for node in tree.nodes.iter().filter(traced) {
            if let Some(parent) = node.parent {
                let (branches, shadows) = &mut children[parent as usize];
                *(if node.kind == RayKind::Shadow { shadows } else { branches }) += 1;
            }
        }
        let (branches, shadow_rays) = *children.first()?;
        let is_full = |(node, &(b, s)): (&TreeNode, &(u32, u32))| {
            node.kind == RayKind::Shadow
                || node.stop.is_some_and(|stop| stop.is_untraced())
                || (node.hit.is_some()
                    && s == shadow_rays
                    && b == if node.depth < depth { branches } else { 0 })
        };
        tree.nodes.iter().zip(&children).all(is_full).then_some(Self { branches, depth, shadow_rays })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_trees_have_the_rays_of_the_formula_i17() {
        for (depth, rays) in [(0, 1.0), (3, 15.0), (5, 63.0), (8, 511.0)] {
            assert_eq!(FullTree { branches: 2, depth, shadow_rays: 0 }.rays(), rays);
        }
        assert_eq!(FullTree { branches: 1, depth: 7, shadow_rays: 0 }.rays(), 8.0);
        assert_eq!(FullTree { branches: 0, depth: 7, shadow_rays: 3 }.rays(), 1.0);
    }
}
