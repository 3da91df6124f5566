//! Phase functions by a table: values at even steps of the cosine of the deflection, from straight back (-1) to straight on (1),
//! with straight lines between them. They are scaled to a density, and drawn from exactly.
use std::f64::consts::TAU;

use durer_core::{math::float::lerp, sampling::LinearDensity};

/// Such a phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Densities, 1/sr.
    values: Vec<f32>,
    drawn: LinearDensity,
}

impl Table {
    /// From at least two values that are not negative; `None` of fewer, or if all are 0.
    pub(super) fn new(values: &[f32]) -> Option<Self> {
        if values.iter().any(|v| *v < 0.0 || !v.is_finite()) {
            return None;
        }
        let drawn = LinearDensity::new(values.iter().copied())?;
        let wide = |v: f32| f64::from(v);
        let area: f64 = values.windows(2).map(|v| 0.5 * (wide(v[0]) + wide(v[1]))).sum();
        let all = TAU * area * 2.0 / (values.len() - 1) as f64;
        let values = values.iter().map(|v| (wide(*v) / all) as f32).collect();
        Some(Self { values, drawn })
    }
    fn steps(&self) -> usize {
        self.values.len() - 1
    }
    /// The mean cosine of the deflection.
    pub(super) fn mean_cos(&self) -> f32 {
        let width = 2.0 / self.steps() as f64;
        let parts = self.values.windows(2).enumerate().map(|(i, v)| {
            let (low, a, b) = (-1.0 + width * i as f64, f64::from(v[0]), f64::from(v[1]));
            // The integral of a product of two straight lines.
            width * (low * 0.5 * (a + b) + width * (a + 2.0 * b) / 6.0)
        });
        (TAU * parts.sum::<f64>()) as f32
    }
    /// Density of going on with this cosine of the deflection, 1/sr.
    pub(super) fn density(&self, cos: f32) -> f32 {
        let place = (0.5 + 0.5 * cos).clamp(0.0, 1.0) * self.steps() as f32;
        let before = (place as usize).min(self.steps() - 1);
        lerp(place - before as f32, self.values[before], self.values[before + 1])
    }
    /// The cosine of a deflection, drawn by `u` in `[0, 1)`.
    pub(super) fn cos(&self, u: f32) -> f32 {
        (2.0 * self.drawn.at(u) - 1.0).clamp(-1.0, 1.0)
    }
}
