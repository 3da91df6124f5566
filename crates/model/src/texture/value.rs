//! What a texture yields: numbers or colours. A kind that works for both is written once, generic over this.
use std::fmt::Debug;

use durer_core::spectrum::Color;
use durer_scene::{Args, ColorInput, FloatInput, ParamSpec};

use super::TextureAt;
use crate::ShadeCx;

/// An input of a texture that yields the same kind of value.
pub(super) trait Value: Debug + Copy + Send + Sync + 'static {
    /// The parameter `name`, grey by default.
    fn spec(name: &'static str, default: f32, doc: &'static str) -> ParamSpec {
        let _ = (name, default, doc);
        ParamSpec::float(name, default, doc)
    }
    /// Its value in `args`.
    fn read(args: &mut Args<'_>, name: &str) -> Self;
    /// As a colour; a number is grey.
    fn color(self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color;
    /// As a number; of a colour, its luminance.
    fn float(self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32;
}

impl Value for ColorInput {
    fn read(args: &mut Args<'_>, name: &str) -> Self {
        args.color_input(name)
    }
    fn color(self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        cx.color(self, at)
    }
    fn float(self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        cx.color(self, at).luminance()
    }
}

impl Value for FloatInput {
    fn read(args: &mut Args<'_>, name: &str) -> Self {
        args.float_input(name)
    }
    fn color(self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        Color::gray(cx.float(self, at))
    }
    fn float(self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        cx.float(self, at)
    }
}
