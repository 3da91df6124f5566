//! Ideal diffuse reflection (Lambert): `f = reflectance / pi`.
use durer_core::math::Vector3;
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Arriving, Material, Sent, largest_share, share, share_input, warn_unsupported};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe},
};

/// A matte surface, the same from both sides.
#[derive(Debug)]
pub struct Diffuse {
    reflectance: ColorInput,
}

impl Kind for Diffuse {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "diffuse",
        aliases: &["matte"],
        doc: "Matte: reflects light equally in all directions.",
        params: &[
            ParamSpec::color_texture("reflectance", [0.5; 3], "Share of light reflected.")
                .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "displacement",
                ParamType::FloatTexture,
                ParamDefault::Unset,
                "Not supported yet.",
            ),
            ParamSpec::new("normalmap", ParamType::Text, ParamDefault::Unset, "Not supported yet."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        warn_unsupported(args, &["displacement", "normalmap"]);
        Some(Box::new(Self { reflectance: share_input(args, "reflectance") }))
    }
}

impl Material for Diffuse {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, _wo: Vector3) -> Bsdf {
        let albedo = share(cx, self.reflectance, &surface.texture_at());
        Bsdf::default().with(Lobe::Diffuse { albedo })
    }
    fn sent(&self, cx: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        let scattered = largest_share(cx, self.reflectance) * arriving.all();
        Sent { scattered, ..Sent::default() }
    }
}
