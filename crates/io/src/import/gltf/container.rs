//! The GLB container: a JSON chunk and at most one binary chunk (glTF 2.0 specification, section 4).

/// `JSON` and `BIN\0` as little-endian numbers.
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// What a file holds.
pub(super) struct Chunks<'a> {
    /// The document.
    pub(super) json: &'a [u8],
    /// The buffer without a URI.
    pub(super) bin: Option<&'a [u8]>,
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
        return match bytes.trim_ascii_start() {
            [] => Err("the file is empty".to_owned()),
            [b'{', ..] => Ok(Chunks { json: bytes, bin: None }),
            [0xef, 0xbb, 0xbf, ..] => Err("a byte order mark stands before the JSON, which glTF forbids: \
                                           save the file as UTF-8 without it"
                .to_owned()),
            _ => Err("no glTF file: a .glb begins with the letters glTF, a .gltf with a brace {".to_owned()),
        };
    }
    let header = word(bytes, 4).zip(word(bytes, 8));
    let (version, length) = header.ok_or("GLB header: the file ends after the magic word")?;
    if version != 2 {
        return Err(format!("GLB container version {version}; durer reads version 2"));
    }
    if length < 12 {
        return Err(format!("GLB header: {length} bytes announced, but the header alone has 12"));
    }
    let whole = bytes
        .get(..length as usize)
        .ok_or_else(|| format!("GLB header: {length} bytes announced, but the file has {}", bytes.len()))?;
    let (mut json, mut bin) = (None, None);
    let mut at = 12;
    while at < whole.len() {
        let (size, kind) =
            word(whole, at).zip(word(whole, at + 4)).ok_or("GLB chunk header: the file ends within it")?;
        let data = whole.get(at + 8..).and_then(|rest| rest.get(..size as usize)).ok_or_else(|| {
            format!("GLB chunk at byte {at}: {size} bytes announced, but the file ends before")
        })?;
        if !size.is_multiple_of(4) {
            return Err(format!("GLB chunk at byte {at}: its length, {size}, is not a multiple of 4"));
        }
        let second = json.is_some_and(|j: &[u8]| at == 20 + j.len());
        match kind {
            JSON if at == 12 => json = Some(data),
            _ if at == 12 => return Err("the first GLB chunk must be of type JSON".to_owned()),
            BIN if second => bin = Some(data),
            JSON | BIN => {
                let what = "a GLB file holds one JSON chunk and, right behind it, at most one BIN chunk";
                return Err(format!("GLB chunk at byte {at}: {what}"));
            }
            // Chunks of unknown types are to be skipped.
            _ => {}
        }
        at += 8 + size as usize;
    }
    Ok(Chunks { json: json.ok_or("a GLB file without JSON chunk")?, bin })
}
