//! No more light leaves a surface than arrives, and all light is a number, not below 0.
use super::{super::words, Checked, Law};
use crate::{
    probe::{RayKind, TreeNode},
    spectrum::{Basis, Spectrum},
};

/// Rounding, and what single precision leaves of equations that keep all light.
const TOLERANCE: f64 = 1e-3;

impl Checked<'_> {
    pub(super) fn energy(&mut self, index: usize, node: &TreeNode) {
        let is_first = node.parent.is_none();
        if self.tree.bad == Some(index as u32)
            || (self.tree.bad.is_none() && is_first && !node.result.is_finite())
        {
            let text = format!(
                "ray {index} brings {}: here an infinite or undefined number comes into the pixel",
                words::light(node.result)
            );
            self.add(Law::Energy, index, "not a number", text);
        }
        let parts = [("radiance", node.result), ("own light", node.local), ("weight", node.weight)];
        for (what, value) in parts {
            let lowest = lanes(value).into_iter().fold(f64::INFINITY, f64::min);
            if lowest < 0.0 {
                let text = format!("the {what} of ray {index} is negative: {}", words::light(value));
                self.add(Law::Energy, index, what, text);
            }
        }
        if let Some(hit) = &node.hit {
            let sharp = |kind| matches!(kind, RayKind::Reflection | RayKind::Refraction);
            let sum = self
                .below(index)
                .filter(|(_, child)| sharp(child.kind))
                .fold(Spectrum::BLACK, |sum, (_, child)| sum + child.share(node));
            let most = lanes(sum).into_iter().fold(0.0, f64::max);
            if most > 1.0 + TOLERANCE {
                let name = self.name(hit);
                let text = format!(
                    "\"{name}\" reflects and transmits more than it gets: the weights of its rays sum to {}",
                    words::light(sum)
                );
                self.add(Law::Energy, index, &name, text);
            }
        }
    }
}

fn lanes(s: Spectrum) -> [f64; 3] {
    Basis::Rgb.to_rgb(s).map(f64::from)
}
