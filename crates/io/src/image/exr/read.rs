//! OpenEXR in: half, float and integer samples, scan lines and tiles, the largest level, every compression of
//! OpenEXR 2. Deep and chroma-subsampled data are refused.
use std::io::Cursor;

use durer_scene::{AssetError, Image, ImageData};
use exr::{
    meta::{MetaData, header::Header},
    prelude::{
        AnyChannel, AnyChannels, FlatSamples, Layer, ReadChannels, ReadLayers, attribute::SampleType, read,
    },
};

use super::{super::Source, NamedChannel};

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
    let planes: Vec<Vec<f32>> = picked.iter().map(|c| floats(&c.sample_data)).collect();
    let size = |v: usize| u32::try_from(v).map_err(|e| source.format_error(e));
    let (width, height) = (size(layer.size.width())?, size(layer.size.height())?);
    let pixels = layer.size.area();
    if planes.iter().any(|p| p.len() != pixels) {
        return Err(source.format_error("damaged OpenEXR file: samples are missing"));
    }
    let mut data = vec![0.0f32; pixels * planes.len()];
    for (i, plane) in planes.iter().enumerate() {
        for (to, from) in data.iter_mut().skip(i).step_by(planes.len()).zip(plane) {
            *to = *from;
        }
    }
    Ok(Image { width, height, channels: planes.len() as u32, data: ImageData::F32(data) })
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
    std::panic::catch_unwind(|| checked_layers(source))
        .unwrap_or_else(|_| Err(source.format_error("damaged OpenEXR file: the decoder gave up")))
}

fn checked_layers(source: &Source<'_>) -> Result<Vec<FlatLayer>, AssetError> {
    let fail = |e: exr::error::Error| source.format_error(format!("damaged OpenEXR file: {e}"));
    let meta = MetaData::read_from_buffered(Cursor::new(source.bytes), false).map_err(fail)?;
    for header in &meta.headers {
        check_header(source, header)?;
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
        .map_err(fail)?;
    Ok(image.layer_data.into_vec())
}

fn check_header(source: &Source<'_>, header: &Header) -> Result<(), AssetError> {
    if header.deep {
        return Err(source.unsupported("an OpenEXR file with deep data"));
    }
    let channels = &header.channels.list;
    if channels.iter().any(|c| c.sampling.x() != 1 || c.sampling.y() != 1) {
        let reason = "an OpenEXR file with subsampled channels (luminance and chroma); convert it to RGB";
        return Err(source.unsupported(reason));
    }
    let bytes = channels.iter().map(|c| if c.sample_type == SampleType::F16 { 2 } else { 4 }).sum();
    let size = header.layer_size;
    source.check_size(size.width() as u64, size.height() as u64, bytes, BEST_RATIO)
}

/// Red, green, blue and alpha if there is one; luminance and alpha; or the only channel.
fn colour_channels(layer: &FlatLayer) -> Option<Vec<&AnyChannel<FlatSamples>>> {
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
        for words in [&["R", "G", "B"][..], &["Y"][..]] {
            if let Some(mut found) = words.iter().map(|w| find(w)).collect::<Option<Vec<_>>>() {
                found.extend(find("A"));
                return Some(found);
            }
        }
    }
    match list.as_slice() {
        [only] => Some(vec![only]),
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
