//! OpenEXR in: half, float and integer samples, scan lines and tiles, the largest level, every compression of
//! OpenEXR 2, luminance with chroma. Deep and chroma-subsampled data are refused.
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use exr::{
    meta::{MetaData, header::Header},
    prelude::{
        AnyChannel, AnyChannels, FlatSamples, Layer, ReadChannels, ReadLayers, attribute::SampleType, read,
    },
};

use super::{
    super::source::{HARMLESS, Source},
    NamedChannel,
    complaint::{self, WHAT},
};
use crate::caught::caught;

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

/// PIZ and DWA store an empty block of any size in a few bytes; real pictures stay far below this.
const BEST_RATIO: u64 = 1 << 12;

/// Reads the first layer with red, green and blue, or with luminance, or with any one channel. The pixels are those
/// of the data window.
pub(in super::super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let layers = layers(source)?;
    let pick = layers.iter().find_map(|l| Some((l, colour_channels(l)?)));
    let Some((layer, picked)) = pick else {
        return Err(source.unsupported("an OpenEXR file without red, green and blue or luminance"));
    };
    let size = |v: usize| u32::try_from(v).map_err(|_| source.damaged(WHAT, "its header makes no sense"));
    let (width, height) = (size(layer.size.width())?, size(layer.size.height())?);
    let (pixels, channels) = (layer.size.area(), picked.list.len());
    if picked.list.iter().any(|c| c.sample_data.len() != pixels) {
        return Err(source.damaged(WHAT, "pixels are missing"));
    }
    let mut data = vec![0.0f32; pixels * channels];
    for (i, channel) in picked.list.iter().enumerate() {
        let places = data.iter_mut().skip(i).step_by(channels);
        match &channel.sample_data {
            FlatSamples::F16(v) => places.zip(v).for_each(|(to, from)| *to = from.to_f32()),
            FlatSamples::F32(v) => places.zip(v).for_each(|(to, from)| *to = *from),
            FlatSamples::U32(v) => places.zip(v).for_each(|(to, from)| *to = *from as f32),
        }
    }
    if picked.is_chroma {
        for pixel in data.chunks_exact_mut(channels) {
            if let [first, second, third, ..] = pixel {
                [*first, *second, *third] = rgb_of_chroma([*first, *second, *third]);
            }
        }
    }
    Ok(Image { width, height, channels: channels as u32, data: ImageData::F32(data) })
}

/// Red, green and blue of luminance Y and the chroma `RY = (R - Y) / Y` and `BY = (B - Y) / Y`, with the luminance weights
/// of Rec. 709 primaries ("Technical Introduction to OpenEXR", luminance/chroma images).
fn rgb_of_chroma([y, ry, by]: [f32; 3]) -> [f32; 3] {
    let (r, b) = ((ry + 1.0) * y, (by + 1.0) * y);
    [r, (y - 0.2126 * r - 0.0722 * b) / 0.7152, b]
}

/// All channels of an OpenEXR file as floats, in the order stored: for tests and tools that compare bits. Channels of
/// a named layer are called `layer.channel`. Also returns width and height of the first layer.
///
/// # Errors
/// If the file is damaged or of a kind we do not read.
pub fn read_exr_channels(
    bytes: &[u8],
    name: &str,
    limits: durer_scene::Limits,
) -> Result<(u32, u32, Vec<NamedChannel>), AssetError> {
    let layers = layers(&Source { bytes, name, limits })?;
    let size = layers.first().map_or((0, 0), |l| (l.size.width() as u32, l.size.height() as u32));
    let named = |layer: &FlatLayer, channel: &AnyChannel<FlatSamples>| {
        let prefix = layer.attributes.layer_name.as_ref().map(|n| format!("{n}.")).unwrap_or_default();
        NamedChannel { name: format!("{prefix}{}", channel.name), values: floats(&channel.sample_data) }
    };
    let channels = layers.iter().flat_map(|l| l.channel_data.list.iter().map(move |c| named(l, c))).collect();
    Ok((size.0, size.1, channels))
}

fn layers(source: &Source<'_>) -> Result<Vec<FlatLayer>, AssetError> {
    // exr 1.74.2 has assertions that damaged tile coordinates break (found by the test with mutilated files). Nothing
    // outlives the closure, so there is no half-changed state to see.
    caught(|| checked_layers(source))
        .unwrap_or_else(|| Err(source.damaged(WHAT, "its header and its pixels contradict each other")))
}

