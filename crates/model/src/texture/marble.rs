//! Veins in stone: layers along y of texture space, bent by noise, coloured by a spline.
//!
//! `t = 1/2 + 1/2 sin(s y + variation fbm(s p))` runs along a cubic spline of six pieces (Perlin 1985, "An Image
//! Synthesizer"; layout and colours are pbrt-v4's, where each piece is a Bezier curve of four neighbouring colours).
use durer_core::{glam::DAffine3, math::float::sin, spectrum::Color};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{
    Filters, Texture, TextureAt,
    fbm::{OCTAVES, ROUGHNESS, read_octaves},
    mapping::Space,
    noise::{Octaves, Sum},
};
use crate::ShadeCx;

const STONE: [f32; 3] = [0.58, 0.58, 0.6];
/// Control points, one after the other.
const COLORS: [[f32; 3]; 9] =
    [STONE, STONE, STONE, [0.5, 0.5, 0.5], [0.6, 0.59, 0.58], STONE, STONE, [0.2, 0.2, 0.33], STONE];
/// All colours are brightened by this.
const GAIN: f32 = 1.5;

/// Marble; as a number, its luminance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marble {
    octaves: Octaves,
    scale: f32,
    variation: f32,
    space: Space,
}

/// The colour at `t` in `[0, 1]`.
fn vein(t: f32) -> Color {
    let pieces = COLORS.len() - 3;
    let along = t * pieces as f32;
    let first = (along as usize).min(pieces - 1);
    let t = along - first as f32;
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    let points = COLORS[first..].iter().zip(weights);
    points.fold(Color::BLACK, |sum, (&[r, g, b], w)| sum + Color::new(r, g, b) * (w * GAIN))
}

impl Texture for Marble {
    fn color(&self, _: &ShadeCx<'_>, at: &TextureAt) -> Color {
        let p = self.space.point(at) * f64::from(self.scale);
        let width = self.space.width(at.footprint.usual()) * self.scale.abs();
        let bent = p.y as f32 + self.variation * self.octaves.at(p.to_array(), width);
        vein(0.5 + 0.5 * sin(bent))
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.color(cx, at).luminance()
    }
    /// A Bezier curve stays between its control points.
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        COLORS.iter().flatten().fold(0.0, |most: f32, c| most.max(c * GAIN)) * (1.0 + 4.0 * f32::EPSILON)
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.space.place(render_from_texture);
    }
    fn filters(&self) -> Filters {
        Filters::AsPbrt
    }
}

impl Kind for Marble {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "marble",
        aliases: &[],
        doc: "Layers along y of texture space, bent by noise, in the colours of marble.",
        params: &[
            OCTAVES,
            ROUGHNESS,
            ParamSpec::float("scale", 1.0, "Factor of the point: larger makes finer veins."),
            ParamSpec::float("variation", 0.2, "How far noise bends the layers, in radians of their sine."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let octaves = read_octaves(args, Sum::Fbm);
        let (scale, variation) = (args.float("scale"), args.float("variation"));
        args.is_sound()
            .then(|| Box::new(Self { octaves, scale, variation, space: Space::WORLD }) as Box<dyn Texture>)
    }
}
