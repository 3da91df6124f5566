//! What a file is by its first bytes, whatever its name says: files of other programs are told by name and with what to
//! do about them, before a reader of the wrong format complains about their first word.
use std::{fs::File, io::Read, path::Path};

use flate2::bufread::MultiGzDecoder;

use super::text::Part;
use crate::{gzip, image};

/// Bytes that are looked at.
const HEAD: u64 = 4096;

/// A kind of file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Content {
    /// With its article.
    name: &'static str,
    /// What to do.
    advice: &'static str,
    /// The format of ours that reads it.
    format: Option<&'static str>,
}

const fn ours(name: &'static str, advice: &'static str, format: &'static str) -> Content {
    Content { name, advice, format: Some(format) }
}

const fn foreign(name: &'static str, advice: &'static str) -> Content {
    Content { name, advice, format: None }
}

/// Beginnings that say all.
const SIGNATURES: &[(&[u8], Content)] = &[
    (b"glTF", ours("a GLB file", "name it .glb", "glTF 2.0")),
    (b"ply\n", ours("a PLY file", "name it .ply", "PLY")),
    (b"ply\r", ours("a PLY file", "name it .ply", "PLY")),
    (b"BLENDER", foreign("a Blender file", "export it as glTF from Blender")),
    (b"Kaydara FBX", foreign("an FBX file", "convert it to glTF, for example with Blender")),
    (b"; FBX", foreign("an FBX file", "convert it to glTF, for example with Blender")),
    (b"PXR-USDC", foreign("a USD file", "convert it to glTF, for example with Blender")),
    (b"#usda", foreign("a USD file", "convert it to glTF, for example with Blender")),
    (b"PK\x03\x04", foreign("a zip archive", "unpack it and name the scene file in it")),
    (b"7z\xbc\xaf\x27\x1c", foreign("a 7z archive", "unpack it and name the scene file in it")),
    (b"Rar!", foreign("a RAR archive", "unpack it and name the scene file in it")),
    (b"BZh", foreign("packed with bzip2", "unpack it first")),
    (b"\xfd7zXZ", foreign("packed with xz", "unpack it first")),
    (b"\x28\xb5\x2f\xfd", foreign("packed with Zstandard (as Blender files are)", "unpack it first")),
    (b"\x1f\x8b", foreign("a gzip file in a gzip file", "unpack it first")),
    (b"%PDF", foreign("a PDF document", "name a scene file")),
    (b"\x7fELF", foreign("a program", "name a scene file")),
    (b"version https://git-lfs", foreign("a Git LFS pointer, not the file itself", "run git lfs pull")),
    (b"<!DOCTYPE html", foreign("a web page", "download the file itself")),
    (b"<html", foreign("a web page", "download the file itself")),
];

const IMAGE: Content = foreign("a picture", "name the scene file that uses it");
const XML: Content =
    foreign("an XML file, such as COLLADA or X3D", "convert it to glTF, for example with Blender");
const MITSUBA: Content = ours("a Mitsuba scene", "name it .xml", "Mitsuba");
const GLTF: Content = ours("glTF text", "name it .gltf", "glTF 2.0");
const JSON: Content = foreign("a JSON file", "name the scene file");
const STL: Content = ours("STL text", "name it .stl", "STL");
const OBJ: Content = ours("Wavefront OBJ text", "name it .obj", "Wavefront OBJ");
const PBRT: Content = ours("a pbrt scene", "name it .pbrt", "pbrt");

impl Content {
    /// What the file that begins with `head` is, as far as it can be told.
    pub(super) fn of(head: &[u8]) -> Option<&'static Self> {
        if let Some((_, content)) = SIGNATURES.iter().find(|(begin, _)| head.starts_with(begin)) {
            return Some(content);
        }
        // Two letters alone may begin any text.
        if image::format_name(head).is_some() && head.iter().any(|&b| b == 0 || b > 0x7f) {
            return Some(&IMAGE);
        }
        let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
        match text {
            [b'{', ..] if text.windows(7).any(|w| w == b"\"asset\"") => Some(&GLTF),
            [b'{' | b'[', ..] => Some(&JSON),
            [b'<', ..] if text.windows(6).any(|w| w == b"<scene") => Some(&MITSUBA),
            [b'<', ..] => Some(&XML),
            _ if text.contains(&0) => None,
            _ => of_words(text),
        }
    }

    /// What to say about a file that is read as `format`; `None` if it is that, or may be.
    pub(super) fn complaint(&self, format: &str) -> Option<String> {
        // Arrays and objects of no asset are faults of JSON that the reader of glTF explains.
        let json = *self == JSON && format == "glTF 2.0";
        (self.format != Some(format) && !json).then(|| format!("this is {}: {}", self.name, self.advice))
    }
}

