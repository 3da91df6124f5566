//! A material for each side of a surface: paper with a coloured back, walls that absorb what meets them from behind.
use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Arriving, MATERIALS, Material, Sent};
use crate::{Medium, ShadeCx, Surface, bsdf::Bsdf, texture::TextureAt};

/// Two materials, back to back.
#[derive(Debug)]
pub struct Sides {
    front: Box<dyn Material>,
    /// Absorbs all light if there is none.
    back: Option<Box<dyn Material>>,
}

impl Kind for Sides {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "sides",
        aliases: &[],
        doc: "Other materials in front, where the normal points, and behind. For opaque ones: each is met from its own side.",
        params: &[
            ParamSpec::new(
                "front",
                ParamType::Text,
                ParamDefault::Required,
                "Name of a material that is described before this one.",
            ),
            ParamSpec::new(
                "back",
                ParamType::Text,
                ParamDefault::Unset,
                "The same for the side behind; without it all light is absorbed there.",
            ),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let front = args.build_named("front", args.text("front"), MATERIALS);
        let back = match args.is_set("back") {
            true => Some(args.build_named("back", args.text("back"), MATERIALS)?),
            false => None,
        };
        Some(Box::new(Self { front: front?, back }))
    }
}

impl Sides {
    fn any(&self, of: impl Fn(&dyn Material) -> bool) -> bool {
        of(&*self.front) || self.back.as_deref().is_some_and(of)
    }
}

impl Material for Sides {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        let is_front = surface.n_s.dot(wo) > 0.0;
        let side = if is_front { Some(&self.front) } else { self.back.as_ref() };
        side.map_or_else(Bsdf::default, |material| material.bsdf(cx, surface, wo))
    }
    fn emission(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        self.front.emission(cx, at)
    }
    fn sent(&self, cx: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        if self.back.is_some() { Sent::UNBOUNDED } else { self.front.sent(cx, arriving) }
    }
    fn medium(&self) -> Option<Medium> {
        self.front.medium()
    }
    fn has_holes(&self) -> bool {
        self.any(|m| m.has_holes())
    }
    fn is_passed(&self) -> bool {
        self.any(|m| m.is_passed())
    }
    fn is_hole(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> bool {
        self.front.is_hole(cx, at)
    }
    fn coverage(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.front.coverage(cx, at)
    }
}
