//! The same value everywhere.
use durer_core::spectrum::{Color, Spectrum};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{Texture, TextureAt, Value};
use crate::ShadeCx;

/// One value; it may also pass another texture on.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant<V> {
    value: V,
}

impl<V: Value> Texture for Constant<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        self.value.color(cx, at)
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.value.float(cx, at)
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        self.value.weight(cx, at)
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        self.value.largest(cx)
    }
}

impl<V: Value> Kind for Constant<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "constant",
        aliases: &[],
        doc: "The same value everywhere.",
        params: &[ParamSpec::new("value", V::TYPE, V::ONE, "The value; colours are linear Rec. 709.")],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let value = V::read(args, "value");
        args.is_sound().then(|| Box::new(Self { value }) as Box<dyn Texture>)
    }
}
