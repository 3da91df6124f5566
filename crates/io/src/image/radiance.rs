//! Radiance HDR (RGBE pixels; plain, old and new run lengths). Values are as stored: `EXPOSURE` lines are not applied, as
//! in other renderers. Pictures stored sideways or upside down and XYZE pixels are refused.
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use image::{ImageDecoder, codecs::hdr::HdrDecoder};

use super::source::Source;

/// The new run lengths give 127 values of a channel for two bytes, the old ones 255 pixels for four.
const BEST_RATIO: u64 = 1 << 10;

const WHAT: &str = "Radiance HDR file";

/// What the decoder's errors mean.
const KNOWN: &[(&str, &str)] = &[
    ("EOF in", "it ends within its header"),
    ("imensions", "the line of its header with width and height makes no sense"),
    ("parse", "its header makes no sense"),
    ("Not enough numbers", "its header makes no sense"),
    ("canline", "its run lengths make no sense"),
];

/// Reads a Radiance file.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let fail = |e: image::ImageError| source.image_error(WHAT, &e, KNOWN);
    // The strict reader knows the signature #?RADIANCE only; the other skips it as a comment.
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(source.bytes)).map_err(fail)?;
    let (width, height) = decoder.dimensions();
    source.check_size(width.into(), height.into(), 12, BEST_RATIO)?;
    let size = source.length(WHAT, decoder.total_bytes())?;
    let mut bytes = vec![0; size];
    decoder.read_image(&mut bytes).map_err(fail)?;
    let data = bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_ne_bytes(b)).collect();
    Ok(Image { width, height, channels: 3, data: ImageData::F32(data) })
}