/// Text formats by the first line that is no comment.
fn of_words(text: &[u8]) -> Option<&'static Content> {
    let mut lines = Part::whole(text).lines();
    let line = lines.find(|l| !matches!(l.bytes.trim_ascii(), [] | [b'#', ..]))?;
    let mut words = line.words();
    let first = words.next()?;
    let is_number = |w: Part<'_>| super::text::float(w.bytes).is_some();
    match first.bytes {
        b"solid" if text.windows(5).any(|w| w == b"facet") => Some(&STL),
        b"mtllib" => Some(&OBJ),
        b"v" if words.clone().count() >= 3 && words.all(is_number) => Some(&OBJ),
        b"LookAt" | b"Camera" | b"Film" | b"Sampler" | b"Integrator" | b"WorldBegin" | b"PixelFilter" => {
            Some(&PBRT)
        }
        _ => None,
    }
}

/// What is wrong with the file at `path` that is to be read as `format`, or by no reader at all, as far as its name and
/// first bytes tell. Faults of the system are left to the reader.
pub(super) fn check(path: &Path, packed: bool, format: Option<&str>) -> Option<String> {
    let about = std::fs::metadata(path).ok()?;
    if about.is_dir() {
        return Some("is a folder; name a scene file in it".to_owned());
    }
    if !about.is_file() {
        return None;
    }
    if about.len() == 0 {
        return Some("the file is empty".to_owned());
    }
    let mut head = Vec::new();
    File::open(path).ok()?.take(HEAD).read_to_end(&mut head).ok()?;
    if packed && !gzip::is_packed(&head) {
        return Some("named .gz, but not gzip".to_owned());
    }
    if gzip::is_packed(&head) {
        let mut unpacked = Vec::new();
        // The head is cut off: what came before the cut is there all the same.
        let whole = MultiGzDecoder::new(head.as_slice()).take(HEAD).read_to_end(&mut unpacked).is_ok();
        if unpacked.is_empty() {
            return whole.then(|| "the file is empty".to_owned());
        }
        head = unpacked;
    }
    // The header of a binary STL file may say anything: its reader asks after it has looked at the length.
    match format {
        Some("STL") => None,
        format => Content::of(&head)?.complaint(format.unwrap_or_default()),
    }
}

/// The first characters of a file for messages; nothing of binary.
pub(super) fn beginning(bytes: &[u8]) -> String {
    let head = bytes.get(..bytes.len().min(60)).unwrap_or_default();
    let printable = head.iter().take_while(|b| matches!(b, b' '..=b'~' | b'\t')).count();
    match printable {
        0..4 => "bytes that are no text".to_owned(),
        n => format!("\"{}\"", String::from_utf8_lossy(head.get(..n).unwrap_or_default()).trim()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(head: &[u8], format: &str) -> Option<String> {
        Content::of(head)?.complaint(format)
    }

    #[test]
    fn files_of_other_formats_are_told_by_name() {
        let cases: [(&[u8], &str, &str); 7] = [
            (b"glTF\x02\0\0\0", "Wavefront OBJ", "this is a GLB file: name it .glb"),
            (b"BLENDER-v300", "glTF 2.0", "this is a Blender file: export it as glTF from Blender"),
            (b"\xff\xd8\xff\xe0", "PLY", "this is a picture: name the scene file that uses it"),
            (b" {\"asset\": {", "pbrt", "this is glTF text: name it .gltf"),
            (b"# Blender\nmtllib a.mtl\n", "PLY", "this is Wavefront OBJ text: name it .obj"),
            (b"v 1 2 3\n", "glTF 2.0", "this is Wavefront OBJ text: name it .obj"),
            (b"# a\n\nLookAt 0 0 1", "PLY", "this is a pbrt scene: name it .pbrt"),
        ];
        for (head, format, expected) in cases {
            assert_eq!(said(head, format).as_deref(), Some(expected));
        }
    }

    #[test]
    fn what_may_be_right_is_left_to_the_reader() {
        let cases: [(&[u8], &str); 6] = [
            (b"glTF", "glTF 2.0"),
            (b"{\"scene\"", "glTF 2.0"),
            (b"[1]", "glTF 2.0"),
            (b"BM words", "Wavefront OBJ"),
            (b"v a b c", "PLY"),
            (b"o Cube\nv 1 2 3\n", "pbrt"),
        ];
        for (head, format) in cases {
            assert_eq!(said(head, format), None);
        }
    }
}
