//! Exit status and the two streams.
use std::{
    borrow::Cow,
    fmt,
    io::{self, Write},
    process::ExitCode,
};

/// What the shell is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Done.
    Done = 0,
    /// Bad scene, unwritable file.
    Failed = 1,
    /// Wrong usage.
    Usage = 2,
    /// Interrupted from the keyboard.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

impl Exit {
    /// Prints an error and says what it amounts to.
    pub(crate) fn of_error(error: &anyhow::Error) -> Self {
        // The reader of our output has seen enough, as in `durer scenes | head -1`.
        let broken = |e: &io::Error| e.kind() == io::ErrorKind::BrokenPipe;
        if error.chain().any(|e| e.downcast_ref().is_some_and(broken)) {
            return Self::Done;
        }
        tell(&format!("error: {error:#}"));
        if error.is::<WrongUsage>() { Self::Usage } else { Self::Failed }
    }
}

/// An error that is the command line's fault.
#[derive(Debug)]
pub(crate) struct WrongUsage(pub(crate) String);

impl fmt::Display for WrongUsage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for WrongUsage {}

/// A line, or several, to stderr. Nothing can be done if that is closed.
pub(crate) fn tell(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// A text without what would command a terminal: names and words of a scene file may hold anything. Each control
/// character becomes as many question marks as it has bytes, so that places in the text stay what they are.
pub(crate) fn harmless(text: &str) -> Cow<'_, str> {
    let commands = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    if !text.contains(commands) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match commands(c) {
            true => shown.extend(std::iter::repeat_n('?', c.len_utf8())),
            false => shown.push(c),
        }
    }
    Cow::Owned(shown)
}

/// Results to stdout.
pub(crate) fn emit(text: &str) -> anyhow::Result<()> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    Ok(stdout.flush()?)
}

/// A result to stdout as JSON.
pub(crate) fn emit_json(value: &impl serde::Serialize) -> anyhow::Result<()> {
    emit(&format!("{}\n", serde_json::to_string_pretty(value)?))
}
