//! Which tree holds what: things that are used once and stand still lie in the scene's own tree, what moves or repeats
//! has a tree of its own and is an instance in one of the scene's.
use durer_core::math::Transform;
use rayon::prelude::*;

use super::{
    emit, moving,
    options::{BuildOptions, Engine},
    source::Source,
    subject::{Part, Subject},
};
use crate::{
    Accel, BuildError,
    accel::{Instance, Movers, Parts},
    geometry::{Geometry, Items},
    isa::Registers,
    lanes::Portable,
    layout::{Link, MovingPacket, Packet, Target},
    owners::Owners,
    placement::Pose,
    traverse::Kernel,
    tree::{Forest, Tree, Trees},
};

/// How trees are made for one set of registers.
struct Maker<'o> {
    options: &'o BuildOptions,
    registers: Registers,
}

impl Maker<'_> {
    fn tree(&self, subject: &Subject<'_>) -> Result<Tree, BuildError> {
        match (self.options.engine, self.registers) {
            (Engine::BruteForce, _) if subject.moves => Ok(emit::list::<MovingPacket>(subject)),
            (Engine::BruteForce, _) => Ok(emit::list::<Packet>(subject)),
            #[cfg(target_arch = "x86_64")]
            (Engine::Bvh, Registers::Avx512(_)) => self.laid_out::<crate::simd::Avx512>(subject),
            #[cfg(target_arch = "x86_64")]
            (Engine::Bvh, Registers::Avx2(_)) => self.laid_out::<crate::simd::Avx2>(subject),
            (Engine::Bvh, Registers::Portable(_)) => self.laid_out::<Portable>(subject),
        }
    }

    fn laid_out<K: Kernel>(&self, subject: &Subject<'_>) -> Result<Tree, BuildError> {
        match subject.moves {
            true => emit::tree::<K::Moving, MovingPacket>(subject, self.options.preset),
            false => emit::tree::<K::Node, Packet>(subject, self.options.preset),
        }
    }

    /// The trees of a geometry that is an instance.
    fn forest(&self, source: &Source<'_>, items: &Items) -> Result<Forest, BuildError> {
        let trees = match source {
            Source::Keyed { indices, keys } => {
                let stretches: Vec<_> = keys.windows(2).collect();
                let tree = |pair: &&[super::source::Key<'_>]| {
                    let part = Part::Keyed { start: &pair[0], end: &pair[1], indices };
                    self.tree(&Subject::new(vec![part], true))
                };
                let trees = stretches.par_iter().map(tree).collect::<Result<_, _>>()?;
                Trees::Moving { times: keys.iter().map(|key| key.0).collect(), trees }
            }
            still => {
                let (part, unbounded) = still_part(still, items, 0, None);
                let mut tree = self.tree(&Subject::new(vec![part], false))?;
                self.add_unbounded(&mut tree, unbounded);
                Trees::Still(tree)
            }
        };
        Ok(Forest::new(trees))
    }

    fn add_unbounded(&self, tree: &mut Tree, unbounded: Vec<Link>) {
        match self.options.engine {
            Engine::Bvh => tree.unbounded = unbounded,
            Engine::BruteForce => tree.leaves.extend(unbounded),
        }
    }

    /// Trees over the instances that move, who learn their numbers.
    fn movers(
        &self,
        instances: &mut [Instance],
        geometries: &[Geometry],
        moving: &[u32],
    ) -> Result<Movers, BuildError> {
        let times = moving::times(instances, moving);
        let mut boxes = Vec::new();
        let mut trees = Vec::new();
        for pair in times.windows(2) {
            let stretch = |&index: &u32| {
                let instance = &instances[index as usize];
                let object = geometries[instance.geometry.index()].bounds();
                moving::stretch(&instance.pose, &object, pair[0], pair[1])
            };
            let own: Vec<_> = moving.iter().map(stretch).collect();
            let part = Part::Instances(moving.iter().copied().zip(own.iter().copied()).collect());
            trees.push(self.tree(&Subject::new(vec![part], true))?);
            boxes.push(own);
        }
        for (number, &index) in (0..).zip(moving) {
            instances[index as usize].mover = number;
        }
        Ok(Movers { forest: Forest::new(Trees::Moving { times: times.clone(), trees }), times, boxes })
    }
}

