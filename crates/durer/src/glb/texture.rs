//! Textures: pictures by reference where glTF says the same of them, else copied texel by texel into pictures that it can
//! say. Kinds that are computed become their mean.
use std::collections::HashMap;

use durer_scene::{Args, Assets, Diagnostics, Image, ImageData, TextureValue, find};
use serde_json::{Value, json};

use super::Writer;
use crate::image::encode_png_rgba;

pub(super) const TRANSFORM: &str = "KHR_texture_transform";

/// What was written.
#[derive(Default)]
pub(super) struct Known {
    images: HashMap<String, usize>,
    samplers: HashMap<String, usize>,
    textures: HashMap<(usize, Option<usize>), usize>,
}

/// A picture on a surface, as glTF has it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mapped {
    filename: String,
    /// Its sampler, if it is not the usual one.
    sampler: Option<Value>,
    /// `texCoord` and the transform.
    place: Value,
    /// How its numbers are stored: `sRGB`, `linear` or other words.
    encoding: String,
    /// Which of its numbers is meant; of colours nothing.
    channel: String,
    pub(super) factor: [f32; 3],
}

impl Writer<'_> {
    /// A texture as a picture with a factor; `Err` is a colour that stands for it, which was warned of.
    pub(super) fn mapped(
        &mut self,
        name: &str,
        value: TextureValue,
        owner: &str,
    ) -> Result<Mapped, [f32; 3]> {
        let Some(texture) = self.texture_desc(name, value).cloned() else { return Err([0.5; 3]) };
        let mut said = Diagnostics::default();
        let entry = find(durer_model::texture::textures(value), "texture", &texture.node, &mut said);
        let Some(entry) = entry else { return Err([0.5; 3]) };
        let mut args = Args::check(&texture.node, entry.schema, &self.desc.textures, &mut said);
        let flat = |args: &mut Args<'_>, name: &str| match value {
            TextureValue::Float => [args.float(name); 3],
            TextureValue::Color => args.color(name).rgb,
        };
        match entry.schema.name {
            "imagemap" => {}
            "constant" => return Err(flat(&mut args, "value")),
            "checkerboard" => {
                let (a, b) = (flat(&mut args, "tex1"), flat(&mut args, "tex2"));
                self.warn(format!("{owner}: checks become their mean, as glTF has pictures only"));
                return Err(std::array::from_fn(|i| 0.5 * (a[i] + b[i])));
            }
            other => {
                self.warn(format!(
                    "{owner}: a texture of kind \"{other}\" becomes grey, as glTF has pictures only"
                ));
                return Err([0.5; 3]);
            }
        }
        if args.text("mapping") != "uv" || args.bool("invert") {
            self.warn(format!("{owner}: a picture that is projected or inverted becomes grey"));
            return Err([0.5; 3]);
        }
        let scale = args.float("scale");
        let factor = match value {
            TextureValue::Color => args.color("factor").rgb.map(|v| v * scale),
            TextureValue::Float => [scale; 3],
        };
        let place = self.place(&args, owner);
        let channel = if value == TextureValue::Float { args.text("channel") } else { "" };
        Ok(Mapped {
            filename: args.text("filename").to_owned(),
            sampler: sampler(&args),
            place,
            encoding: args.text("encoding").to_owned(),
            channel: channel.to_owned(),
            factor,
        })
    }

    /// Where on the surface: the inverse of what the reader makes of KHR_texture_transform.
    fn place(&mut self, args: &Args<'_>, owner: &str) -> Value {
        let mut place = json!({});
        if args.int("uvset") != 0 {
            place["texCoord"] = args.int("uvset").into();
        }
        let m: [f64; 6] = match args.floats("uvmatrix") {
            [a, b, c, d, e, f] => [*a, *b, *c, *d, *e, *f].map(f64::from),
            _ => {
                let [su, sv, du, dv] =
                    ["uscale", "vscale", "udelta", "vdelta"].map(|p| f64::from(args.float(p)));
                [su, 0.0, du, 0.0, sv, dv]
            }
        };
        if m == [1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
            return place;
        }
        let (sx, angle) = (m[0].hypot(m[3]), m[3].atan2(m[0]));
        let (sin, cos) = angle.sin_cos();
        let sy = cos * m[4] - sin * m[1];
        if (m[1] + sin * sy).abs() > 1e-4 * sy.abs() || (m[4] - cos * sy).abs() > 1e-4 * sy.abs() {
            self.warn(format!("{owner}: a sheared picture stands straight in the file"));
        }
        let offset = [m[2] - sin * sy, 1.0 - cos * sy - m[5]];
        self.extensions.insert(TRANSFORM.to_owned());
        place["extensions"] =
            json!({ TRANSFORM: { "offset": offset, "rotation": angle, "scale": [sx, sy] } });
        place
    }

    /// The textureInfo of a picture whose colours are as glTF has them (`srgb` or not), or of a copy.
    pub(super) fn color_info(&mut self, map: &Mapped, srgb: bool) -> Option<Value> {
        let image = self.image(&map.filename)?;
        let is_8_bit = matches!(image.data, ImageData::U8(_));
        let stored_srgb = match map.encoding.as_str() {
            "sRGB" => true,
            "" => is_8_bit,
            _ => false,
        };
        if stored_srgb == srgb && is_8_bit {
            return self.info(map, &map.filename.clone(), None);
        }
        let texel = |i: usize| {
            let [r, g, b, a] = texel(&image, i);
            let coded = [r, g, b].map(|v| match (stored_srgb, srgb) {
                (true, false) => decoded(v),
                (false, true) => encoded(v),
                _ => v,
            });
            [coded[0], coded[1], coded[2], a].map(byte)
        };
        let pixels = (0..image.width as usize * image.height as usize).flat_map(texel).collect();
        self.copied(map, &image, pixels, &format!("{} {srgb}", map.filename))
    }

    /// The textureInfo of numbers: each in a channel of its own (`r`, `g`, `b`, `a`), the others 1. All are of pictures of
    /// the same size and place.
    pub(super) fn number_info(&mut self, maps: [Option<&Mapped>; 4]) -> Option<Value> {
        const CHANNELS: [&str; 4] = ["r", "g", "b", "a"];
        let first = maps.into_iter().flatten().next()?;
        let direct = maps.iter().zip(CHANNELS).all(|(map, channel)| {
            map.is_none_or(|m| m.channel == channel && m.encoding == "linear" && m.filename == first.filename)
        });
        let image = self.image(&first.filename)?;
        if direct && matches!(image.data, ImageData::U8(_)) {
            return self.info(first, &first.filename.clone(), None);
        }
        self.number_copy(maps)
    }

    /// The same in a picture of its own: channels that nobody asks for are 1.
    pub(super) fn number_copy(&mut self, maps: [Option<&Mapped>; 4]) -> Option<Value> {
        let first = maps.into_iter().flatten().next()?;
        let image = self.image(&first.filename)?;
        let mut images = Vec::new();
        for map in maps {
            images.push(match map {
                Some(map) => Some((map, self.image(&map.filename)?)),
                None => None,
            });
        }
        let same = |(_, other): &(&Mapped, std::sync::Arc<Image>)| {
            (other.width, other.height) == (image.width, image.height)
        };
        if !images.iter().flatten().all(same) {
            return None;
        }
        let texel = |i: usize| {
            images.iter().map(move |source| match source {
                Some((map, image)) => byte(number(map, image, i)),
                None => 255,
            })
        };
        let pixels = (0..image.width as usize * image.height as usize).flat_map(texel).collect();
        let name = |map: Option<&Mapped>| {
            map.map_or_else(String::new, |m| format!("{} {} {};", m.filename, m.channel, m.encoding))
        };
        let key: String = maps.map(name).concat();
        self.copied(first, &image, pixels, &key)
    }

    fn copied(&mut self, map: &Mapped, image: &Image, pixels: Vec<u8>, key: &str) -> Option<Value> {
        let png = encode_png_rgba(image.width, image.height, &pixels).ok()?;
        self.info(map, &format!("copy of {key}"), Some(png))
    }

    fn image(&mut self, filename: &str) -> Option<std::sync::Arc<Image>> {
        match self.whole.assets.image(filename) {
            Ok(image) => Some(image),
            Err(error) => {
                self.warn(format!("a picture is left out: {error}"));
                None
            }
        }
    }

    /// A textureInfo; `made` are the bytes of the picture if it is none of the scene's.
    fn info(&mut self, map: &Mapped, key: &str, made: Option<Vec<u8>>) -> Option<Value> {
        let image = match self.memo.textures.images.get(key) {
            Some(known) => *known,
            None => {
                let bytes = match made {
                    Some(bytes) => bytes.into(),
                    None => self.whole.assets.bytes(&map.filename).ok()?,
                };
                let mime = match &*bytes {
                    [0x89, b'P', b'N', b'G', ..] => "image/png",
                    [0xff, 0xd8, 0xff, ..] => "image/jpeg",
                    _ => return self.as_png(map, key),
                };
                let view = self.bin.view(bytes.iter().copied(), None);
                self.images.push(json!({ "bufferView": view, "mimeType": mime }));
                self.memo.textures.images.insert(key.to_owned(), self.images.len() - 1);
                self.images.len() - 1
            }
        };
        let sampler = map.sampler.as_ref().map(|sampler| {
            let samplers = &mut self.samplers;
            *self.memo.textures.samplers.entry(sampler.to_string()).or_insert_with(|| {
                samplers.push(sampler.clone());
                samplers.len() - 1
            })
        });
        let textures = &mut self.textures;
        let index = *self.memo.textures.textures.entry((image, sampler)).or_insert_with(|| {
            let mut texture = json!({ "source": image });
            if let Some(sampler) = sampler {
                texture["sampler"] = sampler.into();
            }
            textures.push(texture);
            textures.len() - 1
        });
        let mut info = map.place.clone();
        info["index"] = index.into();
        Some(info)
    }

    /// A picture of 8 bits in a format that glTF does not know.
    fn as_png(&mut self, map: &Mapped, key: &str) -> Option<Value> {
        let image = self.image(&map.filename)?;
        let texels =
            (0..image.width as usize * image.height as usize).flat_map(|i| texel(&image, i).map(byte));
        let png = encode_png_rgba(image.width, image.height, &texels.collect::<Vec<u8>>()).ok()?;
        self.info(map, key, Some(png))
    }
}

