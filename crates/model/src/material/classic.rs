//! The shading formula of Whitted (1980, section 2):
//! `I = k_a I_a + k_d sum_j (N . L_j) I_j + k_s' sum_j (N . H_j)^n I_j + k_s S + k_t T`,
//! with `S` and `T` the intensities arriving along the mirrored and the refracted ray.
//!
//! Whitted's `k_s` serves both the highlight and the mirrored ray; here they are two parameters, `specular` and
//! `reflection`. All coefficients are constants: nothing keeps their sum below 1.
use durer_core::{
    math::Vector3,
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, ColorInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Arriving, Material, Sent, largest_share, sent::cosine_gain, share, share_input};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Blur, Blurred, Bsdf, Gloss, Highlight, Interface, Lobe, Split},
};

/// The classic formula.
#[derive(Debug)]
pub struct Classic {
    ambient: Option<ColorInput>,
    diffuse: ColorInput,
    /// The others are `None` where they are black everywhere.
    specular: Option<ColorInput>,
    exponent: f32,
    reflection: Option<ColorInput>,
    transmission: Option<ColorInput>,
    medium: Medium,
    fresnel: bool,
    /// Exponents of the blur about mirrored and refracted directions; infinite where they are sharp.
    gloss: f32,
    translucency: f32,
}

const BLACK: [f32; 3] = [0.0; 3];

impl Kind for Classic {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "classic",
        aliases: &["whitted"],
        doc: "The classic formula: ambient, diffuse and highlight terms, mirrored and refracted rays with constant weights.",
        params: &[
            ParamSpec::new(
                "ambient",
                ParamType::ColorTexture,
                ParamDefault::Unset,
                "Coefficient of the ambient term; the diffuse coefficient if left out.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::color_texture("diffuse", [0.5; 3], "Coefficient of the diffuse term.")
                .range(0.0, f32::INFINITY),
            ParamSpec::color_texture("specular", BLACK, "Coefficient of the lights' highlights.")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("exponent", 32.0, "Exponent of the highlights: larger is smaller and sharper.")
                .range(0.0, 1e6),
            ParamSpec::color_texture("reflection", BLACK, "Weight of the mirrored ray; none is traced if 0.")
                .range(0.0, f32::INFINITY),
            ParamSpec::color_texture("transmission", BLACK, "Weight of the refracted ray; opaque if 0.")
                .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "fresnel",
                ParamType::Bool,
                ParamDefault::Bool(false),
                "Multiplies reflection and transmission by Fresnel's shares instead of keeping them constant.",
            ),
            Medium::ETA,
            Medium::CAUCHY,
            Medium::DISPERSION,
            ParamSpec::new(
                "gloss",
                ParamType::Float,
                ParamDefault::Unset,
                "Blurs reflections by the cosine to this power about the mirrored direction (Cook 1984), where rays are \
                 distributed; sharp if left out.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "translucency",
                ParamType::Float,
                ParamDefault::Unset,
                "Blurs what is seen through the surface in the same way about the refracted direction.",
            )
            .range(0.0, f32::INFINITY),
            Medium::PRIORITY,
            Medium::ABSORPTION,
            Medium::INSIDE,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let ambient = args.is_set("ambient").then(|| share_input(args, "ambient"));
        Some(Box::new(Self {
            ambient,
            diffuse: share_input(args, "diffuse"),
            specular: unless_black(share_input(args, "specular")),
            exponent: args.float("exponent"),
            reflection: unless_black(share_input(args, "reflection")),
            transmission: unless_black(share_input(args, "transmission")),
            medium: Medium::read(args),
            fresnel: args.bool("fresnel"),
            gloss: args.optional_float("gloss").unwrap_or(f32::INFINITY),
            translucency: args.optional_float("translucency").unwrap_or(f32::INFINITY),
        }))
    }
}

fn unless_black(input: ColorInput) -> Option<ColorInput> {
    (input != ColorInput::Constant(Color::BLACK)).then_some(input)
}

impl Classic {
    fn blur(&self) -> Blur {
        Blur::Cosine { reflection: self.gloss, transmission: self.translucency }
    }
}

impl Material for Classic {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, _wo: Vector3) -> Bsdf<'_> {
        let at = surface.texture_at();
        let optional = |input: &Option<ColorInput>| input.as_ref().map(|i| share(cx, i, &at));
        let there = |input| optional(input).filter(|weight| !weight.is_black());
        let diffuse = Lobe::Diffuse { albedo: share(cx, &self.diffuse, &at) };
        let ambient = optional(&self.ambient).map(|coefficient| Lobe::Ambient { coefficient });
        let exponent = self.exponent;
        let highlight =
            there(&self.specular).map(|specular| Lobe::Highlight(Highlight { specular, exponent }));
        let followed = match (there(&self.reflection), there(&self.transmission)) {
            (None, None) => None,
            (Some(weight), None) if !self.fresnel => Some(match self.gloss.is_finite() {
                true => Lobe::Gloss(Gloss { weight, exponent: self.gloss }),
                false => Lobe::Mirror { weight },
            }),
            shares => {
                let (reflection, transmission) =
                    (shares.0.unwrap_or(Spectrum::BLACK), shares.1.unwrap_or(Spectrum::BLACK));
                let split = match self.fresnel {
                    true => Split::Fresnel { reflection, transmission },
                    false => Split::Constant { reflection, transmission },
                };
                let interface = Interface { eta: self.medium.eta(&cx.basis), split };
                Some(match self.gloss.min(self.translucency).is_finite() {
                    true => Lobe::Blurred(Blurred { interface, blur: self.blur() }),
                    false => Lobe::Interface(interface),
                })
            }
        };
        Bsdf::of([Some(diffuse), ambient, highlight, followed])
    }
    /// Nothing keeps the coefficients' sum below 1. The highlight of a lamp is less than twice its coefficient times the
    /// lamp: `ks cos^n / pi` over a hemisphere.
    fn sent(&self, cx: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        let most = |input: Option<&ColorInput>| input.map_or(0.0, |input| largest_share(cx, input));
        let diffuse = largest_share(cx, &self.diffuse);
        let (ambient, specular) =
            (most(self.ambient.as_ref().or(Some(&self.diffuse))), most(self.specular.as_ref()));
        let (reflection, transmission) = (most(self.reflection.as_ref()), most(self.transmission.as_ref()));
        let followed = if self.fresnel { reflection.max(transmission) } else { reflection + transmission };
        let blurs = [(reflection, self.gloss), (transmission, self.translucency)];
        let blurred: f32 = blurs
            .into_iter()
            .filter(|(weight, exponent)| *weight > 0.0 && exponent.is_finite())
            .map(|(weight, exponent)| {
                arriving.highlight(weight * cosine_gain(exponent)) + weight * arriving.lamps
            })
            .sum();
        let own = ambient * arriving.sky
            + diffuse * (arriving.lamps + arriving.facing)
            + specular * (2.0 * arriving.lamps + arriving.facing)
            + blurred;
        Sent { own, scattered: 0.0, followed: followed.min(1.0) }
    }
    fn medium(&self) -> Option<Medium> {
        self.transmission.is_some().then(|| self.medium.clone())
    }
}
