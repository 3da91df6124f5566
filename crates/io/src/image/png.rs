//! PNG (ISO/IEC 15948): every colour type, depth and interlacing in; 8-bit sRGB out.
use std::{io::Cursor, path::Path};

use durer_scene::{AssetError, Image, ImageData};
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Limits, SrgbRenderingIntent, Transformations};

use super::{
    WriteError,
    output::{check_length, replace_file},
    source::Source,
};

/// Deflate cannot do better than 1032 : 1; one byte per row of filter types makes it no worse.
const BEST_RATIO: u64 = 1040;

/// Reads a PNG file; palettes become RGB, transparency chunks alpha, depths below 8 bits 8 bits.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let fail = |e: png::DecodingError| complaint(source, &e);
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
    // The crate panics where it expands a palette with a part of a colour.
    let palette = reader.info().palette.as_deref().unwrap_or_default();
    if !palette.len().is_multiple_of(3) {
        return Err(source.damaged("PNG", "its palette is no row of whole colours"));
    }
    let size =
        reader.output_buffer_size().ok_or_else(|| source.damaged("PNG", "its header makes no sense"))?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(fail)?;
    bytes.truncate(frame.buffer_size());
    let channels = match frame.color_type {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
        ColorType::Indexed => return Err(source.damaged("PNG", "it has no palette")),
    };
    let data = match frame.bit_depth {
        BitDepth::Sixteen => {
            ImageData::U16(bytes.as_chunks::<2>().0.iter().map(|&pair| u16::from_be_bytes(pair)).collect())
        }
        _ => ImageData::U8(bytes),
    };
    Ok(Image { width, height, channels, data })
}

/// What the library's errors, which differ in their texts only, mean.
const KNOWN: &[(&str, &str)] = &[
    ("CRC error", "a checksum does not match"),
    ("chunk is missing", "it holds no pixels"),
    ("enough data for image", "pixels are missing"),
    ("Corrupt deflate stream", "its pixel data cannot be decoded"),
    ("palette", "its palette is missing or too short"),
    ("before IHDR", "its header is missing"),
    ("dimensions", "its header makes no sense"),
    ("method", "its header makes no sense"),
    ("hunk", "one of its parts is unknown or not in its place"),
];

fn complaint(source: &Source<'_>, error: &png::DecodingError) -> AssetError {
    let said = match error {
        png::DecodingError::IoError(_) => return source.ends_early("PNG"),
        png::DecodingError::Format(e) => e.to_string(),
        png::DecodingError::Parameter(_) | png::DecodingError::LimitsExceeded => String::new(),
    };
    // IHDR, the first part: the depth is byte 24 of the file, the colour type byte 25.
    let (depth, kind) = (source.u8_at(24), source.u8_at(25));
    let in_words = if said.starts_with("Invalid color type") {
        format!("its header says colour type {kind}, expected 0, 2, 3, 4 or 6")
    } else if said.starts_with("Invalid bit depth") {
        format!("its header says {depth} bits per channel, expected 1, 2, 4, 8 or 16")
    } else if said.starts_with("Invalid color/depth") {
        format!("its header says {depth} bits per channel, which colour type {kind} cannot have")
    } else {
        return source.translated("PNG", &said, KNOWN);
    };
    source.damaged("PNG", &in_words)
}

/// Writes an 8-bit RGB picture with an sRGB chunk. `rgb8` holds rows from top to bottom.
///
/// # Errors
/// If `rgb8` does not hold `3 * width * height` bytes, or the file cannot be written.
pub fn write_png(path: &Path, width: u32, height: u32, rgb8: &[u8]) -> Result<(), WriteError> {
    check_length(path, "rgb8", rgb8.len(), [width, height], 3)?;
    let bytes = encode_png(width, height, rgb8, Packing::Small).map_err(|e| WriteError::new(path, e))?;
    replace_file(path, &bytes)
}

/// How much work goes into a small file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// For files that are kept.
    Small,
    /// For pictures that are looked at once: about a twentieth of the time, half as large again.
    Quick,
}

/// The bytes of such a file.
///
/// # Errors
/// If `rgb8` does not hold `3 * width * height` bytes.
pub fn encode_png(
    width: u32,
    height: u32,
    rgb8: &[u8],
    packing: Packing,
) -> Result<Vec<u8>, png::EncodingError> {
    let compression = match packing {
        Packing::Small => Compression::Balanced,
        Packing::Quick => Compression::Fastest,
    };
    encode((width, height), rgb8, ColorType::Rgb, compression)
}

/// The same with alpha, for textures.
///
/// # Errors
/// If `rgba8` does not hold `4 * width * height` bytes.
pub fn encode_png_rgba(width: u32, height: u32, rgba8: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    encode((width, height), rgba8, ColorType::Rgba, Compression::Balanced)
}

fn encode(
    (width, height): (u32, u32),
    pixels: &[u8],
    color: ColorType,
    compression: Compression,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}
