//! Intensities at angles, as a goniophotometer measures them (type C of LM-63): down from the nadir and around it, bilinear
//! in between.
use std::f64::consts::{PI, TAU};

use durer_core::math::{
    Vector3,
    float::{atan2, lerp},
};

/// Intensities by angle.
#[derive(Debug, PartialEq)]
pub(super) struct Profile {
    /// Angles from the nadir, rising, in radians.
    down: Vec<f32>,
    /// Angles around, rising from 0, in radians; the last is that of the symmetry.
    around: Vec<f32>,
    symmetry: Symmetry,
    /// Candela, for each angle around those of all angles down.
    values: Vec<f32>,
}

/// What the angles around stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symmetry {
    /// A single angle: all alike.
    Round,
    /// Up to 90 degrees: all quarters alike.
    Quarters,
    /// Up to 180 degrees: both halves alike.
    Halves,
    /// From 90 to 270 degrees, counted from 90.
    OtherHalves,
    /// A whole turn.
    None,
}

impl Profile {
    /// From angles in degrees and `around.len()` rows of `down.len()` values; the reason if that makes no profile.
    pub(super) fn new(down: &[f64], around: &[f64], values: Vec<f32>) -> Result<Self, String> {
        let rises = |angles: &[f64]| angles.windows(2).all(|pair| pair[0] < pair[1]);
        if !rises(down) || !rises(around) {
            return Err("its angles do not rise".to_owned());
        }
        let (Some(&top), Some(&bottom)) = (down.last(), down.first()) else {
            return Err("it has no angles".to_owned());
        };
        if !(0.0..=180.0).contains(&bottom) || top > 180.0 {
            return Err(format!("vertical angles go from {bottom} to {top}, expected 0 to 180"));
        }
        let (first, last) = (around.first().copied().unwrap_or(0.0), around.last().copied().unwrap_or(0.0));
        let symmetry = match (first, last) {
            _ if around.len() == 1 => Symmetry::Round,
            (0.0, 90.0) => Symmetry::Quarters,
            (0.0, 180.0) => Symmetry::Halves,
            (90.0, 270.0) => Symmetry::OtherHalves,
            (0.0, 360.0) => Symmetry::None,
            _ => {
                return Err(format!(
                    "horizontal angles go from {first} to {last}, expected 0 to 90, 180 or 360"
                ));
            }
        };
        if values.len() != down.len() * around.len() {
            return Err(format!(
                "it has {} intensities for {} angles",
                values.len(),
                down.len() * around.len()
            ));
        }
        if let Some(bad) = values.iter().find(|v| !(v.is_finite() && **v >= 0.0)) {
            return Err(format!("an intensity is {bad}"));
        }
        let radians = |angle: &f64| angle.to_radians() as f32;
        Ok(Self {
            down: down.iter().map(radians).collect(),
            around: around.iter().map(|angle| radians(&(angle - first))).collect(),
            symmetry,
            values,
        })
    }

    /// The same everywhere: what a missing file becomes.
    pub(super) fn even() -> Self {
        let down = vec![0.0, PI as f32];
        Self { down, around: vec![0.0], symmetry: Symmetry::Round, values: vec![1.0; 2] }
    }

    /// The intensity in unit direction `d`: z is the nadir, angles around go from x to y.
    pub(super) fn at(&self, d: Vector3) -> f32 {
        let below = atan2((d.x * d.x + d.y * d.y).sqrt(), d.z);
        let Some((row, t)) = within(&self.down, below) else { return 0.0 };
        let azimuth = atan2(d.y, d.x);
        let (half, quarter) = (PI as f32, 0.5 * PI as f32);
        let angle = match self.symmetry {
            Symmetry::Round => 0.0,
            Symmetry::Quarters => quarter - (azimuth.abs() - quarter).abs(),
            Symmetry::Halves => azimuth.abs(),
            Symmetry::OtherHalves => half - (half - (azimuth - quarter).rem_euclid(2.0 * half)).abs(),
            Symmetry::None => azimuth.rem_euclid(2.0 * half),
        };
        let value = |column: usize| {
            let of = |row: usize| self.values[column * self.down.len() + row];
            lerp(t, of(row), of((row + 1).min(self.down.len() - 1)))
        };
        match within(&self.around, angle.min(self.around.last().copied().unwrap_or(0.0))) {
            Some((column, s)) => lerp(s, value(column), value((column + 1).min(self.around.len() - 1))),
            None => 0.0,
        }
    }

    /// The angle from the nadir beyond which it is dark.
    pub(super) fn end(&self) -> f32 {
        let rows = self.down.len();
        let shines = |row: usize| self.values.iter().skip(row).step_by(rows).any(|v| *v > 0.0);
        let last = (0..rows).rev().find(|row| shines(*row)).unwrap_or(0);
        self.down[(last + 1).min(rows - 1)]
    }

    /// The largest intensity.
    pub(super) fn largest(&self) -> f32 {
        self.values.iter().copied().fold(0.0, f32::max)
    }

    /// The integral over all directions: intensities are linear in the angle down, by its sine.
    pub(super) fn integral(&self) -> f32 {
        let rows = self.down.len();
        let column = |column: usize| {
            let values = &self.values[column * rows..(column + 1) * rows];
            let ring = |i: usize| {
                let [a, b] = [self.down[i], self.down[i + 1]].map(f64::from);
                let [v, w] = [values[i], values[i + 1]].map(f64::from);
                let slope = (w - v) / (b - a);
                v * libm::cos(a) - w * libm::cos(b) + slope * (libm::sin(b) - libm::sin(a))
            };
            (0..rows - 1).map(ring).sum::<f64>()
        };
        let columns: Vec<f64> = (0..self.around.len()).map(column).collect();
        let (Some(&last), Some(&only)) = (self.around.last(), columns.first()) else { return 0.0 };
        if self.around.len() == 1 {
            return (TAU * only) as f32;
        }
        let wedge =
            |i: usize| f64::from(self.around[i + 1] - self.around[i]) * 0.5 * (columns[i] + columns[i + 1]);
        let sum: f64 = (0..columns.len() - 1).map(wedge).sum();
        (sum * TAU / f64::from(last)) as f32
    }
}

/// Between which of rising angles one lies, and how far; `None` outside.
fn within(angles: &[f32], angle: f32) -> Option<(usize, f32)> {
    let after = angles.partition_point(|a| *a <= angle);
    let before = after.checked_sub(1)?;
    match angles.get(after) {
        Some(next) => Some((before, (angle - angles[before]) / (next - angles[before]))),
        None => (angle <= angles[before]).then_some((before, 0.0)),
    }
}
