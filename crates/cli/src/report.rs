//! What is wrong with a scene, and where: the text with carets under it, or a path in a file without lines.
use std::{
    borrow::Cow,
    collections::HashMap,
    convert::Infallible,
    fmt::{Debug, Display},
    io::IsTerminal,
    ops::Range,
};

use ariadne::{CharSet, Color, Config, Fmt, IndexType, Label, Report, ReportKind, Source};
use durer::{
    Imported,
    scene::{Diagnostic, Diagnostics, Location, Severity, SourceId, Sources, Span},
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
    let mut texts = Texts { sources: &imported.sources, parsed: HashMap::new() };
    let mut said: Vec<_> = imported.diagnostics.iter().filter(|d| d.severity >= least).collect();
    // The errors last: they are what is left on the screen.
    said.sort_by_key(|d| d.severity == Severity::Error);
    said.into_iter().map(|d| one(scene, d, &mut texts, looks)).collect()
}

fn one(scene: &str, diagnostic: &Diagnostic, texts: &mut Texts<'_>, looks: Looks) -> String {
    let Diagnostic { severity, at, message, hint } = diagnostic;
    let header = header(*severity, looks);
    let (message, hint) = (harmless(message), hint.as_deref().map(harmless));
    let place = match at {
        Location::Span(span) => match excerpt(diagnostic, *span, texts, looks) {
            Some(excerpt) => return format!("{header} {message}\n{excerpt}"),
            None => texts.sources.name(span.source).to_owned(),
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
    let hint = hint.as_ref().map(|h| format!("  help: {h}\n")).unwrap_or_default();
    format!("{header} {place}{message}\n{hint}")
}

fn header(severity: Severity, looks: Looks) -> String {
    let word = match severity {
        Severity::Error => "error:",
        Severity::Warning => "warning:",
        Severity::Note => "note:",
    };
    if looks.color { word.fg(color(severity)).to_string() } else { word.to_owned() }
}

fn color(severity: Severity) -> Color {
    match severity {
        Severity::Error => Color::Red,
        Severity::Warning => Color::Yellow,
        Severity::Note => Color::Blue,
    }
}

/// File, line and column, and the text with a mark below; `None` if the span lies in no text.
fn excerpt(diagnostic: &Diagnostic, span: Span, texts: &mut Texts<'_>, looks: Looks) -> Option<String> {
    let at = (span.source, marked(texts.sources.text(span.source), span)?);
    let config = Config::default()
        .with_color(looks.color)
        .with_char_set(if looks.terminal { CharSet::Unicode } else { CharSet::Ascii })
        .with_index_type(IndexType::Byte);
    let label = Label::new(at.clone()).with_message("here").with_color(color(diagnostic.severity));
    let mut report = Report::build(ReportKind::Error, at).with_config(config).with_label(label);
    if let Some(hint) = &diagnostic.hint {
        report.set_help(harmless(hint));
    }
    let mut bytes = Vec::new();
    report.finish().write(texts, &mut bytes).ok()?;
    // The first line is ariadne's header without message; ours has a colour on terminals only.
    String::from_utf8(bytes).ok()?.split_once('\n').map(|(_, below)| below.to_owned())
}

/// The bytes to mark: at least one character, ends between characters.
fn marked(text: &str, span: Span) -> Option<Range<usize>> {
    let last = text.char_indices().next_back()?.0;
    let start = text.floor_char_boundary(span.start as usize).min(last);
    let next = start + text.get(start..)?.chars().next()?.len_utf8();
    Some(start..text.ceil_char_boundary(span.end as usize).clamp(next, text.len()))
}

/// The source texts, cut into lines when they are needed first.
struct Texts<'a> {
    sources: &'a Sources,
    parsed: HashMap<SourceId, Source<Cow<'a, str>>>,
}

impl<'t> ariadne::Cache<SourceId> for Texts<'t> {
    type Storage = Cow<'t, str>;

    fn fetch(&mut self, id: &SourceId) -> Result<&Source<Cow<'t, str>>, impl Debug> {
        let text = self.sources.text(*id);
        Ok::<_, Infallible>(self.parsed.entry(*id).or_insert_with(|| Source::from(harmless(text))))
    }
    fn display<'a>(&self, id: &'a SourceId) -> Option<impl Display + 'a> {
        Some(self.sources.name(*id).to_owned())
    }
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
