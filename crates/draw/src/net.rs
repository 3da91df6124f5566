//! From crossings to links: each cell of the lattice joins the crossings on its sides.
//!
//! A cell with two crossings holds a piece of a line, if a look from beside its middle confirms it. Any other cell is cut in
//! four, again and again, down to a sixteenth of a pixel: there three crossings or more meet in a junction, and one alone is
//! the end of a line. What the halves of a side show is news for the cell beyond it, which is then looked at again: so lines
//! are followed between the rays of the lattice, to the end of threads thinner than a pixel.
use std::{
    collections::{BTreeMap, BTreeSet, HashMap, HashSet},
    sync::atomic::{AtomicBool, Ordering},
};

use durer_core::glam::DVec2;
use rayon::prelude::*;

use crate::{
    eye::{Spot, Touch},
    lattice::{Lattice, Side},
    search::{Crossing, Found, Searcher},
};

/// So many cells are cut at most: hair and leaves finer than the lattice end in junctions instead of hours.
const MOST_CUTS: usize = 400_000;
/// Half of how far from the middle of a piece of a line both sides of it are looked at, in pixels.
const BESIDE: f64 = 1.0 / 16.0;
/// Pieces shorter than this, in pixels, are straight. In a large cell they are rather the tip of something small.
const SHORT: f64 = 0.2;
/// Units along the edge of a large cell.
const LARGE: u32 = 4;

/// A square of the fine grid. Ordered by rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Cell {
    y: u32,
    x: u32,
    size: u32,
}

impl Cell {
    fn sides(&self) -> [Side; 4] {
        let Self { x, y, size: length } = *self;
        [([x, y], false), ([x, y + length], false), ([x, y], true), ([x + length, y], true)]
            .map(|(from, down)| Side { from, length, down })
    }
    fn quarters(&self) -> [Self; 4] {
        let size = self.size / 2;
        [[0, 0], [size, 0], [0, size], [size, size]].map(|[dx, dy]| Self {
            y: self.y + dy,
            x: self.x + dx,
            size,
        })
    }
    /// From the middle of the sides to the middle.
    fn cross(&self) -> [Side; 4] {
        let length = self.size / 2;
        let [upper, left] = [self.quarters()[1], self.quarters()[2]];
        let middle = [upper.x, left.y];
        [([middle[0], self.y], true), (middle, true), ([self.x, middle[1]], false), (middle, false)]
            .map(|(from, down)| Side { from, length, down })
    }
}

/// A point where pieces of lines end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Node {
    /// A crossing.
    On(Side),
    /// A junction.
    In(Cell),
}

/// A piece of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    pub(crate) ends: [Node; 2],
    /// A point between.
    pub(crate) middle: Option<Crossing>,
}

/// What a cell turned out to hold.
enum Verdict {
    Links(Vec<Link>),
    Cut,
}

/// What is known of a side.
#[derive(Clone, Copy)]
enum State {
    Whole(Option<Found>),
    Halved,
}

/// Cells, sides and rays so far.
pub(crate) struct Net<'a> {
    searcher: &'a Searcher<'a>,
    lattice: &'a Lattice,
    /// Rays between those of the lattice. Never walked through: the order of a hash is none.
    fine: HashMap<[u32; 2], Option<Touch>>,
    sides: HashMap<Side, State>,
    cut: HashSet<Cell>,
    /// The links of all other cells that lines touch.
    links: BTreeMap<Cell, Vec<Link>>,
}

impl<'a> Net<'a> {
    /// Follows all lines of which `crossed` sides are known; `None` if `cancel` was set meanwhile.
    pub(crate) fn follow(
        searcher: &'a Searcher<'a>,
        lattice: &'a Lattice,
        crossed: Vec<(Side, Found)>,
        cancel: &AtomicBool,
    ) -> Option<Self> {
        let mut net = Self {
            searcher,
            lattice,
            fine: HashMap::new(),
            sides: crossed.iter().map(|(side, found)| (*side, State::Whole(Some(*found)))).collect(),
            cut: HashSet::new(),
            links: BTreeMap::new(),
        };
        let mut active: BTreeSet<Cell> = crossed.iter().flat_map(|(side, _)| net.beside(side)).collect();
        while !active.is_empty() {
            if cancel.load(Ordering::Relaxed) {
                return None;
            }
            active = net.round(&active);
        }
        Some(net)
    }

    /// All pieces of lines.
    pub(crate) fn links(&self) -> impl Iterator<Item = &Link> {
        self.links.values().flatten()
    }

    /// Where a crossing is.
    pub(crate) fn crossing(&self, side: &Side) -> Option<Crossing> {
        match self.sides.get(side) {
            Some(State::Whole(Some(found))) => Some(found.crossing),
            _ => None,
        }
    }

    /// The middle of a cell, in pixels.
    pub(crate) fn middle(&self, cell: &Cell) -> DVec2 {
        let grid = &self.lattice.grid;
        0.5 * (grid.place([cell.x, cell.y]) + grid.place([cell.x + cell.size, cell.y + cell.size]))
    }

    fn spot(&self, point: [u32; 2]) -> Option<Spot> {
        let eye = self.searcher.eye;
        self.lattice.spot(eye, point).or_else(|| {
            let at = self.lattice.grid.place(point);
            Some(Spot { at, ray: eye.ray(at), touch: *self.fine.get(&point)? })
        })
    }

