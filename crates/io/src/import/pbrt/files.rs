//! The files of a scene: the main one and those it includes.
//!
//! An included path is looked up in the folder of the including file, then in that of the main file (pbrt-v4 knows the
//! latter only). It may not lead out of the main file's folder, and nesting, number and total size are limited, so that
//! a few hostile lines cannot unfold into a parse without end.
use std::{
    collections::HashMap,
    fs::File,
    io::{ErrorKind, Read},
    path::{Component, Path, PathBuf},
    sync::Arc,
};

use crate::{assets::looked_in, gzip};
use durer_scene::{AssetError, Diagnostics, Limits, Location, SourceId, Sources, Span};

/// True if spans, which count bytes in 32 bits, can point at all of `text`.
pub(super) fn spans_fit(text: &str) -> bool {
    u32::try_from(text.len()).is_ok()
}

/// Most `Include` and `Import` directives that are followed.
const MOST_INCLUDES: u32 = 1 << 16;

/// A text with its number.
#[derive(Clone, Debug)]
pub(super) struct Text {
    /// In [`Sources`].
    pub(super) source: SourceId,
    /// All of it.
    pub(super) text: Arc<str>,
    /// Folder that paths in it are relative to; `None` for texts that are no files.
    pub(super) folder: Option<PathBuf>,
    /// The file, links resolved; empty for texts that are no files.
    pub(super) path: PathBuf,
}

/// Finds and reads files, each once.
#[derive(Debug)]
pub(super) struct Files {
    /// The main file's folder, links resolved.
    root: Option<PathBuf>,
    /// The same as the user wrote it.
    shown_root: PathBuf,
    known: HashMap<PathBuf, Text>,
    limits: Limits,
    bytes: u64,
    includes: u32,
}

impl Files {
    /// For a text that is no file: it includes nothing.
    pub(super) fn none(limits: Limits) -> Self {
        Self { root: None, shown_root: PathBuf::new(), known: HashMap::new(), limits, bytes: 0, includes: 0 }
    }

    /// Reads the main file.
    pub(super) fn main(
        path: &Path,
        limits: Limits,
        sources: &mut Sources,
        diagnostics: &mut Diagnostics,
    ) -> Option<(Self, Text)> {
        let mut files = Self::none(limits);
        files.shown_root = path.parent().unwrap_or_else(|| Path::new("")).to_owned();
        let name = path.display().to_string();
        let found = match path.canonicalize() {
            Ok(found) => found,
            Err(e) => {
                diagnostics.error(Location::None, format!("{name}: {}", reason(&e)));
                return None;
            }
        };
        // Not found.parent(): a scene that is a link still finds its files beside the link.
        let folder = if files.shown_root.as_os_str().is_empty() { Path::new(".") } else { &files.shown_root };
        files.root = folder.canonicalize().ok();
        let folder = files.root.clone();
        let text = files.load(found, name, Location::None, sources, diagnostics)?;
        Some((files, Text { folder, ..text }))
    }

    /// Deepest nesting of files and blocks.
    pub(super) fn depth(&self) -> usize {
        self.limits.depth
    }

