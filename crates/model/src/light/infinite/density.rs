//! Directions of a picture around everything, drawn in proportion to the light that comes from them.
//!
//! The density is constant on the cell of each pixel, in solid angle, and proportional to the mean of the luminance that
//! rays see there: between the centres of pixels they see a bilinear mixture, of which the cell's own pixel has the share
//! 3/4 in each direction of the picture and its neighbours have 1/8. So it is above 0 wherever the picture is.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Vector3,
        float::{cos, lerp, sin},
    },
    spectrum::Color,
};
use rayon::prelude::*;

use super::{super::steps, layout::Layout, panorama::Panorama};

/// Shares of the pixels about a cell in its mean, in one direction.
const TENT: [f32; 3] = [0.125, 0.75, 0.125];

/// The density of directions of a picture.
#[derive(Debug)]
pub(super) struct Density {
    layout: Layout,
    size: [u32; 2],
    /// Sums of the shares of the rows.
    rows: Vec<f32>,
    /// Within each row, sums of the shares of the columns.
    columns: Vec<f32>,
    /// Mean luminance over the sphere.
    pub(super) mean: f32,
}

/// The solid angle of the cells of a row.
fn cell(layout: Layout, row: u32, [width, height]: [u32; 2]) -> f32 {
    match layout {
        Layout::PoleToPole(_) => {
            let above = |row: u32| layout.share_above(f64::from(row) / f64::from(height));
            (4.0 * std::f64::consts::PI * (above(row + 1) - above(row)) / f64::from(width)) as f32
        }
        Layout::LatitudeLongitude => {
            // cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2)
            let half = 0.5 * PI / height as f32;
            let middle = (2 * row + 1) as f32 * half;
            TAU / width as f32 * 2.0 * sin(middle) * sin(half)
        }
        Layout::EqualArea => 4.0 * PI / (width as f32 * height as f32),
    }
}

impl Density {
    /// That of a picture; `None` if it is black.
    pub(super) fn of(picture: &Panorama) -> Option<Self> {
        let (layout, size) = (picture.layout(), picture.size());
        let [width, height] = size;
        let luminances: Vec<f32> = (0..height)
            .into_par_iter()
            .flat_map_iter(|y| (0..width).map(move |x| Color { rgb: picture.pixel(x, y) }.luminance()))
            .collect();
        let seen = |x: i64, y: i64| {
            let (x, y) = layout.wrapped(x, y, size);
            luminances[(y * width + x) as usize]
        };
        let mean = |x: i64, y: i64| {
            let across = |y: i64| (-1..).zip(TENT).map(|(i, t)| t * seen(x + i, y)).sum::<f32>();
            (-1..).zip(TENT).map(|(j, t)| t * across(y + j)).sum::<f32>()
        };
        let mut columns = vec![0.0; luminances.len()];
        let mut rows = vec![0.0; height as usize];
        let lines = columns.par_chunks_mut(width as usize).zip(&mut rows).enumerate();
        lines.for_each(|(y, (line, row))| {
            for (x, value) in (0..).zip(line.iter_mut()) {
                *value = mean(x, y as i64);
            }
            *row = (steps::accumulate(line) * f64::from(cell(layout, y as u32, size))) as f32;
        });
        let total = steps::accumulate(&mut rows);
        let mean = (total / (4.0 * std::f64::consts::PI)) as f32;
        (total > 0.0).then_some(Self { layout, size, rows, columns, mean })
    }

    fn line(&self, row: usize) -> &[f32] {
        let width = self.size[0] as usize;
        &self.columns[row * width..(row + 1) * width]
    }

    /// A direction and its density, 1/sr; `u` in `[0, 1)²`.
    pub(super) fn draw(&self, u: [f32; 2]) -> (Vector3, f32) {
        let (row, v, row_share) = steps::pick(&self.rows, u[1]);
        let (column, u, share) = steps::pick(self.line(row), u[0]);
        let [width, height] = self.size.map(|n| n as f32);
        let d = match self.layout {
            Layout::LatitudeLongitude | Layout::PoleToPole(_) => {
                // Even in z: down the cell by the share of its solid angle.
                let above = |row: usize| self.layout.share_above(row as f64 / f64::from(height)) as f32;
                let share = lerp(v, above(row), above(row + 1));
                let r = 2.0 * (share * (1.0 - share)).max(0.0).sqrt();
                let azimuth = (column as f32 + u) / width * TAU;
                Vector3::new(r * cos(azimuth), r * sin(azimuth), 1.0 - 2.0 * share)
            }
            Layout::EqualArea => {
                self.layout.direction([(column as f32 + u) / width, (row as f32 + v) / height])
            }
        };
        (d, share * row_share / cell(self.layout, row as u32, self.size))
    }

    /// The density of unit direction `d`, 1/sr.
    pub(super) fn at(&self, d: Vector3) -> f32 {
        let [u, v] = self.layout.uv(d);
        let [width, height] = self.size;
        let column = ((u * width as f32) as u32).min(width - 1) as usize;
        let row = ((v * height as f32) as u32).min(height - 1);
        let share = steps::share(self.line(row as usize), column) * steps::share(&self.rows, row as usize);
        share / cell(self.layout, row, self.size)
    }
}
