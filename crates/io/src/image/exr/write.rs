//! OpenEXR out: 32-bit floats in scan lines, ZIP-compressed.
use std::{io::Cursor, path::Path};

use exr::{
    image::write::WritableImage,
    prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
        LayerAttributes, LineOrder, Text, Vec2, attribute::AttributeValue,
    },
};

use super::{
    super::output::{WriteError, check_length, replace_file},
    NamedChannel,
};

/// The value of a metadata entry.
#[derive(Clone, Debug, PartialEq)]
pub enum ExrValue {
    /// `string`
    Text(String),
    /// `double`
    Number(f64),
    /// `int`
    Integer(i32),
    /// `m44f`, rows one after another
    Matrix([f32; 16]),
}

/// A picture of any float channels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExrPicture {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The channels, in any order; the file keeps them sorted by name.
    pub channels: Vec<NamedChannel>,
    /// Metadata: `(key, value)`. Keys that OpenEXR itself defines are refused.
    pub attributes: Vec<(String, ExrValue)>,
}

/// Writes `picture`; every channel keeps its exact bits, NaN payloads included.
///
/// # Errors
/// If a channel has the wrong length, two share a name, a name is empty or too long, or the file cannot be written.
pub fn write_exr(path: &Path, picture: &ExrPicture) -> Result<(), WriteError> {
    replace_file(path, &encode(path, picture)?)
}

/// The bytes of such a file.
///
/// # Errors
/// As [`write_exr`], but for those of the file.
pub fn encode_exr(picture: &ExrPicture) -> Result<Vec<u8>, WriteError> {
    encode(Path::new("picture"), picture)
}

fn text(path: &Path, word: &str) -> Result<Text, WriteError> {
    if word.is_empty() || word.len() > 255 || word.contains('\0') {
        let reason = format!("\"{word}\" cannot be a name in an OpenEXR file (1 to 255 bytes)");
        return Err(WriteError::new(path, reason));
    }
    Ok(Text::from_slice_unchecked(word.as_bytes()))
}

fn encode(path: &Path, picture: &ExrPicture) -> Result<Vec<u8>, WriteError> {
    let mut list = Vec::with_capacity(picture.channels.len());
    for channel in &picture.channels {
        let found = channel.values.len();
        check_length(path, &channel.name, found, [picture.width, picture.height], 1)?;
        list.push(AnyChannel::new(text(path, &channel.name)?, FlatSamples::F32(channel.values.clone())));
    }
    list.sort_by(|a, b| a.name.cmp(&b.name));
    if let Some((twin, _)) = list.iter().zip(list.iter().skip(1)).find(|(a, b)| a.name == b.name) {
        return Err(WriteError::new(path, format!("two channels are called {}", twin.name)));
    }
    let size = Vec2(picture.width as usize, picture.height as usize);
    let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    for (key, value) in &picture.attributes {
        let value = match value {
            // Text is bytes in OpenEXR; UTF-8 is the custom.
            ExrValue::Text(t) => AttributeValue::Text(Text::from_slice_unchecked(t.as_bytes())),
            ExrValue::Number(n) => AttributeValue::F64(*n),
            ExrValue::Integer(n) => AttributeValue::I32(*n),
            ExrValue::Matrix(m) => AttributeValue::Matrix4x4(*m),
        };
        attributes.other.insert(text(path, key)?, value);
    }
    let encoding = Encoding { line_order: LineOrder::Increasing, ..Encoding::SMALL_LOSSLESS };
    let channels = AnyChannels::sort(list.into());
    let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
    let image: Image<Layer<AnyChannels<FlatSamples>>> = Image::new(attributes, layer);
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|e| WriteError::new(path, e))?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    Ok(bytes)
}

/// Puts the header's attributes in the order of their names: the library writes ours as its hash map has them, and no
/// two files would be the same. A header is `name 0 type 0 length value` for each attribute, then 0 ("OpenEXR File
/// Layout").
fn sort_attributes(file: &mut [u8]) {
    const START: usize = 8;
    let mut attributes = Vec::new();
    let mut rest = file.get(START..).unwrap_or_default();
    while rest.first().is_some_and(|&b| b != 0) {
        let ends = |from: usize| rest.get(from..)?.iter().position(|&b| b == 0).map(|at| from + at + 1);
        let whole = ends(0).and_then(&ends).and_then(|at| {
            let length = u32::from_le_bytes(*rest.get(at..)?.first_chunk()?);
            rest.split_at_checked(at + 4 + length as usize)
        });
        let Some((attribute, after)) = whole else { return };
        attributes.push(attribute.to_vec());
        rest = after;
    }
    attributes.sort();
    let sorted = attributes.concat();
    if let Some(header) = file.get_mut(START..START + sorted.len()) {
        header.copy_from_slice(&sorted);
    }
}
