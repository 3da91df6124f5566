//! A scene that changes from picture to picture: new vertices, new boxes, new places, without building all anew.
use super::{
    data::{GeometryData, check_alike},
    journal::{Changed, Journal},
    maker::{Kind, Maker, item_part, still_part},
    refit::{Changes, contents, refit},
    source::Source,
    subject::Part,
};
use durer_core::math::Bounds3;

use crate::{
    Accel, BuildError, GeometryId, Placement,
    accel::Movers,
    geometry::{Geometry, Items},
    layout::Target,
    placement::Pose,
    tree::{Forest, Trees},
};

/// Trees of the scene that take the place of old ones.
#[derive(Default)]
struct Renewed {
    scene: Option<Forest>,
    movers: Option<Option<Movers>>,
}

impl Accel {
    /// Gives a geometry new data of the same kind and size: new vertex positions, new boxes, new curves or points. All its
    /// instances follow. Hits are those of a scene built anew, bit for bit; only the form of trees stays as it is, so
    /// that they cost more the further primitives move from their old neighbours. Watch [`Accel::sah_cost`]: where it has
    /// grown by more than rays can afford (a third, say), build anew.
    ///
    /// Takes time proportional to the geometry, and to the scene's own tree, which holds what is used once and stands
    /// still. Instances of other geometries cost a look at their nodes.
    /// Of long curves, which trees hold in parts, each part gets the box of the whole: rays take longer.
    /// Trees over moving instances are built anew if some of this geometry move, and so are the geometry's or the
    /// scene's if boxes became infinite or finite.
    ///
    /// # Errors
    /// As when the geometry was added; data of another kind or number of primitives or keys; a geometry of another
    /// builder; [`BuildError::TreeTooLarge`] where trees are built anew. The scene is left as it was.
    pub fn refit(&mut self, geometry: GeometryId, data: GeometryData<'_>) -> Result<(), BuildError> {
        let at = geometry.index();
        let Some(old) = self.geometries.get(at) else {
            return Err(BuildError::GeometryUnknown { geometry: geometry.0 });
        };
        let source = data.source()?;
        let mut new = Geometry::of(&source);
        check_alike(geometry, old, &new)?;
        let pairs = old.items.boxes().iter().zip(new.items.boxes());
        let same_ends = pairs.into_iter().all(|(a, b)| a.is_some() == b.is_some());
        let is_own = old.forest.is_some();
        if is_own && !same_ends {
            new.forest = Some(self.maker().forest(&source, &new.items)?);
        }
        let mut journal = Journal::with_room_for(self.uses.of(at).len());
        for &index in self.uses.of(at) {
            journal.change(&mut self.instances, index, None, new.bounds);
        }
        // From here on only what cannot fail may change anything but the geometry.
        let is_new = new.forest.is_some();
        let old = std::mem::replace(&mut self.geometries[at], new);
        let changed = journal.changed(&self.instances);
        let renewed = match self.renewed(&changed, !is_own && !same_ends) {
            Ok(renewed) => renewed,
            Err(error) => {
                self.geometries[at] = old;
                journal.undo(&mut self.instances);
                return Err(error);
            }
        };
        if !is_new {
            self.geometries[at].forest = old.forest;
            self.refit_own(at, &source);
        }
        self.adopt(&changed, renewed, Some((geometry, &source)));
        Ok(())
    }

    /// Puts an instance that has a tree of its own somewhere else: see [`Accel::set_placements`].
    ///
    /// # Errors
    /// As that.
    pub fn set_placement(&mut self, instance: u32, placement: Placement) -> Result<(), BuildError> {
        self.set_placements([(instance, placement)])
    }

