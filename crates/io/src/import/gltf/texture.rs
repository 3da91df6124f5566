//! Textures: images by name, samplers, and texture transforms turned to our v, which grows upwards.
use std::collections::HashMap;

use durer_core::{glam::DAffine3, math::float};
use durer_scene::{Data, Location, Node, Params, TextureDesc, TextureValue, ValueType};

use super::{
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    kept,
};
use crate::FileAssets;

/// Extensions that give textures images of other formats, the better first.
const OTHER_IMAGES: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];

/// What a texture is used for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// sRGB-encoded colour, times a factor.
    Color([f64; 3]),
    /// Linear vectors.
    Normal,
    /// One channel, linear, times a factor.
    Channel(&'static str, f64),
}

/// Textures made so far; equal ones are one.
pub(super) struct Textures<'b, 'a> {
    document: &'b Document<'a>,
    buffers: &'b Buffers,
    assets: &'b mut FileAssets,
    /// Images by index.
    filenames: &'b mut HashMap<usize, String>,
    names: HashMap<String, String>,
    /// The sets of texture coordinates that a mesh has for the material at work.
    pub(super) sets: [usize; 2],
    /// What messages call the material at work.
    pub(super) material: String,
    /// The textures.
    pub(super) list: Vec<TextureDesc>,
}

