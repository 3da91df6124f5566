//! The frozen scene: queries and what a debugger may ask.
use durer_core::math::{Bounds3, Point3, Ray, Transform};

use crate::{
    BuildStats, Engine, GeometryId, Hit, TraversalProbe, UserGeometry,
    geometry::Geometry,
    placement::Pose,
    space::Space,
    traverse::{Query, TopLevel},
    tree::{Span, Tree},
};

/// A geometry somewhere.
#[derive(Clone, Debug)]
pub(crate) struct Instance {
    pub(crate) geometry: GeometryId,
    pub(crate) pose: Pose,
    /// Box in render space around everything, over all time.
    pub(crate) bounds: Bounds3,
    /// That box is finite and excludes something.
    pub(crate) is_bounded: bool,
    /// The same around its finite primitives.
    pub(crate) finite: Bounds3,
}

/// A node's box, for pictures of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeBounds {
    /// In object space of `geometry`, or in render space.
    pub bounds: Bounds3,
    /// Whose tree the node belongs to; `None` for the tree of instances.
    pub geometry: Option<GeometryId>,
    /// Primitives (or instances) right below; 0 for an inner node.
    pub leaf_items: u32,
}

/// A scene of instances, ready for rays. Made by `AccelBuilder::build`; never changes.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(crate) engine: Engine,
    pub(crate) top: Tree,
    /// Instances in the order of the tree's leaves.
    pub(crate) order: Vec<u32>,
    pub(crate) geometries: Vec<Geometry>,
    pub(crate) instances: Vec<Instance>,
    bounds: Bounds3,
    /// The one instance is its geometry itself: rays need not pass a tree of instances. PERF: scenes of still things used
    /// once are like that (bench render).
    pub(crate) is_flat: bool,
}

impl Accel {
    pub(crate) fn assemble(
        engine: Engine,
        mut geometries: Vec<Geometry>,
        instances: Vec<Instance>,
        (top, order): (Tree, Vec<u32>),
    ) -> Self {
        let mut base = top.len() as u32;
        for geometry in &mut geometries {
            geometry.tree.base = base;
            base += geometry.tree.len() as u32;
        }
        let bounds = instances.iter().fold(Bounds3::EMPTY, |all, i| all.union(i.finite));
        let is_flat =
            matches!(instances.as_slice(), [only] if only.pose.is_identity()) && engine == Engine::Bvh;
        Self { engine, top, order, geometries, instances, bounds, is_flat }
    }

    /// The nearest hit of `ray` with `t` in `[t_min, t_max]`; on equal `t` the one with the smaller
    /// `(instance, prim)`. `probe` watches, events carry `id`.
    pub fn closest<U: UserGeometry, P: TraversalProbe>(
        &self,
        ray: &Ray,
        user: &U,
        probe: &mut P,
        id: P::Id,
    ) -> Option<Hit> {
        let (world, t_max) = self.space(ray)?;
        let mut best = Hit::nothing(t_max);
        let mut level = TopLevel { accel: self, query: Query { user, probe, id }, world: &world, t_max };
        if self.is_flat {
            level.only(|tree, leaves| tree.nearest(&world.slab, ray.t_min, &mut best, leaves));
        } else {
            self.top.nearest(&world.slab, ray.t_min, &mut best, &mut level);
        }
        best.found()
    }

    /// Whether anything is hit with `t` in `[t_min, t_max]`: equal to `closest(..).is_some()`, but faster.
    pub fn any<U: UserGeometry, P: TraversalProbe>(
        &self,
        ray: &Ray,
        user: &U,
        probe: &mut P,
        id: P::Id,
    ) -> bool {
        let Some((world, t_max)) = self.space(ray) else {
            return false;
        };
        let mut level = TopLevel { accel: self, query: Query { user, probe, id }, world: &world, t_max };
        let span = Span { t_min: ray.t_min, t_max };
        if self.is_flat {
            return level.only(|tree, leaves| tree.blocks(&world.slab, span, leaves)) == Some(true);
        }
        self.top.blocks(&world.slab, span, &mut level)
    }

    /// The ray made ready, and where it ends.
    fn space<'r>(&self, ray: &'r Ray) -> Option<(Space<'r>, f32)> {
        // A finite end keeps infinity, which a shape's division by 0 may return, from counting as a hit.
        let t_max = if ray.t_max == f32::INFINITY { f32::MAX } else { ray.t_max };
        let valid = ray.t_min <= t_max;
        if valid { Some((Space::new(ray, &self.bounds)?, t_max)) } else { None }
    }

    /// Box in render space around all finite primitives, over all time; empty if there are none.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Sizes and counts.
    pub fn stats(&self) -> BuildStats {
        let mut stats = BuildStats {
            instances: self.instances.len() as u64,
            nodes: self.top.len() as u64,
            bytes: (size_of_val(self.top.pairs.as_slice())
                + size_of_val(self.order.as_slice())
                + size_of_val(self.geometries.as_slice())
                + size_of_val(self.instances.as_slice())) as u64,
            ..BuildStats::default()
        };
        let mut below = 0;
        for geometry in &self.geometries {
            let (triangles, boxes) = geometry.counts();
            stats.triangles += triangles;
            stats.user_primitives += boxes;
            stats.nodes += geometry.tree.len() as u64;
            stats.bytes += geometry.bytes() as u64;
            below = below.max(geometry.tree.depth);
        }
        stats.bytes += self.instances.iter().map(|i| i.pose.bytes() as u64).sum::<u64>();
        stats.max_depth = self.top.depth + below;
        stats
    }

    /// The box of a node named by a probe; `None` if there is no such node. Names run from 0 to `stats().nodes - 1`.
    pub fn node_bounds(&self, bvh_node: u32) -> Option<NodeBounds> {
        let inside = |tree: &Tree| {
            ((tree.base as usize)..tree.base as usize + tree.len()).contains(&(bvh_node as usize))
        };
        let (tree, geometry) = if inside(&self.top) {
            (&self.top, None)
        } else {
            let i = self.geometries.iter().position(|g| inside(&g.tree))?;
            (&self.geometries[i].tree, Some(GeometryId(i as u32)))
        };
        let node = tree.node(bvh_node - tree.base);
        Some(NodeBounds { bounds: node.bounds(), geometry, leaf_items: node.count })
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

    /// The vertices of a triangle at `time`, in the instance's object space; `None` if the geometry is not a mesh.
    ///
    /// # Panics
    /// If there is no such instance or triangle.
    pub fn triangle(&self, instance: u32, prim: u32, time: f32) -> Option<[Point3; 3]> {
        self.geometries[self.instance_geometry(instance).index()].vertices(prim, time)
    }
}