    /// The uncut cells on both sides of a side.
    fn beside(&self, side: &Side) -> Vec<Cell> {
        let [x, y] = side.from;
        let before =
            if side.down { x.checked_sub(1).map(|x| [x, y]) } else { y.checked_sub(1).map(|y| [x, y]) };
        before.into_iter().chain([side.from]).filter_map(|unit| self.around(unit)).collect()
    }

    /// The uncut cell that holds a unit of the grid.
    fn around(&self, [x, y]: [u32; 2]) -> Option<Cell> {
        let grid = &self.lattice.grid;
        if x >= grid.cells[0] * grid.span || y >= grid.cells[1] * grid.span {
            return None;
        }
        let within = |size: u32| Cell { y: y / size * size, x: x / size * size, size };
        let mut size = grid.span;
        while self.cut.contains(&within(size)) {
            size /= 2;
        }
        Some(within(size))
    }

    /// The crossed parts of a side.
    fn crossings(&self, side: Side, into: &mut Vec<(Side, Found)>) {
        match self.sides.get(&side) {
            None | Some(State::Whole(None)) => {}
            Some(State::Whole(Some(found))) => into.push((side, *found)),
            Some(State::Halved) => side.halves().into_iter().for_each(|half| self.crossings(half, into)),
        }
    }

    /// Looks at the active cells; what is to be looked at next.
    fn round(&mut self, active: &BTreeSet<Cell>) -> BTreeSet<Cell> {
        let cells: Vec<Cell> = active.iter().copied().collect();
        let is_spent = self.cut.len() >= MOST_CUTS;
        let verdicts: Vec<Verdict> = cells.par_iter().map(|cell| self.judge(cell, is_spent)).collect();
        let mut cuts = Vec::new();
        for (cell, verdict) in cells.into_iter().zip(verdicts) {
            match verdict {
                Verdict::Links(links) => {
                    self.links.insert(cell, links);
                }
                Verdict::Cut => {
                    self.links.remove(&cell);
                    cuts.push(cell);
                }
            }
        }
        self.cut(&cuts)
    }

    fn judge(&self, cell: &Cell, is_spent: bool) -> Verdict {
        let mut crossings = Vec::new();
        cell.sides().into_iter().for_each(|side| self.crossings(side, &mut crossings));
        let is_last = is_spent || cell.size == 1;
        if !is_last && crossings.iter().any(|(_, found)| found.many) {
            return Verdict::Cut;
        }
        match crossings.as_slice() {
            [] => Verdict::Links(Vec::new()),
            [(from, a), (to, b)] => {
                let middle = self.middle_between(a.crossing, b.crossing);
                let short = a.crossing.at.distance(b.crossing.at) < SHORT && cell.size < LARGE;
                if middle.is_none() && !short && !is_last {
                    return Verdict::Cut;
                }
                Verdict::Links(vec![Link { ends: [Node::On(*from), Node::On(*to)], middle }])
            }
            [_] if is_last => Verdict::Links(Vec::new()),
            many if is_last => {
                let link = |(side, _): &(Side, Found)| Link {
                    ends: [Node::On(*side), Node::In(*cell)],
                    middle: None,
                };
                Verdict::Links(many.iter().map(link).collect())
            }
            _ => Verdict::Cut,
        }
    }

    /// The line between two crossings half-way, if it is where it should be.
    fn middle_between(&self, a: Crossing, b: Crossing) -> Option<Crossing> {
        let along = b.at - a.at;
        if along.length() < SHORT {
            return None;
        }
        let middle = 0.5 * (a.at + b.at);
        let aside = along.perp().normalize() * BESIDE;
        let eye = self.searcher.eye;
        let found = self.searcher.between(eye.look(middle - aside), eye.look(middle + aside))?;
        (!found.many).then_some(found.crossing)
    }

    /// Cuts cells in four; the cells that have to be looked at then.
    fn cut(&mut self, cells: &[Cell]) -> BTreeSet<Cell> {
        let outer: BTreeSet<Side> =
            cells.iter().flat_map(Cell::sides).filter(|s| !self.is_halved(s)).collect();
        let halves = outer.iter().flat_map(Side::halves);
        let sides: BTreeSet<Side> = halves.chain(cells.iter().flat_map(Cell::cross)).collect();
        let points: BTreeSet<[u32; 2]> = sides.iter().flat_map(|side| [side.from, side.to()]).collect();
        let new: Vec<[u32; 2]> = points.into_iter().filter(|&point| self.spot(point).is_none()).collect();
        let eye = self.searcher.eye;
        let place = |point: &[u32; 2]| (*point, eye.look(self.lattice.grid.place(*point)).touch);
        let touches: Vec<_> = new.par_iter().map(place).collect();
        self.fine.extend(touches);

        let sides: Vec<Side> = sides.into_iter().collect();
        let between = |side: &Side| self.searcher.between(self.spot(side.from)?, self.spot(side.to())?);
        let found: Vec<_> = sides.par_iter().map(between).collect();
        self.sides.extend(sides.into_iter().zip(found.into_iter().map(State::Whole)));
        self.sides.extend(outer.iter().map(|side| (*side, State::Halved)));
        self.cut.extend(cells);
        let others = outer.iter().flat_map(Side::halves).flat_map(|half| self.beside(&half));
        cells.iter().flat_map(Cell::quarters).chain(others.collect::<Vec<_>>()).collect()
    }

    fn is_halved(&self, side: &Side) -> bool {
        matches!(self.sides.get(side), Some(State::Halved))
    }
}
