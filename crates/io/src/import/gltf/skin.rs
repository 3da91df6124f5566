//! Skins: every vertex follows a weighted mean of joints (glTF 2.0, section 3.7.3.3).
//!
//! `p' = sum of w_i (W_i B_i) p` with `W_i` the joint's place in the world and `B_i` its inverse bind matrix; the place of
//! the skinned mesh's own node does not count. Normals follow the inverse transpose of the same mean. The result is kept
//! relative to the first joint, so that nothing is lost to rounding far from the origin.
use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::{Normal3, Point3},
};
use durer_scene::Mesh;
use rayon::prelude::*;

use super::{
    accessor::Accessor,
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    node::{Hierarchy, is_affine, matrix},
    stance::{Stance, Story},
};

/// Fewer vertices than this are not worth another thread.
const AT_ONCE: usize = 1 << 12;

/// The joints of a skin.
pub(super) struct Skin {
    /// What the skinned mesh is relative to.
    pub(super) anchor: DVec3,
    /// Whether the animation moves a joint, be it at this moment or not.
    pub(super) moves: bool,
    /// By moment, of which there is one if no joint moves: from the mesh at rest to the anchored pose, by joint.
    joints: Vec<Vec<DAffine3>>,
}

/// What a vertex follows: joint and weight.
pub(super) type Influences = [(u32, f32); 4];

impl Skin {
    /// The skin `element` with its joints where the nodes are at each moment.
    pub(super) fn read<'a>(
        document: &Document<'a>,
        buffers: &Buffers,
        (nodes, story): (&Hierarchy<'a>, &Story<'_>),
        element: &Element<'a>,
    ) -> Checked<Self> {
        let list = element.required("joints")?;
        let joints = list.items()?.map(|j| nodes.index(&j)).collect::<Checked<Vec<usize>>>()?;
        let Some(&first) = joints.first() else {
            return Err(list.fault("a skin needs at least one joint"));
        };
        let binds = match element.get("inverseBindMatrices")? {
            None => vec![DAffine3::IDENTITY; joints.len()],
            Some(reference) => binds(document, buffers, &reference, joints.len())?,
        };
        let stances = story.stances;
        let moves = joints.iter().any(|joint| story.moves(*joint));
        let anchor = stances.first().map_or(DVec3::ZERO, |stance| stance.world(first).translation);
        let back = DAffine3::from_translation(-anchor);
        let at = |stance: &Stance| -> Vec<DAffine3> {
            joints.iter().zip(&binds).map(|(&j, bind)| back * stance.world(j) * *bind).collect()
        };
        document.spend(&list, joints.len().saturating_mul(stances.len()), size_of::<DAffine3>())?;
        let mut joints: Vec<Vec<DAffine3>> = stances.iter().map(at).collect();
        if joints.iter().zip(joints.iter().skip(1)).all(|(a, b)| a == b) {
            joints.truncate(1);
        }
        Ok(Self { anchor, moves, joints })
    }

    /// How many joints there are.
    pub(super) fn len(&self) -> usize {
        self.at(0).len()
    }
    /// At how many moments the joints are known.
    pub(super) fn moments(&self) -> usize {
        self.joints.len()
    }
    /// The joints at a moment, by its number; the last if there are fewer.
    fn at(&self, moment: usize) -> &[DAffine3] {
        self.joints.get(moment).or(self.joints.last()).map_or(&[], Vec::as_slice)
    }

    /// Bends `mesh` as at a moment. Its vertices follow `influences`: one list per set of four, each as long as the mesh.
    pub(super) fn bend(&self, mesh: &mut Mesh, influences: &[Vec<Influences>], moment: usize) {
        let joints = self.at(moment);
        let means: Vec<DAffine3> = (0..mesh.positions.len())
            .into_par_iter()
            .with_min_len(AT_ONCE)
            .map(|vertex| mean(joints, influences.iter().filter_map(|set| set.get(vertex)).flatten()))
            .collect();
        for (p, m) in mesh.positions.iter_mut().zip(&means) {
            *p = Point3::from_f64(m.transform_point3(p.to_f64()));
        }
        for (n, m) in mesh.normals.iter_mut().zip(&means) {
            *n = Normal3::from_f64((turning(&m.matrix3) * n.to_f64()).normalize_or_zero());
        }
        for (tangent, m) in mesh.tangents.iter_mut().zip(&means) {
            let [x, y, z, w] = *tangent;
            let t = m.matrix3 * DVec3::new(x.into(), y.into(), z.into());
            let turned = t.normalize_or_zero().as_vec3().to_array();
            let side = if m.matrix3.determinant() < 0.0 { -w } else { w };
            *tangent = [turned[0], turned[1], turned[2], side];
        }
    }
}

/// The mean of the joints a vertex follows; weights are brought to the sum 1. One without weight follows the first.
fn mean<'i>(joints: &[DAffine3], influences: impl Iterator<Item = &'i (u32, f32)>) -> DAffine3 {
    let mut sum = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
    let mut total = 0.0;
    for &(joint, weight) in influences {
        if let Some(m) = joints.get(joint as usize) {
            let weight = f64::from(weight);
            sum.matrix3 += m.matrix3 * weight;
            sum.translation += m.translation * weight;
            total += weight;
        }
    }
    if total == 0.0 {
        return joints.first().copied().unwrap_or(DAffine3::IDENTITY);
    }
    DAffine3 { matrix3: sum.matrix3 * (1.0 / total), translation: sum.translation / total }
}

/// The inverse transpose of `m` up to a positive factor, which also a flat `m` has.
fn turning(m: &DMat3) -> DMat3 {
    let cofactors =
        DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    if m.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}

fn binds<'a>(
    document: &Document<'a>,
    buffers: &Buffers,
    reference: &Element<'a>,
    joints: usize,
) -> Checked<Vec<DAffine3>> {
    let accessor = Accessor::open(document, buffers, reference)?;
    if accessor.count < joints {
        let message = format!("{} inverse bind matrices for {joints} joints", accessor.count);
        return Err(reference.fault(message));
    }
    let rows = accessor.floats::<16>(document, None)?;
    if rows.iter().flatten().any(|v| !v.is_finite()) {
        return Err(accessor.element.fault("an inverse bind matrix holds infinite or NaN numbers"));
    }
    let rows: Vec<[f64; 16]> = rows.into_iter().map(|m| m.map(f64::from)).collect();
    if !rows.iter().all(is_affine) {
        document
            .warn(&accessor.element, "the last row of an inverse bind matrix is not 0 0 0 1; it is ignored");
    }
    Ok(rows.into_iter().map(matrix).collect())
}