    /// Reads the file that the text in `folder` includes as `name`; `open` are the files being read.
    pub(super) fn include(
        &mut self,
        name: &str,
        folder: Option<&Path>,
        open: &[PathBuf],
        at: Span,
        sources: &mut Sources,
        diagnostics: &mut Diagnostics,
    ) -> Option<Text> {
        let (Some(folder), Some(root)) = (folder, self.root.clone()) else {
            diagnostics.error(at, "this text is no file, so it cannot include one");
            return None;
        };
        self.includes += 1;
        if self.includes > MOST_INCLUDES {
            diagnostics.error(at, format!("more than {MOST_INCLUDES} files are included"));
            return None;
        }
        // Told before anything is looked for, so that nobody learns what lies outside.
        let climbs = |from: &Path| climbs_out(from.strip_prefix(&root).unwrap_or(Path::new("")), name);
        let asked = Path::new(name);
        let outside = if asked.is_absolute() { !asked.starts_with(&root) } else { climbs(folder) };
        if outside {
            refuse_outside(name, at, diagnostics);
            return None;
        }
        let candidates = [folder.join(name), if climbs(&root) { folder.join(name) } else { root.join(name) }];
        let found = candidates.iter().map(|p| p.canonicalize()).find(Result::is_ok);
        let found = match found.unwrap_or_else(|| folder.join(name).canonicalize()) {
            Ok(found) => found,
            Err(e) => {
                let relative = Path::new(name);
                let parent = relative.parent().unwrap_or(Path::new(""));
                let folder = self.shown_root.join(shown(folder, &root)).join(parent);
                let last = relative.file_name().unwrap_or_default().to_string_lossy();
                // The names of a folder outside are nobody's business.
                let within = folder.canonicalize().is_ok_and(|folder| folder.starts_with(&root));
                let hint = match within {
                    true => looked_in(&folder, &last),
                    false => format!("looked in {}/", folder.display()),
                };
                diagnostics.error(at, format!("{name}: {}", reason(&e))).hint(hint);
                return None;
            }
        };
        if !found.starts_with(&root) {
            refuse_outside(name, at, diagnostics);
            return None;
        }
        if open.contains(&found) {
            diagnostics.error(at, format!("{name}: the file includes itself, perhaps through others"));
            return None;
        }
        if open.len() > self.limits.depth {
            diagnostics.error(at, format!("files are included more than {} deep", self.limits.depth));
            return None;
        }
        let shown = self.shown_root.join(shown(&found, &root)).display().to_string();
        self.load(found, shown, at.into(), sources, diagnostics)
    }

    fn load(
        &mut self,
        path: PathBuf,
        shown: String,
        at: Location,
        sources: &mut Sources,
        diagnostics: &mut Diagnostics,
    ) -> Option<Text> {
        if let Some(text) = self.known.get(&path) {
            let text = text.clone();
            let fits = self.charge(text.text.len() as u64);
            if !fits {
                diagnostics.error(at, format!("{shown}: the scene's files are too large together"));
            }
            return fits.then_some(text);
        }
        // Spans count bytes in 32 bits.
        let most = self.limits.file_bytes.min(u64::from(u32::MAX) - 4);
        let bytes = match read_bytes(&path, &shown, Limits { file_bytes: most, ..self.limits }) {
            Ok(bytes) if bytes.len() as u64 > most || !self.charge(bytes.len() as u64) => {
                diagnostics.error(at, format!("{shown}: larger than {most} bytes"));
                return None;
            }
            Ok(bytes) => bytes,
            Err(message) => {
                diagnostics.error(at, message);
                return None;
            }
        };
        let folder = path.parent().map(Path::to_owned);
        let (source, text) = decode(bytes, shown, sources, diagnostics)?;
        let text = Text { source, text, folder, path };
        self.known.insert(text.path.clone(), text.clone());
        Some(text)
    }

    /// Counts text to be parsed; false if it is too much in all.
    fn charge(&mut self, bytes: u64) -> bool {
        self.bytes = self.bytes.saturating_add(bytes);
        self.bytes <= self.limits.file_bytes
    }
}

/// True for a path that has more `..` than the folders that it comes through, from `folder` on.
fn climbs_out(folder: &Path, name: &str) -> bool {
    let mut depth = folder.components().count();
    for part in Path::new(name).components() {
        match part {
            Component::Normal(_) => depth += 1,
            Component::ParentDir if depth > 0 => depth -= 1,
            Component::ParentDir => return true,
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    false
}

/// `path` below `root`.
fn shown<'p>(path: &'p Path, root: &Path) -> &'p Path {
    path.strip_prefix(root).unwrap_or(path)
}

fn reason(e: &std::io::Error) -> String {
    if e.kind() == ErrorKind::NotFound { "file not found".to_owned() } else { e.to_string() }
}