    /// Puts instances somewhere else, those later in the list last. Only such as have trees of their own can be moved:
    /// whose geometry is placed more than once, has vertex keys, is known by boxes and not placed by the identity, moves,
    /// or is kept apart (`AccelBuilder::keep_apart`). Hits are those of a scene built anew in which
    /// all these are kept apart, bit for bit.
    ///
    /// Takes time proportional to the instances that are moved and the boxes around them, and a look at all nodes of the
    /// scene's own tree. Trees over moving instances are built anew if one of these changes. The scene's own tree is built anew
    /// ([`Accel::regrow`]) if an instance starts or stops moving. Otherwise its form stays, and costs more the further
    /// instances move apart: watch [`Accel::sah_cost`].
    ///
    /// # Errors
    /// An instance that does not exist or has no tree of its own; a placement that `AccelBuilder::instance` would refuse;
    /// [`BuildError::TreeTooLarge`] where trees are built anew. The scene is left as it was.
    pub fn set_placements(
        &mut self,
        placements: impl IntoIterator<Item = (u32, Placement)>,
    ) -> Result<(), BuildError> {
        let mut placements = placements.into_iter();
        let mut journal = Journal::with_room_for(placements.size_hint().0);
        let done = placements.try_for_each(|(index, placement)| {
            let Some(instance) = self.instances.get(index as usize) else {
                return Err(BuildError::InstanceUnknown { instance: index });
            };
            if self.owners.range_of(index).is_some() {
                return Err(BuildError::InstanceMerged { instance: index });
            }
            let pose = Pose::new(placement, index as usize)?;
            let boxes = self.geometries[instance.geometry.index()].bounds;
            journal.change(&mut self.instances, index, Some(pose), boxes);
            Ok(())
        });
        let changed = journal.changed(&self.instances);
        let renewed = match done.and_then(|()| self.renewed(&changed, false)) {
            Ok(renewed) => renewed,
            Err(error) => {
                journal.undo(&mut self.instances);
                return Err(error);
            }
        };
        self.adopt(&changed, renewed, None);
        Ok(())
    }

    /// Builds the scene's own trees anew, those over its instances and over what is used once and stands still, from what
    /// they hold; geometries that are instances keep theirs. Takes as long as building these trees did at first. For when
    /// [`Accel::sah_cost`] has grown by changes of placement.
    ///
    /// # Errors
    /// [`BuildError::TreeTooLarge`]; the scene is left as it was.
    pub fn regrow(&mut self) -> Result<(), BuildError> {
        let renewed = self.renewed(&[], true)?;
        self.adopt(&[], renewed, None);
        Ok(())
    }

    fn maker(&self) -> Maker {
        Maker { engine: self.engine, preset: self.preset, registers: self.registers }
    }

    /// What must be built anew after instances have changed.
    fn renewed(&mut self, changed: &[Changed], regrows: bool) -> Result<Renewed, BuildError> {
        let now = |change: &Changed| Kind::of(&self.instances[change.index as usize]);
        let mut apart = changed.iter().filter(|change| self.owners.range_of(change.index).is_none());
        let regrows = regrows || apart.clone().any(|change| now(change) != change.was);
        let moves = apart.any(|change| now(change) == Kind::Moving);
        let mut renewed = Renewed::default();
        if regrows {
            renewed.scene = Some(self.regrown()?);
        }
        if regrows || moves {
            let numbers: Vec<u32> = self.instances.iter().map(|instance| instance.mover).collect();
            match self.maker().movers(&mut self.instances, &self.geometries) {
                Ok(movers) => renewed.movers = Some(movers),
                Err(error) => {
                    self.instances.iter_mut().zip(numbers).for_each(|(i, number)| i.mover = number);
                    return Err(error);
                }
            }
        }
        Ok(renewed)
    }

    /// The scene's own tree, from what it holds.
    fn regrown(&self) -> Result<Forest, BuildError> {
        let [tree] = self.scene.trees() else { return Ok(self.scene.clone()) };
        let mut parts = vec![Part::Loose(contents(tree))];
        let mut unbounded = Vec::new();
        for (index, ids) in self.owners.ranges() {
            let (part, more) = item_part(self.items(index), ids.start);
            parts.push(part);
            unbounded.extend(more);
        }
        let stands_apart = |index| self.owners.range_of(index).is_none();
        self.maker().scene(parts, unbounded, &self.instances, stands_apart)
    }

