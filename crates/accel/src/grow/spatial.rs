//! Cuts primitives that would make boxes overlap (Stich, Friedrich, Dietrich 2009, "Spatial Splits in Bounding Volume
//! Hierarchies").
//!
//! A recursion as if to build a tree, choosing at each step between a split of the items and a cut of space; what it
//! keeps are the pieces, over which the tree is then built. Space is cut only where the boxes of the best split overlap
//! by more than a small part of the whole, and only while the number of pieces stays within a budget.
use durer_core::math::Bounds3;
use rayon::prelude::*;
use wide::f32x4;

use super::{
    DEPTH_MAX, Primitives,
    binary::Item,
    bins::{Bins, Slices},
    hull::{AreaUnit, Hull},
    partition::{self, Around},
    shared::{CHUNK, around},
};

/// Overlaps of a smaller part of the whole's area are left alone; nodes of a smaller area are not looked into.
const OVERLAP: f32 = 1e-5;
/// Pieces at most, per primitive, beyond the first.
const BUDGET: f32 = 0.25;
/// Slabs that space is cut into, per axis.
const SLABS: usize = 16;
/// A cut must cost less than this part of what a split costs.
const CHEAPER: f32 = 0.95;
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

/// `items`, some of them in pieces.
pub(super) fn pieces(prims: &impl Primitives, items: Vec<Item>, unit: AreaUnit) -> Vec<Item> {
    let around = around(&items);
    let budget = (BUDGET * items.len() as f32) as usize;
    Cutter { prims, unit, area: unit.area(&around.hull) }.cut(items, around, budget, 0)
}

impl<P: Primitives> Cutter<'_, P> {
    /// The pieces of a range, at most `budget` more than there are items.
    fn cut(&self, mut items: Vec<Item>, around: Around, budget: usize, depth: u32) -> Vec<Item> {
        let least = OVERLAP * self.area;
        if items.len() <= FEW || budget == 0 || depth >= DEPTH_MAX || self.unit.area(&around.hull) <= least {
            return items;
        }
        let slices = Slices::new(&around.centers, items.len());
        let bins: Vec<Bins> = items.par_chunks(CHUNK).map(|chunk| Bins::new(&slices, chunk)).collect();
        let Some(plane) = Bins::sum(&bins).best(&slices, items.len(), &self.unit) else { return items };
        let overlap = Hull {
            lo: plane.hulls[0].lo.fast_max(plane.hulls[1].lo),
            hi: plane.hulls[0].hi.fast_min(plane.hulls[1].hi),
        };
        let overlaps = overlap.extent().iter().all(|&e| e >= 0.0) && self.unit.area(&overlap) > least;
        let cut = if overlaps { self.best(&items, &around.hull) } else { None };
        let n = items.len();
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
        self.below([left, right], budget, depth + 1)
    }

    /// The pieces of two sides.
    fn below(&self, [left, right]: [Vec<Item>; 2], budget: usize, depth: u32) -> Vec<Item> {
        let (n_left, n) = (left.len() as u64, (left.len() + right.len()) as u64);
        let share = (budget as u64 * n_left / n) as usize;
        let cut = |items: Vec<Item>, budget| {
            let around = Around::new(&items);
            self.cut(items, around, budget, depth)
        };
        let (mut pieces, right) = if n > CHUNK as u64 {
            rayon::join(|| cut(left, share), || cut(right, budget - share))
        } else {
            (cut(left, share), cut(right, budget - share))
        };
        pieces.extend(right);
        pieces
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
}

impl Slabs {
    fn new(bounds: &Bounds3) -> Self {
        let width = [0, 1, 2].map(|a| (bounds.max[a] - bounds.min[a]) / SLABS as f32);
        Self { origin: bounds.min.to_array(), width }
    }
    /// The slab that a coordinate is in.
    fn of(&self, axis: usize, x: f32) -> usize {
        (((x - self.origin[axis]) / self.width[axis]) as usize).min(SLABS - 1)
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
            for slab in first..last {
                let cut = prims.clip(item.prim(), &rest, axis, slabs.begin(axis, slab + 1));
                let Some([part, more]) = cut else { break };
                if !part.is_empty() {
                    row[slab].hull = row[slab].hull.joined(Hull::new(&part));
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
