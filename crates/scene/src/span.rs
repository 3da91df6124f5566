//! Where in which file something was written.
use std::sync::Arc;

use serde::Serialize;

/// Number of a source text in [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct SourceId(pub u32);

/// A range of bytes of one source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Span {
    /// Which text.
    pub source: SourceId,
    /// Offset of the first byte.
    pub start: u32,
    /// Offset behind the last byte.
    pub end: u32,
}

/// What a diagnostic points at.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub enum Location {
    /// Nothing in particular.
    #[default]
    None,
    /// A stretch of a text file.
    Span(Span),
    /// A JSON pointer in a file without useful lines: `/materials/3/extensions`.
    Path {
        /// The file.
        file: String,
        /// JSON pointer (RFC 6901).
        pointer: String,
    },
}

impl From<Span> for Location {
    fn from(span: Span) -> Self {
        Self::Span(span)
    }
}

/// One source text with its name.
#[derive(Clone, Debug)]
struct Source {
    name: Arc<str>,
    text: Arc<str>,
}

/// The texts that spans point into.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    list: Vec<Source>,
}

impl Sources {
    /// Adds a text; `name` is what messages show, usually the path as the user gave it.
    pub fn add(&mut self, name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> SourceId {
        let id = SourceId(self.list.len() as u32);
        self.list.push(Source { name: name.into(), text: text.into() });
        id
    }
    /// The name of a text; empty for an id of another table.
    pub fn name(&self, id: SourceId) -> &str {
        self.list.get(id.0 as usize).map_or("", |s| &s.name)
    }
    /// The names of all texts.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|s| &*s.name)
    }
    /// The text; empty for an id of another table.
    pub fn text(&self, id: SourceId) -> &str {
        self.list.get(id.0 as usize).map_or("", |s| &s.text)
    }
    /// One-based line and column (in characters) of a byte offset.
    pub fn line_column(&self, id: SourceId, offset: u32) -> (usize, usize) {
        let text = self.text(id);
        let before = text.get(..offset as usize).unwrap_or(text);
        let line = before.bytes().filter(|&b| b == b'\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        (line, column)
    }
}
