//! Lines and words of a text that need not be UTF-8, with their places; and cuts at line ends, so that the pieces of a
//! large text can be read at the same time.
use std::ops::Range;

/// Bytes of a piece of text that is read at once. It depends on nothing, so that what is read from a file does not
/// depend on how many threads read it.
pub(crate) const PIECE: usize = 1 << 20;

/// A stretch of a text and where it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part<'t> {
    /// The bytes.
    pub(crate) bytes: &'t [u8],
    /// Offset of the first one in the whole text.
    pub(crate) at: usize,
}

impl<'t> Part<'t> {
    /// All of a text.
    pub(crate) fn whole(bytes: &'t [u8]) -> Self {
        Self { bytes, at: 0 }
    }
    /// Where it is.
    pub(crate) fn range(&self) -> Range<usize> {
        self.at..self.at + self.bytes.len()
    }
    /// The first `len` bytes and the rest.
    pub(crate) fn split(self, len: usize) -> (Self, Self) {
        let (head, tail) = self.bytes.split_at_checked(len).unwrap_or((self.bytes, &[]));
        (Self { bytes: head, at: self.at }, Self { bytes: tail, at: self.at + head.len() })
    }
    /// Without white space at its ends.
    pub(crate) fn trim(self) -> Self {
        let start = self.bytes.trim_ascii_start();
        Self { bytes: start.trim_ascii_end(), at: self.at + self.bytes.len() - start.len() }
    }
    /// Bytes that are no UTF-8 are taken as Latin-1, as old programs wrote it.
    pub(crate) fn text(&self) -> String {
        match std::str::from_utf8(self.bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => self.bytes.iter().map(|&b| char::from(b)).collect(),
        }
    }
    /// For messages: the beginning of the text.
    pub(crate) fn shown(&self) -> String {
        let text = self.text();
        let short: String = text.chars().take(40).map(|c| if c.is_control() { '?' } else { c }).collect();
        if short.len() < text.len() { format!("{short}...") } else { short }
    }
    /// Cut behind line ends into pieces of about [`PIECE`] bytes; `may` says whether a piece may end between the two
    /// stretches given.
    pub(crate) fn pieces(self, may: impl Fn(&[u8], &[u8]) -> bool) -> Vec<Self> {
        let mut pieces = Vec::new();
        let mut rest = self;
        while rest.bytes.len() > PIECE {
            let mut end = PIECE;
            let cut = loop {
                let tail = rest.bytes.get(end..).unwrap_or_default();
                match memchr::memchr(b'\n', tail) {
                    None => break rest.bytes.len(),
                    Some(line) => end += line + 1,
                }
                let (before, after) = rest.split(end);
                if may(before.bytes, after.bytes) {
                    break end;
                }
            };
            let (piece, behind) = rest.split(cut);
            pieces.push(piece);
            rest = behind;
        }
        if !rest.bytes.is_empty() {
            pieces.push(rest);
        }
        pieces
    }
    /// Lines without their ends.
    pub(crate) fn lines(self) -> Lines<'t> {
        Lines { rest: self, continued: false }
    }
    /// Lines of which a `\` at the end takes in the next one; not so in comments (`#`).
    pub(crate) fn continued_lines(self) -> Lines<'t> {
        Lines { rest: self, continued: true }
    }
    /// Words between white space. A `\` at a line's end is white space.
    pub(crate) fn words(self) -> Words<'t> {
        Words { rest: self }
    }
}

/// True if the line that ends `before` goes on behind it.
pub(crate) fn is_continued(before: &[u8]) -> bool {
    matches!(before, [.., b'\\', b'\n'] | [.., b'\\', b'\r', b'\n'])
}

/// See [`Part::lines`].
#[derive(Clone, Debug)]
pub(crate) struct Lines<'t> {
    rest: Part<'t>,
    continued: bool,
}

