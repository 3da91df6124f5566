//! The exit pupil: the part of the rearmost surface's plane through which a point of the film sees the scene.
//!
//! It is found by tracing, for rings of the film, as in Physically Based Rendering (Bounding the exit pupil). Where pbrt
//! keeps a rectangle around it, here each row of a grid keeps from where to where: rays are spread evenly over these rows,
//! and few of them meet the barrel.
use durer_core::{glam::DVec3, math::Point2};

use super::glass::Glass;

/// Rings of the film.
const RINGS: usize = 32;
/// Cells along each axis of the grid around a pupil.
const CELLS: usize = 48;
/// The same of the grid that it is looked for with.
const COARSE: usize = 32;
/// Pupils of tiny stops are followed from ring to ring in at most 2 to this many steps.
const STEPS: u32 = 4;
/// The plane is searched so far beyond the rearmost surface: rays reach its bulging rim outside of it.
const REACH: f64 = 1.5;

/// A box in the plane, symmetric in y.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    x: [f64; 2],
    y: f64,
}

/// The pupil of a ring of the film, for points on the +x axis.
#[derive(Clone, Debug, Default, PartialEq)]
struct Pupil {
    y: f64,
    step: f64,
    /// From where to where, in metres.
    rows: Vec<[f64; 2]>,
    /// Length of all rows before each, and of all.
    before: Vec<f64>,
}

/// The pupils of all points of a film.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Pupils {
    /// Half the film's diagonal.
    radius: f64,
    rings: Vec<Pupil>,
}

/// The lens in front of a film.
#[derive(Clone, Copy)]
struct Search<'a> {
    glass: &'a Glass,
    film: f64,
}

impl Search<'_> {
    fn passes(&self, at: f64, [x, y]: [f64; 2]) -> bool {
        let from = DVec3::new(at, 0.0, 0.0);
        self.glass.trace(self.film, from, DVec3::new(x, y, self.film) - from).is_some()
    }

    /// Half the cells of a grid over a window, those with y above 0, that let light from this point of the film pass.
    fn cells(&self, at: f64, window: Window, n: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let step = [(window.x[1] - window.x[0]) / n as f64, 2.0 * window.y / n as f64];
        let all = (0..n / 2).flat_map(move |j| (0..n).map(move |i| (i, j)));
        all.filter(move |&(i, j)| {
            let (x, y) = (window.x[0] + step[0] * (i as f64 + 0.5), step[1] * (j as f64 + 0.5));
            self.passes(at, [x, y])
        })
    }

    /// A box around what passes within a window; `None` if nothing does.
    fn narrowed(&self, at: f64, window: Window) -> Option<Window> {
        let step = window.step(COARSE);
        self.cells(at, window, COARSE).fold(None, |found: Option<Window>, (i, j)| {
            let x = [i as f64 - 1.0, i as f64 + 2.0].map(|i| window.x[0] + i * step[0]);
            let y = (j as f64 + 2.0) * step[1];
            Some(found.map_or(Window { x, y }, |f| f.with(&Window { x, y })))
        })
    }

    /// The same, `None` also if it may reach beyond the window.
    fn whole(&self, at: f64, window: Window) -> Option<Window> {
        let found = self.narrowed(at, window)?;
        let is_cut = found.x[0] < window.x[0] || found.x[1] > window.x[1] || found.y > window.y;
        (!is_cut).then_some(found)
    }

    /// A box around the pupil of the point on the axis; `None` if nothing passes.
    fn middle(&self) -> Option<Window> {
        // Of a tiny stop the widest grid meets nothing.
        [1.0, 0.05, 0.0025]
            .into_iter()
            .find_map(|factor| self.narrowed(0.0, self.everything().scaled(factor)))
    }

    fn everything(&self) -> Window {
        let r = REACH * self.glass.rear_radius();
        Window { x: [-r, r], y: r }
    }

    /// The same of another point, found from that of a point nearby in at most `2^steps` steps.
    fn followed(&self, (from, window): (f64, Window), at: f64, steps: u32) -> Option<Window> {
        let near = [2.0, 4.0, 8.0].into_iter().find_map(|factor| self.whole(at, window.scaled(factor)));
        near.or_else(|| self.narrowed(at, self.everything())).or_else(|| {
            let between = (from + at) * 0.5;
            let steps = steps.checked_sub(1)?;
            let window = self.followed((from, window), between, steps)?;
            self.followed((between, window), at, steps)
        })
    }
}

