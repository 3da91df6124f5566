//! Colours and numbers that vary over a surface.
//!
//! A new texture is one file here and one line in [`COLOR_TEXTURES`], [`FLOAT_TEXTURES`] or both: the same word takes
//! other parameters depending on what it is to yield.

mod checkerboard;
mod constant;
pub(crate) mod imagemap;
mod mapping;
mod scale;
mod value;

use std::{cell::RefCell, fmt::Debug};

use durer_core::{
    math::{Point2, Point3},
    spectrum::Color,
};
use durer_scene::{ColorInput, Entry, FloatInput, TextureValue};

use crate::ShadeCx;

pub use checkerboard::Checkerboard;
pub use constant::Constant;
pub use imagemap::{ColorImageMap, FloatImageMap, ImageMap};
pub use scale::Scale;
pub use value::Value;

/// Where a texture is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureAt {
    /// Surface coordinates.
    pub uv: Point2,
    /// The second set of a mesh; the first where there is none.
    pub second_uv: Point2,
    /// The point in render space.
    pub p: Point3,
    /// Linear RGBA factor of the mesh's vertices.
    pub vertex_color: [f32; 4],
}

/// A look-up of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureLookup {
    /// Index of the texture in the scene.
    pub texture: u32,
    /// Surface coordinates where it was asked.
    pub uv: Point2,
    /// What it said.
    pub value: Looked,
}

/// What a texture yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Looked {
    /// A colour, linear Rec. 709.
    Color(Color),
    /// A number.
    Number(f32),
}

/// Look-ups in the order in which they were answered: a texture made of others comes after them.
pub type TextureLog = RefCell<Vec<TextureLookup>>;

/// A texture.
pub trait Texture: Debug + Send + Sync {
    /// The colour at a point, linear Rec. 709.
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color;
    /// The number at a point.
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32;
    /// No component of a colour and no number of it is of larger magnitude.
    fn largest(&self, cx: &ShadeCx<'_>) -> f32;
}

/// All kinds of texture that yield colours.
pub const COLOR_TEXTURES: &[Entry<Box<dyn Texture>>] = &[
    Entry::of::<Checkerboard<ColorInput>>(),
    Entry::of::<Constant<ColorInput>>(),
    Entry::of::<ColorImageMap>(),
    Entry::of::<Scale<ColorInput>>(),
];

/// All kinds of texture that yield numbers.
pub const FLOAT_TEXTURES: &[Entry<Box<dyn Texture>>] = &[
    Entry::of::<Checkerboard<FloatInput>>(),
    Entry::of::<Constant<FloatInput>>(),
    Entry::of::<FloatImageMap>(),
    Entry::of::<Scale<FloatInput>>(),
];

/// Words of pbrt-v4 that are known but not built yet, and the registered kind that is used instead.
pub const NOT_YET: &[(&str, &str)] = &[
    ("bilerp", "constant"),
    ("directionmix", "constant"),
    ("dots", "constant"),
    ("fbm", "constant"),
    ("marble", "constant"),
    ("mix", "constant"),
    ("ptex", "constant"),
    ("windy", "constant"),
    ("wrinkled", "constant"),
];

/// The register of textures that yield `value`.
pub fn textures(value: TextureValue) -> &'static [Entry<Box<dyn Texture>>] {
    match value {
        TextureValue::Color => COLOR_TEXTURES,
        TextureValue::Float => FLOAT_TEXTURES,
    }
}
