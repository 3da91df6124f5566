//! Colours and numbers that vary over a surface.
//!
//! A new texture is one file here and one line in [`COLOR_TEXTURES`], [`FLOAT_TEXTURES`] or both: the same word takes
//! other parameters depending on what it is to yield.

mod bilerp;
mod checkerboard;
mod constant;
mod directionmix;
mod dots;
mod fbm;
mod footprint;
pub(crate) mod imagemap;
mod mapping;
mod marble;
mod mix;
mod noise;
mod ptex;
mod scale;
mod value;
mod vertexcolor;
mod volume;
mod windy;

use std::{cell::RefCell, fmt::Debug};

use durer_core::{
    glam::DAffine3,
    math::{Normal3, Point2, Point3},
    spectrum::{Color, Spectrum},
};
use durer_scene::{ColorInput, Entry, FloatInput, TextureValue};

use crate::ShadeCx;

pub(crate) use self::noise::noise;
pub use bilerp::Bilerp;
pub use checkerboard::Checkerboard;
pub use constant::Constant;
pub use directionmix::DirectionMix;
pub use dots::Dots;
pub use fbm::{Fbm, Fractal, Wrinkled};
pub use footprint::{Footprint, Habit};
pub use imagemap::{ColorImageMap, FloatImageMap, ImageMap};
pub use marble::Marble;
pub use mix::Mix;
pub use ptex::Ptex;
pub use scale::Scale;
pub use value::Value;
pub use vertexcolor::VertexColor;
pub use volume::Volume;
pub use windy::Windy;

/// Where a texture is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureAt {
    /// Surface coordinates.
    pub uv: Point2,
    /// The second set of a mesh; the first where there is none.
    pub second_uv: Point2,
    /// The number that a mesh gives the face; 0 where it gives none.
    pub face: u32,
    /// The point in render space.
    pub p: Point3,
    /// The geometric normal there, unit.
    pub n: Normal3,
    /// Linear RGBA factor of the mesh's vertices.
    pub vertex_color: [f32; 4],
    /// The surroundings of the point that the look-up stands for.
    pub footprint: Footprint,
}

impl TextureAt {
    /// The point alone.
    #[must_use]
    pub fn as_point(&self) -> Self {
        Self { footprint: Footprint::POINT, ..*self }
    }
}

/// Whether a texture averages over footprints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Filters {
    /// It looks at points only.
    Never,
    /// Only where [`Habit::AsPbrt`] says so.
    AsPbrt,
    /// Wherever there is a footprint: a parameter asks for it.
    Always,
}

/// A look-up of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureLookup {
    /// Index of the texture in the scene.
    pub texture: u32,
    /// Surface coordinates where it was asked.
    pub uv: Point2,
    /// What it said.
    pub value: Looked,
}

/// What a texture yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Looked {
    /// A colour, linear Rec. 709.
    Color(Color),
    /// A number.
    Number(f32),
}

/// Look-ups in the order in which they were answered: a texture made of others comes after them.
pub type TextureLog = RefCell<Vec<TextureLookup>>;

/// A texture.
pub trait Texture: Debug + Send + Sync {
    /// The colour at a point, linear Rec. 709.
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color;
    /// The number at a point.
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32;
    /// The colour at a point as a weight in the lanes of the basis; where textures are made of measured curves, theirs.
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        cx.basis.reflectance(self.color(cx, at).map(|v| v.max(0.0)))
    }
    /// No component of a colour and no number of it is of larger magnitude.
    fn largest(&self, cx: &ShadeCx<'_>) -> f32;
    /// Told once, before it is looked up, where its own space is. Placements have inverses.
    fn place(&mut self, render_from_texture: &DAffine3) {
        let _ = render_from_texture;
    }
    /// Whether it wants to know footprints; of a texture made of others, what it does with its own.
    fn filters(&self) -> Filters {
        Filters::Never
    }
    /// Heap memory in bytes, without the image as it was decoded.
    fn bytes(&self) -> u64 {
        0
    }
}

/// All kinds of texture that yield colours.
pub const COLOR_TEXTURES: &[Entry<Box<dyn Texture>>] = &[
    Entry::of::<Bilerp<ColorInput>>(),
    Entry::of::<Checkerboard<ColorInput>>(),
    Entry::of::<Constant<ColorInput>>(),
    Entry::of::<DirectionMix<ColorInput>>(),
    Entry::of::<Dots<ColorInput>>(),
    Entry::of::<Fbm>(),
    Entry::of::<ColorImageMap>(),
    Entry::of::<Marble>(),
    Entry::of::<Mix<ColorInput>>(),
    Entry::of::<Ptex>(),
    Entry::of::<Scale<ColorInput>>(),
    Entry::of::<VertexColor>(),
    Entry::of::<Volume>(),
    Entry::of::<Windy>(),
    Entry::of::<Wrinkled>(),
];

/// All kinds of texture that yield numbers.
pub const FLOAT_TEXTURES: &[Entry<Box<dyn Texture>>] = &[
    Entry::of::<Bilerp<FloatInput>>(),
    Entry::of::<Checkerboard<FloatInput>>(),
    Entry::of::<Constant<FloatInput>>(),
    Entry::of::<DirectionMix<FloatInput>>(),
    Entry::of::<Dots<FloatInput>>(),
    Entry::of::<Fbm>(),
    Entry::of::<FloatImageMap>(),
    Entry::of::<Marble>(),
    Entry::of::<Mix<FloatInput>>(),
    Entry::of::<Ptex>(),
    Entry::of::<Scale<FloatInput>>(),
    Entry::of::<VertexColor>(),
    Entry::of::<Volume>(),
    Entry::of::<Windy>(),
    Entry::of::<Wrinkled>(),
];

/// The register of textures that yield `value`.
pub fn textures(value: TextureValue) -> &'static [Entry<Box<dyn Texture>>] {
    match value {
        TextureValue::Color => COLOR_TEXTURES,
        TextureValue::Float => FLOAT_TEXTURES,
    }
}
