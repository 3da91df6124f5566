//! Image files: pixels in ([`read`], by content, whatever the suffix says) and pictures out ([`writer_for`]).
//!
//! A new format in is a line in `SIGNATURES`; a new format out is a line in [`WRITERS`].

mod exr;
mod jpeg;
mod output;
mod pfm;
mod png;
mod radiance;
mod raster;

use durer_scene::{AssetError, Image, Limits};

pub use exr::{ExrPicture, ExrValue, NamedChannel, read_exr_channels, write_exr};
pub use output::{PictureFormat, WRITERS, WriteError, Writer, writer_for};
pub use png::write_png;

/// Reads the pixels of one file.
type Decoder = fn(&Source<'_>) -> Result<Image, AssetError>;

/// How a file begins, what that format is called, and who reads it.
struct Signature {
    /// The bytes at `offset`.
    bytes: &'static [u8],
    offset: usize,
    name: &'static str,
    decode: Option<Decoder>,
}

const fn known(bytes: &'static [u8], name: &'static str, decode: Decoder) -> Signature {
    Signature { bytes, offset: 0, name, decode: Some(decode) }
}

const fn foreign(bytes: &'static [u8], offset: usize, name: &'static str) -> Signature {
    Signature { bytes, offset, name, decode: None }
}

/// Formats by their first bytes.
const SIGNATURES: &[Signature] = &[
    known(b"\x89PNG\r\n\x1a\n", "PNG", png::decode),
    known(b"\xff\xd8\xff", "JPEG", jpeg::decode),
    known(b"\x76\x2f\x31\x01", "OpenEXR", exr::decode),
    known(b"#?RADIANCE", "Radiance HDR", radiance::decode),
    known(b"#?RGBE", "Radiance HDR", radiance::decode),
    known(b"BM", "Windows bitmap (BMP)", raster::decode_bmp),
    known(b"PF\n", "portable float map (PFM)", pfm::decode),
    known(b"PF ", "portable float map (PFM)", pfm::decode),
    known(b"PF\r\n", "portable float map (PFM)", pfm::decode),
    known(b"Pf\n", "portable float map (PFM)", pfm::decode),
    known(b"Pf ", "portable float map (PFM)", pfm::decode),
    known(b"Pf\r\n", "portable float map (PFM)", pfm::decode),
    foreign(b"GIF8", 0, "GIF"),
    foreign(b"WEBP", 8, "WebP"),
    foreign(b"\xabKTX 20\xbb\r\n\x1a\n", 0, "KTX 2"),
    foreign(b"\xabKTX 11\xbb\r\n\x1a\n", 0, "KTX"),
    foreign(b"DDS ", 0, "DirectDraw surface (DDS)"),
    foreign(b"II*\0", 0, "TIFF"),
    foreign(b"MM\0*", 0, "TIFF"),
    foreign(b"ftypavif", 4, "AVIF"),
];

/// What the format of an image file is called that begins with `head`.
pub(crate) fn format_name(head: &[u8]) -> Option<&'static str> {
    let starts = |s: &&Signature| head.get(s.offset..).is_some_and(|b| b.starts_with(s.bytes));
    SIGNATURES.iter().find(starts).map(|s| s.name)
}

/// Decoded bytes that any file may promise.
const HARMLESS: u64 = 16 << 20;

/// Encoded bytes, what messages call them, and what they may grow to.
struct Source<'a> {
    bytes: &'a [u8],
    name: &'a str,
    limits: Limits,
}

impl Source<'_> {
    fn format_error(&self, reason: impl ToString) -> AssetError {
        AssetError::Format { path: self.name.to_owned(), reason: reason.to_string() }
    }
    fn unsupported(&self, reason: impl Into<String>) -> AssetError {
        AssetError::Unsupported { path: self.name.to_owned(), reason: reason.into() }
    }
    /// What a decoder of the `image` crate said about a `what`.
    fn image_error(&self, what: &str, error: &image::ImageError) -> AssetError {
        match error {
            image::ImageError::Unsupported(e) => {
                self.unsupported(format!("a {what} of a kind durer does not read: {e}"))
            }
            image::ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
                self.format_error(format!("damaged {what}: the file ends too early"))
            }
            other => self.format_error(format!("damaged {what}: {other}")),
        }
    }
    /// Complains about a header that promises nothing or too much. No compression we read shrinks the `sample_bytes`
    /// of decoded data by more than `ratio`, so a short file that promises more is damaged: nothing is allocated.
    fn check_size(&self, width: u64, height: u64, sample_bytes: u64, ratio: u64) -> Result<(), AssetError> {
        if width == 0 || height == 0 || width > u64::from(u32::MAX) || height > u64::from(u32::MAX) {
            return Err(self.format_error(format!("an image of {width} x {height} pixels")));
        }
        let pixels = width.saturating_mul(height);
        if pixels > self.limits.image_pixels {
            let reason = format!("{width} x {height} pixels, but the limit is {}", self.limits.image_pixels);
            return Err(AssetError::Limits { path: self.name.to_owned(), reason });
        }
        let most = (self.bytes.len() as u64).saturating_mul(ratio).max(HARMLESS);
        if pixels.saturating_mul(sample_bytes) > most {
            let reason = format!("{width} x {height} pixels cannot be stored in {} bytes", self.bytes.len());
            return Err(self.format_error(reason));
        }
        Ok(())
    }
}

/// Decodes a PNG, JPEG, OpenEXR, Radiance HDR, PFM, BMP or TGA file, told apart by content. `name` is what errors call it.
///
/// # Errors
/// If the format is another one, the data is damaged, or the image is larger than `limits` allow.
pub fn read(bytes: &[u8], name: &str, limits: Limits) -> Result<Image, AssetError> {
    let source = Source { bytes, name, limits };
    let starts = |s: &&Signature| bytes.get(s.offset..).is_some_and(|b| b.starts_with(s.bytes));
    const READ: &str = "durer reads PNG, JPEG, OpenEXR, Radiance HDR, PFM, BMP and TGA images";
    match SIGNATURES.iter().find(starts) {
        Some(Signature { decode: Some(decode), .. }) => decode(&source),
        Some(Signature { name, .. }) => Err(source.unsupported(format!("a {name} file; {READ}"))),
        None if bytes.is_empty() => Err(source.format_error("the file is empty")),
        None if raster::is_tga(&source) => raster::decode_tga(&source),
        None => Err(source.unsupported(format!("not an image of a known format; {READ}"))),
    }
}
