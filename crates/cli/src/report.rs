//! What is wrong with a scene, and where: the text with carets under it, or a path in a file without lines.
use std::{borrow::Cow, io::IsTerminal, ops::Range};

use anstyle::{AnsiColor, Style};
use durer::{
    Imported,
    scene::{Diagnostic, Diagnostics, Location, Severity, Sources, Span},
};
use serde::Serialize;

use crate::{
    exit::{harmless, tell},
    options::TalkOptions,
};

impl TalkOptions {
    /// The least severe complaints that are said.
    fn least(&self) -> Severity {
        match (self.quiet, self.verbose) {
            (true, _) => Severity::Error,
            (_, true) => Severity::Note,
            _ => Severity::Warning,
        }
    }
}

/// Complaints about `scene` to stderr, and how many errors there were.
pub(crate) fn print(scene: &str, imported: &Imported, talk: &TalkOptions) {
    let stderr = std::io::stderr().is_terminal();
    let looks = Looks { terminal: stderr, color: stderr && std::env::var_os("NO_COLOR").is_none() };
    let text = render(scene, imported, talk.least(), looks);
    if !text.is_empty() {
        tell(text.trim_end());
    }
    match imported.diagnostics.error_count() {
        0 => {}
        1 => tell("1 error"),
        n if n >= Diagnostics::MOST_ERRORS => tell(&format!("{n} errors; there may be more")),
        n => tell(&format!("{n} errors")),
    }
}

/// Whom the text is for.
#[derive(Clone, Copy)]
pub(crate) struct Looks {
    /// Box-drawing characters; else ASCII, with carets.
    pub(crate) terminal: bool,
    pub(crate) color: bool,
}

impl Looks {
    /// Something that a program may read.
    pub(crate) const PLAIN: Self = Self { terminal: false, color: false };
}

/// All complaints that are at least this severe.
pub(crate) fn render(scene: &str, imported: &Imported, least: Severity, looks: Looks) -> String {
    let mut said: Vec<_> = imported.diagnostics.iter().filter(|d| d.severity >= least).collect();
    // The errors last: they are what is left on the screen.
    said.sort_by_key(|d| d.severity == Severity::Error);
    said.into_iter().map(|d| one(scene, d, &imported.sources, looks)).collect()
}

fn one(scene: &str, diagnostic: &Diagnostic, sources: &Sources, looks: Looks) -> String {
    let Diagnostic { severity, at, message, hint } = diagnostic;
    let header = header(*severity, looks);
    let (message, hint) = (harmless(message), hint.as_deref().map(harmless));
    let place = match at {
        Location::Span(span) => match excerpt(*severity, *span, sources, looks) {
            Some(excerpt) => return format!("{header} {message}\n{excerpt}{}", help(hint.as_deref())),
            None => sources.name(span.source).to_owned(),
        },
        Location::Path { file, pointer } if pointer.is_empty() => file.clone(),
        Location::Path { file, pointer } => format!("{file}: {pointer}"),
        // What is wrong with the whole scene is the file's fault.
        Location::None if *severity == Severity::Error && !message.contains(scene) => scene.to_owned(),
        Location::None => String::new(),
    };
    // Messages about a whole file begin with its name already.
    let place = match place.is_empty() || message.starts_with(&place) {
        true => String::new(),
        false => format!("{}: ", harmless(&place)),
    };
    format!("{header} {place}{message}\n{}", help(hint.as_deref()))
}

/// What to do, as everywhere on a line of its own.
fn help(hint: Option<&str>) -> String {
    hint.map(|hint| format!("  help: {hint}\n")).unwrap_or_default()
}

fn header(severity: Severity, looks: Looks) -> String {
    let word = match severity {
        Severity::Error => "error:",
        Severity::Warning => "warning:",
        Severity::Note => "note:",
    };
    painted(word, severity, looks)
}

/// `text` in the colour of a severity.
fn painted(text: &str, severity: Severity, looks: Looks) -> String {
    let color = match severity {
        Severity::Error => AnsiColor::Red,
        Severity::Warning => AnsiColor::Yellow,
        Severity::Note => AnsiColor::Blue,
    };
    let style = if looks.color { color.on_default().bold() } else { Style::new() };
    format!("{style}{text}{style:#}")
}

