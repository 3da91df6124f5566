//! Dots of the same size, one at most in each unit square of texture space, at random places.
//!
//! Squares have their middles at whole coordinates. Noise at `(i + 1/2, j + 1/2)` says whether square (i, j) has a dot, noise
//! further on how far its centre is shifted (Physically Based Rendering, 3rd edition, section 10.5.2). Not filtered.
use durer_core::{
    glam::DAffine3,
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{
    Texture, TextureAt, Value,
    mapping::{Mapping, mapped},
    noise::noise,
};
use crate::ShadeCx;

/// Of each dot.
const RADIUS: f64 = 0.35;
/// A dot stays in its square: noise at the height that is looked up is below 1.
const MOST_SHIFT: f64 = 0.5 - RADIUS;

/// Dots on a ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Dots<V> {
    inside: V,
    outside: V,
    mapping: Mapping,
}

/// Whether the point is in a dot.
fn is_dot(c: [f64; 2]) -> bool {
    let cell = c.map(|c| (c + 0.5).floor());
    let random = |du: f64, dv: f64| f64::from(noise([cell[0] + du, cell[1] + dv, 0.5]));
    if random(0.5, 0.5) <= 0.0 {
        return false;
    }
    let centre = [cell[0] + MOST_SHIFT * random(1.5, 2.8), cell[1] + MOST_SHIFT * random(4.5, 9.8)];
    let (du, dv) = (c[0] - centre[0], c[1] - centre[1]);
    du * du + dv * dv < RADIUS * RADIUS
}

impl<V: Value> Dots<V> {
    fn value(&self, at: &TextureAt) -> &V {
        if is_dot(self.mapping.apply(at)) { &self.inside } else { &self.outside }
    }
}

impl<V: Value> Texture for Dots<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        self.value(at).color(cx, at)
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.value(at).float(cx, at)
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        self.value(at).weight(cx, at)
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        self.inside.largest(cx).max(self.outside.largest(cx))
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.mapping.place(render_from_texture);
    }
}

impl<V: Value> Kind for Dots<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "dots",
        aliases: &[],
        doc: "Dots of radius 0.35 at random places of texture space, one at most in each unit square.",
        params: &mapped::<2, 10>([
            ParamSpec::new("inside", V::TYPE, V::ONE, "In the dots."),
            ParamSpec::new("outside", V::TYPE, V::ZERO, "Between them."),
        ]),
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let mapping = Mapping::read(args);
        let (inside, outside) = (V::read(args, "inside"), V::read(args, "outside"));
        args.is_sound().then(|| Box::new(Self { inside, outside, mapping }) as Box<dyn Texture>)
    }
}
