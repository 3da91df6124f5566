//! Scene files out: [`durer_scene::SceneDesc`] to text, and the files that lie beside it.
mod beside;
pub mod pbrt;
mod ply;

pub use beside::{Beside, Content, Files};
