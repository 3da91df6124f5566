//! Statements: a piece of the text to arrays, and the arrays of all pieces to those of the file.
use std::ops::Range;

use durer_core::math::{Normal3, Point2, Point3};
use durer_scene::nearest_word;

use super::corner::{self, Wrong};
use crate::import::{
    color::linear,
    text::{Complaint, Part, Tally, Words, float},
};

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

/// What is worth one warning, however often it happens.
#[derive(Debug, Default)]
pub(super) struct Tallies {
    pub(super) lines: Tally,
    pub(super) free_form: Tally,
    pub(super) poor: Tally,
    pub(super) lost: Tally,
    pub(super) uneven: Tally,
    pub(super) bad_normals: Tally,
    pub(super) bad_uvs: Tally,
}

/// What a piece of the text holds.
#[derive(Debug, Default)]
pub(super) struct Piece {
    positions: Vec<Point3>,
    /// Empty, or one for each position.
    colors: Vec<[f32; 4]>,
    uvs: Vec<Point2>,
    normals: Vec<Normal3>,
    pub(super) corners: Vec<[u32; 3]>,
    /// Where each face ends in `corners`.
    pub(super) ends: Vec<usize>,
    /// What goes on before a face, in order.
    pub(super) events: Vec<(usize, Event)>,
    complaints: Vec<Complaint>,
    tallies: Tallies,
    unknown: Vec<(String, Range<usize>)>,
}

/// What the file holds.
#[derive(Debug, Default)]
pub(super) struct Model {
    pub(super) positions: Vec<Point3>,
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) uvs: Vec<Point2>,
    pub(super) normals: Vec<Normal3>,
    /// Faces and events only.
    pub(super) pieces: Vec<Piece>,
    pub(super) complaints: Vec<Complaint>,
}

const WHITE: [f32; 4] = [1.0; 4];

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
const WORDS: [&str; 12] = ["v", "vt", "vn", "f", "o", "g", "s", "usemtl", "mtllib", "l", "p", "fo"];

