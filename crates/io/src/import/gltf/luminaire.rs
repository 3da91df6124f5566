//! EXT_lights_ies: luminaires as their makers measured them, which shine along -z of the node that carries them.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::Motion,
};
use durer_scene::{Data, LightDesc, Node, Params, ValueType};

use super::{
    buffer::Buffers,
    camera::{carried, rigid},
    document::Document,
    element::{Checked, Element},
    kept,
};
use crate::FileAssets;

/// The name of the extension.
pub(super) const NAME: &str = "EXT_lights_ies";

/// Makes the files of all luminaires known by name.
///
/// # Errors
/// If one of them is neither named nor held.
pub(super) fn names(
    (document, buffers): (&Document<'_>, &Buffers),
    assets: &mut FileAssets,
) -> Checked<Vec<String>> {
    let lights = document.root.extension(NAME)?.map_or(Ok(Vec::new()), |all| all.list("lights"))?;
    let name = |(i, light)| kept::file((document, buffers), assets, light, format!("luminaire:{i}"));
    lights.iter().enumerate().map(name).collect()
}

/// The light that a node at `world` carries, of one of the files of these names.
pub(super) fn light(
    carrier: &Element<'_>,
    (name, world): (&str, &Motion),
    names: &[String],
) -> Checked<LightDesc> {
    let reference = carrier.required("light")?;
    let file = names.get(reference.index()?).ok_or_else(|| {
        reference.fault(format!("refers to a luminaire that is not there: the file has {}", names.len()))
    })?;
    let color: [f64; 3] = carrier.numbers_or("color", [1.0; 3])?;
    let multiplier = carrier.number_or("multiplier", 1.0)?;
    if multiplier < 0.0 {
        return Err(carrier.fault_at("multiplier", format!("expected 0 or more, found {multiplier}")));
    }
    let params = Params::new()
        .string("filename", file)
        .rgb("I", color.map(|c| c.clamp(0.0, 1.0) as f32))
        .float("scale", multiplier as f32)
        .with("to", ValueType::Point3, Data::Floats(vec![0.0, 0.0, -1.0]));
    // Angles across grow from x by y, where ours would grow from x by -y.
    let mirrored = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let world_from_light = carried(world, |world| rigid(world) * mirrored);
    Ok(LightDesc { name: name.to_owned(), node: Node::new("ies", params), world_from_light })
}
