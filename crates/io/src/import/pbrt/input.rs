//! The open text and the list of complaints: reads single arguments, says what is wrong with them, finds the next
//! directive after an error.
use durer_core::glam::DVec3;
use durer_scene::{Diagnostic, Diagnostics, Span};

use super::{
    directive::Directive,
    lexer::{Lexer, Token, TokenKind, unescape},
    number::{self, NotNumber},
};

/// An error that was already reported: the caller gives up on the directive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Reported;

/// Where tokens come from and complaints go to.
#[derive(Debug)]
pub(super) struct Input<'a> {
    /// The text being read.
    pub(super) lexer: Lexer,
    /// Complaints.
    pub(super) diagnostics: &'a mut Diagnostics,
}

/// A text argument and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Word {
    /// Without quotes, escapes replaced.
    pub(super) text: String,
    /// With quotes.
    pub(super) at: Span,
}

impl Input<'_> {
    /// Reports an error.
    pub(super) fn error(&mut self, at: Span, message: impl Into<String>) -> &mut Diagnostic {
        self.diagnostics.error(at, message)
    }

    /// True if `token` is a directive's word: then it is not the argument of the one before.
    pub(super) fn is_directive(&self, token: Token) -> bool {
        token.kind == TokenKind::Word && Directive::of(self.lexer.text(token)).is_some()
    }

    /// True if no argument can start here.
    fn ends_arguments(&self, token: Token) -> bool {
        token.kind == TokenKind::End || self.is_directive(token)
    }

    /// What messages call a token.
    pub(super) fn describe(&self, token: Token) -> String {
        let text: String = self.lexer.text(token).chars().take(40).collect();
        match token.kind {
            TokenKind::End => "the end of the file".to_owned(),
            TokenKind::Plain | TokenKind::Escaped => format!("the string {text}"),
            _ => text,
        }
    }

    /// Reports that `token` is not what was expected.
    pub(super) fn unexpected(&mut self, token: Token, expected: &str) -> Reported {
        let at = self.lexer.span(token);
        if token.kind == TokenKind::Unclosed {
            self.error(at, "this string is not closed")
                .hint("a closing quote is missing: strings end on the line they begin on");
        } else {
            let found = self.describe(token);
            self.error(at, format!("expected {expected}, found {found}"));
        }
        Reported
    }

    /// The next token as text; `what` says what it is for.
    pub(super) fn string(&mut self, head: Token, what: &str) -> Result<Word, Reported> {
        let token = self.lexer.peek();
        if token.is_string() {
            self.lexer.next();
            let text = self.unescaped(token)?;
            return Ok(Word { text, at: self.lexer.span(token) });
        }
        if self.ends_arguments(token) {
            let message = format!("{} needs {what} in quotes", self.lexer.text(head));
            self.error(self.lexer.span(head), message);
            return Err(Reported);
        }
        self.lexer.next();
        Err(self.unexpected(token, &format!("{what} in quotes")))
    }

    /// The value of a string token.
    pub(super) fn unescaped(&mut self, token: Token) -> Result<String, Reported> {
        let inside = self.lexer.inside(token);
        if token.kind == TokenKind::Plain {
            return Ok(inside.to_owned());
        }
        unescape(inside).map_err(|(start, end)| {
            let at = self.lexer.range(token.start + 1 + start, token.start + 1 + end);
            let hint = "known are \\b \\f \\n \\r \\t \\\\ \\' \\\"; write paths with / instead of \\";
            self.error(at, "unknown escape in a string").hint(hint);
            Reported
        })
    }

    /// `N` numbers behind the directive `head`.
    pub(super) fn numbers<const N: usize>(&mut self, head: Token) -> Result<[f64; N], Reported> {
        let mut values = [0.0; N];
        let mut end = head.end;
        for (given, value) in values.iter_mut().enumerate() {
            let token = self.lexer.peek();
            if token.kind != TokenKind::Word || self.is_directive(token) {
                if self.ends_arguments(token) || token.kind == TokenKind::Close {
                    let message = format!("{} needs {N} numbers, {given} are given", self.lexer.text(head));
                    self.error(self.lexer.range(head.start, end), message);
                    return Err(Reported);
                }
                self.lexer.next();
                return Err(self.unexpected(token, "a number"));
            }
            self.lexer.next();
            *value = number::float64(self.lexer.text(token))
                .map_err(|why| self.not_number(token, why, "a number"))?;
            end = token.end;
        }
        Ok(values)
    }

    /// Three numbers as a vector.
    pub(super) fn vector(&mut self, head: Token) -> Result<DVec3, Reported> {
        self.numbers::<3>(head).map(DVec3::from_array)
    }

    /// `[` 16 numbers `]`.
    pub(super) fn matrix(&mut self, head: Token) -> Result<[f64; 16], Reported> {
        let open = self.lexer.peek();
        if open.kind != TokenKind::Open {
            let message = format!("{} needs 16 numbers in [ ]", self.lexer.text(head));
            self.error(self.lexer.span(head), message);
            return Err(Reported);
        }
        self.lexer.next();
        let values = self.numbers::<16>(head)?;
        let close = self.lexer.peek();
        if self.ends_arguments(close) {
            self.error(self.lexer.span(open), "this [ is not closed");
            return Err(Reported);
        }
        self.lexer.next();
        if close.kind == TokenKind::Close {
            return Ok(values);
        }
        Err(self.unexpected(close, "] after 16 numbers"))
    }

    /// Reports why a word is no number.
    pub(super) fn not_number(&mut self, token: Token, why: NotNumber, expected: &str) -> Reported {
        let text = self.describe(token);
        let at = self.lexer.span(token);
        match why {
            NotNumber::NoNumber => self.error(at, format!("expected {expected}, found {text}")),
            NotNumber::NotWhole => self
                .error(at, format!("expected {expected}, found {text}"))
                .hint("integers are written without point and exponent"),
            NotNumber::TooLarge => self.error(at, format!("{text} is too large for {expected}")),
        };
        Reported
    }

    /// Skips to the next word that is, or looks like, a directive.
    pub(super) fn resync(&mut self) {
        loop {
            let token = self.lexer.peek();
            let stop = match token.kind {
                TokenKind::End => true,
                TokenKind::Word => self.lexer.text(token).starts_with(|c: char| c.is_ascii_uppercase()),
                _ => false,
            };
            if stop {
                return;
            }
            self.lexer.next();
        }
    }
}
