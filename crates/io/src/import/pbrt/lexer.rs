//! Bytes to tokens: words, quoted strings and brackets, each with its byte range.
//!
//! Lexical rules of pbrt-v4 (pbrt.org/fileformat-v4, "File format"): blanks separate, `#` comments to the end of the
//! line, strings stay on one line. Numbers are words until somebody asks for one. `#` also ends a word, which pbrt
//! leaves open. PERF: one pass over bytes, nothing is copied.
use std::sync::Arc;

use durer_scene::{SourceId, Span};

use super::bulk::{self, Listed};

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A directive, number or truth value.
    Word,
    /// A quoted string without backslash.
    Plain,
    /// A quoted string with at least one backslash.
    Escaped,
    /// A quote without its closing one on the same line; the token ends with the line.
    Unclosed,
    /// `[`
    Open,
    /// `]`
    Close,
    /// End of the text.
    End,
}

/// A stretch of text. Quotes belong to their string.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    /// What it is.
    pub(super) kind: TokenKind,
    /// Offset of its first byte.
    pub(super) start: usize,
    /// Offset behind its last byte.
    pub(super) end: usize,
}

impl Token {
    /// True for closed strings.
    pub(super) fn is_string(self) -> bool {
        matches!(self.kind, TokenKind::Plain | TokenKind::Escaped)
    }
}

/// A place in a text from which tokens are read.
#[derive(Clone, Debug)]
pub(super) struct Lexer {
    text: Arc<str>,
    source: SourceId,
    at: usize,
    peeked: Option<Token>,
}

impl Lexer {
    /// At the beginning of `text`, behind a byte order mark if there is one.
    pub(super) fn new(source: SourceId, text: Arc<str>) -> Self {
        let at = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        Self { text, source, at, peeked: None }
    }

    /// The next token, left in place.
    pub(super) fn peek(&mut self) -> Token {
        if let Some(token) = self.peeked {
            return token;
        }
        let token = self.scan();
        self.peeked = Some(token);
        token
    }

    /// The next token.
    pub(super) fn next(&mut self) -> Token {
        match self.peeked.take() {
            Some(token) => token,
            None => self.scan(),
        }
    }

    /// Takes the numbers that stand next, as far as they are plain.
    pub(super) fn numbers<T: Listed>(&mut self, values: &mut Vec<T>) {
        let from = self.peeked.take().map_or(self.at, |token| token.start);
        self.at = from + bulk::numbers(self.text.as_bytes().get(from..).unwrap_or_default(), values);
    }

    /// The characters of a token, quotes included.
    pub(super) fn text(&self, token: Token) -> &str {
        self.text.get(token.start..token.end).unwrap_or("")
    }

    /// The characters between the quotes of a string, escapes untouched.
    pub(super) fn inside(&self, token: Token) -> &str {
        self.text.get(token.start + 1..token.end.saturating_sub(1)).unwrap_or("")
    }

    /// Where a token is.
    pub(super) fn span(&self, token: Token) -> Span {
        self.range(token.start, token.end)
    }

    /// Where bytes `start..end` are.
    pub(super) fn range(&self, start: usize, end: usize) -> Span {
        Span { source: self.source, start: start as u32, end: end as u32 }
    }

    fn scan(&mut self) -> Token {
        let bytes = self.text.as_bytes();
        let mut at = self.at;
        let first = loop {
            match bytes.get(at) {
                None => {
                    self.at = at;
                    return Token { kind: TokenKind::End, start: at, end: at };
                }
                Some(b' ' | b'\n' | b'\t' | b'\r') => at += 1,
                Some(b'#') => at = skip_comment(bytes, at),
                Some(&b) => break b,
            }
        };
        let start = at;
        let (kind, end) = match first {
            b'[' => (TokenKind::Open, at + 1),
            b']' => (TokenKind::Close, at + 1),
            b'"' => scan_string(bytes, at),
            _ => (TokenKind::Word, scan_word(bytes, at)),
        };
        self.at = end;
        Token { kind, start, end }
    }
}

