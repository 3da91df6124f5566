//! Normals are those of the shapes: asked once more of the scene, and of triangles computed from their corners.
use super::{super::words, Checked, Law, angle, unit};
use crate::{
    math::Vector3,
    probe::{TreeHit, TreeNode},
};

/// Largest angle between normals that are the same, in radians.
const SAME: f64 = 0.01;

impl Checked<'_> {
    /// Whether the normal of a hit is wrong.
    pub(super) fn normals(&mut self, index: usize, node: &TreeNode, hit: &TreeHit) -> bool {
        let scene = &self.prepared.scene;
        let name = self.name(hit);
        let surface = scene.surface(&node.path.ray, &hit.hit).1;
        let [told, true_one] = [hit.n_g, surface.n_g].map(|n| unit(Vector3::from(n)));
        let shading = unit(Vector3::from(hit.n_s));
        let off = angle(told, true_one);
        let degrees = words::degrees(off);
        let text = if off > std::f64::consts::PI - SAME {
            format!(
                "the normal of \"{name}\" at ray {index} is flipped: it points to the inside of the shape, \
                 180 degrees off"
            )
        } else if off > SAME {
            format!("the normal of \"{name}\" at ray {index} is not that of the shape: {degrees} degrees off")
        } else if let Some(off) = off_triangle(hit) {
            format!(
                "the normal of \"{name}\" at ray {index} stands {} degrees off the normal of its triangle",
                words::degrees(off)
            )
        } else if told.dot(shading) < 0.0 {
            format!(
                "the shading normal of \"{name}\" at ray {index} points to the other side than its true normal: \
                 {} degrees apart",
                words::degrees(angle(told, shading))
            )
        } else if hit.from_outside != (true_one.dot(-unit(node.d)) > 0.0) {
            let (said, is) = if hit.from_outside { ("outside", "inside") } else { ("inside", "outside") };
            format!("ray {index} is said to meet \"{name}\" from the {said}, but it comes from the {is}")
        } else {
            return false;
        };
        self.add(Law::Normal, index, &name, text);
        true
    }
}

/// How far the normal is off the line perpendicular to the triangle, if it is; `None` also for slivers, whose normal
/// single precision cannot tell.
fn off_triangle(hit: &TreeHit) -> Option<f64> {
    let [a, b, c] = hit.triangle?.map(crate::math::Point3::to_f64);
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let longest = ab.length().max(ac.length()).max((c - b).length());
    let size = [a, b, c].into_iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
    let height = normal.length() / longest;
    if height <= 1e-4 * size.max(longest) {
        return None;
    }
    let n = unit(Vector3::from(hit.n_g));
    let off = angle(n, normal);
    let off = off.min(std::f64::consts::PI - off);
    (off > SAME).then_some(off)
}
