//! The recorder: the ray tree of one sample.
use durer_accel::{Hit, TraversalProbe};
use durer_core::{
    Id,
    math::{Normal3, Point3, Vector3},
    spectrum::Spectrum,
};
use durer_model::Surface;

use super::{LightEvent, Probe, RayKind, StopReason};
use crate::{Object, PathRay};

/// Number of a node in its [`RayTree`]; none for the eye ray's parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeId(Option<u32>);

/// Where a ray met a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeHit {
    /// What was hit.
    pub object: Id<Object>,
    /// Ray parameter, instance, primitive and barycentrics.
    pub hit: Hit,
    /// The point, in render space.
    pub p: Point3,
    /// Geometric normal.
    pub n_g: Normal3,
    /// Shading normal.
    pub n_s: Normal3,
    /// Surface coordinates.
    pub uv: [f32; 2],
    /// The ray came from the outside.
    pub from_outside: bool,
}

/// One ray.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeNode {
    /// The ray it was spawned by.
    pub parent: Option<u32>,
    /// What it is for.
    pub kind: RayKind,
    /// Bounces before it.
    pub depth: u32,
    /// Origin, in render space.
    pub o: Point3,
    /// Direction; for shadow rays of lights at a place its length is the distance.
    pub d: Vector3,
    /// What the parent multiplies the result with.
    pub weight: Spectrum,
    /// Share in the pixel.
    pub throughput: Spectrum,
    /// Radiance from no other ray.
    pub local: Spectrum,
    /// The ray's radiance.
    pub result: Spectrum,
    /// Where it met a surface.
    pub hit: Option<TreeHit>,
    /// What a shadow ray found out.
    pub light: Option<LightEvent>,
    /// Why nothing follows.
    pub stop: Option<StopReason>,
    /// Share in the pixel that an untraced ray would have had.
    pub lost: Spectrum,
    /// Boxes tested.
    pub node_tests: u32,
    /// Primitives tested.
    pub primitive_tests: u32,
}

impl TreeNode {
    /// What this ray itself adds to the pixel: the contributions of all nodes sum to the pixel, up to rounding.
    pub fn contribution(&self) -> Spectrum {
        self.throughput * self.local
    }
    /// Ray length, in metres: to the hit, or to the light.
    pub fn length(&self) -> Option<f32> {
        match (&self.hit, &self.light) {
            (Some(hit), _) => Some(hit.hit.t * self.d.length()),
            (None, Some(light)) if light.visible && light.point.is_some() => Some(self.d.length()),
            _ => None,
        }
    }
}

/// The rays of one sample, parents before children, in the order they were announced.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayTree {
    /// The nodes; ids are indices.
    pub nodes: Vec<TreeNode>,
}

impl RayTree {
    fn node(&mut self, id: NodeId) -> &mut TreeNode {
        let index = id.0.map_or(0, |i| i as usize);
        &mut self.nodes[index]
    }

    /// The pixel sample, computed again from the leaves: `local` plus weight times result of each child, in recorded
    /// order. Equals the recorded result bit for bit.
    pub fn fold(&self) -> Spectrum {
        let mut results: Vec<Spectrum> = self.nodes.iter().map(|n| n.local).collect();
        // A parent's sum must run over its children from first to last, and each child must be finished before.
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            if let Some(parent) = node.parent {
                children[parent as usize].push(index);
            }
        }
        for index in (0..self.nodes.len()).rev() {
            for &child in &children[index] {
                let added = self.nodes[child].weight * results[child];
                results[index] += added;
            }
        }
        results.first().copied().unwrap_or(Spectrum::BLACK)
    }
}

impl TraversalProbe for RayTree {
    type Id = NodeId;
    fn node(&mut self, id: NodeId, _: u32) {
        RayTree::node(self, id).node_tests += 1;
    }
    fn primitive(&mut self, id: NodeId, _: u32, _: u32) {
        RayTree::node(self, id).primitive_tests += 1;
    }
}

impl Probe for RayTree {
    const RECORDS: bool = true;

    fn ray(&mut self, parent: NodeId, ray: &PathRay, kind: RayKind) -> NodeId {
        self.nodes.push(TreeNode {
            parent: parent.0,
            kind,
            depth: ray.depth,
            o: ray.ray.o,
            d: ray.ray.d,
            weight: ray.weight,
            throughput: ray.throughput,
            local: Spectrum::BLACK,
            result: Spectrum::BLACK,
            hit: None,
            light: None,
            stop: None,
            lost: Spectrum::BLACK,
            node_tests: 0,
            primitive_tests: 0,
        });
        NodeId(Some(self.nodes.len() as u32 - 1))
    }
    fn surface(&mut self, id: NodeId, object: Id<Object>, hit: &Hit, surface: &Surface) {
        let node = RayTree::node(self, id);
        node.hit = Some(TreeHit {
            object,
            hit: *hit,
            p: surface.p,
            n_g: surface.n_g,
            n_s: surface.n_s,
            uv: [surface.uv.x, surface.uv.y],
            from_outside: surface.is_outside(-node.d),
        });
    }
    fn light(&mut self, id: NodeId, event: &LightEvent) {
        RayTree::node(self, id).light = Some(*event);
    }
    fn local(&mut self, id: NodeId, radiance: Spectrum) {
        RayTree::node(self, id).local = radiance;
    }
    fn stop(&mut self, id: NodeId, reason: StopReason, lost: Spectrum) {
        let node = RayTree::node(self, id);
        node.stop = Some(reason);
        node.lost = lost;
    }
    fn result(&mut self, id: NodeId, radiance: Spectrum) {
        RayTree::node(self, id).result = radiance;
    }
}
