//! Scene files out: [`durer_scene::SceneDesc`] to text.
pub mod pbrt;
