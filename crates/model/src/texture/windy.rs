//! Waves on water, higher where the wind blows: `|fbm(p / 10)| fbm(p)` with 3 and 6 octaves.
use durer_core::{glam::DAffine3, spectrum::Color};
use durer_scene::{Args, Kind, Schema};

use super::{
    Filters, Texture, TextureAt,
    mapping::Space,
    noise::{Octaves, Sum},
};
use crate::ShadeCx;

const WIND: Octaves = Octaves { sum: Sum::Fbm, octaves: 3, omega: 0.5 };
const WAVES: Octaves = Octaves { sum: Sum::Fbm, octaves: 6, omega: 0.5 };

/// Height of waves; as a colour, grey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windy {
    space: Space,
}

impl Texture for Windy {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        Color::gray(self.float(cx, at))
    }
    fn float(&self, _: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        let (p, width) = (self.space.point(at), self.space.width(at.footprint.usual()));
        WIND.at((p * 0.1).to_array(), width * 0.1).abs() * WAVES.at(p.to_array(), width)
    }
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        WIND.largest() * WAVES.largest()
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.space.place(render_from_texture);
    }
    fn filters(&self) -> Filters {
        Filters::AsPbrt
    }
}

impl Kind for Windy {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "windy",
        aliases: &[],
        doc: "Heights of waves on windy water, in texture space, around 0.",
        params: &[],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        args.is_sound().then(|| Box::new(Self { space: Space::WORLD }) as Box<dyn Texture>)
    }
}
