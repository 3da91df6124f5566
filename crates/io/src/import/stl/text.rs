//! STL as text: `solid NAME`, then `facet normal x y z`, `outer loop`, three times `vertex x y z`, `endloop`,
//! `endfacet`, and at last `endsolid NAME`; as often as there are bodies. Words may be in either case.
//!
//! The text is cut before facets, so that several threads can read it.
use rayon::prelude::*;

use super::{Solid, check};
use crate::import::text::{Complaint, Part, Words, float, leading_float};

/// True if a file that does not have the length of a binary one is text.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let head = start.get(..start.len().min(512)).unwrap_or_default();
    begins(head, b"solid") && !head.contains(&0)
}

fn begins(text: &[u8], word: &[u8]) -> bool {
    text.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word))
}

/// True if a line that begins a facet follows.
fn before_facet(after: &[u8]) -> bool {
    let mut words = Part::whole(after.get(..after.len().min(256)).unwrap_or_default()).words();
    let mut is = |word: &[u8]| words.next().is_some_and(|w| w.bytes.eq_ignore_ascii_case(word));
    is(b"facet") && is(b"normal")
}

/// What a piece of the text holds: triangles that belong to the body that was open before, then bodies.
#[derive(Default)]
struct Piece {
    solids: Vec<Solid>,
}

/// Reads all bodies.
pub(super) fn read(bytes: &[u8], warnings: &mut Vec<Complaint>) -> Result<Vec<Solid>, Complaint> {
    let pieces = Part::whole(bytes).pieces(|_, after| before_facet(after));
    let last = pieces.len().saturating_sub(1);
    let read: Vec<_> =
        pieces.par_iter().enumerate().map(|(i, piece)| Reader::new(*piece, i == last).read()).collect();
    let mut solids: Vec<Solid> = Vec::new();
    for piece in read {
        let mut found = piece?.solids.into_iter();
        if let (Some(first), Some(open)) = (found.next(), solids.last_mut()) {
            open.triangles.extend(first.triangles);
        }
        solids.extend(found);
    }
    // The first one is what came before any "solid".
    if solids.first().is_some_and(|s| s.triangles.is_empty()) {
        solids.remove(0);
    }
    if !has_end(bytes) {
        let at = bytes.len().saturating_sub(1)..bytes.len();
        warnings
            .push(Complaint::error(at, "\"endsolid\" is missing: the file may have been cut off").warning());
    }
    Ok(solids)
}

fn has_end(bytes: &[u8]) -> bool {
    let tail = bytes.get(bytes.len().saturating_sub(1024)..).unwrap_or_default();
    tail.to_ascii_lowercase().windows(8).any(|w| w == b"endsolid")
}

struct Reader<'t> {
    words: Words<'t>,
    end: usize,
    solids: Vec<Solid>,
    last: bool,
    /// The text has no line ends.
    one_line: bool,
}

impl<'t> Reader<'t> {
    fn new(piece: Part<'t>, last: bool) -> Self {
        let one_line = memchr::memchr(b'\n', piece.bytes.trim_ascii()).is_none();
        Self { words: piece.words(), end: piece.range().end, solids: vec![Solid::default()], last, one_line }
    }

    fn read(mut self) -> Result<Piece, Complaint> {
        while let Some(word) = self.words.next() {
            match word.bytes.to_ascii_lowercase().as_slice() {
                b"solid" => {
                    let name = self.rest_of_line(|word, next| {
                        word == b"endsolid" || (word == b"facet" && next == b"normal")
                    });
                    self.solids.push(Solid { name, triangles: Vec::new() });
                }
                b"endsolid" => drop(self.rest_of_line(|word, _| word == b"solid")),
                b"facet" => self.facet()?,
                _ => return Err(unexpected(word, "\"facet\" or \"endsolid\"")),
            }
        }
        Ok(Piece { solids: self.solids })
    }

    /// A name: all up to the line's end. Where the rest of the file stands in the same line, it ends before the first
    /// word that `ends` it together with the next.
    fn rest_of_line(&mut self, ends: impl Fn(&[u8], &[u8]) -> bool) -> String {
        let rest = self.words.rest();
        let line = rest.lines().next().unwrap_or(rest);
        let mut length = line.bytes.len();
        if self.one_line {
            let lower = |word: Option<Part<'_>>| word.map_or(Vec::new(), |w| w.bytes.to_ascii_lowercase());
            let mut words = line.words();
            while let Some(word) = words.next() {
                if ends(&lower(Some(word)), &lower(words.clone().next())) {
                    length = word.at - rest.at;
                    break;
                }
            }
        }
        let (line, behind) = rest.split(length);
        self.words = behind.words();
        line.trim().text()
    }

    fn word(&mut self, expected: &str) -> Result<Part<'t>, Complaint> {
        self.words.next().ok_or_else(|| self.short(expected))
    }

    /// A complaint about an end where something is expected.
    fn short(&self, expected: &str) -> Complaint {
        let at = self.end.saturating_sub(1)..self.end;
        let message = match self.last {
            true => format!("the file ends within a facet: expected {expected}"),
            false => format!("a facet begins within another: expected {expected}"),
        };
        Complaint::error(at, message)
    }

    fn expect(&mut self, wanted: &[&str]) -> Result<(), Complaint> {
        for wanted in wanted {
            let found = self.words.next();
            if found.is_some_and(|word| word.bytes.eq_ignore_ascii_case(wanted.as_bytes())) {
                continue;
            }
            let expected = format!("\"{wanted}\"");
            return Err(found.map_or_else(|| self.short(&expected), |word| unexpected(word, &expected)));
        }
        Ok(())
    }

    fn number(&mut self) -> Result<f32, Complaint> {
        if let Some(value) = self.words.leading(leading_float) {
            return Ok(value);
        }
        let word = self.word("a number")?;
        float(word.bytes).ok_or_else(|| unexpected(word, "a number"))
    }

    /// What follows the word "facet". The normal is not used and may be anything; loops of more than three corners are
    /// not allowed.
    fn facet(&mut self) -> Result<(), Complaint> {
        self.expect(&["normal"])?;
        for _ in 0..3 {
            self.word("a number")?;
        }
        self.expect(&["outer", "loop"])?;
        let start = self.words.rest();
        let mut corners = [[0.0; 3]; 3];
        for corner in &mut corners {
            self.expect(&["vertex"])?;
            for coordinate in corner {
                *coordinate = self.number()?;
            }
        }
        let length = start.bytes.len() - self.words.rest().bytes.len();
        let at = start.split(length).0.trim().range();
        check(&corners).map_err(|message| Complaint::error(at, message))?;
        self.expect(&["endloop", "endfacet"])?;
        if let Some(solid) = self.solids.last_mut() {
            solid.triangles.push(corners);
        }
        Ok(())
    }
}

fn unexpected(word: Part<'_>, expected: &str) -> Complaint {
    Complaint::error(word.range(), format!("expected {expected}, found \"{}\"", word.shown()))
}
