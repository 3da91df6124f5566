//! Wax, marble, skin, milk: a dense medium behind a boundary, in which light walks at random before it leaves elsewhere.
//!
//! The boundary is that of a dielectric, smooth or rough. Below it `sigma_a` and `sigma_s` say what light meets, by themselves
//! or by the name of a measured stuff, or `reflectance` and `mfp` do: the share of the light that gets in which comes out of a
//! half-space again, and the mean free path. (pbrt-v4 has the same parameters for a tabulated photon beam diffusion: means
//! are alike, details are not.) Who does not follow light below surfaces sees a matte body of the same colour under a coat.
use durer_core::{
    math::Vector3,
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, conductor::reflecting, detail::Detail, roughness::Roughness, share, share_input};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Again, Bsdf, Coat, Interface, Lobe, Matte, Reflectance},
    medium::{HalfSpace, HenyeyGreenstein, Inside},
    texture::TextureAt,
};

/// Bounces between a coat and what is below it: all of them.
const ALL: u32 = 64;

/// A body that light walks in.
#[derive(Debug)]
pub struct Subsurface {
    medium: Medium,
    stuff: Stuff,
    scale: f32,
    phase: HenyeyGreenstein,
    coat: Coat,
    roughness: Roughness,
    detail: Detail,
}

/// What is below, as files say it.
#[derive(Debug)]
enum Stuff {
    /// Absorption and scattering coefficient, 1/m.
    Given { sigma_a: ColorInput, sigma_s: ColorInput },
    /// The share of light that shall come out again, and the mean free path.
    Asked { reflectance: ColorInput, mfp: ColorInput, half: Box<HalfSpace> },
}

const SIGMA_A: ParamSpec = texture("sigma_a", "Absorption coefficient, in 1/m; with \"sigma_s\".");
const SIGMA_S: ParamSpec = texture(
    "sigma_s",
    "Scattering coefficient, in 1/m; without it, \"reflectance\" and \"name\" pbrt's milk: [2.55 3.21 3.77], \
     which absorbs [0.0011 0.0024 0.014].",
);
const REFLECTANCE: ParamSpec = texture(
    "reflectance",
    "Instead of coefficients: the share of an even light, of what gets through the boundary, that comes out of a \
     half-space again.",
);
const MFP: ParamSpec = texture("mfp", "With \"reflectance\": mean free path, in metres; 1 if left out.");
const NAME: ParamSpec = ParamSpec::new(
    "name",
    ParamType::Text,
    ParamDefault::Unset,
    "A measured stuff by pbrt's name, such as \"Skin1\" or \"Marble\", per millimetre: \"scale\" 1000 makes it per metre.",
);

const fn texture(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::ColorTexture, ParamDefault::Unset, doc).range(0.0, f32::INFINITY)
}

impl Stuff {
    fn read(args: &mut Args<'_>) -> Self {
        let even =
            |(a, s)| Self::Given { sigma_a: ColorInput::Constant(a), sigma_s: ColorInput::Constant(s) };
        let [absorbs, scatters] = [&SIGMA_A, &SIGMA_S].map(|spec| args.is_set(spec.name));
        let asked = args.is_set(REFLECTANCE.name);
        if args.is_set(NAME.name) {
            let name = args.text(NAME.name);
            let known = Inside::named(name);
            if known.is_none() {
                args.unknown(NAME.name, "measured stuff", Inside::names());
            }
            for other in [&SIGMA_A, &SIGMA_S, &REFLECTANCE, &MFP] {
                if args.is_set(other.name) {
                    args.warning(other.name, format!("\"{}\" has no effect beside \"name\"", other.name));
                }
            }
            return even(known.unwrap_or((Color::BLACK, Color::BLACK)));
        }
        if absorbs != scatters {
            let (given, missing) = if absorbs { (SIGMA_A, SIGMA_S) } else { (SIGMA_S, SIGMA_A) };
            args.error(given.name, format!("\"{}\" needs \"{}\" beside it", given.name, missing.name));
        }
        if absorbs && asked {
            args.error(
                REFLECTANCE.name,
                "\"reflectance\" and \"sigma_a\" both say what is below the surface: give one of them",
            );
        }
        if args.is_set(MFP.name) && !asked {
            args.warning(MFP.name, "\"mfp\" has no effect without \"reflectance\"");
        }
        if asked {
            let mfp = match args.is_set(MFP.name) {
                true => args.color_input(MFP.name),
                false => ColorInput::Constant(Color::WHITE),
            };
            let half = Box::new(HalfSpace::new(args.index("eta")));
            return Self::Asked { reflectance: share_input(args, REFLECTANCE.name), mfp, half };
        }
        if absorbs || scatters {
            return Self::Given {
                sigma_a: args.color_input(SIGMA_A.name),
                sigma_s: args.color_input(SIGMA_S.name),
            };
        }
        even((Color::new(0.0011, 0.0024, 0.014), Color::new(2.55, 3.21, 3.77)))
    }
}

