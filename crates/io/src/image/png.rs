//! PNG (ISO/IEC 15948): every colour type, depth and interlacing in; 8-bit sRGB out.
use std::{io::Cursor, path::Path};

use durer_scene::{AssetError, Image, ImageData};
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Limits, SrgbRenderingIntent, Transformations};

use super::{
    Source, WriteError,
    output::{check_length, replace_file},
};

/// Deflate cannot do better than 1032 : 1; one byte per row of filter types makes it no worse.
const BEST_RATIO: u64 = 1040;

/// Reads a PNG file; palettes become RGB, transparency chunks alpha, depths below 8 bits 8 bits.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let fail = |e: png::DecodingError| source.format_error(format!("damaged PNG: {e}"));
    if source.bytes.get(12..16) == Some(b"CgBI") {
        return Err(
            source.format_error("a PNG file in Apple's own form (CgBI); convert it to a standard PNG file")
        );
    }
    // Sizes are checked below, against the length of the file too; the crate's own limit would be arbitrary.
    let mut decoder = Decoder::new_with_limits(Cursor::new(source.bytes), Limits { bytes: 1 << 34 });
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    let header = decoder.read_header_info().map_err(fail)?;
    let (width, height) = (header.width, header.height);
    // A palette of 1 bit per pixel expands to 4 bytes: 32 times.
    source.check_size(width.into(), height.into(), 1, 32 * BEST_RATIO)?;
    let mut reader = decoder.read_info().map_err(fail)?;
    let size = reader.output_buffer_size().ok_or_else(|| source.format_error("PNG too large"))?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(fail)?;
    bytes.truncate(frame.buffer_size());
    let channels = match frame.color_type {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
        ColorType::Indexed => return Err(source.format_error("damaged PNG: no palette")),
    };
    let data = match frame.bit_depth {
        BitDepth::Sixteen => {
            ImageData::U16(bytes.as_chunks::<2>().0.iter().map(|&pair| u16::from_be_bytes(pair)).collect())
        }
        _ => ImageData::U8(bytes),
    };
    Ok(Image { width, height, channels, data })
}

/// Writes an 8-bit RGB picture with an sRGB chunk. `rgb8` holds rows from top to bottom.
///
/// # Errors
/// If `rgb8` does not hold `3 * width * height` bytes, or the file cannot be written.
pub fn write_png(path: &Path, width: u32, height: u32, rgb8: &[u8]) -> Result<(), WriteError> {
    check_length(path, "rgb8", rgb8.len(), [width, height], 3)?;
    let fail = |e: png::EncodingError| WriteError::new(path, e);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().map_err(fail)?;
    writer.write_image_data(rgb8).map_err(fail)?;
    writer.finish().map_err(fail)?;
    replace_file(path, &bytes)
}
