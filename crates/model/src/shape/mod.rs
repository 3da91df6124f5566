//! Geometry: where rays hit.
//!
//! A new shape is one file here and one line in [`SHAPES`].

use std::fmt::Debug;

use durer_core::math::{Bounds3, Ray};
use durer_scene::{Entry, Mesh};

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
}

/// What a shape's description becomes.
#[derive(Debug)]
pub enum Geometry {
    /// Triangles, which the kernel intersects itself.
    Mesh(Mesh),
    /// Anything else.
    Shape(Box<dyn Shape>),
}

/// All kinds of shape.
pub const SHAPES: &[Entry<Geometry>] = &[];
