//! WebP files, Windows bitmaps (1 to 32 bits, palettes, run lengths) and Targa files (grey, palettes, true colour, run lengths).
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use image::{
    ColorType, ImageDecoder,
    codecs::{bmp::BmpDecoder, tga::TgaDecoder, webp::WebPDecoder},
};

use super::source::Source;

/// Run lengths give 255 pixels of four bytes for two bytes. Those of bitmaps may also skip pixels; real pictures do not.
const BEST_RATIO: u64 = 1 << 10;

/// How Targa files of version 2 end.
const TARGA_FOOTER: &[u8] = b"TRUEVISION-XFILE.\0";

const BITMAP: &str = "Windows bitmap (BMP)";
const TARGA: &str = "Targa (TGA) file";
const WEBP: &str = "WebP file";
/// Most pixels along an edge of a bitmap that the decoder takes.
const BITMAP_EDGE: u64 = 65535;

/// What the decoders' errors mean.
const KNOWN: &[(&str, &str)] = &[
    ("RLE data", "its run lengths make no sense"),
    ("itfield", "its colour masks make no sense"),
    ("alette", "its palette makes no sense"),
    ("olor map", "its palette makes no sense"),
    ("plane", "its header makes no sense"),
    ("header", "its header makes no sense"),
    ("compression type", "its header makes no sense"),
    ("image type", "its header makes no sense"),
    ("bits", "its header makes no sense"),
];

/// Reads a Windows bitmap.
pub(super) fn decode_bmp(source: &Source<'_>) -> Result<Image, AssetError> {
    check_bitmap_header(source)?;
    let decoder =
        BmpDecoder::new(Cursor::new(source.bytes)).map_err(|e| source.image_error(BITMAP, &e, KNOWN))?;
    pixels(source, BITMAP, decoder, BEST_RATIO)
}

/// Says the numbers of a header that the decoder would refuse.
fn check_bitmap_header(source: &Source<'_>) -> Result<(), AssetError> {
    const CORE_HEADER: i32 = 12;
    if source.bytes.len() < 30 {
        return Err(source.cut(BITMAP, "its header"));
    }
    let (width, height, bits) = if source.i32_at(14) == CORE_HEADER {
        (i64::from(source.u16_at(18)), i64::from(source.u16_at(20)), source.u16_at(24))
    } else {
        // A negative height means that rows come from the top.
        (i64::from(source.i32_at(18)), i64::from(source.i32_at(22)).abs(), source.u16_at(28))
    };
    let Ok(across) = u64::try_from(width) else {
        return Err(source.damaged(BITMAP, &format!("its header says {width} x {height} pixels")));
    };
    let down = height.unsigned_abs();
    source.check_size(across, down, 0, 1)?;
    if across.max(down) > BITMAP_EDGE {
        let reason =
            format!("its header says {width} x {height} pixels, at most {BITMAP_EDGE} along an edge");
        return Err(source.damaged(BITMAP, &reason));
    }
    if ![1, 2, 4, 8, 16, 24, 32].contains(&bits) && bits != 0 {
        let reason = format!("its header says {bits} bits per pixel, expected 1, 2, 4, 8, 16, 24 or 32");
        return Err(source.damaged(BITMAP, &reason));
    }
    Ok(())
}

/// Reads a WebP file; of an animation the first picture.
pub(super) fn decode_webp(source: &Source<'_>) -> Result<Image, AssetError> {
    let decoder =
        WebPDecoder::new(Cursor::new(source.bytes)).map_err(|e| source.image_error(WEBP, &e, KNOWN))?;
    // Plain areas take next to no room: what may be unpacked is bounded by the limits alone.
    pixels(source, WEBP, decoder, u64::MAX)
}

/// Reads a Targa file.
pub(super) fn decode_tga(source: &Source<'_>) -> Result<Image, AssetError> {
    const HEADER: usize = 18;
    if source.bytes.len() < HEADER {
        return Err(source.cut(TARGA, "its header"));
    }
    let (kind, bits) = (source.u8_at(2), source.u8_at(16));
    if kind == 0 {
        return Err(source.damaged(TARGA, "it holds no pixels"));
    }
    source.check_size(source.u16_at(12).into(), source.u16_at(14).into(), 0, 1)?;
    let unread = || {
        source.unsupported(format!(
            "a {TARGA} of type {kind} with {bits} bits per pixel, which durer does not read; export it as PNG"
        ))
    };
    if ![1, 2, 3, 9, 10, 11].contains(&kind) {
        return Err(unread());
    }
    let decoder = TgaDecoder::new(Cursor::new(source.bytes)).map_err(|e| match e {
        image::ImageError::Unsupported(_) => unread(),
        other => source.image_error(TARGA, &other, KNOWN),
    })?;
    pixels(source, TARGA, decoder, BEST_RATIO)
}

/// True if the file is a Targa file: these have no signature, only their name or their last bytes give them away.
pub(super) fn is_tga(source: &Source<'_>) -> bool {
    let name = source.name.to_lowercase();
    [".tga", ".icb", ".vda", ".vst"].iter().any(|s| name.ends_with(s)) || is_tga_by_footer(source.bytes)
}

/// True if these are the bytes of a Targa file of version 2.
pub(super) fn is_tga_by_footer(bytes: &[u8]) -> bool {
    bytes.ends_with(TARGA_FOOTER)
}

/// The pixels of a file a byte of which gives up to `ratio` of them.
fn pixels(
    source: &Source<'_>,
    what: &str,
    decoder: impl ImageDecoder,
    ratio: u64,
) -> Result<Image, AssetError> {
    let (width, height) = decoder.dimensions();
    let channels = match decoder.color_type() {
        ColorType::L8 => 1,
        ColorType::La8 => 2,
        ColorType::Rgb8 => 3,
        ColorType::Rgba8 => 4,
        _ => return Err(source.unsupported(format!("a {what} with more than 8 bits per channel"))),
    };
    source.check_size(width.into(), height.into(), channels.into(), ratio)?;
    let size = source.length(what, decoder.total_bytes())?;
    let mut bytes = vec![0; size];
    decoder.read_image(&mut bytes).map_err(|e| source.image_error(what, &e, KNOWN))?;
    Ok(Image { width, height, channels, data: ImageData::U8(bytes) })
}