/// The file's bytes, unpacked if it is gzip; of one that is not, at most one more than the limit.
///
/// # Errors
/// What to tell; messages call the file `shown`.
fn read_bytes(path: &Path, shown: &str, limits: Limits) -> Result<Vec<u8>, String> {
    let fail = |e: std::io::Error| format!("{shown}: {}", reason(&e));
    // Before it is opened: that waits for ever on a pipe to which nobody writes.
    let about = path.metadata().map_err(fail)?;
    if about.is_dir() {
        return Err(format!("{shown}: this is a folder"));
    }
    if !about.is_file() {
        return Err(format!("{shown}: not a file"));
    }
    let file = File::open(path).map_err(fail)?;
    let most = limits.file_bytes;
    let mut bytes = Vec::with_capacity(about.len().min(most) as usize + 1);
    file.take(most + 1).read_to_end(&mut bytes).map_err(fail)?;
    let packed = gzip::is_packed(&bytes) && bytes.len() as u64 <= most;
    if packed { gzip::unpack(&bytes, shown, limits).map_err(|e| e.to_string()) } else { Ok(bytes) }
}

/// Registers the text, complaining about bytes that are none. Wrong bytes in a text are shown as U+FFFD and reading
/// goes on, in comments without a word; other formats are told by their first bytes and refused.
fn decode(
    bytes: Vec<u8>,
    shown: String,
    sources: &mut Sources,
    diagnostics: &mut Diagnostics,
) -> Option<(SourceId, Arc<str>)> {
    let bytes = match String::from_utf8(bytes) {
        Ok(text) => {
            let text: Arc<str> = text.into();
            return Some((sources.add(shown, text.clone()), text));
        }
        Err(e) => e.into_bytes(),
    };
    let other = match bytes.as_slice() {
        [0x1f, 0x8b, ..] => Some("this is no gzip file that can be unpacked"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("this is UTF-16; save it as UTF-8"),
        b if b.contains(&0) || b.len() > u32::MAX as usize / 3 => {
            Some("this is a binary file, not a pbrt scene")
        }
        _ => None,
    };
    if let Some(other) = other {
        sources.add(shown.clone(), Arc::from(""));
        diagnostics.error(Location::None, format!("{shown}: {other}"));
        return None;
    }
    let (text, first) = with_replacements(&bytes);
    let text: Arc<str> = text.into();
    let source = sources.add(shown, text.clone());
    if let Some(start) = first {
        let at = Span { source, start, end: start + '\u{fffd}'.len_utf8() as u32 };
        diagnostics.error(at, "this is not valid UTF-8").hint("save the file as UTF-8");
    }
    Some((source, text))
}

/// The text with U+FFFD for bytes that are none, and where the first of these outside of comments is.
fn with_replacements(bytes: &[u8]) -> (String, Option<u32>) {
    #[derive(PartialEq)]
    enum In {
        Text,
        Quotes,
        Comment,
    }
    let mut text = String::with_capacity(bytes.len());
    let (mut first, mut place, mut escaped) = (None, In::Text, false);
    for chunk in bytes.utf8_chunks() {
        for c in chunk.valid().chars() {
            place = match (place, c) {
                (_, '\n' | '\r') => In::Text,
                (In::Text, '#') => In::Comment,
                (In::Text, '"') => In::Quotes,
                (In::Quotes, '"') if !escaped => In::Text,
                (place, _) => place,
            };
            escaped = c == '\\' && !escaped;
        }
        text.push_str(chunk.valid());
        if !chunk.invalid().is_empty() {
            if place != In::Comment {
                first.get_or_insert(text.len() as u32);
            }
            text.push('\u{fffd}');
        }
    }
    (text, first)
}

fn refuse_outside(name: &str, at: Span, diagnostics: &mut Diagnostics) {
    let error = AssetError::Outside { path: name.to_owned() };
    diagnostics.error(at, error.to_string()).hint("copy the file into the scene's folder");
}
