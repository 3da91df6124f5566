//! The first wave: a lattice of rays over the picture and a little beyond, and the lines between neighbours.
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use durer_core::glam::DVec2;
use durer_render::{drive::Progress, film::Tile};
use rayon::prelude::*;

use crate::{
    eye::{Eye, Spot, Touch},
    search::{Found, Searcher},
};

/// Lines are followed down to cells of at most this edge, in pixels.
const FINEST: f64 = 1.0 / 16.0;
/// Where the lattice begins, in pixels: beyond the picture's edge, and not where symmetric scenes have theirs.
const ORIGIN: f64 = -0.537;

/// A step along an edge of a cell: from a point of the fine grid to the right, or down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Side {
    pub(crate) from: [u32; 2],
    pub(crate) length: u32,
    pub(crate) down: bool,
}

impl Side {
    /// Where it ends.
    pub(crate) fn to(&self) -> [u32; 2] {
        self.point(self.length)
    }
    /// So many units from its beginning.
    pub(crate) fn point(&self, units: u32) -> [u32; 2] {
        let [x, y] = self.from;
        if self.down { [x, y + units] } else { [x + units, y] }
    }
    /// Both halves.
    pub(crate) fn halves(&self) -> [Self; 2] {
        let length = self.length / 2;
        [Self { length, ..*self }, Self { from: self.point(length), length, ..*self }]
    }
}

/// Places of rays: units of the fine grid, some of which are corners of the lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// Edge of a unit in pixels.
    unit: f64,
    /// Units along the edge of a cell of the lattice: a power of 2.
    pub(crate) span: u32,
    /// Cells per row, rows.
    pub(crate) cells: [u32; 2],
    /// Units from the corner of the whole picture to that of the part.
    corner: DVec2,
}

impl Grid {
    /// Over a part of the picture, with `rays` along the edge of a pixel.
    pub(crate) fn new(part: Tile, rays: u32) -> Self {
        let spacing = 1.0 / f64::from(rays);
        let span = ((spacing / FINEST).ceil() as u32).next_power_of_two();
        // One pixel more than the picture has, all told.
        let cells = [part.x1 - part.x0, part.y1 - part.y0].map(|n| (n + 1) * rays);
        let corner = DVec2::new(part.x0.into(), part.y0.into()) * f64::from(rays * span);
        Self { unit: spacing / f64::from(span), span, cells, corner }
    }
    /// The place of a point of the grid, in pixels.
    pub(crate) fn place(&self, [x, y]: [u32; 2]) -> DVec2 {
        DVec2::splat(ORIGIN) + (self.corner + DVec2::new(x.into(), y.into())) * self.unit
    }
}

/// What the rays of the lattice touched.
pub(crate) struct Lattice {
    pub(crate) grid: Grid,
    touches: Vec<Option<Touch>>,
}

impl Lattice {
    /// Casts all rays; `None` if `cancel` was set meanwhile.
    pub(crate) fn cast(
        eye: &Eye<'_>,
        grid: Grid,
        progress: &dyn Progress,
        cancel: &AtomicBool,
    ) -> Option<Self> {
        let row = |y: u32| -> Vec<Option<Touch>> {
            if cancel.load(Ordering::Relaxed) {
                return Vec::new();
            }
            let points = (0..=grid.cells[0]).map(|x| grid.place([x * grid.span, y * grid.span]));
            let touches: Vec<_> = points.map(|at| eye.look(at).touch).collect();
            progress.advance(touches.len() as u64, touches.len() as u64);
            touches
        };
        let rows: Vec<_> = (0..=grid.cells[1]).into_par_iter().map(row).collect();
        let touches = rows.concat();
        (!cancel.load(Ordering::Relaxed)).then_some(Self { grid, touches })
    }

    /// The spot of a corner, in units of the fine grid.
    pub(crate) fn spot(&self, eye: &Eye<'_>, point: [u32; 2]) -> Option<Spot> {
        let [x, y] = point;
        let span = self.grid.span;
        let is_corner = x % span == 0 && y % span == 0;
        is_corner.then(|| {
            let at = self.grid.place(point);
            let index = (y / span) as usize * (self.grid.cells[0] as usize + 1) + (x / span) as usize;
            Spot { at, ray: eye.ray(at), touch: self.touches[index] }
        })
    }

    /// The sides of cells that lines cross; `None` if `cancel` was set meanwhile.
    pub(crate) fn crossed(
        &self,
        searcher: &Searcher<'_>,
        progress: &dyn Progress,
        cancel: &AtomicBool,
    ) -> Option<Vec<(Side, Found)>> {
        let [columns, rows] = self.grid.cells;
        let span = self.grid.span;
        let told = AtomicU64::new(searcher.eye.rays());
        let row = |y: u32| -> Vec<(Side, Found)> {
            if cancel.load(Ordering::Relaxed) {
                return Vec::new();
            }
            let right = (0..columns).map(|x| (x, false));
            let down = (0..=columns).map(|x| (x, true)).filter(|_| y < rows);
            let sides =
                right.chain(down).map(|(x, down)| Side { from: [x * span, y * span], length: span, down });
            let spot = |point| self.spot(searcher.eye, point);
            let found = |side: Side| Some((side, searcher.between(spot(side.from)?, spot(side.to())?)?));
            let found = sides.filter_map(found).collect();
            let rays = searcher.eye.rays();
            progress.advance(u64::from(columns + 1), rays.saturating_sub(told.swap(rays, Ordering::Relaxed)));
            found
        };
        let found: Vec<_> = (0..=rows).into_par_iter().map(row).collect();
        (!cancel.load(Ordering::Relaxed)).then(|| found.concat())
    }
}
