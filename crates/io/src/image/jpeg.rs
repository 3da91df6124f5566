//! JPEG (ITU-T T.81), baseline and progressive. Grey files stay grey; CMYK ones become RGB.
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use zune_jpeg::{
    JpegDecoder,
    zune_core::{colorspace::ColorSpace, options::DecoderOptions},
};

use super::Source;

/// Reads a JPEG file. An EXIF orientation is not applied: texture coordinates refer to the pixels as stored.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let fail = |e: zune_jpeg::errors::DecodeErrors| source.format_error(format!("damaged JPEG: {e}"));
    let options = DecoderOptions::default().set_max_width(1 << 16).set_max_height(1 << 16);
    let mut probe = JpegDecoder::new_with_options(Cursor::new(source.bytes), options);
    probe.decode_headers().map_err(fail)?;
    let info = probe.info().ok_or_else(|| source.format_error("damaged JPEG: no frame header"))?;
    // Progressive files may code 32767 empty blocks of 64 pixels in three bytes, so the length says nothing.
    source.check_size(info.width.into(), info.height.into(), 1, u64::MAX)?;
    let grey = probe.input_colorspace() == Some(ColorSpace::Luma);
    let (space, channels) = if grey { (ColorSpace::Luma, 1) } else { (ColorSpace::RGB, 3) };
    let options = options.jpeg_set_out_colorspace(space);
    let pixels = JpegDecoder::new_with_options(Cursor::new(source.bytes), options).decode().map_err(fail)?;
    let (width, height) = (u32::from(info.width), u32::from(info.height));
    if pixels.len() as u64 != u64::from(width) * u64::from(height) * u64::from(channels) {
        return Err(source.format_error("damaged JPEG: pixels are missing"));
    }
    Ok(Image { width, height, channels, data: ImageData::U8(pixels) })
}