impl<'b, 'a> Textures<'b, 'a> {
    /// None yet, but for images, which may be known by name.
    pub(super) fn new(
        (document, buffers): (&'b Document<'a>, &'b Buffers),
        assets: &'b mut FileAssets,
        filenames: &'b mut HashMap<usize, String>,
    ) -> Self {
        let names = HashMap::new();
        Self {
            document,
            buffers,
            assets,
            filenames,
            names,
            sets: [0, 1],
            material: String::new(),
            list: Vec::new(),
        }
    }

    /// The name of the texture that the textureInfo object `info` describes; `None` if its image is of no use.
    pub(super) fn texture(&mut self, info: &Element<'a>, role: Role) -> Checked<Option<String>> {
        let texture = self.document.item("textures", &info.required("index")?)?;
        let Some(filename) = self.image(&texture)? else {
            return Ok(None);
        };
        let (filename, at) = filename;
        let mut params = Params::new().string("filename", &filename);
        params = self.sampler(&texture, params)?;
        let (value, params) = match role {
            Role::Color(factor) => {
                let params = params.string("encoding", "sRGB");
                (
                    TextureValue::Color,
                    if factor == [1.0; 3] { params } else { params.rgb("factor", single(factor)) },
                )
            }
            Role::Normal => (TextureValue::Color, params.string("encoding", "linear")),
            Role::Channel(channel, factor) => {
                let params = params.string("encoding", "linear").string("channel", channel);
                (
                    TextureValue::Float,
                    if factor == 1.0 { params } else { params.float("scale", factor as f32) },
                )
            }
        };
        let params = self.transform(info, params)?;
        let node = Node::new("imagemap", params);
        let key = format!("{value:?} {:?}", node.params);
        let count = self.list.len();
        let name = self.names.entry(key).or_insert_with(|| {
            let name = format!("texture:{count}");
            self.list.push(TextureDesc {
                name: name.clone(),
                value,
                node: Node { at, ..node },
                world_from_texture: DAffine3::IDENTITY,
            });
            name
        });
        Ok(Some(name.clone()))
    }

    /// The file name of a texture's image and where that is described; embedded ones are registered under a name of
    /// their own.
    fn image(&mut self, texture: &Element<'a>) -> Checked<Option<(String, Location)>> {
        let mut other = None;
        for name in OTHER_IMAGES {
            if let Some(extension) = texture.extension(name)? {
                other = other.or(extension.get("source")?);
            }
        }
        let Some(source) = other.or(texture.get("source")?) else {
            let other: Vec<&str> = texture.get("extensions")?.iter().flat_map(Element::keys).collect();
            let why =
                if other.is_empty() { "has no image".into() } else { format!("needs {}", other.join(", ")) };
            self.document.warn(texture, format!("a texture {why}; its factor alone is used"));
            return Ok(None);
        };
        let index = source.index()?;
        if let Some(name) = self.filenames.get(&index) {
            let at = self.document.location(&format!("/images/{index}"));
            return Ok(Some((name.clone(), at)));
        }
        let image = self.document.item("images", &source)?;
        let embedded = format!("image:{index}");
        let name = kept::file((self.document, self.buffers), self.assets, &image, embedded)?;
        self.assets.used_by(&name, format!("material \"{}\"", self.material));
        self.filenames.insert(index, name.clone());
        Ok(Some((name, self.document.location(image.pointer()))))
    }

    fn sampler(&self, texture: &Element<'a>, params: Params) -> Checked<Params> {
        let Some(sampler) = self.document.member(texture, "sampler", "samplers")? else {
            return Ok(params);
        };
        let wrap = |key| match sampler.index_or(key, 10497)? {
            10497 => Ok("repeat"),
            33071 => Ok("clamp"),
            33648 => Ok("mirror"),
            other => Err(sampler.fault_at(key, format!("expected 10497, 33071 or 33648, found {other}"))),
        };
        let (u, v) = (wrap("wrapS")?, wrap("wrapT")?);
        let mut params = if u == "repeat" && v == "repeat" { params } else { params.string("wrap", u) };
        if u != v {
            params = params.string("wrapv", v);
        }
        // What is chosen for texels that are wide in the picture counts; then whether there are smaller copies.
        let filter = match (sampler.index_or("magFilter", 9729)?, sampler.index_or("minFilter", 9729)?) {
            (9728, _) => Some("point"),
            (_, 9984..=9987) => Some("trilinear"),
            _ => None,
        };
        Ok(match filter {
            Some(word) => params.string("filter", word),
            None => params,
        })
    }

    fn transform(&self, info: &Element<'a>, params: Params) -> Checked<Params> {
        let mut params = params;
        if let Some(matrix) = matrix(info)? {
            let values = Data::Floats(matrix.map(|v| v as f32).to_vec());
            params = params.with("uvmatrix", ValueType::Float, values);
        }
        Ok(if uv_set(info)? == self.sets[1] { params.int("uvset", 1) } else { params })
    }
}

/// The number of the texture coordinates that a textureInfo object asks for.
pub(super) fn uv_set(info: &Element<'_>) -> Checked<usize> {
    let set = info.index_or("texCoord", 0)?;
    match info.extension("KHR_texture_transform")? {
        Some(transform) => transform.index_or("texCoord", set),
        None => Ok(set),
    }
}

/// The texture transform of a textureInfo object, if it does anything.
fn matrix(info: &Element<'_>) -> Checked<Option<[f64; 6]>> {
    let Some(transform) = info.extension("KHR_texture_transform")? else {
        return Ok(None);
    };
    let offset = transform.numbers_or("offset", [0.0; 2])?;
    let scale = transform.numbers_or("scale", [1.0; 2])?;
    let matrix = uv_matrix(offset, transform.number_or("rotation", 0.0)?, scale);
    Ok((matrix != uv_matrix([0.0; 2], 0.0, [1.0; 2])).then_some(matrix))
}

/// What the texture transform of a normal map does to tangents: the rows of its matrix without the translation; `None`
/// if they stay where they are.
pub(super) fn linear_part(info: &Element<'_>) -> Checked<Option<[f32; 4]>> {
    let turns = |[a, b, _, c, d, _]: [f64; 6]| {
        let stays = b == 0.0 && c == 0.0 && a > 0.0 && d > 0.0;
        (!stays).then_some([a, b, c, d].map(|v| v as f32))
    };
    Ok(matrix(info)?.and_then(turns))
}

/// The rows `[m0 m1 m2; m3 m4 m5]` that map our (u, v) as KHR_texture_transform maps (u, 1 - v).
///
/// In its coordinates, with v downwards, scale S, then rotation R, then offset T:
/// u' = c sx u + s sy v + tx, v' = -s sx u + c sy v + ty. The extension's GLSL has the other sign of the angle; its
/// text ("counter-clockwise"), the Khronos viewer and the markers of TextureTransformTest agree on this one.
/// Put v = 1 - w and w' = 1 - v'.
fn uv_matrix([tx, ty]: [f64; 2], rotation: f64, [sx, sy]: [f64; 2]) -> [f64; 6] {
    let (s, c) = sin_cos(rotation);
    [c * sx, -s * sy, s * sy + tx, s * sx, c * sy, 1.0 - c * sy - ty]
}

/// Sine and cosine with the same bits on every system; quarter turns give exact zeros and ones, which point-sampled
/// textures need.
fn sin_cos(angle: f64) -> (f64, f64) {
    let snap = |v: f32| {
        if (v - v.round()).abs() < 2e-7 { v.round() } else { v }
    };
    let angle = angle as f32;
    (snap(float::sin(angle)).into(), snap(float::cos(angle)).into())
}

fn single(v: [f64; 3]) -> [f32; 3] {
    v.map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::uv_matrix;

    /// Maps glTF texture coordinates (v downwards) the way a renderer with v upwards does.
    fn sampled([u, v]: [f64; 2], m: [f64; 6]) -> [f64; 2] {
        let w = 1.0 - v;
        let [a, b, c, d, e, f] = m;
        [a * u + b * w + c, 1.0 - (d * u + e * w + f)]
    }

    fn near(a: [f64; 2], b: [f64; 2], tolerance: f64) -> bool {
        a.iter().zip(b).all(|(x, y)| (x - y).abs() < tolerance)
    }

    #[test]
    fn no_transform_is_the_identity() {
        assert_eq!(uv_matrix([0.0; 2], 0.0, [1.0; 2]), [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    }

    #[test]
    fn offsets_move_as_in_gltf() {
        assert!(near(sampled([0.25, 0.125], uv_matrix([0.5, 0.25], 0.0, [1.0; 2])), [0.75, 0.375], 1e-12));
    }

    /// The quads of Khronos' TextureTransformTest show an arrow whose tip lies at (0.7778, 0.7778) of its image; green
    /// markers sit where the tip must appear. Their places were read from the file (v = 0.5 - y).
    #[test]
    fn the_arrows_of_the_texture_transform_test_hit_their_green_markers() {
        let tip = [0.7778, 0.7778];
        let rotated = uv_matrix([0.0; 2], std::f64::consts::FRAC_PI_8, [1.0; 2]);
        assert!(near(sampled([0.420_952, 1.016_267], rotated), tip, 1e-4));
        let scaled = uv_matrix([0.0; 2], 0.0, [1.5; 2]);
        assert!(near(sampled([0.518_545, 0.518_545], scaled), tip, 1e-4));
        let all = uv_matrix([-0.2, -0.1], 0.3, [1.5; 2]);
        assert!(near(sampled([0.43, 0.75], all), tip, 0.04));
    }
}
