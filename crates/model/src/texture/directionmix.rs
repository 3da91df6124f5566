//! Blend of two textures by where the surface faces.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::Vector3,
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Texture, TextureAt, Value};
use crate::ShadeCx;

/// `a tex1 + (1 - a) tex2` with `a` the magnitude of the cosine between the geometric normal and a direction.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionMix<V> {
    tex1: V,
    tex2: V,
    /// In texture space.
    dir: DVec3,
    /// In render space, unit.
    placed: Vector3,
}

impl<V: Value> DirectionMix<V> {
    /// The share of the second texture.
    fn amount(&self, at: &TextureAt) -> f32 {
        1.0 - at.n.dot(self.placed).abs().min(1.0)
    }
}

impl<V: Value> Texture for DirectionMix<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        V::blend((&self.tex1, &self.tex2), self.amount(at), |tex| tex.color(cx, at))
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        V::blend((&self.tex1, &self.tex2), self.amount(at), |tex| tex.float(cx, at))
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        V::blend((&self.tex1, &self.tex2), self.amount(at), |tex| tex.weight(cx, at))
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        self.tex1.largest(cx).max(self.tex2.largest(cx))
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.placed = Vector3::from_f64(render_from_texture.transform_vector3(self.dir).normalize());
    }
}

impl<V: Value> Kind for DirectionMix<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "directionmix",
        aliases: &[],
        doc: "A blend of two values or textures by the cosine between the surface's normal and a direction.",
        params: &[
            ParamSpec::new("tex1", V::TYPE, V::ZERO, "Where the normal is along dir, or against it."),
            ParamSpec::new("tex2", V::TYPE, V::ONE, "Where it is perpendicular."),
            ParamSpec::new(
                "dir",
                ParamType::Vector3,
                ParamDefault::Triple([0.0, 1.0, 0.0]),
                "The direction, in the texture's own space.",
            ),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let (tex1, tex2) = (V::read(args, "tex1"), V::read(args, "tex2"));
        let dir = DVec3::from(args.triple("dir").map(f64::from));
        if dir == DVec3::ZERO {
            args.error("dir", "\"dir\" is 0 0 0, expected a direction");
        }
        args.is_sound().then(|| {
            let mut mix = Self { tex1, tex2, dir, placed: Vector3::ZERO };
            mix.place(&DAffine3::IDENTITY);
            Box::new(mix) as Box<dyn Texture>
        })
    }
}
