//! Complaints about stretches of a text, collected by several threads, and told with the text once all is read.
use std::{collections::HashMap, ops::Range, sync::Arc};

use durer_scene::{Diagnostics, Location, Severity, Span};

use crate::import::Imported;

/// Something wrong with a stretch of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Complaint {
    /// How bad it is.
    pub(crate) severity: Severity,
    /// Which bytes; `None` for the whole file.
    pub(crate) at: Option<Range<usize>>,
    /// What is wrong and what was expected.
    pub(crate) message: String,
    /// What to do.
    pub(crate) hint: Option<String>,
}

impl Complaint {
    /// An error about some bytes.
    pub(crate) fn error(at: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Error, at: Some(at), message: message.into(), hint: None }
    }
    /// An error about the whole file.
    pub(crate) fn whole(message: impl Into<String>) -> Self {
        Self { severity: Severity::Error, at: None, message: message.into(), hint: None }
    }
    /// The same as a warning.
    pub(crate) fn warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }
    /// With what to do.
    pub(crate) fn hint(self, hint: impl Into<String>) -> Self {
        Self { hint: Some(hint.into()), ..self }
    }
    /// In one line, for those who have no text to show: with the line's number in `text`.
    pub(crate) fn line(&self, text: &[u8]) -> String {
        match &self.at {
            Some(at) => format!("line {}: {}", line_number(text, at.start), self.message),
            None => self.message.clone(),
        }
    }
}

fn line_number(text: &[u8], offset: usize) -> usize {
    memchr::memchr_iter(b'\n', text.get(..offset).unwrap_or(text)).count() + 1
}

/// How often something happened, and where first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tally {
    /// How often.
    pub(crate) count: usize,
    first: Option<Range<usize>>,
}

impl Tally {
    /// Once more.
    pub(crate) fn add(&mut self, at: Range<usize>) {
        self.count += 1;
        self.first.get_or_insert(at);
    }
    /// Counts what came later in the file.
    pub(crate) fn append(&mut self, later: Self) {
        self.count += later.count;
        self.first = self.first.take().or(later.first);
    }
    /// A warning if it ever happened.
    pub(crate) fn warn(self, message: impl FnOnce(usize) -> String) -> Option<Complaint> {
        (self.count > 0).then(|| Complaint {
            severity: Severity::Warning,
            at: self.first,
            message: message(self.count),
            hint: None,
        })
    }
}

/// Errors that differ only in numbers and quoted words become one: the first, with how many there are.
pub(crate) fn grouped(complaints: Vec<Complaint>) -> Vec<Complaint> {
    let mut kinds: HashMap<String, (usize, usize)> = HashMap::new();
    let mut kept: Vec<Complaint> = Vec::new();
    for complaint in complaints {
        if complaint.severity == Severity::Error {
            let first = kinds.entry(kind(&complaint.message)).or_insert((kept.len(), 0));
            first.1 += 1;
            if first.1 > 1 {
                continue;
            }
        }
        kept.push(complaint);
    }
    for (first, count) in kinds.into_values().filter(|(_, count)| *count > 1) {
        if let Some(complaint) = kept.get_mut(first) {
            complaint.message += &format!(" (the first of {count} such errors)");
        }
    }
    kept
}

/// The message without numbers and quoted words.
fn kind(message: &str) -> String {
    let outside = message.split('"').step_by(2);
    outside.flat_map(str::chars).filter(|c| !c.is_ascii_digit() && *c != '-').collect()
}

/// Tells the complaints about the file `name` with this `text`, of which a copy is kept only if one of them points into
/// it.
pub(crate) fn tell(complaints: Vec<Complaint>, name: &str, text: &[u8], imported: &mut Imported) {
    let fits = u32::try_from(text.len()).is_ok_and(|len| len < u32::MAX - 4);
    let pointed = fits && complaints.iter().any(|c| c.at.is_some());
    let source = pointed.then(|| imported.sources.add(name, readable(text)));
    for complaint in complaints {
        if complaint.severity == Severity::Error && imported.diagnostics.is_full() {
            continue;
        }
        let (location, message) = match (&complaint.at, source) {
            (Some(at), Some(source)) => {
                let (start, end) = (at.start as u32, at.end as u32);
                (Location::Span(Span { source, start, end }), complaint.message)
            }
            _ => (Location::None, format!("{name}: {}", complaint.line(text))),
        };
        put(&mut imported.diagnostics, complaint.severity, location, message, complaint.hint);
    }
}

fn put(list: &mut Diagnostics, severity: Severity, at: Location, message: String, hint: Option<String>) {
    let said = match severity {
        Severity::Error => list.error(at, message),
        Severity::Warning => list.warning(at, message),
        Severity::Note => list.note(at, message),
    };
    said.hint = hint;
}

/// The text with as many bytes: those that are no UTF-8 become question marks.
fn readable(text: &[u8]) -> Arc<str> {
    match std::str::from_utf8(text) {
        Ok(text) => text.into(),
        Err(_) => {
            text.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '?' }).collect::<String>().into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_one_kind_are_told_once() {
        let error = |at, message: &str| Complaint::error(at..at + 1, message);
        let all = vec![
            error(1, "there is no vertex 12: the file has 8"),
            error(2, "there is no vertex 9: the file has 8"),
            error(3, "\"a\" is not a number"),
            error(4, "\"b\" is not a number").warning(),
            error(5, "\"c\" is not a number").warning(),
        ];
        let told = grouped(all);
        let messages: Vec<&str> = told.iter().map(|c| c.message.as_str()).collect();
        let expected = [
            "there is no vertex 12: the file has 8 (the first of 2 such errors)",
            "\"a\" is not a number",
            "\"b\" is not a number",
            "\"c\" is not a number",
        ];
        assert_eq!(messages, expected);
        assert_eq!(told.first().and_then(|c| c.at.clone()), Some(1..2));
    }
}
