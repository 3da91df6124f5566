//! Mirrored rays leave at the angle at which they came, in the plane of ray and normal.
use super::{super::words, Checked, Law, angle, unit};
use crate::{
    glam::DVec3,
    math::Vector3,
    probe::{RayKind, TreeHit, TreeNode},
};

/// Largest angle between directions that are the same, in radians.
const SAME: f64 = 2e-3;

impl Checked<'_> {
    pub(super) fn mirrors(&mut self, index: usize, node: &TreeNode, hit: &TreeHit) {
        let expected = mirrored(node, hit);
        let wrong: Vec<_> = self
            .below(index)
            .filter(|(_, child)| child.kind == RayKind::Reflection)
            .map(|(number, child)| (number, angle(unit(child.d), expected)))
            .filter(|(_, off)| *off > SAME)
            .collect();
        let name = self.name(hit);
        for (number, off) in wrong {
            let text = format!(
                "the mirrored ray {number} leaves \"{name}\" {} degrees off the mirror direction",
                words::degrees(off)
            );
            self.add(Law::Mirror, number, &name, text);
        }
    }
}

/// The mirror direction about the shading normal; about the true one as well if that leads into the surface.
fn mirrored(node: &TreeNode, hit: &TreeHit) -> DVec3 {
    let [n_g, n_s] = [hit.n_g, hit.n_s].map(|n| unit(Vector3::from(n)));
    let reflect = |d: DVec3, n: DVec3| d - n * (2.0 * n.dot(d));
    let d = unit(node.d);
    let mirrored = reflect(d, n_s);
    // The side that the ray came from, on which it has to stay.
    if (mirrored.dot(n_g) > 0.0) == (d.dot(n_g) < 0.0) { mirrored } else { reflect(mirrored, n_g) }
}
