//! Leaves, paper, lamp shades: light spread evenly on both sides.
use durer_core::math::Vector3;
use durer_scene::{Args, ColorInput, Kind, ParamSpec, Schema};

use super::{Material, detail::Detail, share, share_input};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe},
};

/// A thin surface that spreads light on both sides.
#[derive(Debug)]
pub struct DiffuseTransmission {
    reflectance: ColorInput,
    transmittance: ColorInput,
    scale: f32,
    detail: Detail,
}

impl Kind for DiffuseTransmission {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "diffusetransmission",
        aliases: &["translucent"],
        doc: "Matte on both sides: reflects light evenly and transmits it evenly.",
        params: &[
            ParamSpec::color_texture("reflectance", [0.25; 3], "Share of light reflected.")
                .range(0.0, f32::INFINITY),
            ParamSpec::color_texture("transmittance", [0.25; 3], "Share of light transmitted.")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on both.").range(0.0, f32::INFINITY),
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            reflectance: share_input(args, "reflectance"),
            transmittance: share_input(args, "transmittance"),
            scale: args.float("scale"),
            detail: Detail::read(args),
        }))
    }
}

impl Material for DiffuseTransmission {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let at = surface.texture_at();
        let scaled = |input: &ColorInput| (share(cx, input, &at) * self.scale).map(|v| v.min(1.0));
        let (reflected, transmitted) = (scaled(&self.reflectance), scaled(&self.transmittance));
        // Never more than arrives: where both together exceed 1 they give way in proportion.
        let within = (reflected + transmitted).map(|sum| 1.0 / sum.max(1.0));
        Bsdf::default()
            .with(Lobe::Diffuse { albedo: reflected * within })
            .with(Lobe::Behind { albedo: transmitted * within })
    }
}
