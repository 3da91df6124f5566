//! The frozen scene, and what a debugger may ask.
use std::sync::OnceLock;

use durer_core::math::{Bounds3, Transform};

use crate::{
    BuildOptions, BuildStats, Engine, GeometryId, Isa, Precision, Preset, Visibility,
    build::Stretch,
    geometry::{Geometry, Items},
    isa::Registers,
    layout::{MovingNode, Node},
    owners::Owners,
    placement::Pose,
    traverse::Reaches,
    tree::{Forest, Tree, Trees},
    uses::Uses,
};

/// A geometry somewhere.
#[derive(Clone, Debug)]
pub(crate) struct Instance {
    pub(crate) geometry: GeometryId,
    /// Which of the movers it is, or [`Instance::STANDS`].
    pub(crate) mover: u32,
    /// By whom, and the side that is the back in the tree that holds it.
    pub(crate) seen: Visibility,
    /// It stands still and left and right change places.
    pub(crate) mirrors: bool,
    /// Its hits are on triangles that do not move, known to callers as their tree knows them.
    pub(crate) is_plain: bool,
    /// That its box is finite.
    pub(crate) is_bounded: bool,
    /// Box in render space around everything, over all time, grown once by the slack of box tests.
    pub(crate) bounds: Bounds3,
    /// Box around its finite primitives.
    pub(crate) finite: Bounds3,
    pub(crate) pose: Pose,
}

impl Instance {
    pub(crate) const STANDS: u32 = u32::MAX;
}

/// Instances that move.
#[derive(Clone, Debug)]
pub(crate) struct Movers {
    /// Trees over them, one for each stretch of time.
    pub(crate) forest: Forest,
    /// Moments at which stretches begin and end.
    pub(crate) times: Vec<f32>,
    /// Their boxes at both ends of each stretch, grown once.
    pub(crate) boxes: Vec<Vec<Stretch>>,
}

/// A node's box, for pictures of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeBounds {
    /// In object space of `geometry`, or in render space. Of a tree that moves, at the start of its stretch of time.
    pub bounds: Bounds3,
    /// Whose tree the node belongs to; `None` for the trees of the whole scene.
    pub geometry: Option<GeometryId>,
    /// Children that hold primitives or instances; 0 if all are nodes.
    pub leaf_items: u32,
}

/// A scene of instances, ready for rays. Made by `AccelBuilder::build`.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(crate) engine: Engine,
    pub(crate) precision: Precision,
    /// For trees that are built anew.
    pub(crate) preset: Preset,
    pub(crate) registers: Registers,
    /// The tree of everything that stands still and is used once, and of the instances that stand still.
    pub(crate) scene: Forest,
    pub(crate) movers: Option<Movers>,
    pub(crate) geometries: Vec<Geometry>,
    pub(crate) instances: Vec<Instance>,
    /// Whose the primitives of `scene` are.
    pub(crate) owners: Owners,
    /// Who places each geometry.
    pub(crate) uses: Uses,
    /// Whether some instance is not seen by all rays, hides its backs, is put to filters.
    pub(crate) is_selective: bool,
    pub(crate) hides_backs: bool,
    pub(crate) is_filtered: bool,
    pub(crate) bounds: Bounds3,
    /// Computed when near misses are first asked for.
    pub(crate) reaches: OnceLock<Reaches>,
}

/// The parts of a scene.
pub(crate) struct Parts {
    pub(crate) registers: Registers,
    pub(crate) scene: Forest,
    pub(crate) movers: Option<Movers>,
    pub(crate) geometries: Vec<Geometry>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) owners: Owners,
}

impl Accel {
    pub(crate) fn new(options: &BuildOptions, parts: Parts) -> Self {
        let Parts { registers, scene, movers, geometries, instances, owners } = parts;
        let any = |is: fn(&Visibility) -> bool| instances.iter().any(|i| is(&i.seen));
        let is_selective = any(|seen| seen.mask != u32::MAX);
        let (hides_backs, is_filtered) = (any(|seen| seen.hides_backs), any(|seen| seen.is_filtered));
        let BuildOptions { engine, precision, preset, .. } = *options;
        let bounds = Bounds3::EMPTY;
        let uses = Uses::new(geometries.len(), instances.iter().map(|instance| instance.geometry.index()));
        let mut accel = Self {
            engine,
            precision,
            preset,
            registers,
            scene,
            movers,
            geometries,
            instances,
            owners,
            uses,
            is_selective,
            hides_backs,
            is_filtered,
            bounds,
            reaches: OnceLock::new(),
        };
        accel.measure();
        accel.name_nodes();
        accel
    }

    /// Sets the box around everything.
    pub(crate) fn measure(&mut self) {
        self.bounds = self.instances.iter().fold(Bounds3::EMPTY, |all, i| all.union(i.finite));
    }

    /// Nodes of all trees.
    pub(crate) fn node_count(&self) -> u32 {
        self.trees().map(|(_, _, tree)| tree.nodes).sum()
    }

    /// Forgets what was known of nodes.
    pub(crate) fn forget_reaches(&mut self) {
        self.reaches = OnceLock::new();
    }

