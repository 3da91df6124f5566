//! KTX 2 files (Khronos Texture 2.0): pixels as they are, packed with Zstandard or zlib or not at all; those that Basis
//! Universal packed go to [`basis`](super::basis). Of several sizes the largest is read.
//!
//! Numbers are little-endian and rows follow each other without gaps. A single channel is grey.
use std::io::Read;

use durer_scene::{AssetError, Image, ImageData};
use exr::prelude::f16;
use flate2::bufread::ZlibDecoder;
use ruzstd::StreamingDecoder;

use super::{basis, source::Source};
use crate::caught::caught;

/// What messages call such files.
pub(super) const KTX: &str = "KTX 2 file";
/// The fixed part of a header.
pub(super) const HEADER: usize = 80;
/// Bytes that tell where the largest picture lies.
const LEVEL: usize = 24;
/// Plain areas pack to next to nothing; real pictures do not.
const BEST_RATIO: u64 = 1 << 14;

/// How pixels are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Texel {
    /// Bytes, so many for each pixel.
    Bytes(u8),
    /// The same, the first and the third exchanged.
    Swapped(u8),
    /// Whole numbers of 16 bits.
    Words(u8),
    /// Floats of 16 bits.
    Halves(u8),
    /// Floats of 32 bits.
    Floats(u8),
    /// Floats without sign of 11, 11 and 10 bits.
    Short,
    /// Three numbers of 9 bits with one exponent.
    Shared,
}

/// Formats of Vulkan by their numbers. Whether bytes are sRGB-encoded is up to what they are used for.
const FORMATS: &[(u32, Texel)] = &[
    (9, Texel::Bytes(1)),
    (15, Texel::Bytes(1)),
    (16, Texel::Bytes(2)),
    (22, Texel::Bytes(2)),
    (23, Texel::Bytes(3)),
    (29, Texel::Bytes(3)),
    (30, Texel::Swapped(3)),
    (36, Texel::Swapped(3)),
    (37, Texel::Bytes(4)),
    (43, Texel::Bytes(4)),
    (44, Texel::Swapped(4)),
    (50, Texel::Swapped(4)),
    (70, Texel::Words(1)),
    (76, Texel::Halves(1)),
    (77, Texel::Words(2)),
    (83, Texel::Halves(2)),
    (84, Texel::Words(3)),
    (90, Texel::Halves(3)),
    (91, Texel::Words(4)),
    (97, Texel::Halves(4)),
    (100, Texel::Floats(1)),
    (103, Texel::Floats(2)),
    (106, Texel::Floats(3)),
    (109, Texel::Floats(4)),
    (122, Texel::Short),
    (123, Texel::Shared),
];

/// Formats of blocks, which are not read: the last of each.
const BLOCKS: &[(u32, &str)] = &[
    (134, "BC1"),
    (136, "BC2"),
    (138, "BC3"),
    (140, "BC4"),
    (142, "BC5"),
    (144, "BC6H"),
    (146, "BC7"),
    (156, "ETC2 or EAC"),
    (184, "ASTC"),
];
/// The first of them.
const FIRST_BLOCK: u32 = 131;

impl Texel {
    /// Bytes of a pixel.
    fn size(self) -> u64 {
        match self {
            Self::Bytes(lanes) | Self::Swapped(lanes) => lanes.into(),
            Self::Words(lanes) | Self::Halves(lanes) => 2 * u64::from(lanes),
            Self::Floats(lanes) => 4 * u64::from(lanes),
            Self::Short | Self::Shared => 4,
        }
    }

    /// Channels, and the values of all pixels.
    fn read(self, bytes: &[u8]) -> (u8, ImageData) {
        let words = || bytes.as_chunks::<2>().0.iter().copied();
        let packed = || bytes.as_chunks::<4>().0.iter().copied().map(u32::from_le_bytes);
        match self {
            Self::Bytes(lanes) => (lanes, ImageData::U8(bytes.to_vec())),
            Self::Swapped(lanes) => {
                let mut bytes = bytes.to_vec();
                bytes.chunks_exact_mut(lanes.into()).for_each(|pixel| pixel.swap(0, 2));
                (lanes, ImageData::U8(bytes))
            }
            Self::Words(lanes) => (lanes, ImageData::U16(words().map(u16::from_le_bytes).collect())),
            Self::Halves(lanes) => {
                (lanes, ImageData::F32(words().map(|b| f16::from_le_bytes(b).to_f32()).collect()))
            }
            Self::Floats(lanes) => {
                let all = bytes.as_chunks::<4>().0.iter().copied();
                (lanes, ImageData::F32(all.map(f32::from_le_bytes).collect()))
            }
            Self::Short => (3, ImageData::F32(packed().flat_map(short).collect())),
            Self::Shared => (3, ImageData::F32(packed().flat_map(shared).collect())),
        }
    }
}

