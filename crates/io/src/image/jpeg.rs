//! JPEG (ITU-T T.81), baseline and progressive. Grey files stay grey; CMYK ones become RGB.
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use zune_jpeg::{
    JpegDecoder,
    errors::{DecodeErrors, UnsupportedSchemes},
    zune_core::{colorspace::ColorSpace, options::DecoderOptions},
};

use super::source::Source;

/// Reads a JPEG file. An EXIF orientation is not applied: texture coordinates refer to the pixels as stored.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let fail = |e: DecodeErrors| complaint(source, &e);
    let options = DecoderOptions::default().set_max_width(1 << 16).set_max_height(1 << 16);
    let mut probe = JpegDecoder::new_with_options(Cursor::new(source.bytes), options);
    probe.decode_headers().map_err(fail)?;
    let info = probe.info().ok_or_else(|| source.damaged("JPEG", "its header is missing"))?;
    // Progressive files may code 32767 empty blocks of 64 pixels in three bytes, so the length says nothing.
    source.check_size(info.width.into(), info.height.into(), 1, u64::MAX)?;
    let grey = probe.input_colorspace() == Some(ColorSpace::Luma);
    let (space, channels) = if grey { (ColorSpace::Luma, 1) } else { (ColorSpace::RGB, 3) };
    let options = options.jpeg_set_out_colorspace(space);
    let pixels = JpegDecoder::new_with_options(Cursor::new(source.bytes), options).decode().map_err(fail)?;
    let (width, height) = (u32::from(info.width), u32::from(info.height));
    if pixels.len() as u64 != u64::from(width) * u64::from(height) * u64::from(channels) {
        return Err(source.damaged("JPEG", "pixels are missing"));
    }
    Ok(Image { width, height, channels, data: ImageData::U8(pixels) })
}

/// What errors that differ in their texts only mean.
const KNOWN: &[(&str, &str)] = &[
    ("Premature End", "it ends before its pixels"),
    ("uffman", "its code tables make no sense"),
    ("QT", "its tables of precision make no sense"),
    ("quantization", "its tables of precision make no sense"),
    ("SOS", "the header of its pixels makes no sense"),
    ("SOF", "its header makes no sense"),
    ("length", "one of its segments makes no sense"),
    ("ampl", "its header makes no sense"),
    ("omponent", "its header makes no sense"),
];

fn complaint(source: &Source<'_>, error: &DecodeErrors) -> AssetError {
    let unread = |coding: &str| {
        let reason =
            format!("a JPEG file with {coding}, which durer does not read; export it as baseline JPEG");
        source.unsupported(reason)
    };
    match error {
        DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_) => source.ends_early("JPEG"),
        DecodeErrors::ZeroError => source.damaged("JPEG", "its header says 0 pixels wide or high"),
        DecodeErrors::Unsupported(
            UnsupportedSchemes::LosslessHuffman | UnsupportedSchemes::LosslessArithmetic,
        ) => unread("lossless compression"),
        DecodeErrors::Unsupported(
            UnsupportedSchemes::ExtendedSequentialDctArithmetic
            | UnsupportedSchemes::ProgressiveDctArithmetic,
        ) => unread("arithmetic coding"),
        DecodeErrors::Unsupported(_) => unread("a rare compression"),
        DecodeErrors::SofError(said) if said.contains("8-bit") => unread("more than 8 bits per channel"),
        other => source.translated("JPEG", &other.to_string(), KNOWN),
    }
}
