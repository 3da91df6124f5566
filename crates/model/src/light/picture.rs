//! Pictures that lights send out: linear colours, bilinear between the centres of pixels.
use std::sync::Arc;

use durer_core::spectrum::Color;
use durer_scene::{Args, Image, ImageData};
use rayon::prelude::*;

use crate::texture::imagemap::texels::Texels;

/// A picture.
#[derive(Debug)]
pub(super) struct Picture {
    texels: Texels,
}

impl Picture {
    /// The one that the parameter `name` names; complains if it is none.
    pub(super) fn read(args: &mut Args<'_>, name: &str) -> Option<Self> {
        let image = args.image(name)?;
        if let Some(reason) = unfit(&image) {
            args.error(name, format!("{}: {reason}", args.text(name)));
            return None;
        }
        Some(Self::new(image))
    }
    /// Integer values are sRGB-encoded, floats linear; alpha is not looked at.
    pub(super) fn new(image: Arc<Image>) -> Self {
        let encoded = !matches!(image.data, ImageData::F32(_));
        Self { texels: Texels::new(image, encoded) }
    }
    /// Columns and rows.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.texels.width(), self.texels.height()]
    }
    /// The largest component of any pixel.
    pub(super) fn largest(&self) -> f32 {
        self.texels.largest()
    }
    /// The pixel in column `x` and row `y`; negative values become 0.
    pub(super) fn pixel(&self, x: u32, y: u32) -> Color {
        let [r, g, b, _] = self.texels.rgba(x, y);
        Color::new(r.max(0.0), g.max(0.0), b.max(0.0))
    }
    /// A pixel of magenta: what a missing picture becomes.
    pub(super) fn placeholder() -> Self {
        let data = ImageData::F32(vec![1.0, 0.0, 1.0]);
        Self::new(Arc::new(Image { width: 1, height: 1, channels: 3, data }))
    }
    /// The pixel at a place, as [`Picture::at`] counts it.
    pub(super) fn nearest(&self, [u, v]: [f32; 2]) -> Color {
        let [width, height] = self.size();
        let inside = |t: f32, n: u32| ((t * n as f32).max(0.0) as u32).min(n - 1);
        self.pixel(inside(u, width), inside(v, height))
    }
    /// The colour at a place, `(0, 0)` the upper left corner and `(1, 1)` the lower right one; beyond the edge it is that of
    /// the edge, and black where a coordinate is no number.
    pub(super) fn at(&self, [u, v]: [f32; 2]) -> Color {
        let [width, height] = self.size();
        let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
        if !(x.is_finite() && y.is_finite()) {
            return Color::BLACK;
        }
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let inside = |i: f32, n: u32| (i.max(0.0) as u32).min(n - 1);
        let pixel = |i: f32, j: f32| self.pixel(inside(x0 + i, width), inside(y0 + j, height));
        let upper = pixel(0.0, 0.0) * (1.0 - fx) + pixel(1.0, 0.0) * fx;
        let lower = pixel(0.0, 1.0) * (1.0 - fx) + pixel(1.0, 1.0) * fx;
        upper * (1.0 - fy) + lower * fy
    }
}

/// Why a picture is no light.
pub(super) fn unfit(image: &Image) -> Option<String> {
    let stored = u64::from(image.width) * u64::from(image.height) * u64::from(image.channels);
    let values = match &image.data {
        ImageData::U8(v) => v.len(),
        ImageData::U16(v) => v.len(),
        ImageData::F32(v) => v.len(),
    };
    if stored == 0 || image.channels > 4 || stored != values as u64 {
        return Some(format!("the image is not sound: {values} values for {stored}"));
    }
    let ImageData::F32(values) = &image.data else { return None };
    let channels = image.channels as usize;
    let colors = if channels.is_multiple_of(2) { channels - 1 } else { channels };
    let is_bad = |p: &&[f32]| p.iter().take(colors).any(|v| !v.is_finite());
    let bad = values.par_chunks(channels).filter(is_bad).count();
    (bad > 0).then(|| {
        let pixels = if bad == 1 { "pixel is".to_owned() } else { "pixels are".to_owned() };
        format!("{bad} {pixels} infinite or not a number: the picture cannot be a light")
    })
}
