//! Cuts primitives that would make boxes overlap (Stich, Friedrich, Dietrich 2009, "Spatial Splits in Bounding Volume
//! Hierarchies").
//!
//! The top of the tree, where each step is either a split of the items or a cut of space. Space is cut only where the
//! boxes of the best split overlap much, where the cut is clearly cheaper, and while the number of pieces stays within a
//! budget. What is below, where nothing is to be gained, is left to `top_down`.
use durer_core::math::Bounds3;
use rayon::prelude::*;
use wide::f32x4;

use super::{
    Primitives,
    binary::Item,
    bins::{Bins, Plane, Slices},
    hull::{AreaUnit, Hull},
    partition::{self, Around},
    shared::{CHUNK, Top, around},
    top_down::Plot,
};

/// Nodes, and overlaps, with less than this part of the area of everything are left alone.
const SMALL: f32 = 1e-5;
/// So are overlaps with less than this part of their node's area: as soon as pieces are many, a little overlap costs less.
const OVERLAP: f32 = 0.3;
/// Pieces at most, per primitive, beyond the first.
const BUDGET: f32 = 0.25;
/// Slabs that space is cut into, per axis.
const SLABS: usize = 16;
/// A cut must cost less than this part of what a split costs.
const CHEAPER: f32 = 0.8;
/// Items that a cut adds to both sides' costs, as for splits.
const OVERHEAD: f32 = 4.0;
/// Fewer items than this are not cut: they fit a packet.
const FEW: usize = 8;

/// A plane through space.
#[derive(Clone, Copy, Debug)]
struct Cut {
    axis: usize,
    at: f32,
    cost: f32,
}

struct Cutter<'a, P> {
    prims: &'a P,
    unit: AreaUnit,
    /// Half the area of everything.
    area: f32,
}

/// Items, some of them in pieces, and the top of a tree over them.
pub(super) struct Pieces {
    pub(super) items: Vec<Item>,
    pub(super) top: Top<Plot>,
}

/// Cuts some of the items; `None` if none is worth cutting.
pub(super) fn cut(prims: &impl Primitives, items: Vec<Item>, unit: AreaUnit) -> Option<Pieces> {
    let n = items.len();
    let around = around(&items);
    let budget = (BUDGET * n as f32) as usize;
    let cutter = Cutter { prims, unit, area: unit.area(&around.hull) };
    let pieces = cutter.cut(items, Plot { first: 0, depth: 0, around }, budget);
    (pieces.items.len() > n).then_some(pieces)
}

impl<P: Primitives> Cutter<'_, P> {
    /// The pieces of a range, at most `budget` more than there are items.
    fn cut(&self, mut items: Vec<Item>, plot: Plot, budget: usize) -> Pieces {
        let n = items.len();
        let Some(plane) = self.plane(&items, &plot, budget) else {
            return Pieces { items, top: Top::Task(plot) };
        };
        let cut = if self.overlaps(&plane, &plot) { self.best(&items, &plot.around.hull) } else { None };
        let sides =
            cut.filter(|cut| cut.cost < CHEAPER * plane.cost).and_then(|cut| self.sides(&items, &cut));
        let sides = sides.filter(|[left, right]| left.len() + right.len() <= n + budget);
        let [left, right] = sides.unwrap_or_else(|| {
            let middle = partition::by_plane(&mut items, &plane);
            let right = items.split_off(middle);
            [std::mem::take(&mut items), right]
        });
        drop(items);
        let budget = budget + n - (left.len() + right.len());
        let [mut left, right] = self.below([left, right], &plot, budget);
        let middle = left.items.len();
        let below = Box::new([left.top, right.top]);
        left.items.extend(right.items);
        Pieces { items: left.items, top: Top::Split { hull: plot.around.hull, middle, below } }
    }

    /// The plane for a split of a range that is worth looking into.
    fn plane(&self, items: &[Item], plot: &Plot, budget: usize) -> Option<Plane> {
        let n = items.len();
        let small = self.unit.area(&plot.around.hull) <= SMALL * self.area;
        if n <= FEW || budget == 0 || small || !plot.has_levels_for(n + budget) {
            return None;
        }
        let slices = Slices::new(&plot.around.centers, n);
        let bins: Vec<Bins> = items.par_chunks(CHUNK).map(|chunk| Bins::new(&slices, chunk)).collect();
        Bins::sum(&bins).best(&slices, n, &self.unit)
    }

    /// Whether the sides of a plane overlap enough to think of a cut.
    fn overlaps(&self, plane: &Plane, plot: &Plot) -> bool {
        let overlap = Hull {
            lo: plane.hulls[0].lo.fast_max(plane.hulls[1].lo),
            hi: plane.hulls[0].hi.fast_min(plane.hulls[1].hi),
        };
        let least = (SMALL * self.area).max(OVERLAP * self.unit.area(&plot.around.hull));
        overlap.extent().iter().all(|&e| e >= 0.0) && self.unit.area(&overlap) > least
    }

    /// The pieces of two sides.
    fn below(&self, [left, right]: [Vec<Item>; 2], plot: &Plot, budget: usize) -> [Pieces; 2] {
        let (n_left, n) = (left.len() as u64, (left.len() + right.len()) as u64);
        let share = (budget as u64 * n_left / n) as usize;
        let cut = |items: Vec<Item>, budget| {
            let plot = Plot { first: 0, depth: plot.depth + 1, around: Around::new(&items) };
            self.cut(items, plot, budget)
        };
        let (left, right) = if n > CHUNK as u64 {
            rayon::join(|| cut(left, share), || cut(right, budget - share))
        } else {
            (cut(left, share), cut(right, budget - share))
        };
        [left, right]
    }

    /// The cheapest cut through the box around items.
    fn best(&self, items: &[Item], hull: &Hull) -> Option<Cut> {
        let slabs = Slabs::new(&hull.bounds());
        let fill = |items: &[Item]| {
            let mut filling = Filling::default();
            items.iter().for_each(|item| filling.add(self.prims, &slabs, item));
            filling
        };
        let filling = items.par_chunks(CHUNK).map(fill).reduce_with(Filling::joined)?;
        let cuts = (0..3).flat_map(|axis| filling.cuts(&slabs, axis, &self.unit));
        cuts.filter(|cut| cut.cost > 0.0).min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// The items, or pieces of them, on both sides of a cut; `None` if one side has none.
    fn sides(&self, items: &[Item], cut: &Cut) -> Option<[Vec<Item>; 2]> {
        let mut sides = [Vec::new(), Vec::new()];
        for item in items {
            let on_axis = |v: &f32x4| v.as_array()[cut.axis];
            let (lo, hi) = (on_axis(&item.0.lo), on_axis(&item.0.hi));
            let whole = usize::from(item.center_on(cut.axis) > cut.at + cut.at);
            if hi <= cut.at {
                sides[0].push(*item);
            } else if lo >= cut.at {
                sides[1].push(*item);
            } else if let Some(parts) = self.prims.clip(item.prim(), &item.0.bounds(), cut.axis, cut.at) {
                for (side, part) in parts.iter().enumerate().filter(|(_, part)| !part.is_empty()) {
                    sides[side].push(Item::reference(&Hull::new(part), item.prim()));
                }
                if parts.iter().all(Bounds3::is_empty) {
                    sides[whole].push(*item);
                }
            } else {
                sides[whole].push(*item);
            }
        }
        sides.iter().all(|side| !side.is_empty()).then_some(sides)
    }
}

