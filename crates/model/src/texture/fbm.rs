//! Sums of octaves of noise over texture space: smooth (fbm) or creased (wrinkled).
use durer_core::{glam::DAffine3, spectrum::Color};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Filters, Texture, TextureAt,
    mapping::Space,
    noise::{Octaves, Sum},
};
use crate::ShadeCx;

/// How many octaves; 32 are finer than numbers can tell apart.
pub(super) const OCTAVES: ParamSpec =
    ParamSpec::new("octaves", ParamType::Int, ParamDefault::Int(8), "Octaves of noise, at most.")
        .range(0.0, 32.0);
/// `omega` of the octaves.
pub(super) const ROUGHNESS: ParamSpec =
    ParamSpec::float("roughness", 0.5, "Strength of each octave by that of the one before, half as wide.");

/// A sum of octaves; as a colour, grey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fractal {
    octaves: Octaves,
    space: Space,
}

impl Fractal {
    fn read(args: &mut Args<'_>, sum: Sum) -> Option<Box<dyn Texture>> {
        let octaves = read_octaves(args, sum);
        args.is_sound().then(|| Box::new(Self { octaves, space: Space::WORLD }) as Box<dyn Texture>)
    }
}

/// The parameters [`OCTAVES`] and [`ROUGHNESS`].
pub(super) fn read_octaves(args: &Args<'_>, sum: Sum) -> Octaves {
    Octaves { sum, octaves: args.int("octaves").unsigned_abs(), omega: args.float("roughness") }
}

impl Texture for Fractal {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        Color::gray(self.float(cx, at))
    }
    fn float(&self, _: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        let width = self.space.width(at.footprint.usual());
        self.octaves.at(self.space.point(at).to_array(), width)
    }
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        self.octaves.largest()
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.space.place(render_from_texture);
    }
    fn filters(&self) -> Filters {
        Filters::AsPbrt
    }
}

/// The word `fbm`.
#[derive(Clone, Copy, Debug)]
pub struct Fbm;

impl Kind for Fbm {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "fbm",
        aliases: &[],
        doc: "Fractional Brownian motion: octaves of noise in texture space, around 0.",
        params: &[OCTAVES, ROUGHNESS],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Fractal::read(args, Sum::Fbm)
    }
}

/// The word `wrinkled`.
#[derive(Clone, Copy, Debug)]
pub struct Wrinkled;

impl Kind for Wrinkled {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "wrinkled",
        aliases: &[],
        doc: "Turbulence: octaves of the magnitude of noise in texture space, with creases where noise is 0.",
        params: &[OCTAVES, ROUGHNESS],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Fractal::read(args, Sum::Turbulence)
    }
}
