//! EXT_mesh_gpu_instancing: one node draws its mesh many times.
use durer_core::glam::DAffine3;

use super::{
    accessor::Accessor,
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    node::trs,
};

/// The placements that the extension object describes, relative to the node.
pub(super) fn placements<'a>(
    document: &Document<'a>,
    buffers: &Buffers,
    extension: &Element<'a>,
) -> Checked<Vec<DAffine3>> {
    let attributes = extension.required("attributes")?;
    let open = |key| match attributes.get(key)? {
        Some(reference) => Accessor::open(document, buffers, &reference).map(Some),
        None => Ok(None),
    };
    let accessors = [open("TRANSLATION")?, open("ROTATION")?, open("SCALE")?];
    let mut counts = accessors.iter().flatten().map(|a| a.count);
    let Some(count) = counts.next() else {
        return Err(attributes.fault("expected TRANSLATION, ROTATION or SCALE"));
    };
    if counts.any(|c| c != count) {
        return Err(attributes.fault("attributes of instances have different lengths"));
    }
    document.spend(extension, count, size_of::<DAffine3>())?;
    let [translation, rotation, scale] = accessors;
    let triples = |a: Option<Accessor<'_, 'a>>, default: f32| {
        a.map_or(Ok(vec![[default; 3]; count]), |a| a.floats::<3>(document, None))
    };
    let (moves, scales) = (triples(translation, 0.0)?, triples(scale, 1.0)?);
    let upright = || vec![[0.0, 0.0, 0.0, 1.0]; count];
    let turns = rotation.map_or(Ok(upright()), |a| a.floats::<4>(document, None))?;
    let all = moves.iter().zip(&turns).zip(&scales).enumerate();
    all.map(|(i, ((t, r), s))| {
        let placed = trs(t.map(f64::from), r.map(f64::from), s.map(f64::from));
        placed
            .filter(DAffine3::is_finite)
            .ok_or_else(|| attributes.fault(format!("instance {i} has no valid placement")))
    })
    .collect()
}
