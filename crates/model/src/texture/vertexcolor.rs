//! What the vertices of a mesh bring: their colour, or the fourth number beside it.
use durer_core::spectrum::Color;
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{Texture, TextureAt};
use crate::ShadeCx;

/// Colours or numbers of vertices; white and 1 where a mesh has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexColor {
    scale: f32,
}

impl Texture for VertexColor {
    fn color(&self, _cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        let [r, g, b, _] = at.vertex_color;
        Color::new(r, g, b) * self.scale
    }
    fn float(&self, _cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        at.vertex_color[3] * self.scale
    }
    /// Colours of vertices are shares of light.
    fn largest(&self, _cx: &ShadeCx<'_>) -> f32 {
        self.scale.abs()
    }
}

impl Kind for VertexColor {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "vertexcolor",
        aliases: &[],
        doc: "The colours that the vertices of a mesh have; as numbers, their alpha. 1 on other shapes.",
        params: &[ParamSpec::float("scale", 1.0, "Factor of all values.")],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let scale = args.float("scale");
        args.is_sound().then(|| Box::new(Self { scale }) as Box<dyn Texture>)
    }
}
