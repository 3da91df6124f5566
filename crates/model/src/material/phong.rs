//! A matte body with a highlight that is a power of a cosine: Phong's or Blinn's, normalised.
use durer_core::math::Vector3;
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, detail::Detail, share, share_input};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe, Phong as Highlight},
};

/// Diffuse reflection and a highlight.
#[derive(Debug)]
pub struct Phong {
    diffuse: ColorInput,
    specular: ColorInput,
    exponent: f32,
    half: bool,
    detail: Detail,
}

impl Kind for Phong {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "phong",
        aliases: &[],
        doc: "Matte with a highlight after Phong (modified) or Blinn, normalised: it never reflects more than arrives.",
        params: &[
            ParamSpec::color_texture("diffuse", [0.5; 3], "Share of light that the body reflects.")
                .range(0.0, f32::INFINITY),
            ParamSpec::color_texture(
                "specular",
                [0.25; 3],
                "Share of light in the highlight at normal incidence; cut where both together exceed 1.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::float("exponent", 32.0, "Power of the cosine: larger is smaller and sharper.")
                .range(0.0, 1e6),
            ParamSpec::new(
                "model",
                ParamType::Choice(&["phong", "blinn"]),
                ParamDefault::Text("phong"),
                "Cosine to the mirror direction, or of normal and half vector.",
            ),
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            diffuse: share_input(args, "diffuse"),
            specular: share_input(args, "specular"),
            exponent: args.float("exponent"),
            half: args.text("model") == "blinn",
            detail: Detail::read(args),
        }))
    }
}

impl Material for Phong {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let at = surface.texture_at();
        let albedo = share(cx, &self.diffuse, &at);
        let specular = share(cx, &self.specular, &at).zip(albedo, |s, d| s.min(1.0 - d));
        Bsdf::default().with(Lobe::Diffuse { albedo }).with(Lobe::Phong(Highlight {
            specular,
            exponent: self.exponent,
            half: self.half,
        }))
    }
}