impl<'t> Iterator for Lines<'t> {
    type Item = Part<'t>;
    #[inline]
    fn next(&mut self) -> Option<Part<'t>> {
        if self.rest.bytes.is_empty() {
            return None;
        }
        let mut end = 0;
        loop {
            let tail = self.rest.bytes.get(end..).unwrap_or_default();
            match memchr::memchr(b'\n', tail) {
                None => end = self.rest.bytes.len(),
                Some(line) => {
                    end += line + 1;
                    let so_far = self.rest.bytes.get(..end).unwrap_or_default();
                    if self.continued && is_continued(so_far) && !is_comment(so_far) {
                        continue;
                    }
                }
            }
            let (line, rest) = self.rest.split(end);
            self.rest = rest;
            let bytes = line.bytes.strip_suffix(b"\n").unwrap_or(line.bytes);
            return Some(Part { bytes, at: line.at });
        }
    }
}

fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start().first() == Some(&b'#')
}

/// See [`Part::words`].
#[derive(Clone, Debug)]
pub(crate) struct Words<'t> {
    rest: Part<'t>,
}

impl<'t> Words<'t> {
    /// All that was not taken yet.
    pub(crate) fn rest(&self) -> Part<'t> {
        self.rest
    }
    /// What `read` makes of the beginning of the next word, which must be all of it: `read` says how many bytes it took.
    /// PERF: `cargo xtask bench load`; unlike [`Iterator::next`] it looks at each byte once.
    #[inline]
    pub(crate) fn leading<T>(&mut self, read: impl FnOnce(&[u8]) -> Option<(T, usize)>) -> Option<T> {
        let mut bytes = self.rest.bytes;
        while let [b' ' | b'\t', behind @ ..] = bytes {
            bytes = behind;
        }
        let (value, len) = read(bytes)?;
        let taken = self.rest.bytes.len() - bytes.len() + len;
        self.rest = self.rest.split(taken).1;
        Some(value)
    }
}

fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c)
}

impl<'t> Iterator for Words<'t> {
    type Item = Part<'t>;
    #[inline]
    fn next(&mut self) -> Option<Part<'t>> {
        loop {
            let bytes = self.rest.bytes;
            let skip = bytes.iter().position(|&b| !is_space(b))?;
            let (_, from) = self.rest.split(skip);
            let len = from.bytes.iter().position(|&b| is_space(b)).unwrap_or(from.bytes.len());
            let (word, rest) = from.split(len);
            self.rest = rest;
            let at_end = matches!(rest.bytes, [b'\n', ..] | [b'\r', b'\n', ..]);
            match word.bytes.strip_suffix(b"\\") {
                Some([]) if at_end => {}
                Some(bytes) if at_end => return Some(Part { bytes, at: word.at }),
                _ => return Some(word),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        Part::whole(text.as_bytes()).words().map(|w| w.text()).collect()
    }

    #[test]
    fn a_backslash_at_the_end_joins_lines_but_not_comments() {
        let text = b"f 1 \\\r\n2\\\n3\n# C:\\\nv 1\\2\n";
        let lines: Vec<_> = Part::whole(text).continued_lines().map(|l| l.text()).collect();
        assert_eq!(lines, ["f 1 \\\r\n2\\\n3", "# C:\\", "v 1\\2"]);
        assert_eq!(words("f 1 \\\r\n2\\\n3"), ["f", "1", "2", "3"]);
        assert_eq!(words("map_Kd a\\b.png"), ["map_Kd", "a\\b.png"]);
    }

    #[test]
    fn pieces_end_at_lines_and_lose_nothing() {
        let line = "v 1 2 3\n";
        let text = line.repeat(PIECE / line.len() * 2 + 100);
        let pieces = Part::whole(text.as_bytes()).pieces(|_, _| true);
        assert_eq!(pieces.len(), 3);
        assert!(pieces.iter().all(|p| p.bytes.ends_with(b"\n") && p.bytes.starts_with(b"v ")));
        assert_eq!(pieces.iter().map(|p| p.bytes.len()).sum::<usize>(), text.len());
        assert_eq!(Part::whole(text.as_bytes()).pieces(|_, _| false).len(), 1);
    }

    #[test]
    fn names_in_latin_1_survive() {
        assert_eq!(Part::whole(b"K\xf6rper").text(), "Körper");
        assert_eq!(Part::whole("Körper".as_bytes()).text(), "Körper");
    }
}
