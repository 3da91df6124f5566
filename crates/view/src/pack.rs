//! A scene and its files as one archive.
use std::{fs, io::Write, path::Path};

use durer::export::{Content, pbrt::Written};
use flate2::{Compression, write::DeflateEncoder};
use rawzip::{CompressionMethod, ZipArchiveWriter};

/// Most bytes of all files together: an archive is made in memory.
const MOST: u64 = 1 << 30;
/// The archive: `stem.pbrt` and what lies beside it.
///
/// # Errors
/// If a file cannot be read, or it would be too much.
pub(crate) fn packed(stem: &str, scene: Written) -> Result<Vec<u8>, String> {
    let size = |content: &Content| match content {
        Content::Bytes(bytes) => Ok(bytes.len() as u64),
        Content::Copy(file) => fs::metadata(file).map(|m| m.len()).map_err(|e| unreadable(file, &e)),
    };
    let sizes = scene.beside.iter().map(|file| size(&file.content));
    let total = sizes.sum::<Result<u64, String>>()?.saturating_add(scene.text.len() as u64);
    if total > MOST {
        let mib = |bytes: u64| bytes >> 20;
        return Err(format!(
            "the scene with its files has {} MiB, more than the {} MiB that are sent as one archive: \
             save .pbrt and keep it where the original lies, or use durer convert",
            mib(total),
            mib(MOST)
        ));
    }
    let mut archive = ZipArchiveWriter::new(Vec::new());
    add(&mut archive, &format!("{stem}.pbrt"), scene.text.as_bytes())?;
    // No copy of all of it is held while it is packed.
    drop(scene.text);
    for file in scene.beside {
        match file.content {
            Content::Bytes(bytes) => add(&mut archive, &file.path, &bytes)?,
            Content::Copy(from) => {
                add(&mut archive, &file.path, &fs::read(&from).map_err(|e| unreadable(&from, &e))?)?;
            }
        }
    }
    archive.finish().map_err(|e| e.to_string())
}

fn unreadable(file: &Path, error: &std::io::Error) -> String {
    format!("{}: {error}", file.display())
}

/// Adds a file. The same scene is the same archive: no clock is asked.
fn add(archive: &mut ZipArchiveWriter<Vec<u8>>, name: &str, bytes: &[u8]) -> Result<(), String> {
    let mut put = || {
        let file = archive.new_file(name).compression_method(CompressionMethod::DEFLATE);
        let (mut entry, config) = file.start()?;
        let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::fast()));
        writer.write_all(bytes)?;
        let (encoder, descriptor) = writer.finish()?;
        encoder.finish()?;
        entry.finish(descriptor)
    };
    put().map(drop).map_err(|e: rawzip::Error| e.to_string())
}
