//! gzip (RFC 1952), told by its first bytes: whatever a file is called, it is unpacked if it is packed.
use std::io::{ErrorKind, Read};

use durer_scene::{AssetError, Limits, counted};
use flate2::bufread::MultiGzDecoder;

/// True for a gzip stream of the deflate method, the only one there is.
pub(crate) fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b, 8])
}

/// How much smaller scene files get at most once they are longer than [`FREE`].
const RATIO: u64 = 200;
/// Bytes that any file may unpack to.
const FREE: u64 = 64 << 20;

/// The most bytes that `packed` may unpack to.
pub(crate) fn most(packed: &[u8], limits: Limits) -> u64 {
    let likely = (packed.len() as u64).saturating_mul(RATIO).max(FREE);
    likely.min(limits.unpacked_bytes).min(limits.file_bytes)
}

/// What `packed` holds, all members one after another. Messages call it `name`. Memory grows with what was really
/// unpacked, whatever the stream says about itself.
///
/// # Errors
/// If it is damaged, or unpacks to more than is likely or than the limits allow.
pub(crate) fn unpack(packed: &[u8], name: &str, limits: Limits) -> Result<Vec<u8>, AssetError> {
    let path = name.to_owned();
    let most = most(packed, limits);
    let mut bytes = Vec::with_capacity(expected(packed, most));
    let decoder = MultiGzDecoder::new(packed);
    match decoder.take(most.saturating_add(1)).read_to_end(&mut bytes) {
        Ok(_) if bytes.len() as u64 <= most => Ok(bytes),
        Ok(_) => {
            let reason = format!("unpacks to more than {most} bytes (a damaged or hostile file)");
            Err(AssetError::Limits { path, reason })
        }
        Err(e) if e.kind() == ErrorKind::OutOfMemory => {
            let reason = format!("no memory left after unpacking {} bytes", bytes.len());
            Err(AssetError::Io { path, reason })
        }
        Err(e) => {
            let there = counted(bytes.len(), "byte");
            let reason = format!("the gzip file was cut off or is damaged: {there} could be unpacked ({e})");
            Err(AssetError::Format { path, reason })
        }
    }
}

/// The length that the last four bytes claim, as far as it is likely: scans in text unpack to four times their length.
fn expected(packed: &[u8], most: u64) -> usize {
    let claimed = packed.last_chunk().map_or(0, |last| u32::from_le_bytes(*last)) as usize;
    let most = usize::try_from(most).unwrap_or(usize::MAX);
    claimed.min(packed.len().saturating_mul(8)).min(most)
}