fn checked_layers(source: &Source<'_>) -> Result<Vec<FlatLayer>, AssetError> {
    let mut file = Cursor::new(source.bytes);
    let meta = MetaData::read_from_buffered(&mut file, false).map_err(|e| complaint::header(source, &e))?;
    let blocks = meta.headers.iter().fold(0u64, |sum, h| sum.saturating_add(h.chunk_count as u64));
    let mut decoded = 0u64;
    for header in &meta.headers {
        decoded = decoded.saturating_add(check_header(source, header)?);
    }
    // Each part alone may be harmless, but a short file can promise thousands of them.
    if decoded > (source.bytes.len() as u64).saturating_mul(BEST_RATIO).max(HARMLESS) {
        let reason = format!("{} parts cannot be stored in {} bytes", meta.headers.len(), source.bytes.len());
        return Err(source.damaged(WHAT, &reason));
    }
    // The list of blocks has 8 bytes for each. The reader may have looked at one byte after the header.
    let left = (source.bytes.len() as u64 + 1).saturating_sub(file.position());
    if left < blocks.saturating_mul(8) {
        return Err(source.cut(WHAT, "its list of blocks"));
    }
    // One thread: a texture is decoded by whoever asked for it, and damaged blocks must not die in foreign threads.
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(source.bytes))
        .map_err(|e| complaint::pixels(source, &e))?;
    Ok(image.layer_data.into_vec())
}

/// Bytes that the part takes once it is decoded.
fn check_header(source: &Source<'_>, header: &Header) -> Result<u64, AssetError> {
    if header.deep {
        return Err(source.unsupported("an OpenEXR file with deep data"));
    }
    let channels = &header.channels.list;
    if channels.iter().any(|c| c.sampling.x() != 1 || c.sampling.y() != 1) {
        let reason = "an OpenEXR file with subsampled channels (luminance and chroma); convert it to RGB";
        return Err(source.unsupported(reason));
    }
    let bytes: u64 = channels.iter().map(|c| if c.sample_type == SampleType::F16 { 2 } else { 4 }).sum();
    let size = header.layer_size;
    source.check_size(size.width() as u64, size.height() as u64, bytes, BEST_RATIO)?;
    Ok((size.area() as u64).saturating_mul(bytes))
}

/// The channels that make a picture.
struct Picked<'a> {
    list: Vec<&'a AnyChannel<FlatSamples>>,
    /// Luminance and chroma instead of red, green and blue.
    is_chroma: bool,
}

/// Red, green, blue and alpha if there is one; luminance, chroma and alpha; luminance and alpha; or the only channel.
fn colour_channels(layer: &FlatLayer) -> Option<Picked<'_>> {
    let list = &layer.channel_data.list;
    // "diffuse.R" belongs to the sub-layer "diffuse"; the unnamed one comes first.
    let mut prefixes: Vec<String> = vec![String::new()];
    for channel in list {
        if let Some((prefix, _)) = channel.name.to_string().rsplit_once('.') {
            prefixes.push(format!("{prefix}."));
        }
    }
    for prefix in &prefixes {
        let find = |word: &str| {
            let wanted = format!("{prefix}{word}");
            list.iter().find(|c| c.name.to_string().eq_ignore_ascii_case(&wanted))
        };
        for words in [&["R", "G", "B"][..], &["Y", "RY", "BY"][..], &["Y"][..]] {
            if let Some(mut found) = words.iter().map(|w| find(w)).collect::<Option<Vec<_>>>() {
                found.extend(find("A"));
                return Some(Picked { list: found, is_chroma: words.contains(&"RY") });
            }
        }
    }
    match list.as_slice() {
        [only] => Some(Picked { list: vec![only], is_chroma: false }),
        _ => None,
    }
}

fn floats(samples: &FlatSamples) -> Vec<f32> {
    match samples {
        FlatSamples::F16(v) => v.iter().map(|s| s.to_f32()).collect(),
        FlatSamples::F32(v) => v.clone(),
        FlatSamples::U32(v) => v.iter().map(|&s| s as f32).collect(),
    }
}