/// What the reader makes of it: see its own.
fn sampler(args: &Args<'_>) -> Option<Value> {
    let wrap = |word: &str| match word {
        "clamp" | "black" => 33071,
        "mirror" => 33648,
        _ => 10497,
    };
    let u = args.text("wrap");
    let v = if args.is_set("wrapv") { args.text("wrapv") } else { u };
    let filter = match args.text("filter") {
        "point" => Some((9728, 9728)),
        "trilinear" | "ewa" | "EWA" => Some((9729, 9987)),
        _ => None,
    };
    let mut sampler = json!({ "wrapS": wrap(u), "wrapT": wrap(v) });
    if let Some((near, far)) = filter {
        sampler["magFilter"] = near.into();
        sampler["minFilter"] = far.into();
    }
    let usual = wrap(u) == 10497 && wrap(v) == 10497 && filter.is_none();
    (!usual).then_some(sampler)
}

/// Red, green, blue and alpha of a texel as they are stored, from 0 to 1.
fn texel(image: &Image, index: usize) -> [f32; 4] {
    let channels = image.channels as usize;
    let value = |i: usize| {
        let at = index * channels + i;
        match &image.data {
            ImageData::U8(v) => v.get(at).map_or(0.0, |v| f32::from(*v) / 255.0),
            ImageData::U16(v) => v.get(at).map_or(0.0, |v| f32::from(*v) / 65535.0),
            ImageData::F32(v) => v.get(at).copied().unwrap_or(0.0),
        }
    };
    match channels {
        1 => [value(0), value(0), value(0), 1.0],
        2 => [value(0), value(0), value(0), value(1)],
        3 => [value(0), value(1), value(2), 1.0],
        _ => [value(0), value(1), value(2), value(3)],
    }
}

/// The number of a texel that a float texture means.
fn number(map: &Mapped, image: &Image, index: usize) -> f32 {
    let [r, g, b, a] = texel(image, index);
    let is_8_bit = matches!(image.data, ImageData::U8(_));
    let linear = |v: f32| match map.encoding.as_str() {
        "sRGB" => decoded(v),
        "" if is_8_bit => decoded(v),
        _ => v,
    };
    match map.channel.as_str() {
        "r" => linear(r),
        "g" => linear(g),
        "b" => linear(b),
        "a" => a,
        "luminance" => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b),
        "" if matches!(image.channels, 2 | 4) => a,
        _ => (linear(r) + linear(g) + linear(b)) / 3.0,
    }
}

fn byte(v: f32) -> u8 {
    (v.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// The curve of sRGB, and back.
fn decoded(v: f32) -> f32 {
    let v = f64::from(v);
    (if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }) as f32
}

fn encoded(v: f32) -> f32 {
    let v = f64::from(v.clamp(0.0, 1.0));
    (if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }) as f32
}
