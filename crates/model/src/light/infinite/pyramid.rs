//! A picture in ever coarser cells, and its averages over lobes of directions.
//!
//! The finest cells are exact means over solid angle of the picture's pixels: no light is lost or gained. A lobe is summed
//! over the coarsest cells that are small compared with their distance from the lobe's axis (the way of Barnes and Hut 1986
//! with gravity). A cell's light acts from the centroid of its light, so that a sun stays where it is.
use durer_core::{
    math::{Vector3, float::sqr},
    spectrum::Color,
};
use rayon::prelude::*;

use super::{layout::Layout, panorama::Panorama};

/// Least and most rows of the finest cells.
const ROWS: [u32; 2] = [64, 512];
/// Rows of the coarsest cells.
const COARSEST: u32 = 4;
/// Cells are divided until their size is at most this share of their distance to the axis and the lobe's width.
const TOLERANCE: f32 = 0.35;
/// A weight on directions about an axis.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lobe {
    /// The cosine over the hemisphere: irradiance.
    Cosine,
    /// What a GGX surface of this alpha mirrors when it is seen along its normal, weighted by the cosine (Karis 2013):
    /// with h half way between axis and direction `D(h) cos`.
    Glossy(f32),
}

impl Lobe {
    /// The weight at cosine `c` from the axis, up to a factor.
    fn weight(self, c: f32) -> f32 {
        match self {
            _ if c <= 0.0 => 0.0,
            Self::Cosine => c,
            Self::Glossy(alpha) => {
                let (cos2, sin2) = (0.5 + 0.5 * c, 0.5 - 0.5 * c);
                c * sqr(sqr(alpha) / (sin2.max(0.0) + sqr(alpha) * cos2))
            }
        }
    }
    /// Roughly its width as an angle.
    fn width(self) -> f32 {
        match self {
            Self::Cosine => 1.0,
            Self::Glossy(alpha) => 2.0 * alpha,
        }
    }
    /// Largest angle of a cell that may stand for its parts: little of a narrow lobe lies far from its axis.
    fn largest_cell(self) -> f32 {
        if self.width() < 0.2 { 0.4 } else { 0.2 }
    }
}

/// A part of the sphere.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    /// Mean radiance.
    mean: [f32; 3],
    /// Solid angle.
    omega: f32,
    /// Mean direction; a little shorter than 1 in large cells.
    center: Vector3,
    /// Mean direction of its light.
    lit: Vector3,
}

/// Cells of one size, in rows.
#[derive(Debug)]
struct Level {
    columns: u32,
    /// Roughly the angle across a cell.
    angle: f32,
    cells: Vec<Cell>,
}

/// All cells, the finest first.
#[derive(Debug)]
pub(super) struct Pyramid {
    levels: Vec<Level>,
}

/// For each of `count` equal parts of the picture's edge: which pixels of `pixels` reach into it, and their shares.
fn shares(pixels: u32, count: u32, measure: impl Fn(f64) -> f64) -> Vec<Vec<(u32, f32)>> {
    let part = |i: u32| f64::from(i) / f64::from(count);
    let reach = |i: u32| {
        let (from, to) = (part(i), part(i + 1));
        let first = ((from * f64::from(pixels)) as u32).min(pixels - 1);
        let last = ((to * f64::from(pixels)).ceil() as u32).clamp(first + 1, pixels);
        let whole = measure(to) - measure(from);
        let share = |p: u32| {
            let (a, b) = (f64::from(p) / f64::from(pixels), f64::from(p + 1) / f64::from(pixels));
            (measure(b.min(to)) - measure(a.max(from))) / whole
        };
        (first..last).map(|p| (p, share(p) as f32)).collect()
    };
    (0..count).map(reach).collect()
}

