//! Radiance HDR (RGBE pixels; plain, old and new run lengths). Values are as stored: `EXPOSURE` lines are not applied, as
//! in other renderers. Pictures stored sideways or upside down and XYZE pixels are refused.
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use image::{ImageDecoder, codecs::hdr::HdrDecoder};

use super::Source;

/// The new run lengths give 127 values of a channel for two bytes, the old ones 255 pixels for four.
const BEST_RATIO: u64 = 1 << 10;

/// Reads a Radiance file.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let fail = |e: image::ImageError| source.image_error("Radiance HDR file", &e);
    // The strict reader knows the signature #?RADIANCE only; the other skips it as a comment.
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(source.bytes)).map_err(fail)?;
    let (width, height) = decoder.dimensions();
    source.check_size(width.into(), height.into(), 12, BEST_RATIO)?;
    let size = usize::try_from(decoder.total_bytes()).map_err(|e| source.format_error(e))?;
    let mut bytes = vec![0; size];
    decoder.read_image(&mut bytes).map_err(fail)?;
    let data = bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_ne_bytes(b)).collect();
    Ok(Image { width, height, channels: 3, data: ImageData::F32(data) })
}
