//! What a scene is made of: shapes, materials, lights, textures, cameras and the filters of their pictures.
//!
//! Each folder holds a trait, a registry and one file per kind. A new kind is one new file and one line in the
//! registry; parsing, checks, help, reference documentation and the conformance tests iterate over it.
#![forbid(unsafe_code)]

pub mod bsdf;
pub mod camera;
pub mod filter;
pub mod light;
pub mod material;
mod medium;
pub mod shape;
mod surface;
pub mod texture;

use durer_core::spectrum::{Basis, Color, Spectrum};
use durer_scene::{ColorInput, FloatInput};

pub use medium::Medium;
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
    /// The colour of `input` at a point; of a measured curve, the one that stands for it.
    #[inline]
    pub fn color(&self, input: &ColorInput, at: &TextureAt) -> Color {
        match input {
            ColorInput::Constant(color) | ColorInput::Curve(color, _) => *color,
            ColorInput::Texture(index) => self.looked_up(*index, at),
        }
    }
    /// The lanes of `input` at a point, a weight; every component is first brought into a range by `f`.
    #[inline]
    pub fn weight(&self, input: &ColorInput, at: &TextureAt, f: impl Fn(f32) -> f32) -> Spectrum {
        match input {
            ColorInput::Constant(color) => self.basis.reflectance(color.map(f)),
            ColorInput::Texture(index) => match self.basis {
                Basis::Rgb => self.basis.reflectance(self.looked_up(*index, at).map(f)),
                Basis::Spectral(_) => self.weight_looked_up(*index, at).map(f),
            },
            ColorInput::Curve(color, curve) => self.basis.curve(curve, *color).map(f),
        }
    }
    #[inline]
    fn looked_up(&self, index: u32, at: &TextureAt) -> Color {
        let color = self.textures[index as usize].color(self, at);
        if let Some(log) = self.log {
            note(log, index, at, Looked::Color(color));
        }
        color
    }
    fn weight_looked_up(&self, index: u32, at: &TextureAt) -> Spectrum {
        if self.log.is_some() {
            self.looked_up(index, at);
        }
        self.textures[index as usize].weight(&ShadeCx { log: None, ..*self }, at)
    }
    /// No component of `input` is of larger magnitude anywhere.
    pub fn largest_color(&self, input: &ColorInput) -> f32 {
        let largest = |color: &Color| color.rgb.into_iter().fold(0.0, |most: f32, v| most.max(v.abs()));
        match input {
            ColorInput::Constant(color) => largest(color),
            ColorInput::Texture(index) => self.textures[*index as usize].largest(self),
            ColorInput::Curve(color, curve) => {
                curve.ends().into_iter().fold(largest(color), |most, v| most.max(v.abs()))
            }
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
