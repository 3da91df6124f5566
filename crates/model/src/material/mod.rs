//! Materials: what a surface is made of.
//!
//! A new material is one file here and one line in [`MATERIALS`].

mod classic;
mod coatedconductor;
mod coateddiffuse;
mod conductor;
mod detail;
mod dielectric;
mod diffuse;
mod diffusetransmission;
mod disney;
mod forcediffuse;
mod hair;
mod interface;
mod mask;
mod measured;
mod mirror;
mod mix;
mod normal_map;
mod number;
mod phong;
mod principled;
mod roughness;
mod sent;
mod sides;
mod subsurface;
mod thindielectric;

use std::{fmt::Debug, sync::Arc};

use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_scene::{Args, ColorInput, Entry, ParamDefault, ParamSpec, ParamType};

pub use self::{
    classic::Classic,
    coatedconductor::CoatedConductor,
    coateddiffuse::CoatedDiffuse,
    conductor::Conductor,
    dielectric::Dielectric,
    diffuse::Diffuse,
    diffusetransmission::DiffuseTransmission,
    disney::Disney,
    forcediffuse::ForceDiffuse,
    hair::Hair,
    interface::Interface,
    mask::Mask,
    measured::Measured,
    mirror::Mirror,
    mix::Mix,
    phong::Phong,
    principled::Principled,
    sent::{Arriving, GlossRays, Sent},
    sides::Sides,
    subsurface::Subsurface,
    thindielectric::ThinDielectric,
};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Bsdf, Measurement},
    medium::Inside,
    texture::TextureAt,
};

/// A material.
pub trait Material: Debug + Send + Sync {
    /// Evaluates the textures at `surface` and returns the lobes by value. May tilt `surface.n_s` (normal maps).
    /// `wo` is the unit direction back along the ray.
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_>;
    /// The same for those who follow light below the surface, where it walks.
    fn open_bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.bsdf(cx, surface, wo)
    }
    /// True if light walks below the surface.
    fn is_walked(&self) -> bool {
        false
    }
    /// Whether light walks there backwards as it does forwards: what it gets in by it gets out by, and what is below the
    /// surface is the same everywhere.
    fn walks_back(&self) -> bool {
        false
    }
    /// What light walks in that enters at a point.
    fn inside(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Option<Inside> {
        let _ = (cx, at);
        None
    }
    /// Radiance the surface emits by itself.
    fn emission(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        let _ = (cx, at);
        Spectrum::BLACK
    }
    /// The most that it can send where no more than this arrives; no bound unless a material knows one.
    fn sent(&self, cx: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        let _ = (cx, arriving);
        Sent::UNBOUNDED
    }
    /// What was measured of it; several materials may share it.
    fn measurement(&self) -> Option<&Arc<Measurement>> {
        None
    }
    /// What fills the body behind the surface, if light can get in.
    fn medium(&self) -> Option<Medium> {
        None
    }
    /// True if there is no surface at all: what has two sides all the same is passed unseen.
    fn is_nothing(&self) -> bool {
        false
    }
    /// True if some points of the surface may be holes, see [`Material::is_hole`].
    fn has_holes(&self) -> bool {
        false
    }
    /// True if light may go straight on through some points of the surface that are no holes.
    fn is_passed(&self) -> bool {
        false
    }
    /// True if the surface is not seen from behind: rays pass, but those to lights do not.
    fn is_one_sided(&self) -> bool {
        false
    }
    /// True if the surface is cut out at a point: rays pass as if nothing were there.
    fn is_hole(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> bool {
        let _ = (cx, at);
        false
    }
    /// Share of the surface that is there at a point, 0 in a hole: what of its light as a lamp is left.
    fn coverage(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        if self.has_holes() && self.is_hole(cx, at) { 0.0 } else { 1.0 }
    }
}

/// All kinds of material.
pub const MATERIALS: &[Entry<Box<dyn Material>>] = &[
    Entry::of::<Diffuse>(),
    Entry::of::<Mirror>(),
    Entry::of::<Dielectric>(),
    Entry::of::<Classic>(),
    Entry::of::<Principled>(),
    Entry::of::<Interface>(),
    Entry::of::<Conductor>(),
    Entry::of::<CoatedDiffuse>(),
    Entry::of::<CoatedConductor>(),
    Entry::of::<ThinDielectric>(),
    Entry::of::<DiffuseTransmission>(),
    Entry::of::<Phong>(),
    Entry::of::<Disney>(),
    Entry::of::<Hair>(),
    Entry::of::<Subsurface>(),
    Entry::of::<Mix>(),
    Entry::of::<Mask>(),
    Entry::of::<Sides>(),
    Entry::of::<Measured>(),
];

/// The parameter `name`, a reflectance or transmittance; warns if a constant exceeds 1. (No range in the schema says so,
/// because it would be applied to the wavelengths of a spectrum.)
fn share_input(args: &mut Args<'_>, name: &str) -> ColorInput {
    let input = args.color_input(name);
    if let Some(color) = input.even()
        && color.rgb.iter().any(|&v| v > 1.0)
    {
        args.warning(
            name,
            format!("\"{name}\" is more than 1, which reflects or passes more than arrives; 1 is used"),
        );
    }
    input
}

/// A reflectance or transmittance at a point; values outside `[0, 1]` are clamped.
#[inline]
fn share(cx: &ShadeCx<'_>, input: &ColorInput, at: &TextureAt) -> Spectrum {
    cx.weight(input, at, |v| v.clamp(0.0, 1.0))
}

/// A factor that Mitsuba's users may put on what is mirrored or let through, away from what nature does; 1 if it is left out.
const fn factor(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::ColorTexture, ParamDefault::Unset, doc).range(0.0, f32::INFINITY)
}
const REFLECTION: ParamSpec =
    factor("reflection", "Factor on what is reflected, for what nature does not do.");
const TRANSMISSION: ParamSpec =
    factor("transmission", "Factor on what is let through, for what nature does not do.");

/// Such a factor as it was given, if it was.
fn read_factor(args: &mut Args<'_>, spec: &ParamSpec) -> Option<ColorInput> {
    args.is_set(spec.name).then(|| share_input(args, spec.name))
}

/// No [`share`] of this input is larger.
fn largest_share(cx: &ShadeCx<'_>, input: &ColorInput) -> f32 {
    cx.largest_color(input).min(1.0)
}
