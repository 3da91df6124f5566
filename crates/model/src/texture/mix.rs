//! Blend of two textures.
use durer_core::spectrum::{Color, Spectrum};
use durer_scene::{Args, FloatInput, Kind, ParamSpec, Schema};

use super::{Texture, TextureAt, Value};
use crate::ShadeCx;

/// `(1 - amount) tex1 + amount tex2`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mix<V> {
    tex1: V,
    tex2: V,
    amount: FloatInput,
}

impl<V: Value> Texture for Mix<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        V::blend((&self.tex1, &self.tex2), cx.float(self.amount, at), |tex| tex.color(cx, at))
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        V::blend((&self.tex1, &self.tex2), cx.float(self.amount, at), |tex| tex.float(cx, at))
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        V::blend((&self.tex1, &self.tex2), cx.float(self.amount, at), |tex| tex.weight(cx, at))
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        let [a, b] = [&self.tex1, &self.tex2].map(|tex| tex.largest(cx));
        let most = cx.largest_float(self.amount);
        // Between both where the amount is a share; it need not be.
        a.max(b).max((1.0 + most) * a + most * b)
    }
}

impl<V: Value> Kind for Mix<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "mix",
        aliases: &[],
        doc: "A blend of two values or textures.",
        params: &[
            ParamSpec::new("tex1", V::TYPE, V::ZERO, "What amount 0 gives."),
            ParamSpec::new("tex2", V::TYPE, V::ONE, "What amount 1 gives."),
            ParamSpec::float_texture("amount", 0.5, "The share of tex2: a number or a float texture."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let (tex1, tex2) = (V::read(args, "tex1"), V::read(args, "tex2"));
        let amount = args.float_input("amount");
        args.is_sound().then(|| Box::new(Self { tex1, tex2, amount }) as Box<dyn Texture>)
    }
}
