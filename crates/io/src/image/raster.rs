//! Windows bitmaps (1 to 32 bits, palettes, run lengths) and Targa files (grey, palettes, true colour, run lengths).
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use image::{
    ColorType, ImageDecoder,
    codecs::{bmp::BmpDecoder, tga::TgaDecoder},
};

use super::Source;

/// Run lengths give 255 pixels of four bytes for two bytes. Those of bitmaps may also skip pixels; real pictures do not.
const BEST_RATIO: u64 = 1 << 10;

/// How Targa files of version 2 end.
const TARGA_FOOTER: &[u8] = b"TRUEVISION-XFILE.\0";

/// Reads a Windows bitmap.
pub(super) fn decode_bmp(source: &Source<'_>) -> Result<Image, AssetError> {
    const WHAT: &str = "Windows bitmap (BMP)";
    let decoder = BmpDecoder::new(Cursor::new(source.bytes)).map_err(|e| source.image_error(WHAT, &e))?;
    pixels(source, WHAT, decoder)
}

/// Reads a Targa file.
pub(super) fn decode_tga(source: &Source<'_>) -> Result<Image, AssetError> {
    const WHAT: &str = "Targa (TGA) file";
    let decoder = TgaDecoder::new(Cursor::new(source.bytes)).map_err(|e| source.image_error(WHAT, &e))?;
    pixels(source, WHAT, decoder)
}

/// True if the file is a Targa file: these have no signature, only their name or their last bytes give them away.
pub(super) fn is_tga(source: &Source<'_>) -> bool {
    let name = source.name.to_lowercase();
    [".tga", ".icb", ".vda", ".vst"].iter().any(|s| name.ends_with(s)) || source.bytes.ends_with(TARGA_FOOTER)
}

fn pixels(source: &Source<'_>, what: &str, decoder: impl ImageDecoder) -> Result<Image, AssetError> {
    let (width, height) = decoder.dimensions();
    let channels = match decoder.color_type() {
        ColorType::L8 => 1,
        ColorType::La8 => 2,
        ColorType::Rgb8 => 3,
        ColorType::Rgba8 => 4,
        other => return Err(source.unsupported(format!("a {what} with pixels of type {other:?}"))),
    };
    source.check_size(width.into(), height.into(), channels.into(), BEST_RATIO)?;
    let size = usize::try_from(decoder.total_bytes()).map_err(|e| source.format_error(e))?;
    let mut bytes = vec![0; size];
    decoder.read_image(&mut bytes).map_err(|e| source.image_error(what, &e))?;
    Ok(Image { width, height, channels, data: ImageData::U8(bytes) })
}
