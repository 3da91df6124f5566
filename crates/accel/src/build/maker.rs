//! How trees are made for one set of registers.
use durer_core::math::Transform;
use rayon::prelude::*;

use super::{
    emit, moving,
    options::Engine,
    source::{Key, Source},
    subject::{Part, Stretch, Subject},
};
use crate::{
    BuildError, Preset,
    accel::{Instance, Movers},
    geometry::{Geometry, Items},
    isa::Registers,
    lanes::Portable,
    layout::{Link, MovingPacket, Packet, Target},
    placement::Pose,
    traverse::Kernel,
    tree::{Forest, Tree, Trees},
};

/// What a build chose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Maker {
    pub(super) engine: Engine,
    pub(super) preset: Preset,
    pub(super) registers: Registers,
}

/// Which of the scene's trees an instance that is not part of one lies in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Nothing to hit.
    Nothing,
    /// Every ray is tested.
    Endless,
    Still,
    Moving,
}

impl Kind {
    pub(super) fn of(instance: &Instance) -> Self {
        match &instance.pose {
            _ if instance.bounds.is_empty() => Self::Nothing,
            _ if !instance.is_bounded => Self::Endless,
            Pose::Moving(_) => Self::Moving,
            Pose::Identity | Pose::Still(_) => Self::Still,
        }
    }
}

impl Maker {
    pub(super) fn tree(&self, subject: &Subject<'_>) -> Result<Tree, BuildError> {
        match (self.engine, self.registers) {
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
            true => emit::tree::<K::Moving, MovingPacket>(subject, self.preset),
            false => emit::tree::<K::Node, Packet>(subject, self.preset),
        }
    }

    /// The trees of a geometry that is an instance.
    pub(super) fn forest(&self, source: &Source<'_>, items: &Items) -> Result<Forest, BuildError> {
        let trees = match source {
            Source::Keyed { indices, keys } => {
                let stretches: Vec<_> = keys.windows(2).collect();
                let tree = |pair: &&[Key<'_>]| {
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
        match self.engine {
            Engine::Bvh => tree.unbounded = unbounded,
            Engine::BruteForce => tree.leaves.extend(unbounded),
        }
    }

    /// The scene's own tree: over `parts`, items without a finite box, and those `instances` that `stand_apart`.
    pub(super) fn scene<'p>(
        &self,
        mut parts: Vec<Part<'p>>,
        mut unbounded: Vec<Link>,
        instances: &[Instance],
        stands_apart: impl Fn(u32) -> bool,
    ) -> Result<Forest, BuildError> {
        let mut placed = Vec::new();
        for (index, instance) in (0u32..).zip(instances).filter(|(index, _)| stands_apart(*index)) {
            match Kind::of(instance) {
                Kind::Still => placed.push((index, [instance.bounds; 2])),
                Kind::Endless => unbounded.push(Link::new(Target::Instance(index))),
                Kind::Moving | Kind::Nothing => {}
            }
        }
        parts.push(Part::Instances(placed));
        let mut tree = self.tree(&Subject::new(parts, false))?;
        self.add_unbounded(&mut tree, unbounded);
        Ok(Forest::new(Trees::Still(tree)))
    }

    /// Trees over the instances that move, who learn their numbers; `None` if none does.
    pub(super) fn movers(
        &self,
        instances: &mut [Instance],
        geometries: &[Geometry],
    ) -> Result<Option<Movers>, BuildError> {
        let is_moving =
            |(index, instance): (u32, &Instance)| (Kind::of(instance) == Kind::Moving).then_some(index);
        let moving: Vec<u32> = (0..).zip(instances.iter()).filter_map(is_moving).collect();
        instances.iter_mut().for_each(|instance| instance.mover = Instance::STANDS);
        if moving.is_empty() {
            return Ok(None);
        }
        let times = moving::times(instances, &moving);
        let mut boxes = Vec::new();
        let mut trees = Vec::new();
        for pair in times.windows(2) {
            let stretch = |&index: &u32| {
                let instance = &instances[index as usize];
                let [object, _] = geometries[instance.geometry.index()].bounds;
                moving::stretch(&instance.pose, &object, pair[0], pair[1])
            };
            let own: Vec<Stretch> = moving.iter().map(stretch).collect();
            let part = Part::Instances(moving.iter().copied().zip(own.iter().copied()).collect());
            trees.push(self.tree(&Subject::new(vec![part], true))?);
            boxes.push(own);
        }
        for (number, &index) in (0..).zip(&moving) {
            instances[index as usize].mover = number;
        }
        Ok(Some(Movers { forest: Forest::new(Trees::Moving { times: times.clone(), trees }), times, boxes }))
    }
}

/// A geometry that does not move as part of a tree that knows its primitives by `first_id` and up; and the items
/// without a finite box.
pub(super) fn still_part<'s>(
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
        _ => item_part(items, first_id),
    }
}

/// The same for items alone.
pub(super) fn item_part<'s>(items: &Items, first_id: u32) -> (Part<'s>, Vec<Link>) {
    let bounded = items.leaf_boxes().into_iter().map(|(prim, own)| (first_id + prim, own)).collect();
    let endless = (first_id..).zip(items.boxes()).filter(|(_, own)| own.is_none());
    (Part::Items(bounded), endless.map(|(id, _)| Link::new(Target::Item(id))).collect())
}
