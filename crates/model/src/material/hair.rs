//! Hair and fur, for the shape `curve` (Chiang and others 2016; see [`crate::bsdf::Hair`]).
use durer_core::{
    math::Vector3,
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, ColorInput, FloatInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::Material;
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Hair as HairLobe, Lobe, Strand},
    texture::TextureAt,
};

/// Absorption by the pigment of black and brown hair, per concentration and radius (d'Eon and others 2011).
const EUMELANIN: [f32; 3] = [0.419, 0.697, 1.37];
/// The same of the pigment of red and blond hair.
const PHEOMELANIN: [f32; 3] = [0.187, 0.4, 1.05];
/// Concentration of eumelanin unless something says what colour the hair has; pbrt's.
const BROWN: f32 = 1.3;

/// What colours a hair.
#[derive(Clone, Debug)]
enum Tinge {
    Absorption(ColorInput),
    Reflectance(ColorInput),
    /// Concentrations of eumelanin and pheomelanin.
    Pigment([FloatInput; 2]),
}

/// A hair.
#[derive(Debug)]
pub struct Hair {
    tinge: Tinge,
    eta: FloatInput,
    beta: [FloatInput; 2],
    /// Degrees.
    tilt: FloatInput,
}

const fn pigment(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::FloatTexture, ParamDefault::Unset, doc).range(0.0, f32::INFINITY)
}

const fn tinge(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::ColorTexture, ParamDefault::Unset, doc).range(0.0, f32::INFINITY)
}

impl Tinge {
    /// The first that is given, as in pbrt-v4; the others are warned about.
    fn read(args: &mut Args<'_>) -> Self {
        let words = ["sigma_a", "reflectance", "color", "eumelanin", "pheomelanin"];
        let first = words.into_iter().find(|word| args.is_set(word));
        for word in words.into_iter().filter(|word| args.is_set(word)).collect::<Vec<_>>() {
            let both_pigments = first == Some("eumelanin") && word == "pheomelanin";
            if let Some(first) = first.filter(|first| *first != word && !both_pigments) {
                args.warning(
                    word,
                    format!("\"{word}\" has no effect: \"{first}\" says what colour the hair has"),
                );
            }
        }
        match first {
            Some("sigma_a") => Self::Absorption(args.color_input("sigma_a")),
            Some(word @ ("reflectance" | "color")) => Self::Reflectance(args.color_input(word)),
            None => Self::Pigment([FloatInput::Constant(BROWN), FloatInput::Constant(0.0)]),
            Some(_) => {
                let mut of = |word: &str| match args.is_set(word) {
                    true => args.float_input(word),
                    false => FloatInput::Constant(0.0),
                };
                Self::Pigment([of("eumelanin"), of("pheomelanin")])
            }
        }
    }

    /// Absorption per radius.
    fn at(&self, cx: &ShadeCx<'_>, at: &TextureAt, beta_n: f32) -> Spectrum {
        match self {
            Self::Absorption(input @ ColorInput::Curve(..)) => cx.weight(input, at, |v| v.max(0.0)),
            Self::Absorption(input) => cx.basis.unbounded(cx.color(input, at).map(|v| v.max(0.0))),
            Self::Reflectance(input) => {
                cx.weight(input, at, |c| c.clamp(0.0, 1.0)).map(|c| HairLobe::absorption(c, beta_n))
            }
            Self::Pigment(inputs) => {
                let [eu, pheo] = inputs.map(|input| cx.float(input, at).max(0.0));
                let [r, g, b] = std::array::from_fn(|i| eu * EUMELANIN[i] + pheo * PHEOMELANIN[i]);
                cx.basis.unbounded(Color::new(r, g, b))
            }
        }
    }
}

impl Kind for Hair {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "hair",
        aliases: &[],
        doc: "Hair and fur: light that a strand reflects, lets through, and lets through after reflections inside.",
        params: &[
            tinge(
                "sigma_a",
                "Absorption of the inside per radius of the hair. One of these says what colour hair has.",
            ),
            tinge("reflectance", "Colour of many hairs together."),
            tinge("color", "The same."),
            pigment(
                "eumelanin",
                "Concentration of the pigment of brown and black hair; 1.3 if nothing is said.",
            ),
            pigment("pheomelanin", "Concentration of the pigment of red and blond hair."),
            ParamSpec::float_texture("eta", 1.55, "Index of refraction.").range(1.0, 5.0),
            ParamSpec::float_texture("beta_m", 0.3, "Roughness along the hair.").range(0.0, 1.0),
            ParamSpec::float_texture("beta_n", 0.3, "Roughness around the hair.").range(0.0, 1.0),
            ParamSpec::float_texture("alpha", 2.0, "Tilt of the scales.").unit("deg").range(-90.0, 90.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let tinge = Tinge::read(args);
        let beta = ["beta_m", "beta_n"].map(|name| args.float_input(name));
        let (eta, tilt) = (args.float_input("eta"), args.float_input("alpha"));
        Some(Box::new(Self { tinge, eta, beta, tilt }))
    }
}

impl Material for Hair {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, _wo: Vector3) -> Bsdf<'_> {
        let at = surface.texture_at();
        let beta = self.beta.map(|input| cx.float(input, &at));
        let sigma_a = self.tinge.at(cx, &at, beta[1]);
        let frame = surface.frame();
        let (along, across) = (frame.to_local(surface.dpdu), frame.to_local(surface.dpdv));
        let strand = Strand {
            along,
            is_left: along.x * across.y - along.y * across.x >= 0.0,
            h: 2.0 * surface.uv.y - 1.0,
        };
        let eta = cx.float(self.eta, &at).clamp(1.0, 5.0);
        let tilt = cx.float(self.tilt, &at).to_radians();
        Bsdf::default().with(Lobe::Hair(HairLobe::new(&strand, sigma_a, eta, beta, tilt)))
    }
}
