//! Product of a texture and a number that may be a texture too.
use durer_core::spectrum::{Color, Spectrum};
use durer_scene::{Args, FloatInput, Kind, ParamSpec, Schema};

use super::{Texture, TextureAt, Value};
use crate::ShadeCx;

/// `tex * scale`.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale<V> {
    tex: V,
    scale: FloatInput,
}

impl<V: Value> Texture for Scale<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        self.tex.color(cx, at) * cx.float(self.scale, at)
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.tex.float(cx, at) * cx.float(self.scale, at)
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        self.tex.weight(cx, at) * cx.float(self.scale, at)
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        self.tex.largest(cx) * cx.largest_float(self.scale)
    }
}

impl<V: Value> Kind for Scale<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "scale",
        aliases: &[],
        doc: "The product of a texture and a number.",
        params: &[
            ParamSpec::new("tex", V::TYPE, V::ONE, "What is scaled."),
            ParamSpec::float_texture("scale", 1.0, "The factor: a number or a float texture."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let (tex, scale) = (V::read(args, "tex"), args.float_input("scale"));
        args.is_sound().then(|| Box::new(Self { tex, scale }) as Box<dyn Texture>)
    }
}
