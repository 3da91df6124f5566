//! Decoded access to an image's texels.
use std::sync::Arc;

use durer_scene::{Image, ImageData};
use rayon::prelude::*;

use super::encoding::Encoding;

/// An image with the meaning of its values.
#[derive(Clone, Debug)]
pub(crate) struct Texels {
    image: Arc<Image>,
    /// Linear value of every byte, for images of 8 bits.
    bytes: [f32; 256],
    encoding: Encoding,
}

impl Texels {
    /// `encoded`: whether colours (never alpha) are sRGB-encoded.
    pub(crate) fn new(image: Arc<Image>, encoded: bool) -> Self {
        Self::stored_as(image, if encoded { Encoding::Srgb } else { Encoding::Linear })
    }
    /// The same with any encoding.
    pub(crate) fn stored_as(image: Arc<Image>, encoding: Encoding) -> Self {
        Self { image, bytes: encoding.table(), encoding }
    }
    /// Channels as stored.
    pub(crate) fn channels(&self) -> usize {
        self.image.channels as usize
    }
    /// Texels per row.
    pub(crate) fn width(&self) -> u32 {
        self.image.width
    }
    /// Rows.
    pub(crate) fn height(&self) -> u32 {
        self.image.height
    }
    /// Linear RGBA of column `x` and row `y`, both inside; grey is spread over RGB, missing alpha is 1.
    pub(crate) fn rgba(&self, x: u32, y: u32) -> [f32; 4] {
        let channels = self.image.channels as usize;
        let first = (y as usize * self.image.width as usize + x as usize) * channels;
        let color = |channel: usize| self.color(first + channel);
        match channels {
            1 => [color(0), color(0), color(0), 1.0],
            2 => [color(0), color(0), color(0), self.stored(first + 1) as f32],
            3 => [color(0), color(1), color(2), 1.0],
            _ => [color(0), color(1), color(2), self.stored(first + 3) as f32],
        }
    }
    /// No value is of larger magnitude.
    pub(crate) fn largest(&self) -> f32 {
        let stored = match &self.image.data {
            ImageData::U8(_) | ImageData::U16(_) => return 1.0,
            ImageData::F32(v) => v.par_iter().map(|v| v.abs()).reduce(|| 1.0, f32::max),
        };
        stored.max(self.encoding.decode(stored.into()))
    }
    /// A value as stored; integers are mapped to `[0, 1]`.
    fn stored(&self, i: usize) -> f64 {
        match &self.image.data {
            ImageData::U8(v) => f64::from(v[i]) / 255.0,
            ImageData::U16(v) => f64::from(v[i]) / 65_535.0,
            ImageData::F32(v) => v[i].into(),
        }
    }
    /// A linear value.
    fn color(&self, i: usize) -> f32 {
        match &self.image.data {
            ImageData::U8(v) => self.bytes[usize::from(v[i])],
            _ => self.encoding.decode(self.stored(i)),
        }
    }
}
