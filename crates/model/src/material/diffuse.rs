//! Diffuse reflection: ideal (Lambert), `f = reflectance / pi`, or rough (Oren and Nayar; see `bsdf/matte.rs`).
use durer_core::math::Vector3;
use durer_scene::{Args, ColorInput, FloatInput, Kind, ParamSpec, Schema};

use super::{Arriving, Material, Sent, detail::Detail, largest_share, share, share_input};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe, Matte},
};

/// A matte surface, the same from both sides.
#[derive(Debug)]
pub struct Diffuse {
    reflectance: ColorInput,
    sigma: FloatInput,
    detail: Detail,
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
            ParamSpec::float_texture(
                "sigma",
                0.0,
                "How rough the body is: 0 follows Lambert's law, 90 degrees is the roughness 1 of EON.",
            )
            .unit("deg")
            .range(0.0, 90.0),
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            reflectance: share_input(args, "reflectance"),
            sigma: args.float_input("sigma"),
            detail: Detail::read(args),
        }))
    }
}

impl Material for Diffuse {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let at = surface.texture_at();
        let albedo = share(cx, &self.reflectance, &at);
        let roughness = (cx.float(self.sigma, &at) / 90.0).clamp(0.0, 1.0);
        Bsdf::default().with(match roughness > 0.0 {
            true => Lobe::Matte(Matte::rough(albedo, roughness)),
            false => Lobe::Diffuse { albedo },
        })
    }
    fn sent(&self, cx: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        if self.sigma != FloatInput::Constant(0.0) {
            return Sent::UNBOUNDED;
        }
        let scattered = largest_share(cx, &self.reflectance) * arriving.all();
        Sent { scattered, ..Sent::default() }
    }
}
