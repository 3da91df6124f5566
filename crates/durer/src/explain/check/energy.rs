//! No more light leaves a surface than arrives, and all light is a number, not below 0.
use super::{super::words, Checked, Law};
use crate::{
    probe::{RayKind, TreeNode},
    spectrum::Spectrum,
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
                words::lanes(&self.tree.basis, node.result)
            );
            self.add(Law::Energy, index, "not a number", text);
        }
        let parts = [("radiance", node.result), ("own light", node.local), ("weight", node.weight)];
        for (what, value) in parts {
            let lowest = lanes(value).into_iter().fold(f64::INFINITY, f64::min);
            if lowest < 0.0 {
                let text = format!(
                    "the {what} of ray {index} is negative: {}",
                    words::lanes(&self.tree.basis, value)
                );
                self.add(Law::Energy, index, what, text);
            }
        }
        if let Some(hit) = &node.hit {
            let sharp = |kind| matches!(kind, RayKind::Reflection | RayKind::Refraction);
            let sum = self.below(index).filter(|(_, child)| sharp(child.kind)).fold(
                Spectrum::BLACK,
                |sum, (_, child)| {
                    // One wavelength stands for all from here on.
                    let stands_for = child.path.is_collapsed && !node.path.is_collapsed;
                    sum + child.share(node) * if stands_for { 0.25 } else { 1.0 }
                },
            );
            // Lanes that get differently far in what floats share its rays: of them more or less than all arrives here.
            let way = node.floating.as_ref().map_or(Spectrum::ONE, |floating| floating.weight);
            let sum = sum.zip(way, |sum, way| if way > 0.0 { sum / way } else { sum });
            let most = lanes(sum).into_iter().fold(0.0, f64::max);
            if most > 1.0 + TOLERANCE {
                let name = self.name(hit);
                let text = format!(
                    "\"{name}\" reflects and transmits more than it gets: the weights of its rays sum to {}",
                    words::lanes(&self.tree.basis, sum)
                );
                self.add(Law::Energy, index, &name, text);
            }
        }
    }
}

fn lanes(s: Spectrum) -> [f64; 4] {
    s.lanes().map(f64::from)
}