impl Pyramid {
    /// Cells of the picture.
    pub(super) fn of(picture: &Panorama) -> Self {
        let layout = picture.layout();
        let [width, height] = picture.size();
        let wanted = match layout {
            Layout::LatitudeLongitude | Layout::PoleToPole(_) => height.max(width / 2),
            Layout::EqualArea => height,
        };
        let rows = wanted.clamp(ROWS[0], ROWS[1]).next_power_of_two();
        let columns = if layout == Layout::EqualArea { rows } else { 2 * rows };
        let across = shares(width, columns, |t| t);
        let down = shares(height, rows, |t| layout.share_above(t));
        let place = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
        let row = |y: u32| {
            let part = |v: u32| layout.share_above(f64::from(v) / f64::from(rows));
            let omega = 4.0 * std::f64::consts::PI * (part(y + 1) - part(y)) / f64::from(columns);
            let mut sums = vec![[0.0f32; 3]; columns as usize];
            for &(py, share_y) in &down[y as usize] {
                for (sum, pixels) in sums.iter_mut().zip(&across) {
                    for &(px, share_x) in pixels {
                        let rgb = picture.pixel(px, py);
                        for (s, v) in sum.iter_mut().zip(rgb) {
                            *s += v * (share_x * share_y);
                        }
                    }
                }
            }
            let cell = |(x, mean): (usize, [f32; 3])| {
                let center = layout.direction([place(x as u32, columns), place(y, rows)]);
                Cell { mean, omega: omega as f32, center, lit: center }
            };
            sums.into_iter().enumerate().map(cell).collect::<Vec<_>>()
        };
        let cells = (0..rows).into_par_iter().flat_map_iter(row).collect();
        let mut levels = vec![Level { columns, angle: layout.texel_angle(rows), cells }];
        let mut rows = rows / 2;
        while rows >= COARSEST {
            if let Some(finer) = levels.last() {
                levels.push(finer.halved(layout.texel_angle(rows)));
            }
            rows /= 2;
        }
        Self { levels }
    }

    /// Luminance of the irradiance of a plane that faces +z.
    pub(super) fn illuminance(&self) -> f32 {
        let cells = self.levels[0].cells.iter();
        let lights = cells.map(|c| f64::from(luminance(c) * c.omega * c.center.z.max(0.0)));
        lights.sum::<f64>() as f32
    }

    /// Mean radiance over the lobe about unit direction `axis`.
    pub(super) fn mean(&self, lobe: Lobe, axis: Vector3) -> [f32; 3] {
        let top = self.levels.len() - 1;
        let mut sum = Sum::default();
        let columns = self.levels[top].columns as usize;
        for i in 0..self.levels[top].cells.len() {
            self.add(&mut sum, lobe, axis, top, (i % columns, i / columns));
        }
        sum.light.map(|v| (v / sum.weight) as f32)
    }

    /// Adds the cell at column `x` and row `y` of a level, or its parts.
    fn add(&self, sum: &mut Sum, lobe: Lobe, axis: Vector3, level: usize, (x, y): (usize, usize)) {
        let Level { columns, angle, cells } = &self.levels[level];
        let cell = &cells[y * *columns as usize + x];
        let c = axis.dot(cell.center);
        if c < -*angle {
            return;
        }
        let distance = (2.0 - 2.0 * c).max(0.0).sqrt();
        let largest = (TOLERANCE * (lobe.width() + distance)).min(lobe.largest_cell());
        if *angle > largest && level > 0 {
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                self.add(sum, lobe, axis, level - 1, (2 * x + dx, 2 * y + dy));
            }
            return;
        }
        sum.weight += f64::from(lobe.weight(c) * cell.omega);
        let light = f64::from(lobe.weight(axis.dot(cell.lit)) * cell.omega);
        for (s, v) in sum.light.iter_mut().zip(cell.mean) {
            *s += light * f64::from(v);
        }
    }
}

#[derive(Default)]
struct Sum {
    light: [f64; 3],
    weight: f64,
}

fn luminance(cell: &Cell) -> f32 {
    Color { rgb: cell.mean }.luminance()
}

impl Level {
    /// Cells of twice the width and height.
    fn halved(&self, angle: f32) -> Self {
        let from = self.columns as usize;
        let columns = from / 2;
        let rows = self.cells.len() / from / 2;
        let joined = |i: usize| {
            let first = 2 * (i / columns) * from + 2 * (i % columns);
            let parts = [first, first + 1, first + from, first + from + 1].map(|p| &self.cells[p]);
            join(parts)
        };
        let cells = (0..columns * rows).map(joined).collect();
        Self { columns: columns as u32, angle, cells }
    }
}

fn join(parts: [&Cell; 4]) -> Cell {
    let omega: f32 = parts.iter().map(|p| p.omega).sum();
    let mean = std::array::from_fn(|c| parts.iter().map(|p| p.mean[c] * (p.omega / omega)).sum());
    let weighted = |weight: &dyn Fn(&Cell) -> f32, at: &dyn Fn(&Cell) -> Vector3| {
        let total: f32 = parts.iter().map(|p| weight(p)).sum();
        let sum = parts.iter().fold(Vector3::ZERO, |sum, p| sum + at(p) * (weight(p) / total));
        (total > 0.0 && total.is_finite()).then_some(sum)
    };
    let center = weighted(&|p| p.omega, &|p| p.center).unwrap_or(parts[0].center);
    let lit = weighted(&|p| p.omega * luminance(p), &|p| p.lit).unwrap_or(center);
    Cell { mean, omega, center, lit }
}
