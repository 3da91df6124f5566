//! The ray tree of one sample, and what can be told from it.
use durer_core::spectrum::{Basis, Spectrum};

use super::TreeNode;
use crate::film::Developing;

/// Number of a node in its [`RayTree`]; none for the eye ray's parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeId(pub(super) Option<u32>);

/// Where in the picture, when and through which point of the lens a sample was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeEye {
    /// Place in the picture, in pixels from its upper left corner.
    pub film: [f32; 2],
    /// Point of the lens, in metres from its centre; `None` for pinholes.
    pub lens: Option<[f32; 2]>,
    /// Moment, in seconds.
    pub time: f32,
    /// What the sample counts in the pixel, by the filter: may be negative. 1 with adaptive antialiasing, where areas
    /// count.
    pub filter_weight: f32,
    /// What the camera makes of the radiance that arrives: 1 unless a lens of glass or the film's speed count.
    pub gain: f32,
    /// What the film makes of that.
    pub developing: Developing,
}

/// What is recorded beside what is always.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detail {
    /// Rays traced at most; those beyond are given up ([`super::StopReason::Cancelled`]), and the sample is wrong.
    pub rays: usize,
    /// Rays, the first ones, whose boxes are recorded.
    pub walks: usize,
    /// Whether time is measured: it is never the same twice.
    pub clock: Clock,
}

/// Whether time is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clock {
    /// Not at all.
    #[default]
    Off,
    /// From each ray's announcement to its result.
    On,
}

impl Default for Detail {
    fn default() -> Self {
        Self { rays: usize::MAX, walks: 0, clock: Clock::Off }
    }
}

/// The rays of one sample, parents before children, in the order they were announced.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayTree {
    /// The nodes; ids are indices.
    pub nodes: Vec<TreeNode>,
    /// What the lanes of their spectra mean.
    pub basis: Basis,
    /// Where the eye ray comes from; `None` for trees that begin at another ray.
    pub eye: Option<TreeEye>,
    /// The node that an infinite or NaN value comes from, if there is one: the first whose own part or weight is, while
    /// what its children bring is not.
    pub bad: Option<u32>,
}

impl RayTree {
    /// The children of each node, in recorded order.
    pub fn children(&self) -> Vec<Vec<u32>> {
        let mut children: Vec<Vec<u32>> = vec![Vec::new(); self.nodes.len()];
        for (index, node) in (0..).zip(&self.nodes) {
            if let Some(siblings) = node.parent.and_then(|parent| children.get_mut(parent as usize)) {
                siblings.push(index);
            }
        }
        children
    }

    /// The radiance of the pixel sample, computed again from the leaves: `local` plus weight times result of each child, in
    /// recorded order. Equals the recorded result bit for bit.
    pub fn fold(&self) -> Spectrum {
        let mut results: Vec<Spectrum> = self.nodes.iter().map(|n| n.local).collect();
        // A parent's sum must run over its children from first to last, and each child must be finished before.
        for (index, children) in self.children().iter().enumerate().rev() {
            for &child in children {
                let added = self.nodes[child as usize].weight * results[child as usize];
                results[index] += added;
            }
        }
        results.first().copied().unwrap_or(Spectrum::BLACK)
    }

    /// The part of the tree from a node on, with ids from 0.
    #[must_use]
    pub fn below(&self, id: u32) -> Self {
        let mut numbers: Vec<Option<u32>> = vec![None; self.nodes.len()];
        let mut nodes = Vec::new();
        for (index, node) in (0..).zip(&self.nodes) {
            let parent = node.parent.and_then(|parent| numbers[parent as usize]);
            if index == id || parent.is_some() {
                numbers[index as usize] = Some(nodes.len() as u32);
                nodes.push(TreeNode { parent, ..node.clone() });
            }
        }
        Self { nodes, ..self.clone() }
    }

    /// See [`RayTree::bad`].
    pub(super) fn first_bad(&self) -> Option<u32> {
        let brought = |child: u32| {
            let child = &self.nodes[child as usize];
            child.weight * child.result
        };
        let children = self.children();
        let is_source = |(index, node): &(u32, &TreeNode)| {
            let own = node.weight * node.result;
            let children = &children[*index as usize];
            !own.is_finite() && children.iter().all(|&child| brought(child).is_finite())
        };
        (0..).zip(&self.nodes).find(is_source).map(|(index, _)| index)
    }

    /// The shares in the pixel of all rays that were given up, together. Times the largest radiance in the scene it bounds
    /// what they would have brought.
    pub fn killed(&self) -> Spectrum {
        self.nodes.iter().fold(Spectrum::BLACK, |sum, node| sum + node.lost)
    }

    /// The largest lane of any ray's radiance, the light of shadow rays included, also of those that were given up.
    /// Infinite and NaN ones do not count.
    pub fn max_radiance(&self) -> f32 {
        let of = |node: &TreeNode| match &node.light {
            Some(light) if !node.is_traced() => light.unoccluded.max(),
            _ => node.result.max(),
        };
        self.nodes.iter().map(of).filter(|v| v.is_finite()).fold(0.0, f32::max)
    }

    /// What the pixel lacks at most because rays were given up: their shares times what they could have brought. That is
    /// what a light sends, else `brightest`, the largest radiance in the scene ([`crate::Scene::brightest`]): what this
    /// tree has seen tells nothing of what it has not.
    pub fn lost_bound(&self, brightest: f32) -> Spectrum {
        let of = |node: &TreeNode| match &node.light {
            _ if node.lost.is_black() => Spectrum::BLACK,
            Some(light) => node.lost * light.unoccluded,
            None => node.lost * brightest,
        };
        self.nodes.iter().fold(Spectrum::BLACK, |sum, node| sum + of(node))
    }

    /// Whether rays were given up that lead to no light: what they could have brought is known of the scene only.
    pub fn is_cut(&self) -> bool {
        self.nodes.iter().any(|node| node.light.is_none() && !node.lost.is_black())
    }
}
