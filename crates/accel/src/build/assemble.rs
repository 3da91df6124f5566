//! Which tree holds what: things that are used once and stand still lie in the scene's own tree, what moves or repeats
//! has a tree of its own and is an instance in one of the scene's.
use rayon::prelude::*;

use super::{
    maker::{Maker, still_part},
    options::BuildOptions,
    source::Source,
};
use crate::{
    Accel, BuildError,
    accel::{Instance, Parts},
    geometry::Geometry,
    isa::Registers,
    owners::Owners,
    placement::Pose,
};

/// Whether an instance lies in the scene's own tree, part by part.
fn merges(instance: &Instance, source: &Source<'_>, uses: u32) -> bool {
    let once = uses == 1 && !source.moves();
    match (&instance.pose, source) {
        (Pose::Identity, _) => once,
        // Shapes and their callbacks stay in their own space.
        (Pose::Still(_), Source::Triangles { .. } | Source::Quads(_)) => once,
        _ => false,
    }
}

impl Geometry {
    /// Without trees.
    pub(super) fn of(source: &Source<'_>) -> Self {
        Self { items: source.items(), bounds: source.bounds(), keys: source.keys(), forest: None }
    }
}

/// `apart` says which geometries must keep trees of their own.
pub(super) fn assemble(
    options: &BuildOptions,
    sources: &[Source<'_>],
    apart: &[bool],
    mut instances: Vec<Instance>,
) -> Result<Accel, BuildError> {
    let registers = match options.isa {
        None => Registers::best(),
        Some(isa) => Registers::new(isa).ok_or(BuildError::IsaMissing { isa: isa.name() })?,
    };
    let maker = Maker { engine: options.engine, preset: options.preset, registers };
    let mut uses = vec![0u32; sources.len()];
    instances.iter().for_each(|i| uses[i.geometry.index()] += 1);
    let is_merged = |instance: &Instance| {
        let geometry = instance.geometry.index();
        !apart[geometry] && merges(instance, &sources[geometry], uses[geometry])
    };
    let merged: Vec<bool> = instances.iter().map(is_merged).collect();
    let mut is_own = vec![false; sources.len()];
    for (instance, merged) in instances.iter().zip(&merged) {
        is_own[instance.geometry.index()] |= !merged;
    }
    for (instance, merged) in instances.iter_mut().zip(&merged) {
        let source = &sources[instance.geometry.index()];
        let as_given = !merged || instance.pose == Pose::Identity;
        instance.is_plain = as_given && matches!(source, Source::Triangles { .. }) && !source.moves();
    }
    for (instance, _) in instances.iter_mut().zip(&merged).filter(|(i, merged)| **merged && i.mirrors) {
        // In the scene's own tree its triangles are turned round.
        instance.seen.is_reversed = !instance.seen.is_reversed;
    }
    let geometries = sources.par_iter().zip(&is_own).map(|(source, &own)| {
        let geometry = Geometry::of(source);
        let forest = if own { Some(maker.forest(source, &geometry.items)?) } else { None };
        Ok(Geometry { forest, ..geometry })
    });
    let geometries: Vec<Geometry> = geometries.collect::<Result<_, BuildError>>()?;

    let mut owners = Owners::default();
    let mut parts = Vec::new();
    let mut unbounded = Vec::new();
    let own = (0u32..).zip(&mut instances).filter(|(index, _)| merged[*index as usize]);
    for (index, instance) in own {
        let geometry = instance.geometry.index();
        let items = &geometries[geometry].items;
        BuildError::check_count(owners.total() as usize + items.len() as usize, "primitives")?;
        let first_id = owners.push(index, items.len());
        let place = instance.pose.place();
        let (part, more) = still_part(&sources[geometry], items, first_id, place);
        parts.push(part);
        unbounded.extend(more);
    }
    let scene = maker.scene(parts, unbounded, &instances, |index| !merged[index as usize])?;
    let movers = maker.movers(&mut instances, &geometries)?;
    Ok(Accel::new(options, Parts { registers, scene, movers, geometries, instances, owners }))
}
