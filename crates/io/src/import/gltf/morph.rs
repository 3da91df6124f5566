//! Morph targets at rest: every attribute is its base plus the weighted displacements of the targets, before any skin
//! bends it (glTF 2.0, section 3.7.2.2).
use durer_core::math::{Normal3, Point2, Point3};
use durer_scene::Mesh;

use super::{
    element::{Checked, Element},
    mesh::Wish,
    primitive::Columns,
};

/// Adds the targets of `wish` to `mesh`. A target of an attribute that the mesh lacks has no effect.
pub(super) fn apply<'a>(columns: &Columns<'_, 'a>, mesh: &mut Mesh, wish: &Wish<'a>) -> Checked<()> {
    for (target, weight) in &wish.targets {
        let w = *weight;
        let triples = |name| columns.column::<3>(target, name);
        for (p, d) in mesh.positions.iter_mut().zip(triples("POSITION")?) {
            *p = Point3::from(sum(p.to_array(), d, w));
        }
        for (n, d) in mesh.normals.iter_mut().zip(triples("NORMAL")?) {
            *n = Normal3::from(sum(n.to_array(), d, w));
        }
        // The displacement of a tangent has no handedness: it stays.
        for ([x, y, z, _], d) in mesh.tangents.iter_mut().zip(triples("TANGENT")?) {
            [*x, *y, *z] = sum([*x, *y, *z], d, w);
        }
        let [first, second] = wish.sets;
        coordinates(columns, target, (first, w), &mut mesh.uvs)?;
        coordinates(columns, target, (second, w), &mut mesh.second_uvs)?;
        for (c, d) in mesh.colors.iter_mut().zip(columns.colors(target, 0.0)?) {
            *c = sum(*c, d, w);
        }
    }
    if !wish.targets.is_empty() {
        mesh.colors.iter_mut().flatten().for_each(|c| *c = c.clamp(0.0, 1.0));
    }
    Ok(())
}

fn sum<const N: usize>(base: [f32; N], displacement: [f32; N], weight: f32) -> [f32; N] {
    let mut sum = base;
    sum.iter_mut().zip(displacement).for_each(|(s, d)| *s += d * weight);
    sum
}

/// Moves texture coordinates, whose v is turned upwards.
fn coordinates<'a>(
    columns: &Columns<'_, 'a>,
    target: &Element<'a>,
    (set, weight): (usize, f32),
    uvs: &mut [Point2],
) -> Checked<()> {
    for (uv, [du, dv]) in uvs.iter_mut().zip(columns.column(target, &format!("TEXCOORD_{set}"))?) {
        *uv = Point2::from(sum(uv.to_array(), [du, -dv], weight));
    }
    Ok(())
}
