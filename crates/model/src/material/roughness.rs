//! pbrt's words for how rough a surface is, and the microfacets they mean.
use durer_core::math::{Frame, Vector3};
use durer_scene::{Args, FloatInput, ParamDefault, ParamSpec, ParamType};

use super::sent::facet_gain;
use crate::{
    ShadeCx, Surface,
    bsdf::{Distribution, Facets, Shadowing},
};

/// Roughness of microfacets, along u and across it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roughness {
    u: FloatInput,
    v: FloatInput,
    /// Roughness is the square of the width, as pbrt-v4 has it unless told otherwise.
    remap: bool,
    like: Distribution,
    shadowing: Shadowing,
}

/// What the four parameters are called.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words {
    pub(super) both: &'static str,
    pub(super) u: &'static str,
    pub(super) v: &'static str,
}

impl Words {
    pub(super) const USUAL: Self = Self { both: "roughness", u: "uroughness", v: "vroughness" };

    pub(super) const fn both(self) -> ParamSpec {
        let (ty, default) = (ParamType::FloatTexture, ParamDefault::Float(0.0));
        ParamSpec::new(self.both, ty, default, "Roughness; 0 is smooth.").range(0.0, 1.0)
    }
    pub(super) const fn u(self) -> ParamSpec {
        let doc = "Roughness along u, where it differs from that along v.";
        ParamSpec::new(self.u, ParamType::FloatTexture, ParamDefault::Unset, doc).range(0.0, 1.0)
    }
    pub(super) const fn v(self) -> ParamSpec {
        let doc = "Roughness along v.";
        ParamSpec::new(self.v, ParamType::FloatTexture, ParamDefault::Unset, doc).range(0.0, 1.0)
    }
}

impl Roughness {
    pub(super) const BOTH: ParamSpec = Words::USUAL.both();
    pub(super) const U: ParamSpec = Words::USUAL.u();
    pub(super) const V: ParamSpec = Words::USUAL.v();
    pub(super) const REMAP: ParamSpec = ParamSpec::new(
        "remaproughness",
        ParamType::Bool,
        ParamDefault::Bool(true),
        "The width of microfacets is the square root of roughness; if false it is roughness itself.",
    );
    pub(super) const DISTRIBUTION: ParamSpec = ParamSpec::new(
        "distribution",
        ParamType::Choice(&["ggx", "beckmann"]),
        ParamDefault::Text("ggx"),
        "Of the normals of microfacets.",
    );

    pub(super) const SHADOWING: ParamSpec = ParamSpec::new(
        "shadowing",
        ParamType::Choice(&["correlated", "separable"]),
        ParamDefault::Text("correlated"),
        "How microfacets hide each other from two directions: by their heights, as in pbrt-v4, or for each by itself, which is a \
         little darker, as in Mitsuba.",
    );

    /// Reads the parameters.
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        Self::read_as(args, Words::USUAL)
    }

    /// Reads the parameters under these names.
    pub(super) fn read_as(args: &mut Args<'_>, words: Words) -> Self {
        let both = args.float_input(words.both);
        let mut one = |name: &str| if args.is_set(name) { args.float_input(name) } else { both };
        let (u, v) = (one(words.u), one(words.v));
        let like = match args.text(Self::DISTRIBUTION.name) {
            "beckmann" => Distribution::Beckmann,
            _ => Distribution::Ggx,
        };
        let shadowing = match args.text(Self::SHADOWING.name) {
            "separable" => Shadowing::Separable,
            _ => Shadowing::Correlated,
        };
        Self { u, v, remap: args.bool("remaproughness"), like, shadowing }
    }

    /// The facets at a place whose shading normal is settled.
    pub(super) fn facets(&self, cx: &ShadeCx<'_>, surface: &Surface) -> Facets {
        let at = surface.texture_at();
        let alpha = |input: FloatInput| {
            let value = cx.float(input, &at).clamp(0.0, 1.0);
            if self.remap { value.sqrt() } else { value }
        };
        if self.u == self.v {
            let alpha = alpha(self.u);
            return self.like().map(|_| alpha);
        }
        let facets = Facets::along(tangent(surface), alpha(self.u), alpha(self.v));
        facets.distributed(self.like).shadowed(self.shadowing)
    }

    /// Facets like these, of some width.
    pub(super) fn like(&self) -> Facets {
        Facets::round(1.0).distributed(self.like).shadowed(self.shadowing)
    }

    /// The largest `pi f cos` of what is reflected.
    pub(super) fn gain(&self) -> f32 {
        self.constant().map_or(f32::INFINITY, |alpha| facet_gain(alpha, self.like))
    }

    /// The one width of all points, if it is the same everywhere and in all directions.
    pub(super) fn constant(&self) -> Option<f32> {
        match (self.u, self.v) {
            (FloatInput::Constant(u), FloatInput::Constant(v)) if u == v => {
                Some(if self.remap { u.clamp(0.0, 1.0).sqrt() } else { u.clamp(0.0, 1.0) })
            }
            _ => None,
        }
    }
}

/// The direction of growing u in the frame of the lobes.
pub(super) fn tangent(surface: &Surface) -> Vector3 {
    Frame::from_z(surface.n_s).to_local(surface.dpdu)
}
