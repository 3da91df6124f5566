//! Statements: a piece of the text to arrays.
use std::ops::Range;

use super::{
    corner::{self, Wrong},
    model::Tallies,
};
use crate::import::{
    color::linear,
    text::{Complaint, Part, Words, float, leading_float},
};
use durer_core::math::{Normal3, Point2, Point3};

/// Numbers of positions, texture coordinates and normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Counts([usize; 3]);

impl Counts {
    pub(super) fn plus(self, o: &Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, o.0);
        Self([a + d, b + e, c + f])
    }
    pub(super) fn exceeds_indices(&self) -> bool {
        self.0.iter().any(|&n| n >= corner::NONE as usize)
    }
}

/// What goes on at a face of a piece.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Event {
    Object(Range<usize>),
    Group(Range<usize>),
    Material(Range<usize>),
    /// 0 is off.
    Smooth(u32),
    Library(Range<usize>),
}

/// What a piece of the text holds.
#[derive(Debug, Default)]
pub(super) struct Piece {
    pub(super) positions: Vec<Point3>,
    /// Empty, or one for each position.
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) uvs: Vec<Point2>,
    pub(super) normals: Vec<Normal3>,
    pub(super) corners: Vec<[u32; 3]>,
    /// Where each face ends in `corners`.
    pub(super) ends: Vec<usize>,
    /// What goes on before a face, in order.
    pub(super) events: Vec<(usize, Event)>,
    pub(super) complaints: Vec<Complaint>,
    pub(super) tallies: Tallies,
    pub(super) unknown: Vec<(String, Range<usize>)>,
}

pub(super) const WHITE: [f32; 4] = [1.0; 4];

/// Curves, surfaces, and what only modelling programs care about.
const FREE_FORM: [&str; 31] = [
    "vp",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "mg",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "usemap",
    "maplib",
    "bsp",
    "bzp",
    "cdc",
    "cdp",
    "res",
];

/// Words we read.
pub(super) const WORDS: [&str; 12] =
    ["v", "vt", "vn", "f", "o", "g", "s", "usemtl", "mtllib", "l", "p", "fo"];

/// Unknown words that are told.
pub(super) const MOST_UNKNOWN: usize = 8;

/// How many vertices a piece holds.
pub(super) fn count(text: Part<'_>) -> Counts {
    let mut counts = [0; 3];
    let [v, vt, vn] = &mut counts;
    for line in text.continued_lines() {
        match line.words().next().map(|w| w.bytes) {
            Some(b"v") => *v += 1,
            Some(b"vt") => *vt += 1,
            Some(b"vn") => *vn += 1,
            _ => {}
        }
    }
    Counts(counts)
}

/// Reads a piece before which stands what `start` counts, of a file with `total`.
pub(super) fn read(text: Part<'_>, start: Counts, total: Counts) -> Piece {
    let mut piece = Piece::default();
    for line in text.continued_lines() {
        let mut words = line.words();
        let Some(word) = words.next() else {
            continue;
        };
        piece.statement(line, word, words, [start, total]);
    }
    piece
}

impl Piece {
    fn statement(&mut self, line: Part<'_>, word: Part<'_>, words: Words<'_>, counts: [Counts; 2]) {
        let rest = words.rest().trim().range();
        let mut words = match word.bytes {
            b"v" | b"vt" | b"vn" | b"f" => without_comment(words),
            _ => words,
        };
        match word.bytes {
            b"v" | b"vt" | b"vn" if words.rest().bytes.trim_ascii_start().is_empty() => {
                self.complaints.push(Complaint::error(line.range(), "expected numbers"));
            }
            b"v" => self.position(line, words),
            b"vt" => {
                let [u, v, _] = self.numbers::<1>(line, &mut words);
                if !(u.is_finite() && v.is_finite()) {
                    self.tallies.bad_uvs.add(line.range());
                }
                self.uvs.push(Point2::new(finite(u), finite(v)));
            }
            b"vn" => {
                let n = self.numbers::<3>(line, &mut words);
                if !n.iter().all(|c| c.is_finite()) {
                    self.tallies.bad_normals.add(line.range());
                }
                self.normals.push(Normal3::from(n.map(finite)));
            }
            b"f" | b"fo" => self.face(line, words, counts),
            b"o" => self.event(Event::Object(rest)),
            b"g" => self.event(Event::Group(rest)),
            b"usemtl" => self.event(Event::Material(rest)),
            b"mtllib" => self.event(Event::Library(rest)),
            b"s" => self.smooth(words),
            b"l" | b"p" => self.tallies.lines.add(line.range()),
            [b'#', ..] => {}
            other if FREE_FORM.iter().any(|w| w.as_bytes() == other) => {
                self.tallies.free_form.add(line.range())
            }
            _ => {
                let text = word.text();
                if self.unknown.len() <= MOST_UNKNOWN && self.unknown.iter().all(|(known, _)| *known != text)
                {
                    self.unknown.push((text, word.range()));
                }
            }
        }
    }

    fn event(&mut self, event: Event) {
        self.events.push((self.ends.len(), event));
    }

    fn smooth(&mut self, mut words: Words<'_>) {
        let group = words.next().map_or(0, |w| match w.bytes {
            b"off" => 0,
            b"on" => 1,
            number => crate::import::text::integer(number).and_then(|n| u32::try_from(n).ok()).unwrap_or(0),
        });
        self.event(Event::Smooth(group));
    }

