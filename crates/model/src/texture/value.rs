//! What a texture yields: numbers or colours. A kind that works for both is written once, generic over this.
use std::{
    fmt::Debug,
    ops::{Add, Mul},
};

use durer_core::spectrum::{Color, Spectrum};
use durer_scene::{Args, ColorInput, FloatInput, ParamDefault, ParamType};

use super::TextureAt;
use crate::ShadeCx;

/// An input of a texture, of the kind of value that the texture itself yields.
pub trait Value: Debug + Clone + Send + Sync + 'static {
    /// What scene files may give.
    const TYPE: ParamType;
    /// 0 or black.
    const ZERO: ParamDefault;
    /// 1 or white.
    const ONE: ParamDefault;
    /// The parameter `name` of `args`.
    fn read(args: &mut Args<'_>, name: &str) -> Self;
    /// As a colour; a number is grey.
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color;
    /// As a number; of a colour, its luminance.
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32;
    /// As [`super::Texture::weight`].
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum;
    /// As [`super::Texture::largest`].
    fn largest(&self, cx: &ShadeCx<'_>) -> f32;

    /// `(1 - share) a + share b` of what `of` says of `a` and `b`; what has no share is not looked up.
    fn blend<T: Add<Output = T> + Mul<f32, Output = T>>(
        (a, b): (&Self, &Self),
        share: f32,
        of: impl Fn(&Self) -> T,
    ) -> T {
        if share == 0.0 {
            return of(a);
        }
        if share == 1.0 {
            return of(b);
        }
        of(a) * (1.0 - share) + of(b) * share
    }
}

impl Value for ColorInput {
    const TYPE: ParamType = ParamType::ColorTexture;
    const ZERO: ParamDefault = ParamDefault::Triple([0.0; 3]);
    const ONE: ParamDefault = ParamDefault::Triple([1.0; 3]);
    fn read(args: &mut Args<'_>, name: &str) -> Self {
        args.color_input(name)
    }
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        cx.color(self, at)
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        cx.color(self, at).luminance()
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        cx.weight(self, at, |v| v.max(0.0))
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        cx.largest_color(self)
    }
}

impl Value for FloatInput {
    const TYPE: ParamType = ParamType::FloatTexture;
    const ZERO: ParamDefault = ParamDefault::Float(0.0);
    const ONE: ParamDefault = ParamDefault::Float(1.0);
    fn read(args: &mut Args<'_>, name: &str) -> Self {
        args.float_input(name)
    }
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        Color::gray(cx.float(*self, at))
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        cx.float(*self, at)
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        Spectrum::splat(cx.float(*self, at))
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        cx.largest_float(*self)
    }
}
