//! Geometry: where rays hit.
//!
//! A new shape is one file here and one line in [`SHAPES`].

mod bilinear;
mod chord;
mod curve;
mod cylinder;
mod disk;
mod displace;
pub(crate) mod flat;
pub mod loopsubdiv;
mod mesh;
mod plane;
mod plymesh;
pub mod polygon;
mod sdfgrid;
mod sphere;
mod trianglemesh;

use std::{f32::consts::TAU, fmt::Debug, sync::Arc};

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Point2, Ray, float},
};
use durer_scene::{Entry, Mesh, ParamDefault, ParamSpec, ParamType};

pub use bilinear::{BilinearMesh, Patch};
pub use curve::{Curve, StrandForm, Strands};
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use displace::{Displacement, MOST_TRIANGLES, Vertex, displaced};
pub use loopsubdiv::LoopSubdiv;
pub use mesh::mesh_surface;
pub use plane::Plane;
pub use plymesh::PlyMesh;
pub use polygon::Polygon;
pub use sdfgrid::SdfGrid;
pub use sphere::Sphere;
pub use trianglemesh::TriangleMesh;

use crate::Surface;

/// Where a ray meets a shape; `u` and `v` are the shape's own notes for [`Shape::surface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// Ray parameter.
    pub t: f32,
    /// First note.
    pub u: f32,
    /// Second note.
    pub v: f32,
}

/// A shape that is no mesh. Everything is in object space.
pub trait Shape: Debug + Send + Sync {
    /// The smallest box; [`Bounds3::UNBOUNDED`] for infinite shapes.
    fn bounds(&self) -> Bounds3;
    /// The nearest hit with `t` in `[ray.t_min, ray.t_max]` that lies beyond `t_min` by more than its rounding error.
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit>;
    /// The place of a hit that [`Shape::intersect`] gave for this ray, with the error bound of its point.
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface;
    /// Surface area; infinite for infinite shapes.
    fn area(&self) -> f32;
    /// What it is for those who choose points of it, as lights do.
    fn outline(&self) -> Outline;
    /// A point chosen by `u` in `[0, 1)²`, which is spread over the area as evenly as can be; asked of
    /// [`Outline::Sphere`] and [`Outline::Curved`]. `None` if there is nothing to choose from.
    fn by_area(&self, u: Point2) -> Option<AreaPoint> {
        let _ = u;
        None
    }
    /// The density, in 1/m², with which [`Shape::by_area`] gives the point `p` of the shape, which is seen from `from`.
    fn area_density(&self, from: DVec3, p: DVec3) -> f64 {
        let _ = (from, p);
        1.0 / f64::from(self.area())
    }
}

/// A point chosen on a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaPoint {
    /// The point.
    pub p: DVec3,
    /// Unit normal, on the outside.
    pub n: DVec3,
    /// Density of the choice, 1/m².
    pub density: f64,
}

/// A shape as those see it who choose points of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// A whole sphere around the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A corner and both edges; the outside is towards their cross product.
    Parallelogram(DVec3, [DVec3; 2]),
    /// Triangles that cover it, each point once; the outside is where their corners are seen counter-clockwise.
    Triangles(Vec<[DVec3; 3]>),
    /// Points of it can be chosen by [`Shape::by_area`] only.
    Curved,
    /// Triangles near it, of which the outside is as of those that cover it; no point of it can be chosen.
    Near(Vec<[DVec3; 3]>),
    /// It goes on without end: no point of it can be chosen.
    Infinite,
}

/// What a shape's description becomes.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Triangles, which the kernel intersects itself.
    Mesh(Arc<Mesh>),
    /// Anything else: one shape, or the parts of one.
    Shapes(Vec<Arc<dyn Shape>>),
    /// Curves, which the kernel intersects itself.
    Strands(Arc<Strands>),
}

impl Geometry {
    /// A single shape.
    pub fn shape(shape: impl Shape + 'static) -> Self {
        Self::Shapes(vec![Arc::new(shape)])
    }
}

/// All kinds of shape.
pub const SHAPES: &[Entry<Geometry>] = &[
    Entry::of::<BilinearMesh>(),
    Entry::of::<Curve>(),
    Entry::of::<Cylinder>(),
    Entry::of::<Disk>(),
    Entry::of::<LoopSubdiv>(),
    Entry::of::<Plane>(),
    Entry::of::<PlyMesh>(),
    Entry::of::<Polygon>(),
    Entry::of::<SdfGrid>(),
    Entry::of::<Sphere>(),
    Entry::of::<TriangleMesh>(),
];

/// What every shape of pbrt takes; importers make its material a mask.
const RADIUS: ParamSpec = ParamSpec::float("radius", 1.0, "Radius.").unit("m").above(0.0, f32::INFINITY);

const PHI_MAX: ParamSpec =
    ParamSpec::float("phimax", 360.0, "Angle kept about the z axis, from the x axis towards y.")
        .unit("deg")
        .above(0.0, 360.0);

const ALPHA: ParamSpec = ParamSpec::new(
    "alpha",
    ParamType::FloatTexture,
    ParamDefault::Unset,
    "Share of the surface that is there, 0 to 1: the alpha of a material \"mask\".",
);

/// `t` rounded, if it lies in the ray's interval and beyond its lower end by more than `error`, the bound on what is
/// wrong with it, and by more than rounding it changes it.
fn accept(ray: &Ray, t: f64, error: f64) -> Option<f32> {
    let rounded = t as f32;
    let beyond = t - f64::from(ray.t_min) > error && rounded > ray.t_min;
    (beyond && rounded <= ray.t_max && rounded.is_finite()).then_some(rounded)
}

/// An angle in degrees, at most a full turn, in radians; 360 gives exactly [`TAU`].
fn arc_angle(degrees: f32) -> f32 {
    if degrees >= 360.0 { TAU } else { degrees.to_radians() }
}

/// Angle of `(x, y)` from the x axis towards y in `[0, TAU]`.
fn azimuth(x: f32, y: f32) -> f32 {
    let angle = float::atan2(y, x);
    if angle < 0.0 { angle + TAU } else { angle.abs() }
}
