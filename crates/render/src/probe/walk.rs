//! The boxes that a ray was tested against, from the nodes that it entered.
//!
//! A walk tests all boxes of a node at once and enters those it meets, the nearest first, and those that it has put aside
//! when it comes back to them. A box counts as hit if its node was entered, or if the ray meets it before its end.
use std::collections::HashMap;

use durer_accel::{Accel, GeometryId, Held};
use durer_core::math::{Bounds3, Ray, Transform};

use super::{BoxTest, TreeNode};

/// What the kernel told of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// It entered a node.
    Node(u32),
    /// It was tested against a primitive of an instance.
    Primitive(u32),
}

/// A tree that is walked: of the whole scene, or of an instance.
struct Frame {
    /// Whose; `None` for the scene's.
    instance: Option<u32>,
    render_from_tree: Transform,
    /// The ray in the tree's space.
    ray: Ray,
    /// Edges from the scene's root, of nodes that may be entered.
    depths: HashMap<u32, u32>,
    /// Where in the list the boxes of these nodes stand.
    places: HashMap<u32, usize>,
}

impl Frame {
    fn new(instance: Option<u32>, render_from_tree: Transform, ray: &Ray) -> Self {
        let own = instance.map(|_| render_from_tree.inverse().ray(ray));
        let ray = own.unwrap_or(*ray);
        Self { instance, render_from_tree, ray, depths: HashMap::new(), places: HashMap::new() }
    }
}

/// The boxes of all nodes that `node` entered, those of a node one after another, in the order in which nodes were entered.
pub(super) fn boxes(accel: &Accel, node: &TreeNode, steps: &[Step]) -> Vec<BoxTest> {
    let mut ray = node.path.ray;
    if let Some(hit) = &node.hit {
        ray.t_max = hit.hit.t;
    }
    let mut walk = Walk {
        accel,
        ray,
        scene: Frame::new(None, Transform::IDENTITY, &ray),
        inside: None,
        holders: Vec::new(),
        tests: Vec::new(),
    };
    for (index, step) in steps.iter().enumerate() {
        if let Step::Node(entered) = step {
            walk.enter(*entered, &steps[index + 1..]);
        }
    }
    walk.tests
}

struct Walk<'a> {
    accel: &'a Accel,
    ray: Ray,
    scene: Frame,
    /// The instance whose tree is walked.
    inside: Option<Frame>,
    /// Instances in boxes that the ray met, and the depth of these.
    holders: Vec<(u32, u32)>,
    tests: Vec<BoxTest>,
}

impl Walk<'_> {
    fn enter(&mut self, entered: u32, later: &[Step]) {
        let (geometry, boxes) = self.accel.child_boxes(entered, self.ray.time);
        if let Some(geometry) = geometry {
            let is_known = self.inside.as_ref().is_some_and(|frame| frame.depths.contains_key(&entered));
            if !is_known {
                self.inside = self.instance(geometry, later).map(|(instance, depth)| {
                    let placed = self.accel.instance_transform(instance, self.ray.time);
                    let mut frame = Frame::new(Some(instance), placed, &self.ray);
                    frame.depths.insert(entered, depth);
                    frame
                });
            }
        }
        let frame = match (geometry, &mut self.inside) {
            (None, _) => &mut self.scene,
            (Some(_), Some(frame)) => frame,
            // Nothing tells whose it is.
            (Some(_), None) => return,
        };
        if let Some(test) = frame.places.get(&entered).and_then(|&place| self.tests.get_mut(place)) {
            test.hit = true;
        }
        let depth = frame.depths.get(&entered).map_or(0, |depth| depth + 1);
        for child in boxes {
            let hit = meets(&child.bounds, &frame.ray);
            match child.holds {
                Held::Node(node) => {
                    frame.depths.insert(node, depth);
                    frame.places.insert(node, self.tests.len());
                }
                Held::Instance(instance) if hit => self.holders.push((instance, depth)),
                Held::Instance(_) | Held::Primitives => {}
            }
            let bounds = match frame.instance {
                None => child.bounds,
                Some(_) => Bounds3::around(child.bounds.corners().map(|p| frame.render_from_tree.point(p))),
            };
            self.tests.push(BoxTest { bounds: [bounds.min, bounds.max], depth, hit });
        }
    }

    /// The instance whose tree of this geometry the ray begins to walk, and the depth of the box that holds it: the one
    /// whose primitives are tested next, else the first whose box was met.
    fn instance(&mut self, geometry: GeometryId, later: &[Step]) -> Option<(u32, u32)> {
        let is_of = |instance: u32| self.accel.instance_geometry(instance) == geometry;
        let tested = later.iter().find_map(|step| match step {
            Step::Primitive(instance) if is_of(*instance) => Some(*instance),
            _ => None,
        });
        let place = self.holders.iter().position(|(instance, _)| tested == Some(*instance));
        let place = place.or_else(|| self.holders.iter().position(|(instance, _)| is_of(*instance)));
        match place {
            Some(place) => Some(self.holders.remove(place)),
            None => tested.map(|instance| (instance, 0)),
        }
    }
}

/// Whether the ray meets a box, by the slab method; rounding may let it miss one that it touches.
fn meets(bounds: &Bounds3, ray: &Ray) -> bool {
    let (mut near, mut far) = (ray.t_min, ray.t_max);
    let [o, d] = [ray.o.to_array(), ray.d.to_array()];
    let [min, max] = [bounds.min.to_array(), bounds.max.to_array()];
    for axis in 0..3 {
        let planes = [min[axis], max[axis]].map(|plane| (plane - o[axis]) / d[axis]);
        if d[axis] == 0.0 {
            if o[axis] < min[axis] || o[axis] > max[axis] {
                return false;
            }
            continue;
        }
        near = near.max(planes[0].min(planes[1]));
        far = far.min(planes[0].max(planes[1]));
    }
    near <= far
}
