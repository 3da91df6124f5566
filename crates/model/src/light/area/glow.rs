//! How bright the points of a light are.
use std::sync::Arc;

use durer_core::spectrum::{Basis, Color, LightColor, Spectrum};
use durer_scene::{Args, ColorInput, LightInput};

use super::super::{largest, picture::Picture};
use crate::{
    ShadeCx,
    material::Material,
    texture::{Texture, TextureAt},
};

/// The radiance of a surface, point by point.
#[derive(Clone, Debug)]
pub(super) enum Glow {
    /// The same everywhere.
    Even(LightColor),
    /// A texture of the scene.
    Texture(u32),
    /// A picture over the surface coordinates.
    Picture(Arc<Picture>),
}

impl Glow {
    /// What the parameters `L` and `filename` say; complains if they contradict each other.
    pub(super) fn read(args: &mut Args<'_>) -> Option<Self> {
        if args.is_set("filename") {
            if args.is_set("L") {
                args.error("L", "a light has a radiance \"L\" or a picture \"filename\", not both");
            }
            let picture = Picture::read(args, "filename");
            // The placeholder of a missing picture.
            let missing = Self::Even(Color::new(1.0, 0.0, 1.0).into());
            return args.is_sound().then(|| picture.map_or(missing, |p| Self::Picture(Arc::new(p))));
        }
        match args.light_input("L") {
            LightInput::Texture(index) => Some(Self::Texture(index)),
            LightInput::Even(color) => {
                if args.is_set("power") && color.luminance() <= 0.0 {
                    args.error("L", "a light of \"power\" needs a colour \"L\" that is not black");
                }
                Some(Self::Even(color))
            }
        }
    }
    /// The radiance if it is the same everywhere.
    pub(super) fn even(&self) -> Option<&LightColor> {
        match self {
            Self::Even(color) => Some(color),
            Self::Texture(_) | Self::Picture(_) => None,
        }
    }
}

/// The textures of a scene.
pub type Textures = Arc<[Box<dyn Texture>]>;
/// The materials of a scene.
pub type Materials = Arc<[Box<dyn Material>]>;

/// What a scene has to say about the looks of a surface.
#[derive(Clone, Debug, Default)]
pub struct Looks {
    /// All textures.
    pub textures: Textures,
    /// The materials, and which of them is the surface's, if it may have holes.
    pub holes: Option<(Materials, u32)>,
}

impl Looks {
    pub(super) fn has_holes(&self) -> bool {
        self.holes.is_some()
    }
    /// The largest component that [`Looks::radiance`] may give to red, green and blue.
    pub(super) fn largest(&self, glow: &Glow) -> f32 {
        let cx = ShadeCx { basis: Basis::Rgb, textures: &self.textures, log: None };
        match glow {
            Glow::Even(color) => largest(color.color),
            Glow::Texture(index) if self.textures.get(*index as usize).is_none() => 0.0,
            Glow::Texture(index) => cx.largest_color(&ColorInput::Texture(*index)),
            Glow::Picture(picture) => picture.largest(),
        }
    }
    /// The radiance where textures are looked up at `at`, by the share of the surface that is there; black in a hole.
    pub(super) fn radiance(&self, glow: &Glow, basis: &Basis, at: &TextureAt) -> Spectrum {
        let cx = ShadeCx { basis: *basis, textures: &self.textures, log: None };
        let there =
            self.holes.as_ref().map(|(materials, index)| materials[*index as usize].coverage(&cx, at));
        match there {
            Some(0.0) => Spectrum::BLACK,
            Some(share) => self.shown(glow, &cx, at) * share,
            None => self.shown(glow, &cx, at),
        }
    }
    fn shown(&self, glow: &Glow, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        cx.basis.emission(match glow {
            Glow::Even(color) => return cx.basis.light(color),
            // Asked for before the scene's textures are known.
            Glow::Texture(index) if self.textures.get(*index as usize).is_none() => Color::BLACK,
            Glow::Texture(index) => cx.color(&ColorInput::Texture(*index), at).map(|v| v.max(0.0)),
            Glow::Picture(picture) => picture.at([at.uv.x, 1.0 - at.uv.y]),
        })
    }
}
