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
        self.list.push(Diagnostic { severity, at, message: shortened(message), hint: None });
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
        self.hint = Some(shortened(hint.into()));
        self
    }
}

/// Bytes of a message that is told as it is.
const SHORT: usize = 400;
/// Characters of a quoted word or of a path that a longer message keeps.
const KEPT: (usize, usize) = (40, 160);
/// Characters of the longest message.
const LONGEST: usize = 2000;

/// A message in which the words that a file had too many letters for are cut: quoted ones to 40 characters, others to
/// 160, and all of it to 2000.
fn shortened(message: String) -> String {
    if message.len() <= SHORT {
        return message;
    }
    let mut short = String::new();
    let (mut quoted, mut run, mut cut) = (false, 0, 0);
    for c in message.chars().take(1 << 20) {
        if c == '"' || (c.is_whitespace() && !quoted) {
            quoted ^= c == '"';
            (run, cut) = (0, 0);
        } else {
            run += 1;
            if run > if quoted { KEPT.0 } else { KEPT.1 } {
                cut += 1;
                if cut == 1 {
                    short.push_str("...");
                }
                continue;
            }
        }
        short.push(c);
    }
    match short.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", short.get(..end).unwrap_or_default()),
        None => short,
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
#[allow(clippy::indexing_slicing, reason = "a test that fails may panic")]
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

    #[test]
    fn words_that_fill_books_are_cut_and_what_follows_them_is_kept() {
        let long = "a".repeat(1 << 18);
        let mut list = Diagnostics::default();
        list.unknown(Location::None, "shape", &long, ["sphere"]);
        list.error(Location::None, format!("{long}.png: file not found"));
        list.error(Location::None, "one word ".repeat(1000)).hint(&long);
        list.error(Location::None, format!("expected \"b\", found \"{}\", here", "c d".repeat(999)));
        let said: Vec<&str> = list.iter().map(|d| d.message.as_str()).collect();
        assert_eq!(said[0], format!("unknown shape \"{}...\"", &long[..40]));
        assert_eq!(said[1], format!("{}... file not found", &long[..160]));
        assert_eq!(said[2].len(), LONGEST + 3);
        assert_eq!(said[3], format!("expected \"b\", found \"{}...\", here", &"c d".repeat(14)[..40]));
        assert_eq!(list.list[2].hint.as_ref().map(String::len), Some(163));
        let path = "b".repeat(300);
        list.error(Location::None, format!("{path}: file not found"));
        assert_eq!(list.list[4].message, format!("{path}: file not found"));
    }
}
