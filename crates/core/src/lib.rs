//! Mathematics, spectra and sampling: the vocabulary every other crate of durer speaks.
//!
//! Invariants: no IO, no threads, no clock, no environment, no globals, no `unsafe`.
//! Directions, points and normals are separate types; `f32` carries rendering, `f64` carries scene descriptions.
#![forbid(unsafe_code)]

pub mod id;
pub mod math;
pub mod sampling;
pub mod spectrum;

pub use glam;
pub use id::Id;