/// A box in slabs of equal width on each axis.
struct Slabs {
    origin: [f32; 3],
    width: [f32; 3],
    /// Slabs per unit of length.
    scale: [f32; 3],
}

impl Slabs {
    fn new(bounds: &Bounds3) -> Self {
        let width = [0, 1, 2].map(|a| (bounds.max[a] - bounds.min[a]) / SLABS as f32);
        Self { origin: bounds.min.to_array(), width, scale: width.map(|w| 1.0 / w) }
    }
    /// The slab that a coordinate is in.
    fn of(&self, axis: usize, x: f32) -> usize {
        (((x - self.origin[axis]) * self.scale[axis]) as usize).min(SLABS - 1)
    }
    /// Where a slab begins.
    fn begin(&self, axis: usize, slab: usize) -> f32 {
        self.origin[axis] + self.width[axis] * slab as f32
    }
}

/// What is in a slab: the box around all pieces in it, how many items begin and how many end.
#[derive(Clone, Copy)]
struct Slab {
    hull: Hull,
    begin: u32,
    end: u32,
}

/// What is in the slabs of each axis.
struct Filling([[Slab; SLABS]; 3]);

impl Default for Filling {
    fn default() -> Self {
        Self([[Slab { hull: Hull::EMPTY, begin: 0, end: 0 }; SLABS]; 3])
    }
}

impl Filling {
    fn add(&mut self, prims: &impl Primitives, slabs: &Slabs, item: &Item) {
        let bounds = item.0.bounds();
        for (axis, row) in self.0.iter_mut().enumerate() {
            let (first, last) = (slabs.of(axis, bounds.min[axis]), slabs.of(axis, bounds.max[axis]));
            row[first].begin += 1;
            row[last].end += 1;
            let mut rest = bounds;
            for (slab, place) in row.iter_mut().enumerate().take(last).skip(first) {
                let cut = prims.clip(item.prim(), &rest, axis, slabs.begin(axis, slab + 1));
                let Some([part, more]) = cut else { break };
                if !part.is_empty() {
                    place.hull = place.hull.joined(Hull::new(&part));
                }
                rest = more;
                if rest.is_empty() {
                    break;
                }
            }
            if !rest.is_empty() {
                row[last].hull = row[last].hull.joined(Hull::new(&rest));
            }
        }
    }

    fn joined(mut self, o: Self) -> Self {
        for (slab, more) in self.0.iter_mut().flatten().zip(o.0.iter().flatten()) {
            slab.hull = slab.hull.joined(more.hull);
            slab.begin += more.begin;
            slab.end += more.end;
        }
        self
    }

    /// The cuts between slabs of one axis.
    fn cuts(&self, slabs: &Slabs, axis: usize, unit: &AreaUnit) -> Vec<Cut> {
        let row = &self.0[axis];
        let side = |slabs: &[Slab], number: fn(&Slab) -> u32| {
            let hull = slabs.iter().fold(Hull::EMPTY, |hull, slab| hull.joined(slab.hull));
            unit.area(&hull) * (slabs.iter().map(number).sum::<u32>() as f32 + OVERHEAD)
        };
        let cut = |slab: usize| {
            let (left, right) = row.split_at(slab);
            let cost = side(left, |s| s.begin) + side(right, |s| s.end);
            Cut { axis, at: slabs.begin(axis, slab), cost }
        };
        (1..SLABS).map(cut).collect()
    }
}
