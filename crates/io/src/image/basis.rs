//! KTX 2 files whose pixels Basis Universal packed for graphics cards: what glTF's KHR_texture_basisu brings.
use basisu::{DecodeFlags, SourceFormat, TargetFormat, Transcoder};
use durer_scene::{AssetError, Image, ImageData};

use super::{
    ktx::{HEADER, KTX, refused},
    source::Source,
};
use crate::caught::caught;

/// Where a header tells of what all levels share.
const SHARED: usize = 64;
/// Bytes by which a header tells of a level.
const LEVEL: usize = 24;
/// Pixels along an edge of a block, and the most bytes of one.
const BLOCK_EDGE: u32 = 4;
const BLOCK_BYTES: u64 = 16;

/// Reads the largest picture of a file, of this size.
pub(super) fn decode(source: &Source<'_>, [width, height]: [u32; 2]) -> Result<Image, AssetError> {
    let damaged = || source.damaged(KTX, "its pixel data cannot be decoded");
    if !has_sound_levels(source, [width, height], source.i32_at(40) as u32) {
        return Err(damaged());
    }
    // Damaged pixels make the decoder panic, as fuzzing shows: what it had in hand is gone with it.
    let (has_alpha, rgba) = match caught(|| unpacked(source.bytes, (width, height))) {
        Some(Ok(unpacked)) => unpacked,
        Some(Err(Refused::Kind)) => return Err(refused(source, "of a rare kind")),
        Some(Err(Refused::Damage)) | None => return Err(damaged()),
    };
    let (pixels, _) = rgba.as_chunks::<4>();
    let (channels, bytes) = match has_alpha {
        true => (4, rgba),
        false => (3, pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect()),
    };
    Ok(Image { width, height, channels, data: ImageData::U8(bytes) })
}

/// Why a file gives no pixels.
enum Refused {
    Kind,
    Damage,
}

/// Whether there is alpha, and the pixels with it.
fn unpacked(bytes: &[u8], size: (u32, u32)) -> Result<(bool, Vec<u8>), Refused> {
    let packed = Transcoder::new(bytes).map_err(|_| Refused::Damage)?;
    match packed.source_format() {
        SourceFormat::Etc1s | SourceFormat::UastcLdr if !packed.is_video() => {}
        _ => return Err(Refused::Kind),
    }
    if packed.base_dimensions() != size {
        return Err(Refused::Damage);
    }
    let rgba = packed.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(|_| Refused::Damage)?;
    Ok((packed.has_alpha(), rgba))
}

/// Whether all levels lie in the file, and none promises more than its blocks take: the decoder adds and allocates on their
/// word.
fn has_sound_levels(source: &Source<'_>, size: [u32; 2], levels: u32) -> bool {
    let number = |offset: usize| {
        let bytes = source.bytes.get(offset..).and_then(<[u8]>::first_chunk);
        bytes.map(|b| u64::from_le_bytes(*b))
    };
    let lies_in = |begin: Option<u64>, length: Option<u64>| {
        let end = begin.zip(length).and_then(|(begin, length)| begin.checked_add(length));
        end.is_some_and(|end| end <= source.bytes.len() as u64)
    };
    let is_sound = |level: u32| {
        let at = HEADER + LEVEL * level as usize;
        let blocks = size.map(|edge| u64::from((edge >> level).max(1).div_ceil(BLOCK_EDGE)));
        let fits = number(at + 16).is_some_and(|bytes| bytes <= blocks[0] * blocks[1] * BLOCK_BYTES);
        fits && lies_in(number(at), number(at + 8))
    };
    let shared = lies_in(number(SHARED), number(SHARED + 8));
    shared && levels <= 32 && (0..levels.max(1)).all(is_sound)
}
