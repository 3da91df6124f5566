//! Particles of several kinds side by side: a mean of phase functions, whose weights may change from place to place.
//!
//! One of them is drawn by the weights; directions have the density of all together.
use durer_core::{
    math::{Point2, Point3, Transform, Vector3},
    spectrum::{Basis, Spectrum},
};

use super::{super::grid::Grid, Phase, Turn};

/// Such a mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Blend {
    /// Each with its weights over the unit cube.
    parts: Vec<(Phase, Grid<f32>)>,
    cube_from_render: Transform,
}

impl Blend {
    /// Of parts with as many weights for each place, those of a place side by side, x fastest; or for all places.
    ///
    /// # Errors
    /// What is wrong with the weights.
    pub(super) fn new(parts: Vec<Phase>, size: [usize; 3], weights: &[f32]) -> Result<Self, String> {
        let count = parts.len();
        let size = if weights.len() == count { [1; 3] } else { size };
        if let Some(bad) = weights.chunks(count).position(|place| place.iter().all(|w| *w <= 0.0)) {
            return Err(format!("all {count} weights from number {} on are 0", bad * count));
        }
        let [nx, ny, nz] = size;
        let wrong = || {
            let found = weights.len();
            format!("{found} numbers, expected {count} for each of {nx} x {ny} x {nz} places")
        };
        let grid = |i: usize| {
            Grid::new(size, weights.iter().skip(i).step_by(count).copied().collect())
                .map(|grid| grid.clamped(true))
        };
        let parts = parts.into_iter().enumerate().map(|(i, phase)| grid(i).map(|grid| (phase, grid)));
        let parts = parts.collect::<Option<Vec<_>>>().ok_or_else(wrong)?;
        Ok(Self { parts, cube_from_render: Transform::IDENTITY })
    }
    pub(super) fn place(&mut self, cube_from_render: &Transform) {
        self.cube_from_render = *cube_from_render;
        self.parts.iter_mut().for_each(|(phase, _)| phase.place(cube_from_render));
    }
    /// Whether it is the same everywhere.
    pub(super) fn is_even(&self) -> bool {
        self.parts.iter().all(|(phase, grid)| grid.values().len() == 1 && phase.is_even())
    }
    /// Whether light goes back as it came.
    pub(super) fn is_symmetric(&self) -> bool {
        self.parts.iter().all(|(phase, _)| phase.is_symmetric())
    }
    /// The mean cosine of the deflection, by the mean of the weights.
    pub(super) fn mean_cos(&self) -> f32 {
        let sum = |grid: &Grid<f32>| grid.values().iter().sum::<f32>();
        let all: f32 = self.parts.iter().map(|(_, grid)| sum(grid)).sum();
        self.parts.iter().map(|(phase, grid)| phase.g() * sum(grid) / all).sum()
    }
    /// The parts with their weights at a point of render space, which add up to 1.
    fn at(&self, p: Point3) -> impl Iterator<Item = (&Phase, f32)> {
        let q = if self.is_even() { [0.5; 3] } else { self.cube_from_render.point(p).to_array() };
        let all: f32 = self.parts.iter().map(|(_, grid)| grid.at(q)).sum();
        self.parts.iter().map(move |(phase, grid)| (phase, grid.at(q) / all))
    }
    /// Density of this turn, 1/sr.
    pub(super) fn density(&self, turn: &Turn) -> f32 {
        self.at(turn.p).map(|(phase, weight)| weight * phase.density(turn)).sum()
    }
    /// The share of light that goes there by that density.
    pub(super) fn tint(&self, basis: &Basis, turn: &Turn) -> Spectrum {
        let mut sum = (Spectrum::BLACK, 0.0);
        for (phase, weight) in self.at(turn.p) {
            let density = weight * phase.density(turn);
            sum = (sum.0 + phase.tint(basis, turn) * density, sum.1 + density);
        }
        if sum.1 > 0.0 { sum.0 / sum.1 } else { Spectrum::ONE }
    }
    /// A unit direction after unit direction `from`, at a point of the unit square.
    pub(super) fn deflected(&self, (p, from): (Point3, Vector3), u: Point2) -> Vector3 {
        let (mut left, mut last) = (u.x, None);
        for (phase, weight) in self.at(p).filter(|(_, weight)| *weight > 0.0) {
            if left < weight {
                return phase.deflected((p, from), Point2::new((left / weight).min(LARGEST), u.y));
            }
            left -= weight;
            last = Some(phase);
        }
        // Rounding led beyond the last one.
        last.map_or(from, |phase| phase.deflected((p, from), Point2::new(LARGEST, u.y)))
    }
}

/// The largest number below 1.
const LARGEST: f32 = 1.0 - f32::EPSILON / 2.0;
