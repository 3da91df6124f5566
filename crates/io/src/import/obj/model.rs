//! The arrays of all pieces as those of the file, and what is said once about all of them.
use std::ops::Range;

use durer_core::math::{Normal3, Point2, Point3};
use durer_scene::{counted, nearest_word};

use super::piece::{MOST_UNKNOWN, Piece, WHITE, WORDS};
use crate::import::text::{Complaint, Part, Tally};

/// What is worth one warning, however often it happens.
#[derive(Debug, Default)]
pub(super) struct Tallies {
    pub(super) lines: Tally,
    pub(super) free_form: Tally,
    pub(super) poor: Tally,
    pub(super) lost_uvs: Tally,
    pub(super) lost_normals: Tally,
    pub(super) uneven: Tally,
    pub(super) bad_normals: Tally,
    pub(super) bad_uvs: Tally,
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
        self.lost_uvs.append(later.lost_uvs);
        self.lost_normals.append(later.lost_normals);
        self.uneven.append(later.uneven);
        self.bad_normals.append(later.bad_normals);
        self.bad_uvs.append(later.bad_uvs);
    }
    fn warn(self, to: &mut Vec<Complaint>) {
        to.extend(
            self.lines.warn(|n| format!("{n} lines and points (l, p) are left out: only faces are drawn")),
        );
        to.extend(self.free_form.warn(|n| {
            let lines = if n == 1 { "1 line is".to_owned() } else { format!("{n} lines are") };
            format!("{lines} skipped: curves and free-form surfaces are not read")
        }));
        to.extend(self.poor.warn(|n| {
            let verb = if n == 1 { "is" } else { "are" };
            format!("{} with fewer than 3 corners {verb} left out", counted(n, "face"))
        }));
        let gone = |what: &str, n| {
            let name = if n == 1 { "1 face names".to_owned() } else { format!("{n} faces name") };
            format!("{name} {what} that are not there; drawn without them")
        };
        to.extend(self.lost_uvs.warn(|n| gone("texture coordinates", n)));
        to.extend(self.lost_normals.warn(|n| gone("normals", n)));
        to.extend(self.uneven.warn(|n| {
            format!("{n} faces have texture coordinates or normals at some corners only; drawn without them")
        }));
        to.extend(
            self.bad_normals
                .warn(|n| format!("{n} normals are nan or infinite; taken as if they were missing")),
        );
        to.extend(self.bad_uvs.warn(|n| format!("{n} texture coordinates are nan or infinite; 0 is used")));
    }
}
