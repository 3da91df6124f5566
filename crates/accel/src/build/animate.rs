//! A scene that changes from picture to picture: new vertices, new boxes, new places, without building all anew.
use super::{
    data::{GeometryData, check_alike},
    maker::{Kind, Maker, item_part, still_part},
    refit::{Changes, contents, refit},
    source::Source,
    subject::Part,
};
use crate::{
    Accel, BuildError, GeometryId, Placement,
    accel::{Instance, Movers},
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
    /// still: for a million triangles 0.12 s on two cores, where building takes 1 s (debug profile, optimized).
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
        let mut instances = self.instances.clone();
        instances.iter_mut().filter(|i| i.geometry == geometry).for_each(|i| i.measure(new.bounds));
        // From here on only what cannot fail may change anything but the geometry.
        let is_new = new.forest.is_some();
        let old = std::mem::replace(&mut self.geometries[at], new);
        let renewed = match self.renewed(&mut instances, !is_own && !same_ends) {
            Ok(renewed) => renewed,
            Err(error) => {
                self.geometries[at] = old;
                return Err(error);
            }
        };
        if !is_new {
            self.geometries[at].forest = old.forest;
            self.refit_own(at, &source);
        }
        self.adopt(instances, renewed, Some((geometry, &source)));
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
    /// Takes time proportional to all instances and the nodes of the scene's own tree, whose boxes follow, however many are
    /// moved. Trees over moving instances are built anew if one of these changes. The scene's own tree is built anew
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
        let mut instances = self.instances.clone();
        for (index, placement) in placements {
            let Some(instance) = instances.get_mut(index as usize) else {
                return Err(BuildError::InstanceUnknown { instance: index });
            };
            if self.owners.range_of(index).is_some() {
                return Err(BuildError::InstanceMerged { instance: index });
            }
            instance.pose = Pose::new(placement, index as usize)?;
            instance.mirrors = instance.pose.mirrors();
            instance.measure(self.geometries[instance.geometry.index()].bounds);
        }
        let renewed = self.renewed(&mut instances, false)?;
        self.adopt(instances, renewed, None);
        Ok(())
    }

    /// Builds the scene's own trees anew, those over its instances and over what is used once and stands still, from what
    /// they hold; geometries that are instances keep theirs. Takes as long as building these trees did at first. For when
    /// [`Accel::sah_cost`] has grown by changes of placement.
    ///
    /// # Errors
    /// [`BuildError::TreeTooLarge`]; the scene is left as it was.
    pub fn regrow(&mut self) -> Result<(), BuildError> {
        let mut instances = self.instances.clone();
        let renewed = self.renewed(&mut instances, true)?;
        self.adopt(instances, renewed, None);
        Ok(())
    }

    fn maker(&self) -> Maker {
        Maker { engine: self.engine, preset: self.preset, registers: self.registers }
    }

    /// What must be built anew for `instances` to take the place of those there are.
    fn renewed(&self, instances: &mut [Instance], regrows: bool) -> Result<Renewed, BuildError> {
        let pairs = (0u32..).zip(self.instances.iter().zip(instances.iter()));
        let apart = pairs.filter(|(index, _)| self.owners.range_of(*index).is_none());
        let kinds: Vec<_> =
            apart.map(|(_, (old, new))| (Kind::of(old), Kind::of(new), old.differs(new))).collect();
        let regrows = regrows || kinds.iter().any(|(old, new, _)| old != new);
        let moves = kinds.iter().any(|(_, new, differs)| *new == Kind::Moving && *differs);
        let mut renewed = Renewed::default();
        if regrows {
            renewed.scene = Some(self.regrown(instances)?);
        }
        if regrows || moves {
            renewed.movers = Some(self.maker().movers(instances, &self.geometries)?);
        }
        Ok(renewed)
    }

    /// The scene's own tree, from what it holds.
    fn regrown(&self, instances: &[Instance]) -> Result<Forest, BuildError> {
        let [tree] = self.scene.trees() else { return Ok(self.scene.clone()) };
        let mut parts = vec![Part::Loose(contents(tree))];
        let mut unbounded = Vec::new();
        for (index, ids) in self.owners.ranges() {
            let (part, more) = item_part(self.items(index), ids.start);
            parts.push(part);
            unbounded.extend(more);
        }
        let stands_apart = |index| self.owners.range_of(index).is_none();
        self.maker().scene(parts, unbounded, instances, stands_apart)
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

    /// Takes on instances and trees that fit them, and what `changed` says of a geometry.
    fn adopt(
        &mut self,
        instances: Vec<Instance>,
        renewed: Renewed,
        changed: Option<(GeometryId, &Source<'_>)>,
    ) {
        let old = std::mem::replace(&mut self.instances, instances);
        let is_regrown = renewed.scene.is_some();
        if let Some(scene) = renewed.scene {
            self.scene = scene;
        }
        if let Some(movers) = renewed.movers {
            self.movers = movers;
        }
        self.measure();
        let differs: Vec<bool> = old.iter().zip(&self.instances).map(|(a, b)| a.differs(b)).collect();
        let merged = changed.and_then(|(geometry, source)| {
            let index = self.instances.iter().position(|instance| instance.geometry == geometry)?;
            Some((index, self.owners.range_of(index as u32)?, source))
        });
        if !is_regrown && (merged.is_some() || differs.contains(&true)) {
            self.refit_scene(&differs, merged);
        }
        self.name_nodes();
    }

    /// Brings the scene's own tree up to date: instances that differ, and one that is part of it.
    fn refit_scene(&mut self, differs: &[bool], merged: Option<(usize, std::ops::Range<u32>, &Source<'_>)>) {
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