impl Window {
    fn with(&self, o: &Self) -> Self {
        Self { x: [self.x[0].min(o.x[0]), self.x[1].max(o.x[1])], y: self.y.max(o.y) }
    }
    fn scaled(&self, factor: f64) -> Self {
        let (middle, half) = ((self.x[0] + self.x[1]) * 0.5, (self.x[1] - self.x[0]) * 0.5 * factor);
        Self { x: [middle - half, middle + half], y: self.y * factor }
    }
    /// Sides of a cell of a grid of `n` times `n`.
    fn step(&self, n: usize) -> [f64; 2] {
        [(self.x[1] - self.x[0]) / n as f64, 2.0 * self.y / n as f64]
    }
}

impl Pupil {
    /// Of the ring of the film between two radii, whose windows are known.
    fn new(search: Search<'_>, ring: [f64; 2], window: Window) -> Self {
        let step = window.step(CELLS);
        let mut spans = vec![None; CELLS / 2];
        for at in ring {
            for (i, j) in search.cells(at, window, CELLS) {
                let (low, high) = spans[j].unwrap_or((i, i));
                spans[j] = Some((i.min(low), i.max(high)));
            }
        }
        // What a cell's middle does not show lies within a cell of it. Between the ring's edges the pupil moves along x.
        let widened = |j: usize| {
            let near = (j.saturating_sub(1)..=j + 1).filter_map(|j| spans.get(j).copied().flatten());
            let (low, high) = near.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
            Some([low as f64 - 1.0, high as f64 + 2.0].map(|i| window.x[0] + i * step[0]))
        };
        let half: Vec<[f64; 2]> = (0..CELLS / 2).map_while(widened).collect();
        let rows: Vec<[f64; 2]> = half.iter().rev().chain(&half).copied().collect();
        let mut before = vec![0.0];
        let mut sum = 0.0;
        for [low, high] in &rows {
            sum += high - low;
            before.push(sum);
        }
        Self { y: -(half.len() as f64) * step[1], step: step[1], rows, before }
    }

    /// In square metres.
    fn area(&self) -> f64 {
        self.before.last().map_or(0.0, |all| all * self.step)
    }

    /// A point for `u` in `[0, 1)²`, evenly spread; `None` of an empty one.
    fn at(&self, u: Point2) -> Option<[f64; 2]> {
        let (u, v) = (f64::from(u.x), f64::from(u.y));
        let along = v * self.before.last()?;
        let row = self.before.partition_point(|sum| *sum <= along).clamp(1, self.rows.len().max(1)) - 1;
        let [low, high] = *self.rows.get(row)?;
        let part = (along - self.before.get(row)?) / (high - low);
        Some([low + (high - low) * u, self.y + (row as f64 + part) * self.step])
    }
}

impl Pupils {
    /// Of a film at distance `film` behind the glass, `diagonal` metres across.
    pub(super) fn new(glass: &Glass, film: f64, diagonal: f64) -> Self {
        let (search, radius) = (Search { glass, film }, diagonal * 0.5);
        let at = |i: usize| radius * i as f64 / RINGS as f64;
        let mut last = search.middle();
        let mut rings = Vec::with_capacity(RINGS);
        for i in 0..RINGS {
            let next = last.and_then(|window| search.followed((at(i), window), at(i + 1), STEPS));
            let both = match (last, next) {
                (Some(a), Some(b)) => Some(a.with(&b)),
                (a, b) => a.or(b),
            };
            rings.push(both.map_or_else(Pupil::default, |w| Pupil::new(search, [at(i), at(i + 1)], w)));
            last = next;
        }
        Self { radius, rings }
    }

    /// A point of the rearmost surface's plane to look through from `film` (metres from its middle), evenly spread over
    /// `u` in `[0, 1)²`, and the area that such points are spread over; `None` where the lens leaves the film dark.
    pub(super) fn sample(&self, film: [f64; 2], u: Point2) -> Option<([f64; 2], f64)> {
        let r = (film[0] * film[0] + film[1] * film[1]).sqrt();
        let ring = ((r / self.radius * RINGS as f64) as usize).min(RINGS - 1);
        let pupil = self.rings.get(ring)?;
        let [x, y] = pupil.at(u)?;
        let [c, s] = if r > 0.0 { film.map(|v| v / r) } else { [1.0, 0.0] };
        Some(([c * x - s * y, s * x + c * y], pupil.area()))
    }
}
