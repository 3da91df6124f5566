//! The GLB container: a JSON chunk and at most one binary chunk (glTF 2.0 specification, section 4).

use std::ops::Range;

use durer_scene::counted;

use crate::import::content::beginning;

/// `JSON` and `BIN\0` as little-endian numbers.
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// What a file holds.
pub(super) struct Chunks<'a> {
    /// The document.
    pub(super) json: &'a [u8],
    /// The buffer without a URI.
    pub(super) bin: Option<Range<usize>>,
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// Splits a `.glb` file; what does not begin with `glTF` but like JSON is JSON alone, whatever its suffix.
///
/// # Errors
/// Says what is wrong with the container.
pub(super) fn split(bytes: &[u8]) -> Result<Chunks<'_>, String> {
    if !bytes.starts_with(b"glTF") {
        return json_alone(bytes);
    }
    let header = word(bytes, 4).zip(word(bytes, 8));
    let (version, length) =
        header.ok_or_else(|| cut_off("the file ends within the 12 bytes of its header"))?;
    if version != 2 {
        return Err(format!("a GLB file of version {version}; durer reads version 2: export it as glTF 2.0"));
    }
    if length < 12 {
        return Err(export_again(&format!(
            "its header announces {length} bytes, fewer than the header itself has"
        )));
    }
    let whole = bytes.get(..length as usize).ok_or_else(|| {
        cut_off(&format!("its header announces {}, but the file has {}", many(length as usize), bytes.len()))
    })?;
    let (mut json, mut bin) = (None, None);
    let mut at = 12;
    while at < whole.len() {
        let chunk = Chunk::read(whole, at)?;
        let second = json.is_some_and(|j: &[u8]| at == 20 + j.len());
        match chunk.kind {
            JSON if at == 12 => json = Some(chunk.data),
            other if at == 12 => {
                return Err(export_again(&format!("the first chunk must be JSON, found {}", shown(other))));
            }
            BIN if second => bin = Some(at + 8..at + 8 + chunk.data.len()),
            JSON => return Err(export_again(&format!("a second JSON chunk at byte {at}"))),
            BIN if bin.is_some() => return Err(export_again(&format!("a second BIN chunk at byte {at}"))),
            BIN => {
                let message =
                    format!("the BIN chunk at byte {at} does not stand right behind the JSON chunk");
                return Err(export_again(&message));
            }
            // Chunks of unknown types are to be skipped.
            _ => {}
        }
        at += 8 + chunk.data.len();
    }
    let none = || export_again("the file ends behind its header: there is no JSON chunk");
    Ok(Chunks { json: json.ok_or_else(none)?, bin })
}

/// A file that is no container.
fn json_alone(bytes: &[u8]) -> Result<Chunks<'_>, String> {
    match bytes.trim_ascii_start() {
        [] => Err("the file is empty".to_owned()),
        [b'{' | b'[' | b'"' | b'0'..=b'9', ..] => Ok(Chunks { json: bytes, bin: None }),
        [0xef, 0xbb, 0xbf, ..] => Err("a byte order mark stands before the JSON, which glTF forbids: \
                                       save the file as UTF-8 without it"
            .to_owned()),
        _ => Err(format!(
            "no glTF file: a .glb begins with the letters glTF, a .gltf with a brace {{; this one begins with {}",
            beginning(bytes)
        )),
    }
}

/// A stretch of the container.
struct Chunk<'a> {
    kind: u32,
    data: &'a [u8],
}

impl<'a> Chunk<'a> {
    /// The chunk at byte `at`.
    fn read(whole: &'a [u8], at: usize) -> Result<Self, String> {
        let (size, kind) = word(whole, at).zip(word(whole, at + 4)).ok_or_else(|| {
            cut_off(&format!("the file ends within the 8 bytes that begin the chunk at byte {at}"))
        })?;
        let rest = whole.get(at + 8..).unwrap_or_default();
        let size = size as usize;
        let data = rest.get(..size).ok_or_else(|| {
            let (announced, kind) = (many(size), shown(kind));
            let there = rest.len();
            cut_off(&format!("the chunk {kind} at byte {at} announces {announced}, but only {there} follow"))
        })?;
        if !size.is_multiple_of(4) {
            let message =
                format!("the length of the chunk {} at byte {at}, {size}, is no multiple of 4", shown(kind));
            return Err(export_again(&message));
        }
        Ok(Self { kind, data })
    }
}

fn many(bytes: usize) -> String {
    counted(bytes, "byte")
}

fn cut_off(what: &str) -> String {
    format!("GLB: {what}; it was probably cut off: copy or download it again")
}

fn export_again(what: &str) -> String {
    format!("GLB: {what}; export the file again")
}

/// The type of a chunk as its letters, else as its number.
fn shown(kind: u32) -> String {
    match kind {
        JSON => "JSON".to_owned(),
        BIN => "BIN".to_owned(),
        other => match other.to_le_bytes() {
            letters if letters.iter().all(u8::is_ascii_graphic) => {
                format!("\"{}\"", letters.map(char::from).iter().collect::<String>())
            }
            _ => format!("{other:#010x}"),
        },
    }
}
