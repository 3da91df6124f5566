//! The pixel is the sum of what its rays bring, and a ray's share is the product of the weights on the way to it.
use super::{super::words, Checked, Law};
use crate::spectrum::Spectrum;

/// The same numbers, or none both.
fn is_same(a: Spectrum, b: Spectrum) -> bool {
    let [a, b] = [a, b].map(Spectrum::lanes);
    a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan() || a == b)
}

impl Checked<'_> {
    /// Every result is the local part and what the children bring, in their order, bit for bit.
    pub(super) fn sums(&mut self) {
        let nodes = &self.tree.nodes;
        let mut wrong = Vec::new();
        for (index, node) in nodes.iter().enumerate() {
            let folded = self.below(index).fold(node.local, |sum, (_, c)| sum + c.weight * c.result);
            if !is_same(folded, node.result) {
                let (is, should) =
                    (words::lanes(&self.tree.basis, node.result), words::lanes(&self.tree.basis, folded));
                let text = format!(
                    "ray {index} is said to bring {is}, but its own light and what its children bring sum to {should}"
                );
                wrong.push((index, "result", text));
            }
            if let Some(parent) = node.parent.and_then(|p| nodes.get(p as usize)) {
                let share = parent.throughput * node.weight;
                if !is_same(share, node.throughput) {
                    let (is, should) = (
                        words::lanes(&self.tree.basis, node.throughput),
                        words::lanes(&self.tree.basis, share),
                    );
                    let text = format!(
                        "ray {index} is said to have a share of {is} in the pixel, but the weights on the way to it \
                         make {should}"
                    );
                    wrong.push((index, "share", text));
                }
            }
        }
        for (index, about, text) in wrong {
            self.add(Law::Sum, index, about, text);
        }
    }
}
