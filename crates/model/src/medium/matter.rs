//! How much a stuff absorbs and scatters, as files give it.
use durer_core::spectrum::Color;
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use super::preset::Preset;

/// Absorption and scattering where the density is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Matter {
    /// Absorption coefficient, 1/m.
    pub(super) sigma_a: Color,
    /// Scattering coefficient, 1/m.
    pub(super) sigma_s: Color,
}

impl Matter {
    pub(super) const PRESET: ParamSpec = ParamSpec::new(
        "preset",
        ParamType::Text,
        ParamDefault::Unset,
        "A measured stuff by pbrt's name, such as \"Wholemilk\", per millimetre: \"scale\" 1000 makes it per metre.",
    );
    pub(super) const SIGMA_A: ParamSpec =
        ParamSpec::color("sigma_a", [1.0; 3], "Absorption coefficient, in 1/m.").range(0.0, f32::INFINITY);
    pub(super) const SIGMA_S: ParamSpec =
        ParamSpec::color("sigma_s", [1.0; 3], "Scattering coefficient, in 1/m.").range(0.0, f32::INFINITY);
    pub(super) const SCALE: ParamSpec =
        ParamSpec::float("scale", 1.0, "Factor of both coefficients.").range(0.0, f32::INFINITY);
    pub(super) const G: ParamSpec = ParamSpec::float(
        "g",
        0.0,
        "Mean cosine of the deflection: above 0 light is scattered on, below 0 back (Henyey and Greenstein).",
    )
    .range(-1.0, 1.0);

    /// Reads the coefficients, or those of the stuff that is named.
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let own = Self { sigma_a: args.color("sigma_a"), sigma_s: args.color("sigma_s") };
        let scale = args.float("scale");
        own.or_preset(args).scaled(scale)
    }
    fn or_preset(self, args: &mut Args<'_>) -> Self {
        if !args.is_set(Self::PRESET.name) {
            return self;
        }
        let name = args.text(Self::PRESET.name);
        let Some(Preset { sigma_a, sigma_s }) = Preset::named(name) else {
            args.unknown(Self::PRESET.name, "preset", Preset::names());
            return self;
        };
        for own in ["sigma_a", "sigma_s"] {
            if args.is_set(own) {
                args.warning(own, format!("\"{own}\" has no effect beside \"preset\""));
            }
        }
        Self { sigma_a, sigma_s }
    }
    pub(super) fn scaled(self, scale: f32) -> Self {
        Self { sigma_a: self.sigma_a * scale, sigma_s: self.sigma_s * scale }
    }
    pub(super) fn scatters(&self) -> bool {
        self.sigma_s != Color::BLACK
    }
}
