//! From geometries and placements to an `Accel`.
mod animate;
mod assemble;
mod data;
mod emit;
mod journal;
mod maker;
mod moving;
mod options;
mod refit;
mod source;
mod subject;

use std::borrow::Cow;

use durer_core::math::{Bounds3, Point3};

use crate::{
    Accel, BuildError, GeometryId, Placement,
    accel::Instance,
    curve::Curves,
    placement::Pose,
    point::Points,
    slab::{extent, grown},
};

pub use data::GeometryData;
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
    /// Boxes around everything in each, and around what is finite there: asked for by every instance.
    bounds: Vec<[Bounds3; 2]>,
    /// Which of them keep trees of their own.
    apart: Vec<bool>,
    instances: Vec<Instance>,
}

impl<'a> AccelBuilder<'a> {
    /// An empty scene.
    pub fn new(options: BuildOptions) -> Self {
        let (sources, bounds, apart) = (Vec::new(), Vec::new(), Vec::new());
        Self { options, sources, bounds, apart, instances: Vec::new() }
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

    /// Adds segments of curves, each a primitive. Hits have the `u` and `v` of [`CurveHit`](crate::curve::CurveHit) and its
    /// unit normal, in object space; a curve under a transform that stretches it is stretched with its radii. They lie
    /// in the space of the instance like shapes of the caller, but need no `UserGeometry`.
    ///
    /// # Errors
    /// [`BuildError::Curves`] if [`Curves::check`] finds a mistake; too many segments.
    pub fn curves(&mut self, curves: Curves) -> Result<GeometryId, BuildError> {
        self.add(Source::curves(curves)?)
    }

    /// Adds points, each a primitive: spheres and discs. `u` and `v` of a hit are 0, its normal is that of
    /// [`PointHit`](crate::point::PointHit), in object space.
    ///
    /// # Errors
    /// [`BuildError::Points`] if [`Points::check`] finds a mistake; too many points.
    pub fn points(&mut self, points: Points) -> Result<GeometryId, BuildError> {
        self.add(Source::points(points)?)
    }

    fn add(&mut self, source: Source<'a>) -> Result<GeometryId, BuildError> {
        let id = BuildError::check_count(self.sources.len(), "geometries")?;
        self.bounds.push(source.bounds());
        self.sources.push(source);
        self.apart.push(false);
        Ok(GeometryId(id))
    }

    /// Gives a geometry a tree of its own in any case, so that `Accel::set_placement` can move its instances. Otherwise
    /// what is placed once and stands still lies in the scene's own tree, which makes rays faster. Hits are the same up to
    /// rounding.
    ///
    /// # Errors
    /// A geometry of another builder.
    pub fn keep_apart(&mut self, geometry: GeometryId) -> Result<(), BuildError> {
        let unknown = BuildError::GeometryUnknown { geometry: geometry.0 };
        *self.apart.get_mut(geometry.index()).ok_or(unknown)? = true;
        Ok(())
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
        let Some(&bounds) = self.bounds.get(geometry.index()) else {
            return Err(BuildError::GeometryUnknown { geometry: geometry.0 });
        };
        let pose = Pose::new(placement, self.instances.len())?;
        self.instances.push(Instance::new(geometry, pose, bounds, seen));
        Ok(index)
    }

    /// Builds all trees and freezes the scene.
    ///
    /// # Errors
    /// Instructions that this processor lacks, or a tree larger than links can reach.
    pub fn build(self) -> Result<Accel, BuildError> {
        assemble::assemble(&self.options, &self.sources, &self.apart, self.instances)
    }
}

impl Instance {
    fn new(geometry: GeometryId, pose: Pose, bounds: [Bounds3; 2], seen: Visibility) -> Self {
        let empty = Bounds3::EMPTY;
        let mover = Self::STANDS;
        let mut instance = Self {
            geometry,
            mover,
            seen,
            mirrors: pose.mirrors(),
            is_plain: false,
            is_bounded: false,
            bounds: empty,
            finite: empty,
            pose,
        };
        instance.measure(bounds);
        instance
    }

    /// Sets its boxes: `all` and `finite` are those of its geometry in object space.
    fn measure(&mut self, [all, finite]: [Bounds3; 2]) {
        let bounds = self.pose.bounds(&all);
        self.finite = Some(self.pose.bounds(&finite)).filter(Bounds3::is_finite).unwrap_or(Bounds3::EMPTY);
        self.is_bounded = bounds.is_finite();
        self.bounds = if self.is_bounded { grown(&bounds, extent(&bounds)) } else { bounds };
    }
}
