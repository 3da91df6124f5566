//! Directions for particles of a pattern: its cone in cells of equal solid angle, each chosen by what it has.
use std::f32::consts::TAU;

use durer_core::math::{
    Frame, Normal3, Point2, Vector3,
    float::{atan2, cos, sin, sqr},
};

use super::{beam::Pattern, steps};

/// Cells from the axis to the rim, and around.
const CELLS: [usize; 2] = [64, 128];
/// Looks into each cell, in both ways.
const LOOKS: usize = 2;
/// What a cell in which nothing was found has of the mean: there may be something all the same.
const LEAST: f32 = 0.02;

/// The cells of a pattern.
#[derive(Debug)]
pub(super) struct PatternRays {
    frame: Frame,
    /// `1 - cos` of the cone's angle.
    opening: f32,
    /// Sums of the shares of the cells.
    sums: Vec<f32>,
}

impl PatternRays {
    pub(super) fn of(pattern: &dyn Pattern) -> Self {
        let cone = pattern.cone();
        let opening = 1.0 - cos(cone.angle.min(0.5 * TAU));
        let mut rays = Self { frame: Frame::from_z(Normal3::from(cone.axis)), opening, sums: Vec::new() };
        let [rings, sectors] = CELLS;
        let look = |cell: usize| {
            let at = |place: usize, k: usize, n: usize| {
                (place as f32 + (k as f32 + 0.5) / LOOKS as f32) / n as f32
            };
            let of = |k: usize| {
                let place = [at(cell / sectors, k / LOOKS, rings), at(cell % sectors, k % LOOKS, sectors)];
                pattern.intensity(rays.place(place)).luminance()
            };
            (0..LOOKS * LOOKS).map(of).sum::<f32>()
        };
        let mut weights: Vec<f32> = (0..rings * sectors).map(look).collect();
        let mean = weights.iter().sum::<f32>() / weights.len() as f32;
        weights.iter_mut().for_each(|w| *w += LEAST * mean + f32::MIN_POSITIVE);
        steps::accumulate(&mut weights);
        rays.sums = weights;
        rays
    }
    /// The unit direction at a share of the solid angle and of a turn.
    fn place(&self, [down, turn]: [f32; 2]) -> Vector3 {
        let below = down * self.opening;
        let (r, azimuth) = ((below * (2.0 - below)).max(0.0).sqrt(), TAU * turn);
        self.frame.to_world(Vector3::new(r * cos(azimuth), r * sin(azimuth), 1.0 - below)).normalize()
    }
    /// The one that `u` in `[0, 1)²` chooses.
    pub(super) fn direction(&self, u: Point2) -> Vector3 {
        let (cell, rest, _) = steps::pick(&self.sums, u.x);
        let [rings, sectors] = CELLS;
        self.place([
            ((cell / sectors) as f32 + rest) / rings as f32,
            ((cell % sectors) as f32 + u.y) / sectors as f32,
        ])
    }
    /// Its density at unit direction `d`, 1/sr.
    pub(super) fn density(&self, d: Vector3) -> f32 {
        let local = self.frame.to_local(d);
        // 1 - cos, to all digits.
        let below = 0.5 * (sqr(local.x) + sqr(local.y) + sqr(1.0 - local.z));
        let turn = (atan2(local.y, local.x) / TAU).rem_euclid(1.0);
        let [rings, sectors] = CELLS;
        let ring = (below / self.opening * rings as f32) as usize;
        if ring >= rings {
            return 0.0;
        }
        let sector = ((turn * sectors as f32) as usize).min(sectors - 1);
        steps::share(&self.sums, ring * sectors + sector) * (rings * sectors) as f32 / (TAU * self.opening)
    }
}