    /// Brings the trees of a geometry up to date.
    fn refit_own(&mut self, at: usize, source: &Source<'_>) {
        let width = self.registers.width();
        let Geometry { items, bounds, forest, .. } = &mut self.geometries[at];
        let Some(forest) = forest else { return };
        let whole = bounds[1];
        let shapes = |target: Target| match target {
            Target::Item(prim) => items.own_box(prim),
            _ => None,
        };
        let bring = |trees: &mut Trees, at: usize, part: &Part<'_>| {
            let triangles = Some((part, 0..items.len()));
            refit(trees, at, width, &Changes { triangles, shapes: &shapes, whole });
        };
        if let (Source::Keyed { indices, keys }, Trees::Moving { times, .. }) = (source, &mut forest.trees) {
            *times = keys.iter().map(|key| key.0).collect();
            for (at, pair) in keys.windows(2).enumerate() {
                let part = Part::Keyed { start: &pair[0], end: &pair[1], indices };
                bring(&mut forest.trees, at, &part);
            }
        } else {
            bring(&mut forest.trees, 0, &still_part(source, items, 0, None).0);
        }
        forest.measure();
    }

    /// Takes on trees that fit changed instances, and what `refitted` says of a geometry.
    fn adopt(&mut self, changed: &[Changed], renewed: Renewed, refitted: Option<(GeometryId, &Source<'_>)>) {
        let is_regrown = renewed.scene.is_some();
        let has_new_trees = is_regrown || renewed.movers.is_some();
        if let Some(scene) = renewed.scene {
            self.scene = scene;
        }
        if let Some(movers) = renewed.movers {
            self.movers = movers;
        }
        self.measure_changed(changed);
        let merged = refitted.and_then(|(geometry, source)| {
            let index = *self.uses.of(geometry.index()).first()?;
            Some((index as usize, self.owners.range_of(index)?, source))
        });
        if !is_regrown && (merged.is_some() || !changed.is_empty()) {
            self.refit_scene(changed, merged);
        }
        if has_new_trees || refitted.is_some() {
            self.name_nodes();
        }
        self.forget_reaches();
    }

    /// Sets the box around everything, which grows with what has changed if nothing of that was at its sides.
    fn measure_changed(&mut self, changed: &[Changed]) {
        let all = self.bounds;
        let is_inside = |b: &Bounds3| {
            let at = |axis: usize| all.min[axis] < b.min[axis] && b.max[axis] < all.max[axis];
            b.is_empty() || (at(0) && at(1) && at(2))
        };
        if changed.iter().all(|change| is_inside(&change.was_finite)) {
            let now = changed.iter().map(|change| self.instances[change.index as usize].finite);
            self.bounds = now.fold(all, Bounds3::union);
        } else {
            self.measure();
        }
    }

    /// Brings the scene's own tree up to date: instances that differ, and one that is part of it.
    fn refit_scene(
        &mut self,
        changed: &[Changed],
        merged: Option<(usize, std::ops::Range<u32>, &Source<'_>)>,
    ) {
        let mut differs = vec![false; self.instances.len()];
        changed.iter().for_each(|change| differs[change.index as usize] = true);
        let none = Items::Triangles(0);
        let items = merged
            .as_ref()
            .map_or(&none, |(index, ..)| &self.geometries[self.instances[*index].geometry.index()].items);
        let part = merged.as_ref().map(|(index, ids, source)| {
            let place = self.instances[*index].pose.place();
            (still_part(source, items, ids.start, place).0, ids.clone())
        });
        let first = part.as_ref().map_or(u32::MAX, |(_, ids)| ids.start);
        let instances = &self.instances;
        let shapes = |target: Target| match target {
            Target::Item(id) => id.checked_sub(first).and_then(|prim| items.own_box(prim)),
            Target::Instance(index) if differs[index as usize] => Some(instances[index as usize].bounds),
            _ => None,
        };
        let triangles = part.as_ref().map(|(part, ids)| (part, ids.clone()));
        let changes = Changes { triangles, shapes: &shapes, whole: self.bounds };
        let mut trees = std::mem::replace(&mut self.scene.trees, Trees::Still(crate::tree::Tree::empty()));
        refit(&mut trees, 0, self.registers.width(), &changes);
        self.scene.trees = trees;
        self.scene.measure();
    }
}
