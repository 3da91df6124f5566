//! Four corners, interpolated: `(1 - u)(1 - v) v00 + u (1 - v) v10 + (1 - u) v v01 + u v v11`, and on beyond the unit square.
use durer_core::{
    glam::DAffine3,
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{
    Texture, TextureAt, Value,
    mapping::{Mapping, mapped},
};
use crate::ShadeCx;

/// A bilinear function of the texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Bilerp<V> {
    /// v00, v10, v01, v11.
    corners: [V; 4],
    mapping: Mapping,
}

impl<V: Value> Bilerp<V> {
    fn weights(&self, at: &TextureAt) -> [f32; 4] {
        let [u, v] = self.mapping.apply(at);
        [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v].map(|w| w as f32)
    }
}

impl<V: Value> Texture for Bilerp<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        let parts = self.corners.iter().zip(self.weights(at));
        parts.fold(Color::BLACK, |sum, (corner, w)| sum + corner.color(cx, at) * w)
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.corners.iter().zip(self.weights(at)).map(|(corner, w)| corner.float(cx, at) * w).sum()
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        let parts = self.corners.iter().zip(self.weights(at));
        parts.fold(Spectrum::BLACK, |sum, (corner, w)| sum + corner.weight(cx, at) * w)
    }
    /// Beyond the unit square there is no bound.
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        let most = self.corners.iter().map(|corner| corner.largest(cx)).fold(0.0, f32::max);
        if most > 0.0 { f32::INFINITY } else { 0.0 }
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.mapping.place(render_from_texture);
    }
}

impl<V: Value> Kind for Bilerp<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "bilerp",
        aliases: &[],
        doc: "Four values, interpolated between the corners of the unit square of texture space, and on beyond it.",
        params: &mapped::<4, 12>([
            ParamSpec::new("v00", V::TYPE, V::ZERO, "At (0, 0)."),
            ParamSpec::new("v01", V::TYPE, V::ONE, "At (0, 1)."),
            ParamSpec::new("v10", V::TYPE, V::ZERO, "At (1, 0)."),
            ParamSpec::new("v11", V::TYPE, V::ONE, "At (1, 1)."),
        ]),
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let mapping = Mapping::read(args);
        let corners = ["v00", "v10", "v01", "v11"].map(|name| V::read(args, name));
        args.is_sound().then(|| Box::new(Self { corners, mapping }) as Box<dyn Texture>)
    }
}