/// Unknown words that are told.
const MOST_UNKNOWN: usize = 8;

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
        match word.bytes {
            b"v" | b"vt" | b"vn" if words.rest().bytes.is_empty() => {
                self.complaints.push(Complaint::error(line.range(), "expected numbers"));
            }
            b"v" => self.position(line, words),
            b"vt" => {
                let [u, v, _] = self.numbers::<1>(line, words);
                if !(u.is_finite() && v.is_finite()) {
                    self.tallies.bad_uvs.add(line.range());
                }
                self.uvs.push(Point2::new(finite(u), finite(v)));
            }
            b"vn" => {
                let n = self.numbers::<3>(line, words);
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
    fn numbers<const LEAST: usize>(&mut self, line: Part<'_>, mut words: Words<'_>) -> [f32; 3] {
        let mut values = [0.0; 3];
        for (i, value) in values.iter_mut().enumerate() {
            match words.next() {
                Some(word) => *value = self.number(word),
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

    fn number(&mut self, word: Part<'_>) -> f32 {
        float(word.bytes).unwrap_or_else(|| {
            let message = format!("expected a number, found \"{}\"", word.shown());
            self.complaints.push(Complaint::error(word.range(), message));
            0.0
        })
    }

    /// Three coordinates, perhaps with a weight, or with a colour (red, green, blue) behind them.
    fn position(&mut self, line: Part<'_>, mut words: Words<'_>) {
        let position = self.numbers::<3>(line, words.clone());
        if !position.iter().all(|c| c.is_finite()) {
            self.complaints.push(Complaint::error(line.range(), "a vertex is not finite"));
        }
        let more = words.by_ref().skip(3).map(|word| self.number(word)).take(4);
        let more: [Option<f32>; 4] = {
            let mut more = more.fuse();
            std::array::from_fn(|_| more.next())
        };
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

    fn face(&mut self, line: Part<'_>, words: Words<'_>, [start, total]: [Counts; 2]) {
        let first = self.corners.len();
        let here = Counts([self.positions.len(), self.uvs.len(), self.normals.len()]);
        let so_far = start.plus(&here).0;
        let mut lost = 0;
        for word in words {
            if word.bytes.starts_with(b"#") {
                break;
            }
            match corner::resolve(word, so_far, total.0, &mut lost) {
                Ok(corner) => self.corners.push(corner),
                Err(wrong) => {
                    self.complaints.push(complaint(word, wrong, total.0));
                    self.corners.truncate(first);
                    return;
                }
            }
        }
        if lost > 0 {
            self.tallies.lost.add(line.range());
        }
        if self.corners.len() < first + 3 {
            self.tallies.poor.add(line.range());
            self.corners.truncate(first);
            return;
        }
        self.make_even(line, first, lost);
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
            format!("there are fewer than {} vertices before this", n.unsigned_abs()),
        ),
        Wrong::Range(n) => {
            let message = format!("there is no vertex {n}: the file has {vertices}");
            Complaint::error(word.range(), message).hint("the file may have been cut off")
        }
    }
}

fn finite(x: f32) -> f32 {
    if x.is_finite() { x } else { 0.0 }
}

impl Model {
    /// Puts pieces together.
    pub(super) fn gather(mut pieces: Vec<Piece>) -> Self {
        let mut model = Self::default();
        let mut tallies = Tallies::default();
        let mut unknown: Vec<(String, Range<usize>)> = Vec::new();
        for piece in &mut pieces {
            if !piece.colors.is_empty() || !model.colors.is_empty() {
                model.colors.resize(model.positions.len(), WHITE);
                piece.colors.resize(piece.positions.len(), WHITE);
                model.colors.append(&mut piece.colors);
            }
            model.positions.append(&mut piece.positions);
            model.uvs.append(&mut piece.uvs);
            model.normals.append(&mut piece.normals);
            model.complaints.append(&mut piece.complaints);
            tallies.append(std::mem::take(&mut piece.tallies));
            for (word, at) in piece.unknown.drain(..) {
                if unknown.iter().all(|(known, _)| *known != word) {
                    unknown.push((word, at));
                }
            }
        }
        model.pieces = pieces;
        tallies.warn(&mut model.complaints);
        let more = unknown.len().saturating_sub(MOST_UNKNOWN);
        for (word, at) in unknown.into_iter().take(MOST_UNKNOWN) {
            let shown = Part { bytes: word.as_bytes(), at: 0 }.shown();
            let warning =
                Complaint::error(at, format!("unknown word \"{shown}\"; lines with it are skipped"))
                    .warning();
            let near = nearest_word(&word, WORDS);
            model.complaints.push(match near {
                Some(near) => warning.hint(format!("did you mean \"{near}\"?")),
                None => warning,
            });
        }
        if more > 0 {
            model
                .complaints
                .push(Complaint::whole("more unknown words follow: is this a Wavefront OBJ?").warning());
        }
        model
    }
}

impl Tallies {
    fn append(&mut self, later: Self) {
        self.lines.append(later.lines);
        self.free_form.append(later.free_form);
        self.poor.append(later.poor);
        self.lost.append(later.lost);
        self.uneven.append(later.uneven);
        self.bad_normals.append(later.bad_normals);
        self.bad_uvs.append(later.bad_uvs);
    }
    fn warn(self, to: &mut Vec<Complaint>) {
        to.extend(
            self.lines.warn(|n| format!("{n} lines and points (l, p) are left out: only faces are drawn")),
        );
        to.extend(
            self.free_form
                .warn(|n| format!("{n} lines are skipped: curves and free-form surfaces are not read")),
        );
        to.extend(self.poor.warn(|n| format!("{n} faces with fewer than 3 corners are left out")));
        to.extend(self.lost.warn(|n| {
            format!("{n} faces name texture coordinates or normals that are not there; drawn without them")
        }));
        to.extend(self.uneven.warn(|n| {
            format!("{n} faces have texture coordinates or normals at some corners only; drawn without them")
        }));
        to.extend(
            self.bad_normals.warn(|n| format!("{n} normals are not finite; taken as if they were missing")),
        );
        to.extend(self.bad_uvs.warn(|n| format!("{n} texture coordinates are not finite; 0 is used")));
    }
}
