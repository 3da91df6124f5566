//! A picture around everything: pixels at full resolution, as rays that leave the scene see them.
use std::sync::Arc;

use durer_core::math::Vector3;
use durer_scene::{Image, ImageData};
use rayon::prelude::*;

use super::layout::Layout;
use crate::texture::imagemap::texels::Texels;

/// A picture with its layout.
#[derive(Debug)]
pub(super) struct Panorama {
    texels: Texels,
    layout: Layout,
}

impl Panorama {
    /// The picture. Integer values are sRGB-encoded, floats linear; alpha is not looked at.
    pub(super) fn new(image: Arc<Image>, layout: Layout) -> Self {
        let encoded = !matches!(image.data, ImageData::F32(_));
        Self { texels: Texels::new(image, encoded), layout }
    }
    /// How it is wrapped around the sphere.
    pub(super) fn layout(&self) -> Layout {
        self.layout
    }
    /// Columns and rows.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.texels.width(), self.texels.height()]
    }
    /// Linear RGB of the pixel in column `x` and row `y`; negative values, as sharpening leaves them, become 0.
    pub(super) fn pixel(&self, x: u32, y: u32) -> [f32; 3] {
        let [r, g, b, _] = self.texels.rgba(x, y);
        [r.max(0.0), g.max(0.0), b.max(0.0)]
    }
    /// True if no pixel shines.
    pub(super) fn is_black(&self) -> bool {
        let [width, height] = self.size();
        (0..height).all(|y| (0..width).all(|x| self.pixel(x, y) == [0.0; 3]))
    }
    /// The largest component of all pixels.
    pub(super) fn largest(&self) -> f32 {
        let [width, height] = self.size();
        let of_row = |y| (0..width).flat_map(move |x| self.pixel(x, y)).fold(0.0, f32::max);
        (0..height).into_par_iter().map(of_row).reduce(|| 0.0, f32::max)
    }
    /// Linear RGB in unit direction `d`, bilinear.
    pub(super) fn seen(&self, d: Vector3) -> [f32; 3] {
        weighted(self.layout.corners(self.layout.uv(d), self.size()), |x, y| self.pixel(x, y))
    }
}

/// The weighted sum of four pixels.
pub(super) fn weighted(corners: [((u32, u32), f32); 4], pixel: impl Fn(u32, u32) -> [f32; 3]) -> [f32; 3] {
    let parts = corners.map(|((x, y), weight)| pixel(x, y).map(|v| v * weight));
    std::array::from_fn(|c| parts.iter().map(|p| p[c]).sum())
}
