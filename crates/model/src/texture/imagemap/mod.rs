//! Images on surfaces.
//!
//! Texture space has v upwards: `(0, 0)` is the lower left corner, image row 0 lies at v = 1. The texel of column i covers
//! `[i / w, (i + 1) / w)`. Texels are decoded to linear values before they are interpolated (Physically Based Rendering,
//! 4th edition, section 10.4). The filters point and bilinear look at the image itself; pbrt-v4 has them choose a copy by the
//! footprint too, which differs where an image is seen from far.
pub(crate) mod encoding;
pub(crate) mod filter;
mod footprint;
mod lookup;
mod pyramid;
mod srgb;
pub(crate) mod texels;
mod wrap;

use std::sync::Arc;

use durer_core::{glam::DAffine3, spectrum::Color};
use durer_scene::{Args, Image, ImageData, Kind, ParamDefault, ParamSpec, ParamType, Schema, TextureValue};

use super::{
    Filters, Texture, TextureAt,
    mapping::{Mapping, UV_MATRIX, mapped},
};
use crate::ShadeCx;
use encoding::Encoding;
use filter::{FILTER, Filter, MAX_ANISOTROPY};
use lookup::Picture;
use texels::Texels;
use wrap::Wrap;

/// The number that a colour becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Channel {
    Rgba(usize),
    Luminance,
    /// Of red, green and blue.
    Mean,
}

/// An image, looked up by texture coordinates.
#[derive(Clone, Debug)]
pub struct ImageMap {
    picture: Picture,
    mapping: Mapping,
    channel: Channel,
    scale: f32,
    factor: Color,
    invert: bool,
}

impl ImageMap {
    /// Linear RGBA, filtered. Black at coordinates that are not finite.
    #[inline]
    fn lookup(&self, at: &TextureAt) -> [f32; 4] {
        let [u, v] = self.mapping.apply(at);
        if !self.picture.has_levels() || at.footprint.is_point() {
            return self.picture.at([u, 1.0 - v]);
        }
        let steps = self.mapping.spread(at, &at.footprint);
        // Rows count downwards.
        self.picture.under([u, 1.0 - v], steps.map(|[du, dv]| [du, -dv]))
    }

    /// `scale c`, or `1 - scale c` if inverted; never negative.
    fn adjusted(&self, value: f32) -> f32 {
        let scaled = self.scale * value;
        (if self.invert { 1.0 - scaled } else { scaled }).max(0.0)
    }

    fn read(args: &mut Args<'_>, value: TextureValue) -> Option<Self> {
        let mapping = Mapping::read(args);
        let image = args.image("filename");
        if !args.is_sound() {
            return None;
        }
        let is_color = value == TextureValue::Color;
        let Some(image) = image else {
            let texels = Texels::new(Arc::new(placeholder()), false);
            return Some(Self {
                picture: Picture::new(texels, [Wrap::Repeat; 2], Filter::Point),
                mapping,
                channel: Channel::Luminance,
                scale: 1.0,
                factor: Color::WHITE,
                invert: false,
            });
        };
        let stored = u64::from(image.width) * u64::from(image.height) * u64::from(image.channels);
        let values = match &image.data {
            ImageData::U8(v) => v.len(),
            ImageData::U16(v) => v.len(),
            ImageData::F32(v) => v.len(),
        };
        if stored == 0 || image.channels > 4 || stored != values as u64 {
            args.error("filename", format!("the image is not sound: {values} values for {stored}"));
            return None;
        }
        let channel = if is_color { Channel::Luminance } else { channel(args, &image) };
        let texels = Texels::stored_as(Arc::clone(&image), Encoding::read(args, &image.data)?);
        Some(Self {
            picture: Picture::new(texels, wrap(args)?, Filter::read(args)),
            mapping,
            channel,
            scale: args.float("scale"),
            factor: if is_color { args.color("factor") } else { Color::WHITE },
            invert: args.bool("invert"),
        })
    }
}

/// The number that the image gives; by default what pbrt-v4 takes.
fn channel(args: &Args<'_>, image: &Image) -> Channel {
    match args.text("channel") {
        "r" => Channel::Rgba(0),
        "g" => Channel::Rgba(1),
        "b" => Channel::Rgba(2),
        "a" => Channel::Rgba(3),
        "luminance" => Channel::Luminance,
        "mean" => Channel::Mean,
        _ if image.channels == 4 && !is_opaque(image) => Channel::Rgba(3),
        _ => Channel::Mean,
    }
}

/// Whether the fourth channel is 1 everywhere.
fn is_opaque(image: &Image) -> bool {
    match &image.data {
        ImageData::U8(v) => v.chunks_exact(4).all(|p| p[3] == u8::MAX),
        ImageData::U16(v) => v.chunks_exact(4).all(|p| p[3] == u16::MAX),
        ImageData::F32(v) => v.chunks_exact(4).all(|p| p[3] == 1.0),
    }
}

