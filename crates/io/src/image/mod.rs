//! Image files: pixels in ([`read`], by content, whatever the suffix says) and pictures out ([`writer_for`]).
//!
//! A new format in is a line in `SIGNATURES` and one in `SUFFIXES`; a new format out is a line in [`WRITERS`].

mod basis;
mod exr;
mod jpeg;
mod ktx;
mod output;
mod pfm;
mod png;
mod radiance;
mod raster;
mod source;

use durer_scene::{AssetError, Image, Limits};

pub use exr::{ExrPicture, ExrValue, NamedChannel, encode_exr, read_exr_channels, write_exr};
pub use output::{PictureFormat, WRITERS, WriteError, Writer, replace_file, writer_for};
pub use png::{Packing, encode_png, encode_png_rgba, write_png};

use source::Source;

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
    Signature { bytes: b"WEBP", offset: 8, name: "WebP", decode: Some(raster::decode_webp) },
    known(b"\xabKTX 20\xbb\r\n\x1a\n", "KTX 2", ktx::decode),
    foreign(b"\xabKTX 11\xbb\r\n\x1a\n", 0, "KTX"),
    foreign(b"DDS ", 0, "DirectDraw surface (DDS)"),
    foreign(b"II*\0", 0, "TIFF"),
    foreign(b"MM\0*", 0, "TIFF"),
    foreign(b"ftypavif", 4, "AVIF"),
];

/// Suffixes in lower case, and the format that each promises. Targa files are known by theirs.
const SUFFIXES: &[(&str, &str)] = &[
    (".png", "PNG"),
    (".jpg", "JPEG"),
    (".jpeg", "JPEG"),
    (".exr", "OpenEXR"),
    (".hdr", "Radiance HDR"),
    (".bmp", "BMP"),
    (".webp", "WebP"),
    (".ktx2", "KTX 2"),
    (".pfm", "PFM"),
];

/// What the format of an image file is called that begins with `head`.
pub(crate) fn format_name(head: &[u8]) -> Option<&'static str> {
    let starts = |s: &&Signature| head.get(s.offset..).is_some_and(|b| b.starts_with(s.bytes));
    SIGNATURES.iter().find(starts).map(|s| s.name)
}

/// What the names of image files end with that hold such bytes.
pub(crate) fn suffix_of(bytes: &[u8]) -> Option<&'static str> {
    let Some(name) = format_name(bytes) else {
        return raster::is_tga_by_footer(bytes).then_some(".tga");
    };
    SUFFIXES.iter().find(|(_, format)| name.contains(format)).map(|(suffix, _)| *suffix)
}

/// Decodes a PNG, JPEG, WebP, KTX 2, OpenEXR, Radiance HDR, PFM, BMP or TGA file, told apart by content. `name` is what errors call it.
///
/// # Errors
/// If the format is another one, the data is damaged, or the image is larger than `limits` allow.
pub fn read(bytes: &[u8], name: &str, limits: Limits) -> Result<Image, AssetError> {
    let source = Source { bytes, name, limits };
    let starts = |s: &&Signature| bytes.get(s.offset..).is_some_and(|b| b.starts_with(s.bytes));
    const READ: &str = "durer reads PNG, JPEG, WebP, KTX 2, OpenEXR, Radiance HDR, PFM, BMP and TGA images";
    match SIGNATURES.iter().find(starts) {
        Some(Signature { decode: Some(decode), .. }) => decode(&source),
        Some(Signature { name, .. }) => Err(source.unsupported(format!("a {name} file; {READ}"))),
        None if bytes.is_empty() => Err(source.format_error("the file is empty")),
        None if raster::is_tga(&source) => raster::decode_tga(&source),
        None => Err(unknown(&source, READ)),
    }
}

/// A file that begins like none we know.
fn unknown(source: &Source<'_>, read: &str) -> AssetError {
    let name = source.name.to_lowercase();
    match SUFFIXES.iter().find(|(suffix, _)| name.ends_with(suffix)) {
        Some((_, format)) => source.format_error(format!(
            "the name says {format}, but it does not begin like one; damaged on the way, or another kind of file?"
        )),
        None => source.unsupported(format!("not an image of a known format; {read}")),
    }
}
