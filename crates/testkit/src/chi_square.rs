//! Pearson's test of directions against the density they claim to have.
use std::f64::consts::TAU;

use glam::DVec3;

/// Cells of equal solid angle: rows in z, columns around.
const ROWS: usize = 20;
const COLUMNS: usize = 40;
/// Points along each edge of a cell at which its density is integrated.
const FINE: usize = 24;

/// Counts of directions, cell by cell.
#[derive(Clone, Debug)]
pub struct Histogram {
    counts: Vec<u64>,
    total: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: vec![0; ROWS * COLUMNS], total: 0 }
    }
}

impl Histogram {
    /// Counts a unit direction.
    pub fn add(&mut self, w: DVec3) {
        let row = ((1.0 - w.z) * 0.5 * ROWS as f64) as usize;
        let column = (w.y.atan2(w.x).rem_euclid(TAU) / TAU * COLUMNS as f64) as usize;
        self.counts[row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)] += 1;
        self.total += 1;
    }
    /// Counts a draw that gave no direction.
    pub fn miss(&mut self) {
        self.total += 1;
    }
    /// The probability of counts this far off if draws had the density `pdf` (1/sr; what it lacks to 1 are the misses).
    /// Cells that expect fewer than five counts are taken together.
    pub fn p_value(&self, pdf: impl Fn(DVec3) -> f64) -> f64 {
        let total = self.total as f64;
        let expected: Vec<f64> = (0..ROWS * COLUMNS).map(|cell| total * mass(cell, &pdf)).collect();
        let mut cells: Vec<(f64, f64)> =
            expected.into_iter().zip(self.counts.iter().map(|&c| c as f64)).collect();
        let hit: (f64, f64) = cells.iter().fold((0.0, 0.0), |s, c| (s.0 + c.0, s.1 + c.1));
        cells.push(((total - hit.0).max(0.0), total - hit.1));
        cells.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut statistic, mut freedom, mut pooled) = (0.0, -1.0, (0.0, 0.0));
        for (expected, counted) in cells {
            pooled = (pooled.0 + expected, pooled.1 + counted);
            if pooled.0 >= 5.0 {
                statistic += (pooled.1 - pooled.0).powi(2) / pooled.0;
                freedom += 1.0;
                pooled = (0.0, 0.0);
            }
        }
        upper_tail(statistic, freedom)
    }
}

/// The integral of `pdf` over a cell.
fn mass(cell: usize, pdf: &impl Fn(DVec3) -> f64) -> f64 {
    let (row, column) = (cell / COLUMNS, cell % COLUMNS);
    let mut sum = 0.0;
    for i in 0..FINE {
        let z = 1.0 - 2.0 * (row as f64 + (i as f64 + 0.5) / FINE as f64) / ROWS as f64;
        let r = (1.0 - z * z).sqrt();
        for j in 0..FINE {
            let phi = (column as f64 + (j as f64 + 0.5) / FINE as f64) / COLUMNS as f64 * TAU;
            sum += pdf(DVec3::new(r * phi.cos(), r * phi.sin(), z));
        }
    }
    sum * 2.0 * TAU / (ROWS * COLUMNS * FINE * FINE) as f64
}

/// Probability that chi-square of this many degrees of freedom exceeds `x` (Wilson and Hilferty 1931; good to 1e-3).
fn upper_tail(x: f64, freedom: f64) -> f64 {
    let k = 2.0 / (9.0 * freedom);
    let z = ((x / freedom).cbrt() - (1.0 - k)) / k.sqrt();
    0.5 * erfc(z / std::f64::consts::SQRT_2)
}

/// Complementary error function (Abramowitz and Stegun 7.1.26; good to 2e-7).
fn erfc(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let series = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    let tail = series.iter().rev().fold(0.0, |sum, c| (sum + c) * t) * (-x * x).exp();
    if x < 0.0 { 2.0 - tail } else { tail }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn right_densities_pass_and_wrong_ones_fail() {
        let mut random = Random::new(4);
        let mut uniform = Histogram::default();
        (0..100_000).for_each(|_| uniform.add(random.direction()));
        let density = 0.5 / TAU;
        assert!(uniform.p_value(|_| density) > 0.001);
        assert!(uniform.p_value(|w| density * (1.0 + 0.1 * w.x)) < 1e-6);
        assert!(uniform.p_value(|_| density * 0.98) < 1e-6, "misses that were none");
    }

    #[test]
    fn known_quantiles_come_out() {
        for (x, freedom, p) in [(18.307, 10.0, 0.05), (124.342, 100.0, 0.05), (135.807, 100.0, 0.01)] {
            assert!((upper_tail(x, freedom) - p).abs() < 2e-3, "{x} {freedom}");
        }
    }
}
