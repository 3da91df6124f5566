//! From geometries and placements to an `Accel`.
mod assemble;
mod emit;
mod moving;
mod options;
mod source;
mod subject;

use std::borrow::Cow;

use durer_core::math::{Bounds3, Point3};

use crate::{
    Accel, BuildError, GeometryId, Placement,
    accel::Instance,
    placement::Pose,
    slab::{extent, grown},
};

pub use options::{BuildOptions, Engine, Precision, Visibility};
use source::Source;
pub use source::{Quads, Triangles};
pub(crate) use subject::Stretch;

/// Collects geometries and instances. The order of calls decides the ids and with them ties.
///
/// ```
/// use durer_accel::math::{Point3, Ray, Transform, Vector3};
/// use durer_accel::{AccelBuilder, BuildOptions, Placement, Triangles};
///
/// let mut builder = AccelBuilder::new(BuildOptions::default());
/// let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from).to_vec();
/// let mesh = builder.triangles(Triangles { positions, indices: vec![[0, 1, 2]] })?;
/// // The same mesh twice: here, and four further on.
/// builder.instance(mesh, Placement::Identity)?;
/// builder.instance(mesh, Placement::Still(Transform::translate(Vector3::new(0.0, 0.0, 4.0))))?;
/// let accel = builder.build()?;
///
/// let ray = Ray { t_min: 1.5, ..Ray::new(Point3::new(0.0, 0.0, -1.0), Vector3::new(0.0, 0.0, 1.0)) };
/// let hit = accel.closest(&ray).expect("beyond the first there is the second");
/// assert_eq!((hit.instance, hit.t), (1, 5.0));
/// # Ok::<(), durer_accel::BuildError>(())
/// ```
#[derive(Debug)]
pub struct AccelBuilder<'a> {
    options: BuildOptions,
    sources: Vec<Source<'a>>,
    instances: Vec<Instance>,
}

impl<'a> AccelBuilder<'a> {
    /// An empty scene.
    pub fn new(options: BuildOptions) -> Self {
        Self { options, sources: Vec::new(), instances: Vec::new() }
    }

    /// Adds a mesh.
    ///
    /// # Errors
    /// A vertex that is not finite, an index that is out of range, or too many triangles.
    pub fn triangles(&mut self, mesh: Triangles) -> Result<GeometryId, BuildError> {
        self.add(Source::triangles(Cow::Owned(mesh.positions), Cow::Owned(mesh.indices))?)
    }

    /// Adds a mesh that stays where it is until the scene is built.
    ///
    /// # Errors
    /// As [`AccelBuilder::triangles`].
    pub fn borrowed_triangles(
        &mut self,
        positions: &'a [Point3],
        indices: &'a [[u32; 3]],
    ) -> Result<GeometryId, BuildError> {
        self.add(Source::triangles(Cow::Borrowed(positions), Cow::Borrowed(indices))?)
    }

    /// Adds a mesh of quads.
    ///
    /// # Errors
    /// As [`AccelBuilder::triangles`].
    pub fn quads(&mut self, mesh: Quads) -> Result<GeometryId, BuildError> {
        self.add(Source::quads(mesh)?)
    }

    /// Adds a mesh whose vertices move: `(seconds, positions)` with rising times, each vertex on a straight line between
    /// keys, still before the first and after the last. A single key makes an ordinary mesh.
    ///
    /// # Errors
    /// As [`AccelBuilder::triangles`]; keys of different lengths or whose times do not rise.
    pub fn keyed_triangles(
        &mut self,
        indices: &'a [[u32; 3]],
        keys: impl IntoIterator<Item = (f32, &'a [Point3])>,
    ) -> Result<GeometryId, BuildError> {
        let keys = keys.into_iter().map(|(time, positions)| (time, Cow::Borrowed(positions)));
        self.add(Source::keyed(Cow::Borrowed(indices), keys.collect())?)
    }

    /// Adds shapes known by their boxes only; rays that may meet one are handed to the `UserGeometry` of the query.
    /// A box must contain its shape; it may be infinite (a plane), then every ray is tested against it.
    ///
    /// # Errors
    /// A box that is NaN or has `min > max`, or too many boxes.
    pub fn user(&mut self, bounds: Vec<Bounds3>) -> Result<GeometryId, BuildError> {
        self.add(Source::boxes(bounds)?)
    }

    fn add(&mut self, source: Source<'a>) -> Result<GeometryId, BuildError> {
        let id = BuildError::check_count(self.sources.len(), "geometries")?;
        self.sources.push(source);
        Ok(GeometryId(id))
    }

    /// Places a geometry where all rays see it; returns the instance's index. A geometry may be placed any number of
    /// times, or never.
    ///
    /// # Errors
    /// A geometry of another builder, a transform without inverse, motion keys whose times do not rise, or too many
    /// instances.
    pub fn instance(&mut self, geometry: GeometryId, placement: Placement) -> Result<u32, BuildError> {
        self.instance_seen(geometry, placement, Visibility::default())
    }

    /// Places a geometry for some rays.
    ///
    /// # Errors
    /// As [`AccelBuilder::instance`].
    pub fn instance_seen(
        &mut self,
        geometry: GeometryId,
        placement: Placement,
        seen: Visibility,
    ) -> Result<u32, BuildError> {
        let index = BuildError::check_count(self.instances.len(), "instances")?;
        let Some(source) = self.sources.get(geometry.index()) else {
            return Err(BuildError::GeometryUnknown { geometry: geometry.0 });
        };
        let pose = Pose::new(placement, self.instances.len())?;
        self.instances.push(Instance::new(geometry, pose, source.bounds(), seen));
        Ok(index)
    }

    /// Builds all trees and freezes the scene.
    ///
    /// # Errors
    /// Instructions that this processor lacks, or a tree larger than links can reach.
    pub fn build(self) -> Result<Accel, BuildError> {
        assemble::assemble(&self.options, &self.sources, self.instances)
    }
}

impl Instance {
    fn new(geometry: GeometryId, pose: Pose, [all, finite]: [Bounds3; 2], seen: Visibility) -> Self {
        let bounds = pose.bounds(&all);
        let finite = Some(pose.bounds(&finite)).filter(Bounds3::is_finite).unwrap_or(Bounds3::EMPTY);
        let is_bounded = bounds.is_finite();
        let bounds = if is_bounded { grown(&bounds, extent(&bounds)) } else { bounds };
        let mirrors = pose.mirrors();
        Self { geometry, mover: Self::STANDS, seen, mirrors, is_bounded, bounds, finite, pose }
    }
}
