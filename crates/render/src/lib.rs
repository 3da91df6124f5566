//! From a described scene to a film: compilation, light transport, probes, the film and the driver.
//!
//! Layers, top to bottom: `drive` knows films and threads; `integrator` knows scenes and probes, but no film, tile or
//! file; `probe` only watches; `compile` turns a [`durer_scene::SceneDesc`] into a frozen [`Scene`].
#![forbid(unsafe_code)]

pub mod compile;
pub mod drive;
mod emitters;
pub mod film;
mod footprint;
pub mod integrator;
mod light_sampler;
mod media;
mod pieces;
pub mod probe;
mod sample;
mod scene;
mod view;

pub use light_sampler::{Chosen, LightSampler, Lit};
pub use media::{ImbalanceTotals, Imbalances, Media, MediumStack};
pub use pieces::{Form, Piece};
pub use sample::{Below, Contribution, PathRay, SampleCx, Splat, Value};
pub use scene::{Object, Scene};
pub use view::{CameraPlacement, Sighted, View};
