//! Which picture formats can be written, and how a file is replaced as a whole.
use std::{ffi::OsString, fs, io::Write, path::Path};

/// A picture that could not be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {reason}")]
pub struct WriteError {
    /// The file.
    pub path: String,
    /// Why, and what to do.
    pub reason: String,
}

impl WriteError {
    pub(super) fn new(path: &Path, reason: impl ToString) -> Self {
        Self { path: path.display().to_string(), reason: reason.to_string() }
    }
}

/// What a picture file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// 8 bits per channel as displayed: tone-mapped, sRGB-encoded. Written by [`super::write_png`].
    Png,
    /// Linear floats with any channels and metadata. Written by [`super::write_exr`].
    Exr,
}

/// A line of the register of picture formats.
#[derive(Clone, Copy, Debug)]
pub struct Writer {
    /// What people call the format.
    pub name: &'static str,
    /// Suffixes in lower case, without dot.
    pub suffixes: &'static [&'static str],
    /// The format.
    pub format: PictureFormat,
}

/// The formats we write.
pub const WRITERS: &[Writer] = &[
    Writer { name: "PNG", suffixes: &["png"], format: PictureFormat::Png },
    Writer { name: "OpenEXR", suffixes: &["exr"], format: PictureFormat::Exr },
];

/// The format that the suffix of `path` names, in any letter case.
///
/// # Errors
/// If it names none; the error lists those we write.
pub fn writer_for(path: &Path) -> Result<&'static Writer, WriteError> {
    let suffix = path.extension().map(|s| s.to_string_lossy().to_lowercase()).unwrap_or_default();
    WRITERS.iter().find(|w| w.suffixes.contains(&suffix.as_str())).ok_or_else(|| {
        let known: Vec<String> = WRITERS.iter().flat_map(|w| w.suffixes).map(|s| format!(".{s}")).collect();
        let found = if suffix.is_empty() { "no suffix".to_owned() } else { format!("\".{suffix}\"") };
        WriteError::new(path, format!("{found} names no picture format; use one of {}", known.join(", ")))
    })
}

/// Complains unless `found` is `width * height * channels` and more than nothing.
pub(super) fn check_length(
    path: &Path,
    what: &str,
    found: usize,
    [width, height]: [u32; 2],
    channels: u64,
) -> Result<(), WriteError> {
    let wanted = u64::from(width) * u64::from(height) * channels;
    if found as u64 != wanted || wanted == 0 {
        let reason = format!("{what} holds {found} values, but {width} x {height} pixels need {wanted}");
        return Err(WriteError::new(path, reason));
    }
    Ok(())
}

/// Writes `bytes` beside `path` and renames, so that an interrupted run never leaves half a picture under that name.
///
/// # Errors
/// If the file cannot be written.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let Some(name) = path.file_name() else {
        return Err(WriteError::new(path, "names no file"));
    };
    let mut temporary = OsString::from(".");
    temporary.push(name);
    temporary.push(format!(".{}.part", std::process::id()));
    let temporary = path.with_file_name(temporary);
    let written = fs::File::create(&temporary)
        .and_then(|mut file| file.write_all(bytes))
        .and_then(|()| fs::rename(&temporary, path));
    written.map_err(|e| {
        // The first failure is what the user must know; a leftover file is the lesser evil.
        let _ = fs::remove_file(&temporary);
        WriteError::new(path, e)
    })
}
