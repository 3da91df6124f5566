//! The share of the body in which light walks at random below the surface, as Blender's and Cycles' principled material has it.
//!
//! It lies behind the same boundary as the rest, and its particles scatter so that a half-space sends back its colour, of the
//! light that gets in. Seen from below the boundary is all there is: what got in gets out through all of it.
use durer_core::spectrum::Spectrum;
use durer_scene::{Args, ColorInput, FloatInput, ParamDefault, ParamSpec, ParamType};

use super::super::{share_input, subsurface::unbounded};
use crate::{
    Medium, ShadeCx,
    medium::{HalfSpace, HenyeyGreenstein, Inside},
    texture::TextureAt,
};

/// What is below the surface, if light walks there.
#[derive(Debug)]
pub(super) struct Below {
    share: FloatInput,
    /// The base colour if there is none.
    color: Option<ColorInput>,
    radius: ColorInput,
    half: HalfSpace,
    medium: Medium,
}

impl Below {
    pub(super) const PARAMS: [ParamSpec; 3] = [
        ParamSpec::float_texture("subsurface", 0.0, "Share of the body in which light walks below the surface.")
            .range(0.0, 1.0),
        ParamSpec::color_texture("subsurfaceradius", [0.05, 0.01, 0.005], "How far light gets there between particles.")
            .unit("m")
            .range(0.0, f32::INFINITY),
        ParamSpec::new(
            "subsurfacecolor",
            ParamType::ColorTexture,
            ParamDefault::Unset,
            "Share of an even light, of what gets in, that comes out of it again; the base colour if left out.",
        )
        .range(0.0, f32::INFINITY),
    ];

    /// `None` if light walks nowhere. Complains where the body is a clear one.
    pub(super) fn read(args: &mut Args<'_>, is_clear: bool) -> Option<Self> {
        let share = args.float_input("subsurface");
        if share == FloatInput::Constant(0.0) {
            return None;
        }
        if is_clear {
            args.warning(
                "subsurface",
                "\"subsurface\" has no effect beside \"thickness\", which makes a clear body",
            );
            return None;
        }
        let eta = args.float("eta").max(1.0);
        Some(Self {
            share,
            color: args.is_set("subsurfacecolor").then(|| share_input(args, "subsurfacecolor")),
            radius: args.color_input("subsurfaceradius"),
            half: HalfSpace::new(eta),
            medium: Medium::clear(eta),
        })
    }
    pub(super) fn medium(&self) -> Medium {
        self.medium.clone()
    }
    pub(super) fn eta(&self) -> f32 {
        self.medium.eta_d
    }
    /// How much of the body it is at a point.
    pub(super) fn share(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        cx.float(self.share, at).clamp(0.0, 1.0)
    }
    /// Its colour, by that of the base.
    pub(super) fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt, base: Spectrum) -> Spectrum {
        self.color.as_ref().map_or(base, |color| super::super::share(cx, color, at))
    }
    /// What light walks in.
    pub(super) fn inside(&self, cx: &ShadeCx<'_>, at: &TextureAt, base: Spectrum) -> Inside {
        let albedo = self.half.albedo(self.color(cx, at, base), 0.0);
        Inside::new(unbounded(cx, &self.radius, at), albedo, HenyeyGreenstein::new(0.0))
    }
}
