//! What follows from a ray tree as documented: who follows whom, and the sample's value.
use super::{
    document::{Node, Tree},
    number::{Place, plain},
};
use crate::film::Developing;

impl Node {
    /// True if the ray was given up before it was traced.
    pub fn is_untraced(&self) -> bool {
        crate::probe::StopReason::ALL
            .iter()
            .any(|s| s.is_untraced() && self.stop.as_deref() == Some(s.word()))
    }
    /// Where the ray ends: at its hit or light; `None` if it leaves the scene or was not traced.
    pub fn end(&self) -> Option<Place> {
        let light = self.light.as_ref().filter(|l| l.visible);
        self.point.or(light.and_then(|l| l.point))
    }
}

impl Tree {
    /// The children of every node, in their order.
    pub fn children(&self) -> Vec<Vec<usize>> {
        let mut children = vec![Vec::new(); self.nodes.len()];
        for (id, node) in self.nodes.iter().enumerate() {
            if let Some(siblings) = node.parent.and_then(|p| children.get_mut(p as usize)) {
                siblings.push(id);
            }
        }
        children
    }
    /// The sample's value, folded from the leaves: `local` plus weight times result of each child, in order, in single
    /// precision; times `gain`, times `clamp`, and then `balance`d. The bits of `rgb` for radiance.
    pub fn fold(&self) -> [f32; 3] {
        let gain = self.gain.map_or(1.0, |gain| gain.0);
        let clamp = self.clamp.map_or(1.0, |clamp| clamp.0);
        let balance = self.balance.map(|rows| rows.map(plain));
        Developing { clamp, balance }.of(self.radiance().map(|v| v * gain))
    }
    fn radiance(&self) -> [f32; 3] {
        match &self.lane_weights {
            None => self.folded(|node| (node.weight.map(|v| v.0), node.local.map(|v| v.0))),
            Some(weights) => {
                let lanes = self.folded(|node| {
                    let lanes = node.lanes.unwrap_or_default();
                    (lanes.weight.map(|v| v.0), lanes.local.map(|v| v.0))
                });
                let mut rgb = [0.0; 3];
                for (lane, weights) in lanes.into_iter().zip(weights) {
                    rgb.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += lane * weight.0);
                }
                rgb
            }
        }
    }
    fn folded<const N: usize>(&self, of: impl Fn(&Node) -> ([f32; N], [f32; N])) -> [f32; N] {
        let children = self.children();
        let mut sums: Vec<[f32; N]> = self.nodes.iter().map(|n| of(n).1).collect();
        for parent in (0..self.nodes.len()).rev() {
            for &child in &children[parent] {
                let (weight, result) = (of(&self.nodes[child]).0, sums[child]);
                (0..N).for_each(|i| sums[parent][i] += weight[i] * result[i]);
            }
        }
        sums.first().copied().unwrap_or([0.0; N])
    }
}
