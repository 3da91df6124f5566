//! Checkerboard of unit squares.
//!
//! `tex1` where `floor(u') + floor(v')` is even, `tex2` elsewhere (Physically Based Rendering, 4th edition, section 10.4).
//! A square owns its lower and left edge, also at negative coordinates. Not filtered.
use durer_core::spectrum::Color;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Texture, TextureAt, Value,
    mapping::{MAPPING, U_DELTA, U_SCALE, UV_SET, UvMapping, V_DELTA, V_SCALE},
};
use crate::ShadeCx;

/// Two alternating textures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard<V> {
    tex1: V,
    tex2: V,
    mapping: UvMapping,
}

impl<V: Value> Checkerboard<V> {
    fn square(&self, at: &TextureAt) -> V {
        // Parities are added, not floors: large coordinates would round their sum.
        // PERF: floor is a call where the processor is not known to have SSE4.1 (bench render).
        let odd = self.mapping.apply(at).map(|c| {
            let truncated = c as i64;
            let floor = truncated - i64::from(c < truncated as f64);
            floor & 1 == 1
        });
        if odd[0] == odd[1] { self.tex1 } else { self.tex2 }
    }
}

impl<V: Value> Texture for Checkerboard<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        self.square(at).color(cx, at)
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.square(at).float(cx, at)
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        self.tex1.largest(cx).max(self.tex2.largest(cx))
    }
}

impl<V: Value> Kind for Checkerboard<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "checkerboard",
        aliases: &[],
        doc: "Two values or textures on alternating unit squares of texture space; tex1 in [0, 1)².",
        params: &[
            ParamSpec::new("tex1", V::TYPE, V::ONE, "On squares whose coordinates add up to an even number."),
            ParamSpec::new("tex2", V::TYPE, V::ZERO, "On the other squares."),
            UV_SET,
            U_SCALE,
            V_SCALE,
            U_DELTA,
            V_DELTA,
            MAPPING,
            ParamSpec::new(
                "dimension",
                ParamType::Int,
                ParamDefault::Int(2),
                "Only 2, squares, is supported.",
            )
            .range(2.0, 3.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        if args.int("dimension") == 3 {
            args.error("dimension", "checkerboards of dimension 3 are not supported yet, only 2");
        }
        let mapping = UvMapping::read(args);
        let (tex1, tex2) = (V::read(args, "tex1"), V::read(args, "tex2"));
        args.is_sound().then(|| Box::new(Self { tex1, tex2, mapping }) as Box<dyn Texture>)
    }
}
