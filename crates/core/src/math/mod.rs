//! Points, vectors, normals, rays, bounds, frames and transforms.
//!
//! World space is right-handed and in metres. Matrices are named like the product they are used in:
//! `world_from_object * p_object`.

mod bounds;
pub mod error;
pub mod float;
mod frame;
mod guide;
mod interval;
mod keys;
mod motion;
mod ray;
mod transform;
mod vector;

pub use bounds::Bounds3;
pub use frame::Frame;
pub use guide::Guide;
pub use interval::Interval;
pub use keys::Segment;
pub use motion::Motion;
pub use ray::Ray;
pub use transform::Transform;
pub use vector::{Normal3, Point2, Point3, Vector3};
