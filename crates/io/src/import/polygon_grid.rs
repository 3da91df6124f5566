//! Corners of a polygon in the cells of a grid, so that those in a triangle are found without looking at all.
use std::ops::RangeInclusive;

use durer_core::glam::DVec2;

/// Numbers of corners by place.
#[derive(Debug, Default)]
pub(super) struct Grid {
    low: DVec2,
    /// Size of a cell.
    cell: DVec2,
    /// Cells along each side.
    side: usize,
    /// Where the corners of each cell begin in `corners`, and how many are left of them.
    cells: Vec<(usize, usize)>,
    corners: Vec<usize>,
    /// Which corners are held.
    holds: Vec<bool>,
}

impl Grid {
    /// Holds these of the `points` from now on, a few of them in each cell.
    pub(super) fn fill(&mut self, points: &[DVec2], which: &[usize]) {
        let first = points.first().copied().unwrap_or_default();
        let (low, high) = points.iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)));
        self.low = low;
        self.side = (which.len() / 2).isqrt().max(1);
        // Of a line, the cells have some size nevertheless.
        self.cell = ((high - low) / self.side as f64).max(DVec2::splat(f64::MIN_POSITIVE));
        self.cells.clear();
        self.cells.resize(self.side * self.side, (0, 0));
        let of = |&i: &usize| self.index(points.get(i).copied().unwrap_or_default());
        let places: Vec<usize> = which.iter().map(of).collect();
        for &place in &places {
            self.cells.get_mut(place).into_iter().for_each(|c| c.1 += 1);
        }
        let mut start = 0;
        for cell in &mut self.cells {
            let count = cell.1;
            *cell = (start, 0);
            start += count;
        }
        self.holds.clear();
        self.holds.resize(points.len(), false);
        which.iter().for_each(|&i| self.holds.get_mut(i).into_iter().for_each(|h| *h = true));
        self.corners.clear();
        self.corners.resize(which.len(), 0);
        for (&corner, place) in which.iter().zip(places) {
            let Some(cell) = self.cells.get_mut(place) else { continue };
            self.corners.get_mut(cell.0 + cell.1).into_iter().for_each(|c| *c = corner);
            cell.1 += 1;
        }
    }

    fn along(&self, offset: f64, cell: f64) -> usize {
        ((offset / cell) as usize).min(self.side.saturating_sub(1))
    }
    fn index(&self, p: DVec2) -> usize {
        let offset = p - self.low;
        self.along(offset.y, self.cell.y) * self.side + self.along(offset.x, self.cell.x)
    }

    /// Takes `corner` at `point` out, if it is in. Returns how many were looked at.
    pub(super) fn forget(&mut self, corner: usize, point: DVec2) -> u64 {
        let held = self.holds.get_mut(corner).is_some_and(|held| std::mem::replace(held, false));
        if !held {
            return 0;
        }
        let place = self.index(point);
        let Some(cell) = self.cells.get_mut(place) else {
            return 0;
        };
        let held = self.corners.get_mut(cell.0..cell.0 + cell.1).unwrap_or_default();
        if let Some(found) = held.iter().position(|&c| c == corner) {
            let last = held.len() - 1;
            held.swap(found, last);
            cell.1 = last;
        }
        held.len() as u64
    }

    /// Whether one of the corners in the cells that a triangle touches is `inside`, and how many cells and corners were
    /// looked at.
    pub(super) fn any(&self, triangle: [DVec2; 3], inside: impl Fn(usize) -> bool) -> (bool, u64) {
        let mut tests = 0;
        // A corner that rounding puts into the next cell is found too.
        let slack = self.cell * 1e-6;
        let [p, q, r] = triangle;
        let (low, high) = (p.min(q).min(r) - slack - self.low, p.max(q).max(r) + slack - self.low);
        for row in self.along(low.y, self.cell.y)..=self.along(high.y, self.cell.y) {
            let bottom = self.low.y + row as f64 * self.cell.y - slack.y;
            let band = bottom..=bottom + self.cell.y + 2.0 * slack.y;
            let Some((from, to)) = reach(triangle, &band) else { continue };
            let columns = self.along(from - slack.x - self.low.x, self.cell.x)
                ..=self.along(to + slack.x - self.low.x, self.cell.x);
            for column in columns {
                let cell = self.cells.get(row * self.side + column).copied().unwrap_or_default();
                let held = self.corners.get(cell.0..cell.0 + cell.1).unwrap_or_default();
                tests += 1 + held.len() as u64;
                if held.iter().any(|&i| inside(i)) {
                    return (true, tests);
                }
            }
        }
        (false, tests)
    }
}

/// The least and the greatest x of the part of a triangle whose y lies in `band`; `None` if there is no such part.
fn reach([p, q, r]: [DVec2; 3], band: &RangeInclusive<f64>) -> Option<(f64, f64)> {
    let mut found: Option<(f64, f64)> = None;
    for (a, b) in [(p, q), (q, r), (r, p)] {
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        if b.y < *band.start() || a.y > *band.end() {
            continue;
        }
        let at = |y: f64| if b.y > a.y { a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)) } else { a.x };
        let start = if a.y < *band.start() { at(*band.start()) } else { a.x };
        let end = if b.y > *band.end() { at(*band.end()) } else { b.x };
        let (low, high) = found.unwrap_or((start, start));
        found = Some((low.min(start).min(end), high.max(start).max(end)));
    }
    found
}
