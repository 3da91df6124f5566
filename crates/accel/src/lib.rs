//! Where does a ray first meet the scene? Two levels of trees, walked one ray at a time.
//!
//! One tree over the triangles or boxes of each geometry that moves or repeats, one tree over everything else and the
//! placed instances. Curves ([`curve`]) and points ([`point`]) are built in; all other shapes are boxes with a callback
//! ([`UserGeometry`]). A second engine,
//! [`Engine::BruteForce`], tests every primitive with every ray and returns the same hits bit for bit.
//!
//! Scenes that change from picture to picture keep their trees: [`Accel::refit`] gives a geometry new vertices,
//! [`Accel::set_placements`] moves instances, [`Accel::sah_cost`] tells when building anew pays. For antialiasing that must
//! not lose small things [`Accel::near_misses`] tells what a ray passes closely.
//!
#![doc = include_str!("../README.md")]
//!
//! # The contract of a hit
//! - A hit has a finite `t` with `t_min <= t <= t_max`; of two hits with equal `t` the smaller `(instance, prim)` wins.
//! - A hit on a triangle that reaches back beyond the ray's origin lies further from it than the bound on its own rounding
//!   error, so a ray that starts on a triangle, off it by the error of its origin
//!   ([`offset_ray_origin`](math::error::offset_ray_origin)), does not meet it again at `t` = noise. There are no epsilons.
//! - `t` is never less than where the ray enters the primitive's box (and its instance's): if rounding says otherwise,
//!   `t` is raised to it. Boxes of nodes are tested with more slack than that entry is computed with, so that none around
//!   the primitive is entered later than its hit, and culling cannot change a result. Of triangles that [`Preset::High`]
//!   has cut this is tested, not proven: a part's box may begin beyond the entry of the whole.
//! - A ray with a zero or non-finite direction, a non-finite origin or `t_min > t_max` misses everything; also one whose
//!   direction's components add up, in magnitude, to less than 9e-39, or to more than `f32::MAX` with those of its origin.
#![deny(unsafe_code)]

mod accel;
mod build;
mod cost;
pub mod curve;
mod error;
mod geometry;
mod grow;
mod hit;
mod inspect;
mod isa;
mod lanes;
mod layout;
mod owners;
mod placement;
pub mod point;
mod probe;
mod query;
mod simd;
mod slab;
mod space;
mod stats;
mod traverse;
mod tree;
pub mod triangle;
mod user;
mod uses;

pub use accel::{Accel, NodeBounds};
pub use build::{AccelBuilder, BuildOptions, Engine, GeometryData, Precision, Quads, Triangles, Visibility};
pub use durer_core::{glam, math};
pub use error::BuildError;
pub use geometry::GeometryId;
pub use grow::Preset;
pub use hit::{Hit, PrimitiveHit};
pub use inspect::{ChildBox, Held};
pub use isa::Isa;
pub use placement::Placement;
pub use probe::{NoTraversalProbe, TraversalCounts, TraversalProbe};
pub use query::Query;
pub use stats::BuildStats;
pub use traverse::NearMiss;
pub use user::{NoUserGeometry, UserGeometry};
