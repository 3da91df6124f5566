//! The header: elements with their properties, and how the body is written (Turk 1994, "The PLY polygon file format").
use std::ops::Range;

use durer_scene::nearest_word;

use crate::import::{
    content::{Content, beginning},
    text::{Complaint, Part, Words},
};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// As text.
    Ascii,
    /// In bytes, least significant first.
    Little,
    /// In bytes, most significant first.
    Big,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// Both ways to name them.
const TYPES: [(&str, &str, Scalar); 8] = [
    ("char", "int8", Scalar::I8),
    ("uchar", "uint8", Scalar::U8),
    ("short", "int16", Scalar::I16),
    ("ushort", "uint16", Scalar::U16),
    ("int", "int32", Scalar::I32),
    ("uint", "uint32", Scalar::U32),
    ("float", "float32", Scalar::F32),
    ("double", "float64", Scalar::F64),
];

impl Scalar {
    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
    fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }
}

/// One number, or a list of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

/// A column of an element.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) shape: Shape,
}

impl Property {
    /// Least bytes of a value.
    fn least(&self) -> usize {
        match self.shape {
            Shape::Scalar(ty) | Shape::List { count: ty, .. } => ty.size(),
        }
    }
}

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Element {
    pub(super) name: String,
    /// Rows.
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// Its line.
    pub(super) at: Range<usize>,
}

impl Element {
    /// Least bytes of a row in a binary file.
    pub(super) fn least(&self) -> usize {
        self.properties.iter().map(Property::least).sum()
    }
    /// True if all rows have the same number of bytes.
    pub(super) fn is_even(&self) -> bool {
        self.properties.iter().all(|p| matches!(p.shape, Shape::Scalar(_)))
    }
    /// Rows that take any room: one without properties has none.
    pub(super) fn rows(&self) -> usize {
        if self.properties.is_empty() { 0 } else { self.count }
    }
    /// The column of one of these names.
    pub(super) fn find(&self, names: &[&str]) -> Option<(usize, &Property)> {
        self.properties.iter().enumerate().find(|(_, p)| names.contains(&p.name.as_str()))
    }
}

/// All of it.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Where the body begins.
    pub(super) body: usize,
    /// The image that a comment names, as MeshLab writes it.
    pub(super) texture: Option<String>,
    /// Lines that no one knows.
    pub(super) warnings: Vec<Complaint>,
}

/// A file whose header has CR for line ends, as old Macintosh programs wrote them, with LF instead; `None` for all others.
/// The body is changed only if it is text.
pub(super) fn with_line_feeds(file: &[u8]) -> Option<Vec<u8>> {
    const END: &[u8] = b"\rend_header\r";
    if !file.starts_with(b"ply\r") || file.get(4) == Some(&b'\n') {
        return None;
    }
    let end = memchr::memmem::find(file, END)? + END.len();
    let is_text = memchr::memmem::find(file.get(..end)?, b"format ascii").is_some();
    let mut file = file.to_vec();
    let changed = if is_text { file.as_mut_slice() } else { file.get_mut(..end)? };
    changed.iter_mut().filter(|b| **b == b'\r').for_each(|b| *b = b'\n');
    Some(file)
}

const WORDS: [&str; 6] = ["format", "element", "property", "comment", "obj_info", "end_header"];

/// Reads the header of a file.
pub(super) fn parse(file: &[u8]) -> Result<Header, Complaint> {
    let mut lines = Part::whole(file).lines();
    match lines.next() {
        Some(line) if line.bytes.trim_ascii() == b"ply" => {}
        _ => {
            return Err(Complaint::whole(foreign(file)));
        }
    }
    let mut header = Header {
        encoding: Encoding::Ascii,
        elements: Vec::new(),
        body: 0,
        texture: None,
        warnings: Vec::new(),
    };
    let mut encoding = None;
    for line in lines {
        let mut words = line.words();
        let Some(first) = words.next() else {
            continue;
        };
        match first.bytes {
            b"end_header" => {
                header.body = (line.at + line.bytes.len() + 1).min(file.len());
                let missing = "the header has no line \"format\"";
                header.encoding = encoding.ok_or_else(|| Complaint::error(line.range(), missing))?;
                return Ok(header);
            }
            b"format" => encoding = Some(format(line, words)?),
            b"comment" | b"obj_info" => comment(words, &mut header.texture),
            b"element" => header.elements.push(element(line, words)?),
            b"property" => {
                let message = "a property before the first element";
                let element =
                    header.elements.last_mut().ok_or_else(|| Complaint::error(line.range(), message))?;
                element.properties.push(property(line, words)?);
            }
            _ if header.warnings.len() < 8 => header.warnings.push(unknown(first)),
            _ => {}
        }
    }
    Err(Complaint::whole("the header does not end: there is no line \"end_header\""))
}