/// Floats of 5 bits of exponent, as halves have it, and no sign.
fn short(packed: u32) -> [f32; 3] {
    let half = |bits: u32| f16::from_bits(bits as u16).to_f32();
    [half((packed & 0x7ff) << 4), half((packed >> 11 & 0x7ff) << 4), half((packed >> 22) << 5)]
}

fn shared(packed: u32) -> [f32; 3] {
    let scale = 2f64.powi((packed >> 27) as i32 - 15 - 9);
    [0, 9, 18].map(|at| (f64::from(packed >> at & 0x1ff) * scale) as f32)
}

/// Two channels are red and green.
fn with_blue<T: Copy + Default>(values: &[T]) -> Vec<T> {
    values.as_chunks::<2>().0.iter().flat_map(|[r, g]| [*r, *g, T::default()]).collect()
}

/// Reads the largest picture of a file.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    if source.bytes.len() < HEADER {
        return Err(source.cut(KTX, "its header"));
    }
    let number = |offset: usize| source.i32_at(offset) as u32;
    let [format, width, height, depth, layers, faces] = [12, 20, 24, 28, 32, 36].map(number);
    let texel = FORMATS.iter().find(|(known, _)| *known == format).map(|(_, texel)| *texel);
    source.check_size(width.into(), height.into(), texel.map_or(4, Texel::size), BEST_RATIO)?;
    if depth > 1 || layers > 1 || faces != 1 {
        return Err(refused(source, "of more than one picture"));
    }
    match texel {
        _ if format == 0 => basis::decode(source, [width, height]),
        Some(texel) => plain(source, texel, [width, height]),
        None => {
            let block = BLOCKS.iter().find(|(last, _)| (FIRST_BLOCK..=*last).contains(&format));
            Err(match block {
                Some((_, name)) => refused(source, &format!("whose pixels are packed as {name}")),
                None => refused(source, &format!("of the rare format {format} of Vulkan")),
            })
        }
    }
}

/// A sound file that is not read.
pub(super) fn refused(source: &Source<'_>, what: &str) -> AssetError {
    source.unsupported(format!("a {KTX} {what}, which durer does not read; export it as PNG or EXR"))
}

fn plain(source: &Source<'_>, texel: Texel, [width, height]: [u32; 2]) -> Result<Image, AssetError> {
    let length = source.length(KTX, u64::from(width) * u64::from(height) * texel.size())?;
    let number = |offset: usize| {
        let bytes = source.bytes.get(offset..).and_then(<[u8]>::first_chunk)?;
        usize::try_from(u64::from_le_bytes(*bytes)).ok()
    };
    let lies = number(HEADER).zip(number(HEADER + LEVEL / 3));
    let end = lies.and_then(|(begin, length)| Some((begin, begin.checked_add(length)?)));
    let stored = end.and_then(|(begin, end)| source.bytes.get(begin..end));
    let stored = stored.ok_or_else(|| source.cut(KTX, "its pixel data"))?;
    let unpacked = match source.i32_at(44) {
        0 => Some(stored.to_vec()),
        2 => caught(|| limited(StreamingDecoder::new(stored).ok()?, length)).flatten(),
        3 => limited(ZlibDecoder::new(stored), length),
        other => return Err(refused(source, &format!("packed in a way (supercompression {other})"))),
    };
    let unpacked = unpacked
        .filter(|bytes| bytes.len() == length)
        .ok_or_else(|| source.damaged(KTX, "its pixel data is not as long as its header says"))?;
    let (channels, data) = match texel.read(&unpacked) {
        (2, ImageData::U8(values)) => (3, ImageData::U8(with_blue(&values))),
        (2, ImageData::U16(values)) => (3, ImageData::U16(with_blue(&values))),
        (2, ImageData::F32(values)) => (3, ImageData::F32(with_blue(&values))),
        others => others,
    };
    Ok(Image { width, height, channels: channels.into(), data })
}

/// All that a stream unpacks to, if that is no more than so many bytes.
fn limited(stream: impl Read, length: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    stream.take(length as u64 + 1).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}
