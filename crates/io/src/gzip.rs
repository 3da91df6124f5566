//! gzip (RFC 1952), told by its first bytes: whatever a file is called, it is unpacked if it is packed.
use std::io::Read;

use durer_scene::{AssetError, Limits, counted};
use flate2::bufread::MultiGzDecoder;

/// True for a gzip stream of the deflate method, the only one there is.
pub(crate) fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b, 8])
}

/// What `packed` holds, all members one after another. Messages call it `name`. Memory grows with what was really
/// unpacked, whatever the stream says about itself.
///
/// # Errors
/// If it is damaged, or longer than the limits allow.
pub(crate) fn unpack(packed: &[u8], name: &str, limits: Limits) -> Result<Vec<u8>, AssetError> {
    let mut bytes = Vec::with_capacity(expected(packed, limits));
    let decoder = MultiGzDecoder::new(packed);
    decoder.take(limits.file_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| {
        let there = counted(bytes.len(), "byte");
        let reason = format!("the gzip file was cut off or is damaged: {there} could be unpacked ({e})");
        AssetError::Format { path: name.to_owned(), reason }
    })?;
    if bytes.len() as u64 > limits.file_bytes {
        let reason = format!("unpacks to more than {} bytes, the limit", limits.file_bytes);
        return Err(AssetError::Limits { path: name.to_owned(), reason });
    }
    Ok(bytes)
}

/// The length that the last four bytes claim, as far as it is likely: scans in text unpack to four times their length.
fn expected(packed: &[u8], limits: Limits) -> usize {
    let claimed = packed.last_chunk().map_or(0, |last| u32::from_le_bytes(*last)) as usize;
    let most = usize::try_from(limits.file_bytes).unwrap_or(usize::MAX);
    claimed.min(packed.len().saturating_mul(8)).min(most)
}
