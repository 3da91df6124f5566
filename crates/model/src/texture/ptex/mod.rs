//! A picture for each face of a mesh (Burley and Lacewell 2008, "Ptex: Per-Face Texture Mapping for Production Rendering").
//!
//! Quadrangles are interpolated between four texels, also beyond their edges, and between copies of half the size by the
//! footprint's longer side. Triangles, whose texels are triangles, are not interpolated between these. pbrt-v4 has Ptex's
//! library filter with B-splines, along each side by itself: it blurs a little more. Texels are decoded before they are
//! averaged; pbrt decodes what was averaged, rounded to 8 bits.

mod faces;

use durer_core::spectrum::Color;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Filters, Texture, TextureAt, imagemap::encoding::Encoding};
use crate::ShadeCx;
use faces::Faces;

/// What is shown for a file that is missing: magenta.
const MISSING: [f32; 3] = [1.0, 0.0, 1.0];

/// A picture for each face.
#[derive(Clone, Debug)]
pub struct Ptex {
    /// `None` for a file that is missing.
    faces: Option<Faces>,
    scale: f32,
}

impl Ptex {
    fn rgb(&self, at: &TextureAt) -> [f32; 3] {
        let rgb = self.faces.as_ref().map_or(MISSING, |faces| faces.at(at));
        rgb.map(|v| v * self.scale)
    }
}

impl Kind for Ptex {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "ptex",
        aliases: &[],
        doc: "A picture for each face of a mesh, by the numbers that the mesh gives its faces (\"faceIndices\", \"face_indices\" in \
              PLY files); black where the file has no such face.",
        params: &[
            ParamSpec::new(
                "filename",
                ParamType::File,
                ParamDefault::Required,
                "The file (.ptx), relative to the scene file.",
            ),
            ParamSpec::new(
                "encoding",
                ParamType::Text,
                ParamDefault::Text("gamma 2.2"),
                "How colours are stored: sRGB, linear, or gamma and the exponent.",
            ),
            ParamSpec::float("scale", 1.0, "Factor of all values."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let file = args.ptex("filename");
        if !args.is_sound() {
            return None;
        }
        let faces = match file {
            None => None,
            Some(file) => {
                for what in &file.passed_over {
                    args.warning("filename", format!("{what} in this file is passed over"));
                }
                let encoding = Encoding::read(args, &file.texels.data)?;
                Some(Faces::new(&file, encoding))
            }
        };
        Some(Box::new(Self { faces, scale: args.float("scale") }))
    }
}

impl Texture for Ptex {
    fn color(&self, _: &ShadeCx<'_>, at: &TextureAt) -> Color {
        Color { rgb: self.rgb(at).map(|v| v.max(0.0)) }
    }
    fn float(&self, _: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        let [r, g, b] = self.rgb(at);
        if r == g && g == b { r } else { (r + g + b) / 3.0 }
    }
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        self.scale.abs() * self.faces.as_ref().map_or(1.0, Faces::largest)
    }
    fn filters(&self) -> Filters {
        Filters::Always
    }
    fn bytes(&self) -> u64 {
        self.faces.as_ref().map_or(0, Faces::bytes)
    }
}
