//! Images on surfaces.
//!
//! Texture space has v upwards: `(0, 0)` is the lower left corner, image row 0 lies at v = 1. The texel of column i covers
//! `[i / w, (i + 1) / w)`. Texels are decoded to linear values before they are interpolated (Physically Based Rendering,
//! 4th edition, section 10.4.1). No mip maps: distant images need more samples.
mod srgb;
pub(crate) mod texels;
mod wrap;

use std::sync::Arc;

use durer_core::spectrum::Color;
use durer_scene::{Args, Image, ImageData, Kind, ParamDefault, ParamSpec, ParamType, Schema, TextureValue};

use super::{
    Texture, TextureAt,
    mapping::{MAPPING, U_DELTA, U_SCALE, UV_MATRIX, UV_SET, UvMapping, V_DELTA, V_SCALE},
};
use crate::ShadeCx;
use texels::Texels;
use wrap::Wrap;

/// What becomes of the place between texel centres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Filter {
    Point,
    Bilinear,
}

/// The number that a colour becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Channel {
    Rgba(usize),
    Luminance,
}

/// An image, looked up by texture coordinates.
#[derive(Clone, Debug)]
pub struct ImageMap {
    texels: Texels,
    mapping: UvMapping,
    wrap: [Wrap; 2],
    filter: Filter,
    channel: Channel,
    scale: f32,
    factor: Color,
    invert: bool,
}

impl ImageMap {
    fn texel(&self, x: i64, y: i64) -> [f32; 4] {
        let x = self.wrap[0].index(x, self.texels.width());
        let y = self.wrap[1].index(y, self.texels.height());
        x.zip(y).map_or([0.0; 4], |(x, y)| self.texels.rgba(x, y))
    }

    /// Linear RGBA, filtered. Black at coordinates that are not finite.
    fn lookup(&self, at: &TextureAt) -> [f32; 4] {
        let [u, v] = self.mapping.apply(at);
        let x = u * f64::from(self.texels.width());
        let y = (1.0 - v) * f64::from(self.texels.height());
        if !(x.is_finite() && y.is_finite()) {
            return [0.0; 4];
        }
        if self.filter == Filter::Point {
            return self.texel(x.floor() as i64, y.floor() as i64);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = ((x - x0) as f32, (y - y0) as f32);
        // Saturates far out, where neighbours are one anyway.
        let (x0, y0) = (x0 as i64, y0 as i64);
        let (x1, y1) = (x0.saturating_add(1), y0.saturating_add(1));
        let corners = [
            (self.texel(x0, y0), (1.0 - fx) * (1.0 - fy)),
            (self.texel(x1, y0), fx * (1.0 - fy)),
            (self.texel(x0, y1), (1.0 - fx) * fy),
            (self.texel(x1, y1), fx * fy),
        ];
        std::array::from_fn(|c| corners.iter().map(|(texel, weight)| texel[c] * weight).sum())
    }

    /// `scale c`, or `1 - scale c` if inverted; never negative.
    fn adjusted(&self, value: f32) -> f32 {
        let scaled = self.scale * value;
        (if self.invert { 1.0 - scaled } else { scaled }).max(0.0)
    }

    fn read(args: &mut Args<'_>, value: TextureValue) -> Option<Self> {
        let mapping = UvMapping::read(args);
        let image = args.image("filename");
        if !args.is_sound() {
            return None;
        }
        let word = if args.is_set("wrapv") { "wrapv" } else { "wrap" };
        let wrap = [Wrap::of_word(args.text("wrap")), Wrap::of_word(args.text(word))];
        let filter = match args.text("filter") {
            "point" => Filter::Point,
            "bilinear" => Filter::Bilinear,
            other => {
                args.warning(
                    "filter",
                    format!("the filter \"{other}\" is not supported yet; bilinear is used"),
                );
                Filter::Bilinear
            }
        };
        let is_color = value == TextureValue::Color;
        let channel = match if is_color { "luminance" } else { args.text("channel") } {
            "r" => Channel::Rgba(0),
            "g" => Channel::Rgba(1),
            "b" => Channel::Rgba(2),
            "a" => Channel::Rgba(3),
            _ => Channel::Luminance,
        };
        let factor = if is_color { args.color("factor") } else { Color::WHITE };
        let (scale, invert) = (args.float("scale"), args.bool("invert"));
        let Some(image) = image else {
            let texels = Texels::new(Arc::new(placeholder()), false);
            let wrap = [Wrap::Repeat; 2];
            let filter = Filter::Point;
            return Some(Self {
                texels,
                mapping,
                wrap,
                filter,
                channel,
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
        let encoded = match args.text("encoding") {
            "" => is_color && matches!(image.data, ImageData::U8(_)),
            word => word == "sRGB",
        };
        Some(Self {
            texels: Texels::new(image, encoded),
            mapping,
            wrap,
            filter,
            channel,
            scale,
            factor,
            invert,
        })
    }
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
        })
    }
    /// Interpolation makes nothing larger.
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        let scaled = self.scale.abs() * self.texels.largest();
        let factor = self.factor.rgb.into_iter().fold(0.0, |most: f32, v| most.max(v.abs()));
        (if self.invert { 1.0 + scaled } else { scaled }) * factor
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
    "Beyond the image's edges: repeat it, clamp to the edge, repeat mirrored, or black.",
);
const WRAP_V: ParamSpec = ParamSpec::new(
    "wrapv",
    ParamType::Choice(Wrap::WORDS),
    ParamDefault::Unset,
    "The same along v; default: as wrap.",
);
const ENCODING: ParamSpec = ParamSpec::new(
    "encoding",
    ParamType::Choice(&["sRGB", "linear"]),
    ParamDefault::Unset,
    "How colours are stored; default: sRGB for colour textures of 8 bits, else linear. Alpha is always linear.",
);
const FILTER: ParamSpec = ParamSpec::new(
    "filter",
    ParamType::Choice(&["bilinear", "point", "trilinear", "ewa", "EWA"]),
    ParamDefault::Text("bilinear"),
    "Between texel centres: interpolate, or take the nearest (point).",
);
const MAX_ANISOTROPY: ParamSpec = ParamSpec::float("maxanisotropy", 8.0, "Of the ewa filter; no effect.");
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
        params: &[
            FILENAME,
            WRAP,
            WRAP_V,
            ENCODING,
            FILTER,
            MAX_ANISOTROPY,
            SCALE,
            ParamSpec::color("factor", [1.0; 3], "Linear factor of the colours, after inversion."),
            INVERT,
            UV_SET,
            U_SCALE,
            V_SCALE,
            U_DELTA,
            V_DELTA,
            UV_MATRIX,
            MAPPING,
        ],
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
        params: &[
            FILENAME,
            WRAP,
            WRAP_V,
            ENCODING,
            FILTER,
            MAX_ANISOTROPY,
            SCALE,
            ParamSpec::new(
                "channel",
                ParamType::Choice(&["r", "g", "b", "a", "luminance"]),
                ParamDefault::Text("luminance"),
                "Which number to take; a is alpha, 1 if the image has none.",
            ),
            INVERT,
            UV_SET,
            U_SCALE,
            V_SCALE,
            U_DELTA,
            V_DELTA,
            UV_MATRIX,
            MAPPING,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        ImageMap::read(args, TextureValue::Float).map(|map| Box::new(map) as Box<dyn Texture>)
    }
}
