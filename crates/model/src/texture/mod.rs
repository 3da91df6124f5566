//! Colours and numbers that vary over a surface.
//!
//! A new texture is one file here and one line in [`TEXTURES`].

use std::fmt::Debug;

use durer_core::{
    math::{Point2, Point3},
    spectrum::Color,
};
use durer_scene::Entry;

use crate::ShadeCx;

/// Where a texture is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureAt {
    /// Surface coordinates.
    pub uv: Point2,
    /// The point in render space.
    pub p: Point3,
    /// Linear RGBA factor of the mesh's vertices.
    pub vertex_color: [f32; 4],
}

/// A texture.
pub trait Texture: Debug + Send + Sync {
    /// The colour at a point, linear Rec. 709.
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color;
    /// The number at a point.
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32;
}

/// All kinds of texture.
pub const TEXTURES: &[Entry<Box<dyn Texture>>] = &[];