/// What a file is that does not begin as PLY does.
fn foreign(file: &[u8]) -> String {
    match Content::of(file).and_then(|content| content.complaint("PLY")) {
        Some(said) => said,
        None if file.is_empty() => "the file is empty".to_owned(),
        None => format!("not a PLY file: it begins with {}, not with a line \"ply\"", beginning(file)),
    }
}

fn unknown(word: Part<'_>) -> Complaint {
    let text = word.text();
    let complaint =
        Complaint::error(word.range(), format!("unknown word \"{}\" in the header", word.shown()));
    let complaint = complaint.warning();
    match nearest_word(&text, WORDS) {
        Some(near) => complaint.hint(format!("did you mean \"{near}\"?")),
        None => complaint.hint("the line is skipped"),
    }
}

fn format(line: Part<'_>, mut words: Words<'_>) -> Result<Encoding, Complaint> {
    let expected = "expected \"ascii\", \"binary_little_endian\" or \"binary_big_endian\"";
    let word = words.next().ok_or_else(|| Complaint::error(line.range(), expected))?;
    match word.bytes {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::Little),
        b"binary_big_endian" => Ok(Encoding::Big),
        _ => Err(Complaint::error(word.range(), format!("{expected}, found \"{}\"", word.shown()))),
    }
}

fn comment(mut words: Words<'_>, texture: &mut Option<String>) {
    if words.next().is_some_and(|w| w.bytes == b"TextureFile") {
        let name = words.rest().trim().text();
        texture.get_or_insert(name);
    }
}

fn element(line: Part<'_>, mut words: Words<'_>) -> Result<Element, Complaint> {
    let expected = "expected \"element\", a name and a number of rows";
    let (Some(name), Some(count)) = (words.next(), words.next()) else {
        return Err(Complaint::error(line.range(), expected));
    };
    let number = std::str::from_utf8(count.bytes).ok().and_then(|t| t.parse().ok());
    let count = number
        .ok_or_else(|| Complaint::error(count.range(), format!("{expected}, found \"{}\"", count.shown())))?;
    Ok(Element { name: name.text(), count, properties: Vec::new(), at: line.range() })
}

fn property(line: Part<'_>, mut words: Words<'_>) -> Result<Property, Complaint> {
    let mut word = || {
        let message = "expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"";
        words.next().ok_or_else(|| Complaint::error(line.range(), message))
    };
    let first = word()?;
    let shape = if first.bytes == b"list" {
        let count = word()?;
        let ty = scalar(count)?;
        if ty.is_float() {
            return Err(Complaint::error(count.range(), "the length of a list must be a whole number"));
        }
        Shape::List { count: ty, item: scalar(word()?)? }
    } else {
        Shape::Scalar(scalar(first)?)
    };
    Ok(Property { name: word()?.text(), shape })
}

fn scalar(word: Part<'_>) -> Result<Scalar, Complaint> {
    let text = word.text();
    if let Some((_, _, ty)) = TYPES.iter().find(|(a, b, _)| [*a, *b].contains(&text.as_str())) {
        return Ok(*ty);
    }
    if text.contains(|c: char| c.is_control() || c == '\u{fffd}') {
        let message = "the header holds bytes that are no text: the file is damaged";
        return Err(Complaint::error(word.range(), message).hint("copy or export it again"));
    }
    let complaint = Complaint::error(word.range(), format!("unknown type \"{}\"", word.shown()));
    let names = TYPES.iter().flat_map(|(a, b, _)| [*a, *b]);
    Err(match nearest_word(&text, names.clone()) {
        Some(near) => complaint.hint(format!("did you mean \"{near}\"?")),
        None => complaint.hint(format!("valid: {}", names.collect::<Vec<_>>().join(", "))),
    })
}
