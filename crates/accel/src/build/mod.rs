//! From geometries and placements to an `Accel`.
mod sah;

use durer_core::math::{Bounds3, Point3};

use crate::{
    Accel, BuildError, GeometryId, Placement, Triangles, accel::Instance, geometry::Geometry, placement::Pose,
};

pub(crate) use sah::grow;

/// How rays find their hits. Both give the same ones, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// Walk trees of boxes.
    #[default]
    Bvh,
    /// Test every primitive of every instance with every ray, shadow rays too, never stopping early: the lecture's
    /// loop, whose cost is exactly primitives times rays.
    BruteForce,
}

/// Choices of a build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildOptions {
    /// How rays find their hits.
    pub engine: Engine,
    /// Most primitives in a leaf; 0 counts as 1.
    pub leaf_max: u32,
    /// Candidate split planes per axis, plus one; clamped to 2..=32.
    pub bins: u32,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self { engine: Engine::Bvh, leaf_max: 4, bins: 16 }
    }
}

/// Collects geometries and instances. The order of calls decides the ids and with them ties.
#[derive(Debug)]
pub struct AccelBuilder {
    options: BuildOptions,
    geometries: Vec<Geometry>,
    instances: Vec<Instance>,
}

impl AccelBuilder {
    /// An empty scene.
    pub fn new(options: BuildOptions) -> Self {
        Self { options, geometries: Vec::new(), instances: Vec::new() }
    }

    /// Adds a mesh and builds its tree.
    ///
    /// # Errors
    /// A vertex that is not finite, an index that is out of range, or too many triangles.
    pub fn triangles(&mut self, mesh: Triangles) -> Result<GeometryId, BuildError> {
        let geometry = Geometry::triangles(&mesh.positions, &mesh.indices, &self.options)?;
        self.add(geometry)
    }

    /// Adds a mesh whose vertices move: `(seconds, positions)` with rising times, each vertex on a straight line between
    /// keys, still before the first and after the last. A single key makes an ordinary mesh.
    ///
    /// # Errors
    /// As [`AccelBuilder::triangles`]; keys of different lengths or whose times do not rise.
    pub fn keyed_triangles<'a>(
        &mut self,
        indices: &[[u32; 3]],
        keys: impl IntoIterator<Item = (f32, &'a [Point3])>,
    ) -> Result<GeometryId, BuildError> {
        let keys: Vec<_> = keys.into_iter().collect();
        let geometry = match keys.as_slice() {
            [] => Geometry::triangles(&[], indices, &self.options)?,
            [(_, positions)] => Geometry::triangles(positions, indices, &self.options)?,
            keys => Geometry::moving(indices, keys, &self.options)?,
        };
        self.add(geometry)
    }

    /// Adds shapes known by their boxes only; rays that may meet one are handed to the `UserGeometry` of the query.
    /// A box must contain its shape; it may be infinite (a plane), then every ray is tested against it.
    ///
    /// # Errors
    /// A box that is NaN or has `min > max`, or too many boxes.
    pub fn user(&mut self, bounds: Vec<Bounds3>) -> Result<GeometryId, BuildError> {
        let geometry = Geometry::boxes(&bounds, &self.options)?;
        self.add(geometry)
    }

    fn add(&mut self, geometry: Geometry) -> Result<GeometryId, BuildError> {
        let id = BuildError::check_count(self.geometries.len(), "geometries")?;
        self.geometries.push(geometry);
        Ok(GeometryId(id))
    }

    /// Places a geometry; returns the instance's index. A geometry may be placed any number of times, or never.
    ///
    /// # Errors
    /// A geometry of another builder, a transform without inverse, motion keys whose times do not rise, or too many
    /// instances.
    pub fn instance(&mut self, geometry: GeometryId, placement: Placement) -> Result<u32, BuildError> {
        let index = BuildError::check_count(self.instances.len(), "instances")?;
        let Some(placed) = self.geometries.get(geometry.index()) else {
            return Err(BuildError::GeometryUnknown { geometry: geometry.0 });
        };
        let pose = Pose::new(placement, self.instances.len())?;
        let bounds = pose.bounds(&placed.bounds);
        let finite = Some(pose.bounds(&placed.finite)).filter(Bounds3::is_finite).unwrap_or(Bounds3::EMPTY);
        let is_bounded = bounds.is_finite();
        self.instances.push(Instance { geometry, pose, bounds, is_bounded, finite });
        Ok(index)
    }

    /// Builds the tree of instances and freezes the scene.
    pub fn build(self) -> Accel {
        let (top, order) = grow(self.instances.iter().map(|i| i.bounds), &self.options);
        Accel::assemble(self.options.engine, self.geometries, self.instances, (top, order))
    }
}
