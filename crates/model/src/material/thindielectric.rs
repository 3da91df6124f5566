//! A thin pane: two parallel interfaces so close that light which passes goes straight on, however often it bounced between
//! them. With `R` the share that one interface reflects, `R' = R + T² R / (1 - R²) = 2 R / (1 + R)` (validation.md I10).
use durer_core::{
    math::Vector3,
    spectrum::{Color, Curve, Spectrum},
};
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, REFLECTION, TRANSMISSION, detail::Detail, read_factor, share};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe, fresnel_dielectric},
};

/// A pane.
#[derive(Debug)]
pub struct ThinDielectric {
    /// At 587.6 nm, and how it changes with wavelength if it does: no direction depends on it, each wavelength has its own.
    eta: (f32, Option<Curve>),
    /// On what is reflected and let through.
    factors: [Option<ColorInput>; 2],
    detail: Detail,
}

impl Kind for ThinDielectric {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "thindielectric",
        aliases: &[],
        doc: "A thin pane of glass: reflects, and lets the rest pass straight on.",
        params: &[
            ParamSpec::new(
                "eta",
                ParamType::Index,
                ParamDefault::Float(1.5),
                "Index of refraction of the pane, relative to what is on both sides of it.",
            )
            .range(0.1, 10.0),
            REFLECTION,
            TRANSMISSION,
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            eta: args.refraction("eta"),
            factors: [&REFLECTION, &TRANSMISSION].map(|spec| read_factor(args, spec)),
            detail: Detail::read(args),
        }))
    }
}

impl Material for ThinDielectric {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let cos = surface.n_s.dot(wo).abs().min(1.0);
        let reflected = |eta: f32| {
            let once = fresnel_dielectric(cos, eta);
            2.0 * once / (1.0 + once)
        };
        let all = match &self.eta {
            (eta, None) => Spectrum::splat(reflected(*eta)),
            (eta, Some(curve)) => cx.basis.curve(curve, Color { rgb: [*eta; 3] }).map(reflected),
        };
        let (mut back, mut on) = (all, all.map(|r| 1.0 - r));
        for (weight, factor) in [&mut back, &mut on].into_iter().zip(&self.factors) {
            if let Some(factor) = factor {
                *weight *= share(cx, factor, &surface.texture_at());
            }
        }
        Bsdf::default().with(Lobe::Mirror { weight: back }).with(Lobe::PassThrough { weight: on })
    }
    fn is_passed(&self) -> bool {
        true
    }
}
