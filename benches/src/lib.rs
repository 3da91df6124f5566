//! What a benchmark of the kernel needs: scenes, rays, competitors, timing in turns, ratios.
//!
//! `cargo xtask bench kernel` runs it; `docs/benchmarks.md` says how it measures and what its figures mean.
#![forbid(unsafe_code)]

pub mod embree;
pub mod load;
pub mod options;
pub mod ours;
pub mod pin;
pub mod ratio;
pub mod rays;
pub mod report;
pub mod scene;
pub mod spawn;
pub mod terrain;
pub mod turns;
pub mod view;