/// What has no bound but 0 at a point: coefficients, lengths.
pub(super) fn unbounded(cx: &ShadeCx<'_>, input: &ColorInput, at: &TextureAt) -> Spectrum {
    match input {
        ColorInput::Curve(color, curve) => cx.basis.curve(curve, *color),
        other => cx.basis.unbounded(cx.color(other, at)),
    }
    .map(|v| v.max(0.0))
}

impl Kind for Subsurface {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "subsurface",
        aliases: &[],
        doc: "Wax, marble, skin or milk: light gets in through a boundary, walks at random and leaves elsewhere.",
        params: &[
            SIGMA_A,
            SIGMA_S,
            REFLECTANCE,
            MFP,
            NAME,
            ParamSpec::float("scale", 1.0, "Factor of the coefficients, or of \"mfp\".")
                .range(0.0, f32::INFINITY),
            ParamSpec::float(
                "g",
                0.0,
                "Mean cosine of the deflection: above 0 light is scattered on, below 0 back (Henyey and Greenstein).",
            )
            .range(-1.0, 1.0),
            ParamSpec::new(
                "eta",
                ParamType::Index,
                ParamDefault::Float(1.33),
                "Index of refraction inside, relative to the outside.",
            )
            .range(1.0, 10.0),
            Medium::PRIORITY,
            Roughness::BOTH,
            Roughness::U,
            Roughness::V,
            Roughness::REMAP,
            Roughness::DISTRIBUTION,
            Roughness::SHADOWING,
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let priority = args.is_set(Medium::PRIORITY.name).then(|| args.int(Medium::PRIORITY.name));
        let (eta, dispersion) = args.refraction("eta");
        let roughness = Roughness::read(args);
        Some(Box::new(Self {
            coat: Coat::new((eta, dispersion.as_ref()), 0.0, (roughness.constant(), roughness.like())),
            medium: Medium { dispersion, priority, ..Medium::clear(eta) },
            stuff: Stuff::read(args),
            scale: args.float("scale"),
            phase: HenyeyGreenstein::new(args.float("g")),
            roughness,
            detail: Detail::read(args),
        }))
    }
}

impl Subsurface {
    fn below(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Inside {
        match &self.stuff {
            Stuff::Given { sigma_a, sigma_s } => Inside {
                sigma_a: unbounded(cx, sigma_a, at) * self.scale,
                sigma_s: unbounded(cx, sigma_s, at) * self.scale,
                phase: self.phase,
            },
            Stuff::Asked { reflectance, mfp, half } => {
                let albedo = half.albedo(share(cx, reflectance, at), self.phase.g());
                Inside::new(unbounded(cx, mfp, at) * self.scale, albedo, self.phase)
            }
        }
    }
}

impl Material for Subsurface {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let albedo = self.below(cx, &surface.texture_at()).albedo();
        let facets = self.roughness.facets(cx, surface);
        let cos = surface.n_s.dot(wo).abs().min(1.0);
        let eta = self.medium.eta(&cx.basis);
        Bsdf::default()
            .with(Lobe::Matte(Matte::Coated(self.coat.body(
                (albedo, Again::Colored),
                (eta, &facets),
                ALL,
                cos,
            ))))
            .with(reflecting(Reflectance::dielectric(eta), facets, cos))
    }
    fn open_bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let interface = Interface::clear(self.medium.eta(&cx.basis));
        Bsdf::default().with(Lobe::boundary(interface, self.roughness.facets(cx, surface)))
    }
    fn inside(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Option<Inside> {
        Some(self.below(cx, at))
    }
    fn is_walked(&self) -> bool {
        true
    }
    fn walks_back(&self) -> bool {
        let (Stuff::Given { sigma_a: a, sigma_s: b } | Stuff::Asked { reflectance: a, mfp: b, .. }) =
            &self.stuff;
        a.even().is_some() && b.even().is_some()
    }
    fn medium(&self) -> Option<Medium> {
        Some(self.medium.clone())
    }
}