    /// Gives each tree the first of its nodes' names.
    pub(crate) fn name_nodes(&mut self) {
        let own = self.geometries.iter_mut().filter_map(|geometry| geometry.forest.as_mut());
        let movers = self.movers.iter_mut().map(|movers| &mut movers.forest);
        let mut base = 0;
        for tree in std::iter::once(&mut self.scene).chain(movers).chain(own).flat_map(Forest::trees_mut) {
            tree.base = base;
            base += tree.nodes;
        }
    }

    /// All trees and whose they are.
    pub(crate) fn trees(&self) -> impl Iterator<Item = (Option<GeometryId>, &Forest, &Tree)> {
        let own =
            (0..).zip(&self.geometries).filter_map(|(i, g)| Some((Some(GeometryId(i)), g.forest.as_ref()?)));
        let movers = self.movers.iter().map(|movers| (None, &movers.forest));
        let all = std::iter::once((None, &self.scene)).chain(movers).chain(own);
        all.flat_map(|(id, forest)| forest.trees().iter().map(move |tree| (id, forest, tree)))
    }

    /// What primitives of an instance are.
    #[inline]
    pub(crate) fn items(&self, instance: u32) -> &Items {
        &self.geometries[self.instances[instance as usize].geometry.index()].items
    }

    /// Number, u and v of a primitive of a tree as callers know it: of the two triangles of a quad the second counts
    /// from the other corner.
    #[inline]
    pub(crate) fn called(&self, instance: u32, prim: u32, u: f32, v: f32) -> (u32, f32, f32) {
        match self.items(instance) {
            Items::Quads(_) if prim % 2 == 1 => (prim / 2, 1.0 - u, 1.0 - v),
            Items::Quads(_) => (prim / 2, u, v),
            Items::Triangles(_) | Items::Boxes(_) | Items::Curves(..) | Items::Points(..) => (prim, u, v),
        }
    }

    /// Box in render space around all finite primitives, over all time; empty if there are none.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Which instructions walk.
    pub fn isa(&self) -> Isa {
        self.registers.isa()
    }

    /// How hits are found.
    pub fn engine(&self) -> Engine {
        self.engine
    }

    /// Sizes and counts.
    pub fn stats(&self) -> BuildStats {
        let mut stats = BuildStats {
            instances: self.instances.len() as u64,
            bytes: (size_of_val(self.geometries.as_slice()) + size_of_val(self.instances.as_slice())) as u64,
            ..BuildStats::default()
        };
        for geometry in &self.geometries {
            let count = u64::from(geometry.items.len());
            match &geometry.items {
                // Of a quad both triangles are counted where they are stored.
                Items::Triangles(_) | Items::Quads(_) => stats.triangles += count,
                Items::Boxes(_) => stats.user_primitives += count,
                Items::Curves(..) => stats.curve_segments += count,
                Items::Points(..) => stats.points += count,
            }
            stats.bytes += geometry.bytes() as u64;
        }
        let own = self.geometries.iter().filter_map(|g| Some(g.forest.as_ref()?.depth())).max();
        let movers = self.movers.as_ref();
        stats.nodes = u64::from(self.node_count());
        stats.max_depth = self.scene.depth().max(movers.map_or(0, |m| m.forest.depth())) + own.unwrap_or(0);
        let boxes = movers.map_or(0, |m| {
            m.forest.bytes() + m.boxes.iter().map(|b| size_of_val(b.as_slice())).sum::<usize>()
        });
        let poses: usize = self.instances.iter().map(|i| i.pose.bytes()).sum();
        let reaches = self.reaches.get().map_or(0, Reaches::bytes);
        stats.bytes +=
            (self.scene.bytes() + self.owners.bytes() + self.uses.bytes() + boxes + poses + reaches) as u64;
        stats
    }

    /// The box of a node named by a probe; `None` if there is no such node. Names run from 0 to `stats().nodes - 1`.
    pub fn node_bounds(&self, bvh_node: u32) -> Option<NodeBounds> {
        let inside = |tree: &Tree| (tree.base..tree.base + tree.nodes).contains(&bvh_node);
        let (geometry, forest, tree) = self.trees().find(|(_, _, tree)| inside(tree))?;
        let index = bvh_node - tree.base;
        let (bounds, leaf_items) = match (&forest.trees, self.registers.width()) {
            (Trees::Still(_), 16) => tree.node_bounds::<Node<16>>(index),
            (Trees::Still(_), _) => tree.node_bounds::<Node<8>>(index),
            (Trees::Moving { .. }, 16) => tree.node_bounds::<MovingNode<16>>(index),
            (Trees::Moving { .. }, _) => tree.node_bounds::<MovingNode<8>>(index),
        };
        Some(NodeBounds { bounds, geometry, leaf_items })
    }

    /// Which geometry an instance places.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn instance_geometry(&self, instance: u32) -> GeometryId {
        self.instances[instance as usize].geometry
    }

    /// `render_from_object` of an instance at `time` seconds: the very map its rays are transformed by.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn instance_transform(&self, instance: u32, time: f32) -> Transform {
        self.instances[instance as usize].pose.at(time).unwrap_or(Transform::IDENTITY)
    }
}