/// What is beyond the edges along u and v; `None` after a complaint.
fn wrap(args: &mut Args<'_>) -> Option<[Wrap; 2]> {
    let word = if args.is_set("wrapv") { "wrapv" } else { "wrap" };
    let wrap = [Wrap::of_word(args.text("wrap")), Wrap::of_word(args.text(word))];
    if (wrap[0] == Wrap::Octahedral) != (wrap[1] == Wrap::Octahedral) {
        args.error("wrapv", "octahedralsphere concerns both directions: give no other \"wrapv\"");
        return None;
    }
    Some(wrap)
}

/// Shown for an image that is missing: magenta and black squares, eight each way.
fn placeholder() -> Image {
    let pixel = |i: usize| {
        if (i % 8 + i / 8).is_multiple_of(2) { [255, 0, 255] } else { [0, 0, 0] }
    };
    Image { width: 8, height: 8, channels: 3, data: ImageData::U8((0..64).flat_map(pixel).collect()) }
}

impl Texture for ImageMap {
    fn color(&self, _: &ShadeCx<'_>, at: &TextureAt) -> Color {
        let [r, g, b, _] = self.lookup(at);
        Color::new(r, g, b).map(|c| self.adjusted(c)) * self.factor
    }
    fn float(&self, _: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        let rgba @ [r, g, b, _] = self.lookup(at);
        self.adjusted(match self.channel {
            Channel::Rgba(c) => rgba[c],
            Channel::Luminance => Color::new(r, g, b).luminance(),
            Channel::Mean if r == g && g == b => r,
            Channel::Mean => (r + g + b) / 3.0,
        })
    }
    /// Means make nothing larger.
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        let scaled = self.scale.abs() * self.picture.largest();
        let factor = self.factor.rgb.into_iter().fold(0.0, |most: f32, v| most.max(v.abs()));
        (if self.invert { 1.0 + scaled } else { scaled }) * factor
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        self.mapping.place(render_from_texture);
    }
    fn filters(&self) -> Filters {
        if self.picture.has_levels() { Filters::Always } else { Filters::Never }
    }
    fn bytes(&self) -> u64 {
        self.picture.bytes()
    }
}

const FILENAME: ParamSpec = ParamSpec::new(
    "filename",
    ParamType::File,
    ParamDefault::Required,
    "The image, relative to the scene file.",
);
const WRAP: ParamSpec = ParamSpec::new(
    "wrap",
    ParamType::Choice(Wrap::WORDS),
    ParamDefault::Text("repeat"),
    "Beyond the image's edges: repeat it, clamp to the edge, repeat mirrored, black, or as the octahedral map of a sphere.",
);
const WRAP_V: ParamSpec = ParamSpec::new(
    "wrapv",
    ParamType::Choice(Wrap::WORDS),
    ParamDefault::Unset,
    "The same along v; default: as wrap.",
);
const ENCODING: ParamSpec = ParamSpec::new(
    "encoding",
    ParamType::Text,
    ParamDefault::Unset,
    "How colours are stored: sRGB, linear, or gamma and the exponent, as \"gamma 2.2\". Default: sRGB for images of 8 bits \
     and PNG, else linear. Alpha is always linear.",
);
const SCALE: ParamSpec = ParamSpec::float("scale", 1.0, "Factor of all values.");
const INVERT: ParamSpec =
    ParamSpec::new("invert", ParamType::Bool, ParamDefault::Bool(false), "Take 1 - x of every scaled value.");

/// The word `imagemap` for colours.
#[derive(Clone, Copy, Debug)]
pub struct ColorImageMap;

impl Kind for ColorImageMap {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "imagemap",
        aliases: &[],
        doc: "An image; v grows upwards, (0, 0) is its lower left corner.",
        params: &mapped::<10, 18>([
            FILENAME,
            WRAP,
            WRAP_V,
            ENCODING,
            FILTER,
            MAX_ANISOTROPY,
            SCALE,
            ParamSpec::color("factor", [1.0; 3], "Linear factor of the colours, after inversion."),
            INVERT,
            UV_MATRIX,
        ]),
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        ImageMap::read(args, TextureValue::Color).map(|map| Box::new(map) as Box<dyn Texture>)
    }
}

/// The word `imagemap` for numbers.
#[derive(Clone, Copy, Debug)]
pub struct FloatImageMap;

impl Kind for FloatImageMap {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "imagemap",
        aliases: &[],
        doc: "A channel of an image; v grows upwards, (0, 0) is its lower left corner.",
        params: &mapped::<10, 18>([
            FILENAME,
            WRAP,
            WRAP_V,
            ENCODING,
            FILTER,
            MAX_ANISOTROPY,
            SCALE,
            ParamSpec::new(
                "channel",
                ParamType::Choice(&["r", "g", "b", "a", "luminance", "mean"]),
                ParamDefault::Unset,
                "Which number to take; a is alpha, 1 if the image has none, mean that of r, g and b. Default, as in pbrt: a of \
                 images that are not opaque, mean of the others.",
            ),
            INVERT,
            UV_MATRIX,
        ]),
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        ImageMap::read(args, TextureValue::Float).map(|map| Box::new(map) as Box<dyn Texture>)
    }
}
