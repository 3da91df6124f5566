//! The account of bodies: what a ray enters it is in until it leaves it.
use super::{Checked, Law};
use crate::{
    Id, MediumStack,
    model::Medium,
    probe::{NoProbe, RayKind, TreeHit, TreeNode},
};

/// Surfaces looked at along a line.
const MOST_SURFACES: usize = 64;

fn count(stack: &MediumStack, medium: Id<Medium>) -> usize {
    stack.iter().filter(|id| *id == medium).count()
}

impl Checked<'_> {
    pub(super) fn media(&mut self, index: usize, node: &TreeNode, hit: &TreeHit) {
        let scene = &self.prepared.scene;
        let Some(shading) = &node.shading else { return };
        let Some(medium) = scene.media.of_material(self.object(hit).material) else { return };
        // Ray casting knows no bodies.
        if self.children[index].is_empty() && shading.media.is_none() {
            return;
        }
        let name = self.name(hit);
        let before = node.path.media;
        let after = shading.media.map(|m| m.after).unwrap_or_default();
        let (was_in, is_in) = (count(&before, medium), count(&after, medium));
        if !hit.from_outside && was_in == 0 {
            let why = self.why_unentered(node, hit);
            let text = format!("ray {index} leaves \"{name}\" without having entered it: {why}");
            self.add(Law::Media, index, &name, text);
            return;
        }
        let has_priority = scene.media.get(medium).priority.is_some();
        let should = if hit.from_outside { was_in + 1 } else { was_in - 1 };
        // Where bodies with priorities touch, several surfaces are crossed at once.
        if !has_priority && is_in != should && before.iter().count() < MediumStack::CAPACITY {
            let verb = if hit.from_outside { "enters" } else { "leaves" };
            let text = format!(
                "ray {index} {verb} \"{name}\", but behind its surface it counts as {} of its kind instead of {should}",
                inside(is_in)
            );
            self.add(Law::Media, index, &name, text);
            return;
        }
        let wrong: Vec<_> = self
            .below(index)
            .filter(|(_, child)| child.is_traced())
            .filter(|(_, child)| match child.kind {
                RayKind::Refraction | RayKind::GlossyRefraction => child.path.media != after,
                RayKind::Reflection | RayKind::GlossyReflection => {
                    !has_priority && child.path.media != before
                }
                _ => false,
            })
            .map(|(number, child)| (number, child.kind.word()))
            .collect();
        for (number, kind) in wrong {
            let text = format!(
                "the {kind} ray {number} that leaves \"{name}\" starts in other bodies than lie on its side of the surface"
            );
            self.add(Law::Media, number, &name, text);
        }
    }

    /// Whether the surface is turned inside out, or open: a body that is turned inside out is left by its outside, further
    /// along the line of the ray.
    fn why_unentered(&self, node: &TreeNode, hit: &TreeHit) -> String {
        let scene = &self.prepared.scene;
        let cx = crate::SampleCx { scene, basis: self.tree.basis };
        let name = self.name(hit);
        let time = node.path.ray.time;
        let mut ray = scene.surface(&node.path.ray, &hit.hit).1.spawn(node.d, time);
        let mut later = Vec::new();
        for _ in 0..MOST_SURFACES {
            let Some(next) = scene.closest(&cx, &ray, &mut NoProbe, ()) else { break };
            let (object, surface) = scene.surface(&ray, &next);
            if object == hit.object {
                later.push(surface.is_outside(-ray.d));
            }
            ray = surface.spawn(ray.d, time);
        }
        if later.first() == Some(&true) && later.len() % 2 == 1 {
            format!(
                "behind it the ray would come to the outside of \"{name}\", so its surface is turned inside out"
            )
        } else {
            format!("the surface of \"{name}\" is open, or the ray began inside of it unawares")
        }
    }
}

fn inside(n: usize) -> String {
    if n == 1 { "inside 1 body".to_owned() } else { format!("inside {n} bodies") }
}
