//! pbrt's words for how rough a surface is, and the GGX width they mean.
use durer_scene::{Args, FloatInput, ParamDefault, ParamSpec, ParamType};

use crate::{ShadeCx, texture::TextureAt};

/// Roughness of microfacets, the same in all directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roughness {
    u: FloatInput,
    v: FloatInput,
    /// Roughness is the square of the GGX width, as pbrt-v4 has it unless told otherwise.
    remap: bool,
}

impl Roughness {
    pub(super) const BOTH: ParamSpec = ParamSpec::new(
        "roughness",
        ParamType::FloatTexture,
        ParamDefault::Float(0.0),
        "Roughness; 0 is smooth.",
    )
    .range(0.0, 1.0);
    pub(super) const U: ParamSpec = ParamSpec::new(
        "uroughness",
        ParamType::FloatTexture,
        ParamDefault::Unset,
        "Roughness along u; the geometric mean of both directions is used.",
    )
    .range(0.0, 1.0);
    pub(super) const V: ParamSpec =
        ParamSpec::new("vroughness", ParamType::FloatTexture, ParamDefault::Unset, "Roughness along v.")
            .range(0.0, 1.0);
    pub(super) const REMAP: ParamSpec = ParamSpec::new(
        "remaproughness",
        ParamType::Bool,
        ParamDefault::Bool(true),
        "The GGX width is the square root of roughness; if false it is roughness itself.",
    );

    /// Reads the four parameters.
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let both = args.float_input("roughness");
        let mut one = |name: &str| if args.is_set(name) { args.float_input(name) } else { both };
        let (u, v) = (one("uroughness"), one("vroughness"));
        if u != v {
            args.warning(
                "uroughness",
                "roughness that differs along u and v is not supported yet; its mean is used",
            );
        }
        Self { u, v, remap: args.bool("remaproughness") }
    }

    /// The GGX width at a point, in `[0, 1]`.
    pub(super) fn alpha(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.width(|input| cx.float(input, at))
    }

    /// The GGX width if it is the same everywhere.
    pub(super) fn constant(&self) -> Option<f32> {
        match (self.u, self.v) {
            (FloatInput::Constant(u), FloatInput::Constant(v)) => {
                Some(self.width(|input| if input == self.u { u } else { v }))
            }
            _ => None,
        }
    }

    fn width(&self, value: impl Fn(FloatInput) -> f32) -> f32 {
        let value = |input: FloatInput| value(input).clamp(0.0, 1.0);
        let mean = if self.u == self.v { value(self.u) } else { (value(self.u) * value(self.v)).sqrt() };
        if self.remap { mean.sqrt() } else { mean }
    }
}
