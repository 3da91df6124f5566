//! Morph targets: every attribute is its base plus the weighted displacements of the targets, before any skin bends it
//! (glTF 2.0, section 3.7.2.2).
use durer_core::math::{Normal3, Point2, Point3};
use durer_scene::Mesh;

use super::{element::Checked, mesh::Wish, primitive::Columns};

/// The displacements of one target; empty lists for attributes that it or the mesh lacks.
struct Target<'w> {
    /// By moment, of which there may be but one.
    weights: &'w [f32],
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    tangents: Vec<[f32; 3]>,
    uvs: [Vec<[f32; 2]>; 2],
    colors: Vec<[f32; 4]>,
}

/// The targets of a mesh, read.
pub(super) struct Targets<'w>(Vec<Target<'w>>);

impl<'w> Targets<'w> {
    /// The targets of `wish`.
    pub(super) fn read<'a>(columns: &Columns<'_, 'a>, wish: &'w Wish<'a>) -> Checked<Self> {
        let mut all = Vec::new();
        for (target, weights) in &wish.targets {
            let triples = |name| columns.column::<3>(target, name);
            let [first, second] = wish.sets.map(|set| columns.column(target, &format!("TEXCOORD_{set}")));
            all.push(Target {
                weights,
                positions: triples("POSITION")?,
                normals: triples("NORMAL")?,
                tangents: triples("TANGENT")?,
                uvs: [first?, second?],
                colors: columns.colors(target, 0.0)?,
            });
        }
        Ok(Self(all))
    }

    /// At how many moments weights are known.
    pub(super) fn moments(&self) -> usize {
        self.0.iter().map(|target| target.weights.len()).max().unwrap_or(1)
    }

    /// Adds the targets as they are at a moment to those attributes that `mesh` has.
    pub(super) fn apply(&self, mesh: &mut Mesh, moment: usize) {
        for target in &self.0 {
            let w = target.weights.get(moment).or(target.weights.last()).copied().unwrap_or(0.0);
            if w == 0.0 {
                continue;
            }
            for (p, d) in mesh.positions.iter_mut().zip(&target.positions) {
                *p = Point3::from(sum(p.to_array(), *d, w));
            }
            for (n, d) in mesh.normals.iter_mut().zip(&target.normals) {
                *n = Normal3::from(sum(n.to_array(), *d, w));
            }
            // The displacement of a tangent has no handedness: it stays.
            for ([x, y, z, _], d) in mesh.tangents.iter_mut().zip(&target.tangents) {
                [*x, *y, *z] = sum([*x, *y, *z], *d, w);
            }
            let [first, second] = &target.uvs;
            move_coordinates(&mut mesh.uvs, first, w);
            move_coordinates(&mut mesh.second_uvs, second, w);
            for (c, d) in mesh.colors.iter_mut().zip(&target.colors) {
                *c = sum(*c, *d, w);
            }
        }
        if !self.0.is_empty() {
            mesh.colors.iter_mut().flatten().for_each(|c| *c = c.clamp(0.0, 1.0));
        }
    }
}

fn sum<const N: usize>(base: [f32; N], displacement: [f32; N], weight: f32) -> [f32; N] {
    let mut sum = base;
    sum.iter_mut().zip(displacement).for_each(|(s, d)| *s += d * weight);
    sum
}

/// Moves texture coordinates, whose v is turned upwards.
fn move_coordinates(uvs: &mut [Point2], displacements: &[[f32; 2]], weight: f32) {
    for (uv, [du, dv]) in uvs.iter_mut().zip(displacements) {
        *uv = Point2::from(sum(uv.to_array(), [*du, -dv], weight));
    }
}
