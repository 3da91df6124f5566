//! Metal: microfacets, each a smooth conductor after Fresnel's equations.
//!
//! Where rays carry colours and no wavelengths a metal has three indices. They are chosen so that the colour of its reflectance at
//! normal incidence is that of the measured curves, integrated over wavelengths: see [`durer_core::spectrum::conductor`].
use durer_core::{
    math::Vector3,
    spectrum::{Basis, Color, Curve, Sampled, Spectrum, conductor, conductor_of, curve, extinction},
};
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, REFLECTION, detail::Detail, read_factor, roughness::Roughness, share, share_input};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bounced, Bsdf, Facets, Glossy, Lobe, Matte, Reflectance},
    texture::TextureAt,
};

/// A metal, the same from both sides.
#[derive(Debug)]
pub struct Conductor {
    metal: Metal,
    roughness: Roughness,
    compensates: bool,
    factor: Option<ColorInput>,
    detail: Detail,
}

/// Where the indices come from.
#[derive(Clone, Debug)]
pub(super) enum Metal {
    /// Index and extinction, of colours and of wavelengths.
    Index { eta: Color, k: Color, curves: Option<[Curve; 2]> },
    /// What is reflected at normal incidence, by something of index 1 whose index is then divided by that outside it.
    Reflectance { input: ColorInput, outside: f32 },
}

/// What the parameters of a metal are called.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words {
    pub(super) eta: &'static str,
    pub(super) k: &'static str,
}

impl Words {
    pub(super) const USUAL: Self = Self { eta: "eta", k: "k" };

    pub(super) const fn eta(self) -> ParamSpec {
        let doc =
            "Index of refraction: a colour, a curve, or a name such as metal-Au-eta; copper if left out.";
        ParamSpec::new(self.eta, ParamType::Color, ParamDefault::Unset, doc).range(0.0, f32::INFINITY)
    }
    pub(super) const fn k(self) -> ParamSpec {
        let doc = "Extinction, the imaginary part of the index; copper's if left out.";
        ParamSpec::new(self.k, ParamType::Color, ParamDefault::Unset, doc).range(0.0, f32::INFINITY)
    }
}

impl Metal {
    pub(super) const REFLECTANCE: ParamSpec = ParamSpec::new(
        "reflectance",
        ParamType::ColorTexture,
        ParamDefault::Unset,
        "Share of light reflected at normal incidence, instead of eta and k.",
    )
    .range(0.0, f32::INFINITY);

    /// Reads index and extinction, or the reflectance, of a metal below something of index `outside`.
    pub(super) fn read(args: &mut Args<'_>, words: Words, outside: f32) -> Self {
        let Words { eta, k } = words;
        if args.is_set(Self::REFLECTANCE.name) {
            for name in [eta, k] {
                if args.is_set(name) {
                    args.warning(name, format!("\"{name}\" has no effect beside \"reflectance\""));
                }
            }
            return Self::Reflectance { input: share_input(args, Self::REFLECTANCE.name), outside };
        }
        let mut curve_of =
            |name: &str, usual: &str| if args.is_set(name) { args.curve(name) } else { curve(usual) };
        let curves = (curve_of(eta, "metal-Cu-eta"), curve_of(k, "metal-Cu-k"));
        let of_waves = |curve: &Sampled| Curve::nearest(curve).scaled(1.0 / outside);
        let of_both = match &curves {
            (Some(eta), Some(k)) => Some([of_waves(eta), of_waves(k)]),
            _ => None,
        };
        let (eta, k) = match curves {
            (Some(eta), Some(k)) => conductor(&eta, &k, outside),
            (from_eta, from_k) => {
                let mut color = |own: Option<Sampled>, name: &str| match own {
                    Some(curve) => curve.share(),
                    None => args.color(name),
                };
                (color(from_eta, eta) * (1.0 / outside), color(from_k, k) * (1.0 / outside))
            }
        };
        Self::Index { eta, k, curves: of_both }
    }

    /// The reflectance at a point.
    pub(super) fn at(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Reflectance {
        match (self, cx.basis) {
            (Self::Index { eta, k, curves: Some([eta_curve, k_curve]) }, basis @ Basis::Spectral(_)) => {
                Reflectance::Index { eta: basis.curve(eta_curve, *eta), k: basis.curve(k_curve, *k) }
            }
            (Self::Index { eta, k, .. }, basis) => {
                Reflectance::Index { eta: basis.unbounded(*eta), k: basis.unbounded(*k) }
            }
            (Self::Reflectance { input, outside }, Basis::Rgb) => {
                let (eta, k) = conductor_of(cx.color(input, at).map(|v| v.clamp(0.0, 1.0)));
                let (eta, k) = (eta * (1.0 / outside), k * (1.0 / outside));
                Reflectance::Index { eta: cx.basis.reflectance(eta), k: cx.basis.reflectance(k) }
            }
            (Self::Reflectance { input, outside }, Basis::Spectral(_)) => {
                let k = share(cx, input, at).map(extinction);
                Reflectance::Index { eta: Spectrum::ONE / *outside, k: k / *outside }
            }
        }
    }
}

/// Whether light that bounces several times between microfacets is added.
const COMPENSATION: ParamSpec = ParamSpec::new(
    "energycompensation",
    ParamType::Bool,
    ParamDefault::Bool(false),
    "Adds the light that bounces several times between microfacets: rough metal is brighter.",
);

impl Kind for Conductor {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "conductor",
        aliases: &["metal"],
        doc: "Metal, smooth or rough, by its measured index of refraction or by its colour.",
        params: &[
            Words::USUAL.eta(),
            Words::USUAL.k(),
            Metal::REFLECTANCE,
            Roughness::BOTH,
            Roughness::U,
            Roughness::V,
            Roughness::REMAP,
            Roughness::DISTRIBUTION,
            Roughness::SHADOWING,
            COMPENSATION,
            REFLECTION,
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            metal: Metal::read(args, Words::USUAL, 1.0),
            roughness: Roughness::read(args),
            compensates: args.bool(COMPENSATION.name),
            factor: read_factor(args, &REFLECTION),
            detail: Detail::read(args),
        }))
    }
}

/// The lobe of facets that reflect so; a mirror where they are smooth.
pub(super) fn reflecting(reflectance: Reflectance, facets: Facets, cos: f32) -> Lobe<'static> {
    match facets.is_smooth() {
        true => Lobe::Mirror { weight: reflectance.at(cos) },
        false => Lobe::Glossy(Glossy { reflectance, facets, scale: 1.0 }),
    }
}

impl Material for Conductor {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let reflectance = self.metal.at(cx, &surface.texture_at());
        let facets = self.roughness.facets(cx, surface);
        let cos = surface.n_s.dot(wo).abs().min(1.0);
        let mut single = Bsdf::default().with(reflecting(reflectance, facets, cos));
        if let Some(factor) = &self.factor {
            single.dim(share(cx, factor, &surface.texture_at()));
        }
        match Bounced::of(&reflectance, &facets).filter(|_| self.compensates) {
            Some(lost) => single.with(Lobe::Matte(Matte::Bounced(lost))),
            None => single,
        }
    }
}
