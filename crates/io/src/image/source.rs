//! The bytes of a picture, and what is said when they are damaged or of a kind that is not read: sentences for people who
//! paint, never the texts of the libraries below.
use durer_scene::{AssetError, Limits};
use image::error::{ImageFormatHint, UnsupportedErrorKind};

/// Decoded bytes that any file may promise.
pub(super) const HARMLESS: u64 = 16 << 20;
/// What helps against most damage.
const AGAIN: &str = "copy or export the picture again";

/// What the `image` crate calls features of sound files that it does not read, and what we do.
const FEATURES: &[(&str, &str)] = &[
    ("Orientation", "stored sideways or upside down"),
    ("JPEG compression", "that holds a JPEG picture"),
    ("PNG compression", "that holds a PNG picture"),
    ("CMYK", "with printing colours (CMYK)"),
    ("dimensions", "of too many pixels"),
];

/// Encoded bytes, what messages call them, and what they may grow to.
pub(super) struct Source<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) name: &'a str,
    pub(super) limits: Limits,
}

impl Source<'_> {
    /// The bytes are not what they claim to be.
    pub(super) fn format_error(&self, reason: impl Into<String>) -> AssetError {
        AssetError::Format { path: self.name.to_owned(), reason: reason.into() }
    }
    /// A sound file of a kind that is not read.
    pub(super) fn unsupported(&self, reason: impl Into<String>) -> AssetError {
        AssetError::Unsupported { path: self.name.to_owned(), reason: reason.into() }
    }
    /// A `what` is damaged.
    pub(super) fn damaged(&self, what: &str, reason: &str) -> AssetError {
        self.format_error(format!("damaged {what}: {reason}; {AGAIN}"))
    }
    /// A `what` whose `part`, such as `its header`, goes on beyond the end of the file.
    pub(super) fn cut(&self, what: &str, part: &str) -> AssetError {
        self.format_error(format!("damaged {what}: the file ends before {part} does; copy it again"))
    }
    /// A `what` of which nobody knows where it was cut off.
    pub(super) fn ends_early(&self, what: &str) -> AssetError {
        self.format_error(format!("damaged {what}: the file ends too early; copy it again"))
    }
    /// What a library that cannot tell its errors apart otherwise `said`: the sentence beside the first of `known` words
    /// in it, else something general.
    pub(super) fn translated(&self, what: &str, said: &str, known: &[(&str, &str)]) -> AssetError {
        let found = known.iter().find(|(word, _)| said.contains(word));
        self.damaged(what, found.map_or("its pixel data cannot be decoded", |(_, ours)| ours))
    }
    /// What a decoder of the `image` crate said about a `what`; `known` damage as in [`Self::translated`].
    pub(super) fn image_error(
        &self,
        what: &str,
        error: &image::ImageError,
        known: &[(&str, &str)],
    ) -> AssetError {
        match error {
            image::ImageError::Unsupported(e) => {
                let kind = match e.kind() {
                    UnsupportedErrorKind::GenericFeature(feature) => {
                        FEATURES.iter().find(|(word, _)| feature.contains(word)).map(|(_, ours)| *ours)
                    }
                    UnsupportedErrorKind::Format(ImageFormatHint::Name(name)) if name.contains("xyze") => {
                        Some("with XYZ colours")
                    }
                    _ => None,
                };
                let kind = kind.unwrap_or("of a rare kind");
                self.unsupported(format!(
                    "a {what} {kind}, which durer does not read; export it as EXR or PNG"
                ))
            }
            image::ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
                self.ends_early(what)
            }
            other => self.translated(what, &other.to_string(), known),
        }
    }
    /// Complains about a header that promises nothing or too much. No compression we read shrinks the `sample_bytes`
    /// of decoded data by more than `ratio`, so a short file that promises more is damaged: nothing is allocated.
    pub(super) fn check_size(
        &self,
        width: u64,
        height: u64,
        sample_bytes: u64,
        ratio: u64,
    ) -> Result<(), AssetError> {
        if width == 0 || height == 0 {
            let reason = format!("its header says {width} x {height} pixels, which is no picture; {AGAIN}");
            return Err(self.format_error(reason));
        }
        let pixels = width.saturating_mul(height);
        let most = self.limits.image_pixels;
        if pixels > most || width.max(height) > u64::from(u32::MAX) {
            let reason =
                format!("{width} x {height} pixels; durer reads at most {most} in all (damaged header?)");
            return Err(AssetError::Limits { path: self.name.to_owned(), reason });
        }
        let most = (self.bytes.len() as u64).saturating_mul(ratio).max(HARMLESS);
        if pixels.saturating_mul(sample_bytes) > most {
            let found = self.bytes.len();
            let reason = format!("{width} x {height} pixels cannot be stored in {found} bytes; {AGAIN}");
            return Err(self.format_error(reason));
        }
        Ok(())
    }
    /// The little-endian number in the two bytes at `offset`; 0 beyond the end.
    pub(super) fn u16_at(&self, offset: usize) -> u16 {
        let bytes = self.bytes.get(offset..).and_then(<[u8]>::first_chunk);
        bytes.map_or(0, |b| u16::from_le_bytes(*b))
    }
    /// The little-endian number in the four bytes at `offset`; 0 beyond the end.
    pub(super) fn i32_at(&self, offset: usize) -> i32 {
        let bytes = self.bytes.get(offset..).and_then(<[u8]>::first_chunk);
        bytes.map_or(0, |b| i32::from_le_bytes(*b))
    }
    /// The byte at `offset`; 0 beyond the end.
    pub(super) fn u8_at(&self, offset: usize) -> u8 {
        self.bytes.get(offset).copied().unwrap_or(0)
    }
    /// A length in memory.
    pub(super) fn length(&self, what: &str, bytes: u64) -> Result<usize, AssetError> {
        usize::try_from(bytes)
            .map_err(|_| self.format_error(format!("{what}: too large for this machine's memory")))
    }
}