/// A geometry that does not move as part of a tree that knows its primitives by `first_id` and up; and the items
/// without a finite box.
fn still_part<'s>(
    source: &'s Source<'_>,
    items: &Items,
    first_id: u32,
    place: Option<Transform>,
) -> (Part<'s>, Vec<Link>) {
    match source {
        Source::Triangles { positions, indices } => {
            (Part::Triangles { positions, indices, place, first_id }, Vec::new())
        }
        Source::Quads(mesh) => (Part::Quads { mesh, place, first_id }, Vec::new()),
        Source::Keyed { .. } | Source::Boxes(_) => {
            let mut bounded = Vec::new();
            let mut unbounded = Vec::new();
            for prim in 0..items.len() {
                match items.own_box(prim) {
                    Some(own) => bounded.push((first_id + prim, own)),
                    None => unbounded.push(Link::new(Target::Item(first_id + prim))),
                }
            }
            (Part::Items(bounded), unbounded)
        }
    }
}

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

pub(super) fn assemble(
    options: &BuildOptions,
    sources: &[Source<'_>],
    mut instances: Vec<Instance>,
) -> Result<Accel, BuildError> {
    let registers = match options.isa {
        None => Registers::best(),
        Some(isa) => Registers::new(isa).ok_or(BuildError::IsaMissing { isa: isa.name() })?,
    };
    let maker = Maker { options, registers };
    let mut uses = vec![0u32; sources.len()];
    instances.iter().for_each(|i| uses[i.geometry.index()] += 1);
    let merged: Vec<bool> =
        instances.iter().map(|i| merges(i, &sources[i.geometry.index()], uses[i.geometry.index()])).collect();
    let mut is_own = vec![false; sources.len()];
    for (instance, merged) in instances.iter().zip(&merged) {
        is_own[instance.geometry.index()] |= !merged;
    }
    for (instance, _) in instances.iter_mut().zip(&merged).filter(|(i, merged)| **merged && i.mirrors) {
        // In the scene's own tree its triangles are turned round.
        instance.seen.is_reversed = !instance.seen.is_reversed;
    }
    let geometries = sources.par_iter().zip(&is_own).map(|(source, &own)| {
        let items = source.items();
        let forest = if own { Some(maker.forest(source, &items)?) } else { None };
        Ok(Geometry { items, forest })
    });
    let geometries: Vec<Geometry> = geometries.collect::<Result<_, BuildError>>()?;

    let mut owners = Owners::default();
    let mut parts = Vec::new();
    let mut unbounded = Vec::new();
    let (mut placed, mut moving) = (Vec::new(), Vec::new());
    let mut endless = Vec::new();
    for (index, (instance, &merged)) in (0u32..).zip(instances.iter().zip(&merged)) {
        let geometry = instance.geometry.index();
        if merged {
            let items = &geometries[geometry].items;
            BuildError::check_count(owners.total() as usize + items.len() as usize, "primitives")?;
            let first_id = owners.push(index, items.len());
            let place = match &instance.pose {
                Pose::Still(m) => Some(*m),
                _ => None,
            };
            let (part, more) = still_part(&sources[geometry], items, first_id, place);
            parts.push(part);
            unbounded.extend(more);
        } else if !instance.is_bounded {
            endless.push(index);
        } else if instance.bounds.is_empty() {
            // Nothing to hit.
        } else if matches!(instance.pose, Pose::Moving(_)) {
            moving.push(index);
        } else {
            placed.push((index, [instance.bounds; 2]));
        }
    }
    parts.push(Part::Instances(placed));
    let mut tree = maker.tree(&Subject::new(parts, false))?;
    unbounded.extend(endless.into_iter().map(|index| Link::new(Target::Instance(index))));
    maker.add_unbounded(&mut tree, unbounded);
    let scene = Forest::new(Trees::Still(tree));
    let movers =
        if moving.is_empty() { None } else { Some(maker.movers(&mut instances, &geometries, &moving)?) };
    Ok(Accel::new(options, Parts { registers, scene, movers, geometries, instances, owners }))
}
