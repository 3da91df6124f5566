//! Complaints about a scene, collected so that one wrong name does not hide the next ten.
use serde::Serialize;

use crate::{Location, nearest_word};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing; listed by `durer info`.
    Note,
    /// The picture may differ from what the file asks for.
    Warning,
    /// No picture.
    Error,
}

/// One complaint.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What it is about.
    pub at: Location,
    /// What is wrong and what was expected.
    pub message: String,
    /// What to do.
    pub hint: Option<String>,
}

/// A list of complaints.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// After this many errors the rest is dropped: a binary file read as text must not print a book.
    pub const MOST_ERRORS: usize = 50;

    fn push(&mut self, severity: Severity, at: Location, message: String) -> &mut Diagnostic {
        self.list.push(Diagnostic { severity, at, message, hint: None });
        let last = self.list.len() - 1;
        #[expect(clippy::indexing_slicing, reason = "pushed the line above")]
        &mut self.list[last]
    }
    /// Adds an error.
    pub fn error(&mut self, at: impl Into<Location>, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Severity::Error, at.into(), message.into())
    }
    /// Adds a warning.
    pub fn warning(&mut self, at: impl Into<Location>, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Severity::Warning, at.into(), message.into())
    }
    /// Adds a note.
    pub fn note(&mut self, at: impl Into<Location>, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Severity::Note, at.into(), message.into())
    }
    /// Adds `unknown WHAT "word"` with the nearest of the `valid` words as the hint.
    pub fn unknown<'a>(
        &mut self,
        at: impl Into<Location>,
        what: &str,
        word: &str,
        valid: impl IntoIterator<Item = &'a str>,
    ) {
        let valid: Vec<&str> = valid.into_iter().collect();
        let hint = match nearest_word(word, valid.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None if valid.is_empty() => format!("the scene defines no {what}s"),
            None => format!("valid: {}", listed(&valid)),
        };
        self.error(at, format!("unknown {what} \"{word}\"")).hint(hint);
    }
    /// Moves all complaints of `other` behind these.
    pub fn append(&mut self, mut other: Self) {
        self.list.append(&mut other.list);
    }
    /// All complaints in the order they were found.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }
    /// Number of errors.
    pub fn error_count(&self) -> usize {
        self.list.iter().filter(|d| d.severity == Severity::Error).count()
    }
    /// True if there is an error.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }
    /// True if a parser should give up: [`Self::MOST_ERRORS`] were found.
    pub fn is_full(&self) -> bool {
        self.error_count() >= Self::MOST_ERRORS
    }
    /// True if nothing was said.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}

/// Words with commas between them, of long lists the first.
pub fn listed(words: &[&str]) -> String {
    const MOST: usize = 12;
    match words.get(..MOST) {
        // Nothing is gained by "and 1 more".
        Some(first) if words.len() > MOST + 1 => {
            format!("{} and {} more", first.join(", "), words.len() - MOST)
        }
        _ => words.join(", "),
    }
}

impl Diagnostic {
    /// Sets what to do about it.
    pub fn hint(&mut self, hint: impl Into<String>) -> &mut Self {
        self.hint = Some(hint.into());
        self
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut() {
        let words: Vec<String> = (1..=30).map(|i| i.to_string()).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        assert_eq!(listed(&words), "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 and 18 more");
        assert_eq!(listed(words.get(..13).unwrap_or_default()), "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13");
    }

    #[test]
    fn an_empty_list_is_told_in_words() {
        let mut said = Diagnostics::default();
        said.unknown(Location::None, "material", "gold", []);
        assert_eq!(
            said.iter().next().and_then(|d| d.hint.clone()),
            Some("the scene defines no materials".into())
        );
    }
}
