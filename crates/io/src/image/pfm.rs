//! Portable float maps (Debevec): `PF` (RGB) or `Pf` (grey), width, height, and a number whose sign tells the byte order
//! (negative: little-endian); one blank; then floats, rows from bottom to top. The number's magnitude is not applied, as
//! in pbrt.
use durer_scene::{AssetError, Image, ImageData};

use super::source::Source;

/// Longest word of a header: a number with all digits of a double.
const LONGEST_WORD: usize = 64;

/// Reads a portable float map.
pub(super) fn decode(source: &Source<'_>) -> Result<Image, AssetError> {
    let mut rest = source.bytes;
    let mut next = |what: &str| {
        let (word, after) = word(rest).ok_or_else(|| damaged(source, format!("{what} is missing")))?;
        rest = after;
        Ok(word)
    };
    let channels = if next("the signature")? == "PF" { 3 } else { 1 };
    let width: u32 = number(source, next("the width")?, "a width")?;
    let height: u32 = number(source, next("the height")?, "a height")?;
    let scale: f64 = number(source, next("the byte order")?, "a number whose sign tells the byte order")?;
    if scale == 0.0 || !scale.is_finite() {
        return Err(damaged(
            source,
            format!("the byte order is {scale}, expected a number below or above 0"),
        ));
    }
    source.check_size(width.into(), height.into(), u64::from(channels) * 4, 1)?;
    let row = width as usize * channels as usize * 4;
    let wanted = row.saturating_mul(height as usize);
    let Some(bytes) = rest.get(..wanted) else {
        return Err(damaged(source, format!("{} bytes of pixels, expected {wanted}", rest.len())));
    };
    let value = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    let rows = bytes.chunks_exact(row).rev();
    let data = rows.flat_map(|row| row.as_chunks::<4>().0.iter().map(|&b| value(b))).collect();
    Ok(Image { width, height, channels, data: ImageData::F32(data) })
}

fn damaged(source: &Source<'_>, reason: String) -> AssetError {
    source.damaged("portable float map (PFM)", &reason)
}

/// The next word, and what follows the one blank after it.
fn word(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let bytes = bytes.trim_ascii_start();
    let end = bytes.iter().take(LONGEST_WORD).position(u8::is_ascii_whitespace)?;
    let word = std::str::from_utf8(bytes.get(..end)?).ok()?;
    Some((word, bytes.get(end + 1..)?))
}

fn number<T: std::str::FromStr>(source: &Source<'_>, word: &str, what: &str) -> Result<T, AssetError> {
    word.parse().map_err(|_| damaged(source, format!("\"{word}\", expected {what}")))
}

#[cfg(test)]
mod tests {
    use durer_scene::Limits;

    use super::super::read;
    use super::*;

    fn pfm(header: &str, values: &[f32], bytes: fn(f32) -> [u8; 4]) -> Result<Image, AssetError> {
        let mut file = header.as_bytes().to_vec();
        file.extend(values.iter().flat_map(|&v| bytes(v)));
        read(&file, "a.pfm", Limits::default())
    }

    #[test]
    fn rows_come_from_bottom_to_top_in_either_byte_order() {
        let stored = [4.0, 5.0, 6.0, 1.0, 2.0, 3.0];
        let turned = ImageData::F32(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let grey = pfm("Pf\n3 2\n-1.0\n", &stored, f32::to_le_bytes);
        assert_eq!(grey, Ok(Image { width: 3, height: 2, channels: 1, data: turned.clone() }));
        let colour = pfm("PF 1 2\n 1\n", &stored, f32::to_be_bytes);
        assert_eq!(colour, Ok(Image { width: 1, height: 2, channels: 3, data: turned }));
    }

    #[test]
    fn damage_is_told() {
        let values = [0.0; 3];
        for (header, words) in [
            ("PF\n1 1\n", "byte order is missing"),
            ("PF\n1 x\n-1\n", "\"x\", expected a height"),
            ("PF\n1 1\n0\n", "byte order is 0"),
            ("PF\n2 1\n-1\n", "12 bytes of pixels, expected 24"),
            ("PF\n0 1\n-1\n", "0 x 1 pixels"),
            ("PF\n99999 99999\n-1\n", "at most 268435456 in all"),
            ("Pf\n9999 9999\n-1\n", "cannot be stored in 28 bytes"),
        ] {
            let error = pfm(header, &values, f32::to_le_bytes).err();
            let said = error.map(|e| e.to_string()).unwrap_or_default();
            assert!(said.starts_with("a.pfm") && said.contains(words), "{header:?}: {said}");
        }
    }
}
