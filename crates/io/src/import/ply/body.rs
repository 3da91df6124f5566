//! The body: tables one after another, as text or as bytes.
//!
//! In text, one line is one row in all files that programs write; such a body is cut at line ends and read by several
//! threads. The format as most readers know it cares for words only: a body with more or fewer lines than rows is read
//! word by word. Numbers behind the last column of a line are left out, as some programs write more than they announce.
use durer_scene::counted;
use rayon::prelude::*;

use super::{
    header::{Element, Encoding, Header},
    numbers::{Packed, Written},
    row::{Role, Rows, role},
};
use crate::import::text::{Complaint, Part};

/// Rows of bytes that one thread reads at once.
const BLOCK: usize = 1 << 15;

/// The tables with what they are read as.
struct Plan<'h> {
    tables: Vec<(&'h Element, Role)>,
    vertices: usize,
}

/// Reads all tables of `file`.
pub(super) fn read(header: &Header, file: &[u8]) -> Result<Rows, Complaint> {
    let mut tables = Vec::new();
    for element in header.elements.iter().filter(|e| e.rows() > 0) {
        tables.push((element, role(element)?));
    }
    let mut vertex = tables.iter().filter(|(_, role)| matches!(role, Role::Vertices(_)));
    let vertices = vertex.next().map_or(0, |(element, _)| element.count);
    if let Some((second, _)) = vertex.next() {
        return Err(Complaint::error(second.at.clone(), "a second element \"vertex\""));
    }
    if u32::try_from(vertices).is_err() {
        return Err(Complaint::whole(format!("{vertices} vertices are more than durer can count")));
    }
    let plan = Plan { tables, vertices };
    let (_, body) = Part::whole(file).split(header.body);
    match header.encoding {
        Encoding::Ascii => plan.text(body),
        Encoding::Little => plan.bytes(body, false),
        Encoding::Big => plan.bytes(body, true),
    }
}

impl Plan<'_> {
    fn text(&self, body: Part<'_>) -> Result<Rows, Complaint> {
        let pieces = body.pieces(|_, _| true);
        let lines = |piece: &Part<'_>| piece.lines().filter(|l| !l.bytes.trim_ascii().is_empty()).count();
        let counts: Vec<usize> = pieces.par_iter().map(lines).collect();
        let (found, expected) = (
            counts.iter().sum::<usize>(),
            self.tables.iter().fold(0, |n: usize, t| n.saturating_add(t.0.count)),
        );
        if found < expected {
            return self.words(body);
        }
        let mut starts = Vec::with_capacity(pieces.len());
        counts.iter().fold(0, |first, count| {
            starts.push(first);
            first + count
        });
        let read = pieces.par_iter().zip(starts).map(|(piece, start)| self.lines(*piece, start));
        match together(read.collect()) {
            Err(_) if found > expected => self.words(body),
            Ok(rows) if found > expected && rows.long.count > 0 => self.words(body),
            read => read,
        }
    }

    /// The rows of a piece whose first line is row `first` of the body.
    fn lines(&self, piece: Part<'_>, first: usize) -> Result<Rows, Complaint> {
        let mut rows = Rows::default();
        let mut tables = self.tables.iter();
        let mut current = tables.next();
        // Rows until the current table ends, counted from `first`.
        let mut end = current.map_or(0, |t| t.0.count);
        let full = piece.lines().filter(|l| !l.bytes.trim_ascii().is_empty());
        for (number, line) in (first..).zip(full) {
            while number >= end {
                current = tables.next();
                let Some((element, _)) = current else {
                    return Ok(rows);
                };
                end += element.count;
            }
            let Some((element, role)) = current else {
                return Ok(rows);
            };
            let mut numbers = Written::new(line);
            rows.row(element, role, self.vertices, &mut numbers)?;
            if let Some(word) = numbers.left() {
                rows.long.add(word.range());
            }
        }
        Ok(rows)
    }

    /// Rows that do not care for lines.
    fn words(&self, body: Part<'_>) -> Result<Rows, Complaint> {
        let mut rows = Rows::default();
        let mut numbers = Written::new(body);
        for (element, role) in &self.tables {
            for done in 0..element.count {
                if numbers.left().is_none() {
                    return Err(short(element, done));
                }
                rows.row(element, role, self.vertices, &mut numbers)?;
            }
        }
        Ok(rows)
    }

    fn bytes(&self, body: Part<'_>, big: bool) -> Result<Rows, Complaint> {
        let mut rows = Rows::default();
        let mut numbers = Packed { rest: body, big };
        for (element, role) in &self.tables {
            let least = element.least();
            if element.count.saturating_mul(least) > numbers.rest.bytes.len() {
                return Err(short(element, numbers.rest.bytes.len() / least.max(1)));
            }
            if element.is_even() {
                let (table, rest) = numbers.rest.split(element.count * least);
                numbers.rest = rest;
                if let Role::Vertices(_) = role {
                    rows.append(self.even(element, role, table, big)?);
                }
                continue;
            }
            for _ in 0..element.count {
                rows.row(element, role, self.vertices, &mut numbers)?;
            }
        }
        Ok(rows)
    }

    /// A table whose rows all have the same number of bytes.
    fn even(&self, element: &Element, role: &Role, table: Part<'_>, big: bool) -> Result<Rows, Complaint> {
        let bytes = BLOCK * element.least();
        let blocks: Vec<_> = table.bytes.chunks(bytes).enumerate().collect();
        let read = blocks.into_par_iter().map(|(i, block)| {
            let mut rows = Rows::default();
            let mut numbers = Packed { rest: Part { bytes: block, at: table.at + i * bytes }, big };
            while !numbers.rest.bytes.is_empty() {
                rows.row(element, role, self.vertices, &mut numbers)?;
            }
            Ok(rows)
        });
        together(read.collect())
    }
}

fn short(element: &Element, done: usize) -> Complaint {
    let Element { name, count, at, .. } = element;
    let rows = counted(*count, "row");
    let message = format!("the header promises {rows} of the element {name}, but the file ends after {done}");
    Complaint::error(at.clone(), message)
}

/// The rows of all pieces, or the first complaint.
fn together(pieces: Vec<Result<Rows, Complaint>>) -> Result<Rows, Complaint> {
    let mut all = Rows::default();
    for piece in pieces {
        let piece = piece?;
        if all.positions.is_empty() && all.corners.is_empty() {
            all = piece;
        } else {
            all.append(piece);
        }
    }
    Ok(all)
}
