//! What a scene is made of: shapes, materials, media, lights, textures, cameras and the filters of their pictures.
//!
//! Each folder holds a trait, a registry and one file per kind. A new kind is one new file and one line in the
//! registry; parsing, checks, help, reference documentation and the conformance tests iterate over it.
#![forbid(unsafe_code)]

pub mod bsdf;
pub mod camera;
pub mod filter;
pub mod light;
pub mod material;
pub mod medium;
pub mod shape;
mod surface;
pub mod texture;

use durer_core::spectrum::{Basis, Color};
use durer_scene::{ColorInput, FloatInput};

pub use medium::{Fill, Hull, Medium, Volume};
pub use surface::Surface;
use texture::{Looked, Texture, TextureAt, TextureLog, TextureLookup};

/// What materials need to turn a point into a [`bsdf::Bsdf`].
#[derive(Clone, Copy)]
pub struct ShadeCx<'a> {
    /// Meaning of the lanes.
    pub basis: Basis,
    /// The scene's textures, in the order of [`durer_scene::SceneDesc::textures`].
    pub textures: &'a [Box<dyn Texture>],
    /// Where look-ups are noted, if somebody wants to know.
    pub log: Option<&'a TextureLog>,
}

impl ShadeCx<'_> {
    /// The colour of `input` at a point.
    #[inline]
    pub fn color(&self, input: ColorInput, at: &TextureAt) -> Color {
        match input {
            ColorInput::Constant(color) => color,
            ColorInput::Texture(index) => {
                let color = self.textures[index as usize].color(self, at);
                if let Some(log) = self.log {
                    note(log, index, at, Looked::Color(color));
                }
                color
            }
        }
    }
    /// No component of `input` is of larger magnitude anywhere.
    pub fn largest_color(&self, input: ColorInput) -> f32 {
        match input {
            ColorInput::Constant(color) => color.rgb.into_iter().fold(0.0, |most: f32, v| most.max(v.abs())),
            ColorInput::Texture(index) => self.textures[index as usize].largest(self),
        }
    }
    /// The magnitude of `input` is larger nowhere.
    pub fn largest_float(&self, input: FloatInput) -> f32 {
        match input {
            FloatInput::Constant(value) => value.abs(),
            FloatInput::Texture(index) => self.textures[index as usize].largest(self),
        }
    }
    /// The number of `input` at a point.
    #[inline]
    pub fn float(&self, input: FloatInput, at: &TextureAt) -> f32 {
        match input {
            FloatInput::Constant(value) => value,
            FloatInput::Texture(index) => {
                let value = self.textures[index as usize].float(self, at);
                if let Some(log) = self.log {
                    note(log, index, at, Looked::Number(value));
                }
                value
            }
        }
    }
}

/// PERF: apart, so that those who do not ask are short enough to be inlined (docs/benchmarks.md, what recording costs).
#[cold]
#[inline(never)]
fn note(log: &TextureLog, texture: u32, at: &TextureAt, value: Looked) {
    log.borrow_mut().push(TextureLookup { texture, uv: at.uv, value });
}