/// File, line and column, and the line with a mark below; `None` if the span lies in no text.
fn excerpt(severity: Severity, span: Span, sources: &Sources, looks: Looks) -> Option<String> {
    let (line, mark) = line_with_mark(sources.text(span.source), span)?;
    let (number, column) = sources.line_column(span.source, span.start);
    let name = harmless(sources.name(span.source));
    let (line, before) = (harmless(&line), line.get(..mark.start)?.to_owned());
    let number = number.to_string();
    let margin = " ".repeat(number.len() + 1);
    let bar = if looks.terminal { '│' } else { '|' };
    // Tabs stay tabs, so that the mark stands under what it marks however wide they are.
    let blank: String = before.chars().map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
    let marks = "^".repeat(line.get(mark)?.chars().count());
    let marks = painted(&marks, severity, looks);
    let line = line.trim_end();
    Some(format!(
        "{margin}--> {name}:{number}:{column}\n {number} {bar} {line}\n{margin} {bar} {blank}{marks}\n"
    ))
}

/// The line in which a span begins, and the bytes of it to mark: at least one character, ends between characters. Long
/// lines are cut around the mark: scenes may have millions of numbers in one.
fn line_with_mark(text: &str, span: Span) -> Option<(Cow<'_, str>, Range<usize>)> {
    const AROUND: usize = 100;
    let last = text.char_indices().next_back()?.0;
    let start = text.floor_char_boundary(span.start as usize).min(last);
    let next = start + text.get(start..)?.chars().next()?.len_utf8();
    let from = text.get(..start)?.rfind('\n').map_or(0, |at| at + 1);
    let to = text.get(next..)?.find('\n').map_or(text.len(), |at| next + at);
    let end = text.ceil_char_boundary(span.end as usize).clamp(next, to.max(next)).min(start + AROUND);
    let end = text.ceil_char_boundary(end).max(next);
    let first = text.ceil_char_boundary(from.max(start.saturating_sub(AROUND)));
    let stop = text.floor_char_boundary(to.max(end).min(end + AROUND));
    let piece = text.get(first..stop)?;
    if first == from && stop == to.max(end) {
        return Some((Cow::Borrowed(piece), start - first..end - first));
    }
    let before = if first == from { "" } else { "... " };
    let after = if stop == to.max(end) { "" } else { " ..." };
    let mark = before.len() + start - first..before.len() + end - first;
    Some((Cow::Owned(format!("{before}{piece}{after}")), mark))
}

/// A complaint in JSON.
#[derive(Serialize)]
pub(crate) struct Complaint<'a> {
    severity: Severity,
    message: &'a str,
    hint: Option<&'a str>,
    file: Option<&'a str>,
    line: Option<usize>,
    column: Option<usize>,
    pointer: Option<&'a str>,
}

impl<'a> Complaint<'a> {
    fn new(diagnostic: &'a Diagnostic, sources: &'a Sources) -> Self {
        let Diagnostic { severity, at, message, hint } = diagnostic;
        let (mut file, mut place, mut pointer) = (None, None, None);
        match at {
            Location::None => {}
            Location::Span(span) => {
                file = Some(sources.name(span.source));
                place = Some(sources.line_column(span.source, span.start));
            }
            Location::Path { file: name, pointer: path } => {
                file = Some(name.as_str());
                pointer = Some(path.as_str());
            }
        }
        let (line, column) = place.unzip();
        Self { severity: *severity, message, hint: hint.as_deref(), file, line, column, pointer }
    }

    /// All complaints about a scene.
    pub(crate) fn all(imported: &'a Imported) -> Vec<Self> {
        imported.diagnostics.iter().map(|d| Self::new(d, &imported.sources)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, start: usize, end: usize) -> (String, String) {
        let source = durer::scene::SourceId(0);
        let span = Span { source, start: start as u32, end: end as u32 };
        let (line, mark) = line_with_mark(text, span).expect("the span lies in the text");
        (line.to_string(), line[mark].to_owned())
    }

    #[test]
    fn a_short_line_is_shown_whole() {
        assert_eq!(shown("one\ntwo three\nfour", 8, 13), ("two three".into(), "three".into()));
        assert_eq!(shown("end", 3, 3), ("end".into(), "d".into()));
        assert_eq!(
            shown("a \"b\nc\" d", 2, 6),
            ("a \"b".into(), "\"b".into()),
            "only the first line of a span"
        );
    }

    #[test]
    fn a_long_line_is_cut_around_the_mark() {
        let text = format!("{}\u{e9}oops {}", "1 ".repeat(1_000_000), "2 ".repeat(1_000_000));
        let (line, mark) = shown(&text, 2_000_000, 2_000_006);
        assert_eq!(mark, "\u{e9}oops");
        assert!(line.starts_with("... ") && line.ends_with(" ...") && line.len() < 300, "{line}");
        let (line, mark) = shown(&"x".repeat(1 << 20), 5, 1 << 20);
        assert!(mark.len() == 100 && line.len() < 400 && !line.starts_with("..."));
    }
}