fn skip_comment(bytes: &[u8], at: usize) -> usize {
    let rest = bytes.get(at..).unwrap_or(&[]);
    rest.iter().position(|b| matches!(b, b'\n' | b'\r')).map_or(bytes.len(), |n| at + n)
}

pub(super) fn scan_word(bytes: &[u8], at: usize) -> usize {
    let rest = bytes.get(at..).unwrap_or(&[]);
    let ends = |b: &u8| matches!(b, b' ' | b'\n' | b'\t' | b'\r' | b'"' | b'[' | b']' | b'#');
    rest.iter().position(ends).map_or(bytes.len(), |n| at + n)
}

fn scan_string(bytes: &[u8], start: usize) -> (TokenKind, usize) {
    let mut kind = TokenKind::Plain;
    let mut at = start + 1;
    loop {
        match bytes.get(at) {
            None | Some(b'\n' | b'\r') => return (TokenKind::Unclosed, at.min(bytes.len())),
            Some(b'"') => return (kind, at + 1),
            Some(b'\\') => {
                kind = TokenKind::Escaped;
                // The escaped byte may be a quote; a line end still ends the string.
                at += if matches!(bytes.get(at + 1), None | Some(b'\n' | b'\r')) { 1 } else { 2 };
            }
            Some(_) => at += 1,
        }
    }
}

/// Replaces the escapes of pbrt: `\b \f \n \r \t \\ \' \"`.
///
/// # Errors
/// Byte range, within `inside`, of an escape that is none of these.
pub(super) fn unescape(inside: &str) -> Result<String, (usize, usize)> {
    let mut out = String::with_capacity(inside.len());
    let mut chars = inside.char_indices();
    while let Some((at, c)) = chars.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        out.push(match chars.next() {
            Some((_, 'b')) => '\u{8}',
            Some((_, 'f')) => '\u{c}',
            Some((_, 'n')) => '\n',
            Some((_, 'r')) => '\r',
            Some((_, 't')) => '\t',
            Some((_, c @ ('\\' | '\'' | '"'))) => c,
            Some((next, c)) => return Err((at, next + c.len_utf8())),
            None => return Err((at, at + 1)),
        });
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<(TokenKind, String)> {
        let mut lexer = Lexer::new(SourceId(0), Arc::from(text));
        let mut found = Vec::new();
        loop {
            let token = lexer.next();
            if token.kind == TokenKind::End {
                return found;
            }
            found.push((token.kind, lexer.text(token).to_owned()));
        }
    }

    #[test]
    fn blanks_comments_and_line_ends_separate() {
        use TokenKind::*;
        let words = tokens("\u{feff}Shape\t\"a b\"[1.# ü ]\r\n-2e+3]# end");
        let expected =
            [(Word, "Shape"), (Plain, "\"a b\""), (Open, "["), (Word, "1."), (Word, "-2e+3"), (Close, "]")];
        assert_eq!(words, expected.map(|(k, t)| (k, t.to_owned())));
    }

    #[test]
    fn strings_end_with_their_line() {
        use TokenKind::*;
        let words = tokens("\"open\nnext \"a\\\"b\" \"x\\\n\"");
        let expected = [
            (Unclosed, "\"open"),
            (Word, "next"),
            (Escaped, "\"a\\\"b\""),
            (Unclosed, "\"x\\"),
            (Unclosed, "\""),
        ];
        assert_eq!(words, expected.map(|(k, t)| (k, t.to_owned())));
    }

    #[test]
    fn escapes_are_those_of_pbrt() {
        assert_eq!(unescape(r#"a\n\t\\\"\'b"#), Ok("a\n\t\\\"'b".to_owned()));
        assert_eq!(unescape(r"tex\qü"), Err((3, 5)));
        assert_eq!(unescape("end\\"), Err((3, 4)));
    }
}