    /// At least `LEAST` and at most three numbers; 0 for those that are missing.
    fn numbers<const LEAST: usize>(&mut self, line: Part<'_>, words: &mut Words<'_>) -> [f32; 3] {
        let mut values = [0.0; 3];
        for (i, value) in values.iter_mut().enumerate() {
            match self.number(words) {
                Some(number) => *value = number,
                None if i < LEAST => {
                    let message = format!("expected {LEAST} numbers, found {i}");
                    self.complaints.push(Complaint::error(line.range(), message));
                    break;
                }
                None => break,
            }
        }
        values
    }

    /// The next number; 0 after a complaint, `None` if no word is left.
    #[inline]
    fn number(&mut self, words: &mut Words<'_>) -> Option<f32> {
        if let Some(value) = words.leading(leading_float) {
            return Some(value);
        }
        let word = words.next()?;
        Some(float(word.bytes).unwrap_or_else(|| {
            let message = format!("\"{}\" is not a number", word.shown());
            self.complaints.push(Complaint::error(word.range(), message));
            0.0
        }))
    }

    /// Three coordinates, perhaps with a weight, or with a colour (red, green, blue) behind them.
    fn position(&mut self, line: Part<'_>, mut words: Words<'_>) {
        let position = self.numbers::<3>(line, &mut words);
        if !position.iter().all(|c| c.is_finite()) {
            self.complaints.push(Complaint::error(line.range(), "a coordinate is nan or infinite"));
        }
        let mut more = [None; 4];
        for value in &mut more {
            *value = self.number(&mut words);
            if value.is_none() {
                break;
            }
        }
        self.positions.push(Point3::from(position));
        let color = match more {
            [Some(r), Some(g), Some(b), _] => Some([r, g, b].map(|c| linear(finite(c).clamp(0.0, 1.0)))),
            _ => None,
        };
        if color.is_some() || !self.colors.is_empty() {
            self.colors.resize(self.positions.len() - 1, WHITE);
            self.colors.push(color.map_or(WHITE, |[r, g, b]| [r, g, b, 1.0]));
        }
    }

    fn face(&mut self, line: Part<'_>, mut words: Words<'_>, [start, total]: [Counts; 2]) {
        let first = self.corners.len();
        let here = Counts([self.positions.len(), self.uvs.len(), self.normals.len()]);
        let so_far = start.plus(&here).0;
        let mut lost = [0; 2];
        loop {
            if let Some(corner) = words.leading(|text| corner::leading(text, so_far, total.0)) {
                self.corners.push(corner);
                continue;
            }
            let Some(word) = words.next() else { break };
            match corner::resolve(word, so_far, total.0, &mut lost) {
                Ok(corner) => self.corners.push(corner),
                Err(wrong) => {
                    self.complaints.push(complaint(word, wrong, total.0));
                    self.corners.truncate(first);
                    return;
                }
            }
        }
        let [uvs, normals] = lost;
        if uvs > 0 {
            self.tallies.lost_uvs.add(line.range());
        }
        if normals > 0 {
            self.tallies.lost_normals.add(line.range());
        }
        if self.corners.len() < first + 3 {
            self.tallies.poor.add(line.range());
            self.corners.truncate(first);
            return;
        }
        self.make_even(line, first, uvs + normals);
        self.ends.push(self.corners.len());
    }

    /// All corners of a face have texture coordinates, or none; normals likewise.
    fn make_even(&mut self, line: Part<'_>, first: usize, lost: usize) {
        let face = self.corners.get_mut(first..).unwrap_or_default();
        let has =
            |face: &[[u32; 3]], n: usize| face.iter().filter(|c| c.get(n) != Some(&corner::NONE)).count();
        for place in 1..3 {
            let with = has(face, place);
            if with != 0 && with != face.len() {
                face.iter_mut().filter_map(|c| c.get_mut(place)).for_each(|i| *i = corner::NONE);
                if lost == 0 {
                    self.tallies.uneven.add(line.range());
                }
            }
        }
    }
}

fn complaint(word: Part<'_>, wrong: Wrong, total: [usize; 3]) -> Complaint {
    let [vertices, ..] = total;
    match wrong {
        Wrong::Form => {
            let message =
                format!("expected a corner such as 1, 1/1, 1//1 or 1/1/1, found \"{}\"", word.shown());
            Complaint::error(word.range(), message)
        }
        Wrong::Range(0) => Complaint::error(word.range(), "there is no vertex 0")
            .hint("vertices are counted from 1, or backwards from -1"),
        Wrong::Range(n) if n < 0 => Complaint::error(
            word.range(),
            format!(
                "{n} counts backwards, but there are fewer than {} vertices before this",
                n.unsigned_abs()
            ),
        ),
        Wrong::Range(n) => {
            let message = format!("there is no vertex {n}: the file has {vertices}");
            Complaint::error(word.range(), message).hint("the file may have been cut off")
        }
    }
}

/// Names may hold a `#`, numbers do not, but for what old programs write in place of one: `1.#IND`, `-1.#INF`.
fn without_comment(words: Words<'_>) -> Words<'_> {
    let rest = words.rest();
    let is_number = |at: usize| {
        let behind = rest.bytes.get(at + 1..).unwrap_or_default();
        [&b"IND"[..], b"INF", b"QNAN", b"SNAN"].iter().any(|word| behind.starts_with(word))
    };
    match memchr::memchr_iter(b'#', rest.bytes).find(|&at| !is_number(at)) {
        Some(comment) => rest.split(comment).0.words(),
        None => words,
    }
}

fn finite(x: f32) -> f32 {
    if x.is_finite() { x } else { 0.0 }
}
