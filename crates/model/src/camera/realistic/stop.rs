//! The shape of the aperture stop: how much light it lets through, by place. All shapes let through as much as a round hole
//! of the stop's radius does, on average over the square around it (as in pbrt-v4).
use std::{
    f32::consts::{FRAC_PI_2, TAU},
    f64::consts::{E, PI},
};

use durer_core::math::float::{cos, exp, sin};
use durer_scene::{Args, ImageData};

use crate::texture::imagemap::texels::Texels;

/// The shape of a stop.
#[derive(Clone, Debug)]
pub(super) enum Stop {
    /// Wherever the barrel lets light through.
    Round,
    Gaussian,
    Square,
    /// Corners one after another, and the factor inside.
    Polygon(Vec<[f64; 2]>, f64),
    /// A picture over the square around the stop, upper edge at +y.
    Picture(Box<Grey>),
}

/// A picture of one number per texel.
#[derive(Clone, Debug)]
pub(super) struct Grey {
    width: i64,
    height: i64,
    values: Vec<f32>,
}

/// Circumradius of pbrt's pentagon.
const PENTAGON: f32 = 0.8;

/// A polygon around the origin with the factor that makes it as bright as the unit disk.
fn polygon(corners: Vec<[f64; 2]>) -> Stop {
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let doubled: f64 = corners.iter().enumerate().map(|(i, a)| a[0] * next(i)[1] - a[1] * next(i)[0]).sum();
    let factor = PI / (0.5 * doubled.abs());
    Stop::Polygon(corners, factor)
}

impl Stop {
    /// What parameter `aperture` says: a shape's name or a picture's; `None` after a complaint.
    pub(super) fn read(args: &mut Args<'_>) -> Option<Self> {
        let around = |n: usize, first: f32, radii: [f32; 2]| {
            let corner = |i: usize| {
                let angle = first + TAU * i as f32 / n as f32;
                [cos(angle), sin(angle)].map(|v| f64::from(radii[i % 2] * v))
            };
            polygon((0..n).map(corner).collect())
        };
        Some(match args.text("aperture") {
            "" | "circular" => Self::Round,
            "gaussian" => Self::Gaussian,
            "square" => Self::Square,
            // As pbrt has them: a corner below, and a star of which one ray points to the left.
            "pentagon" => around(5, -FRAC_PI_2, [PENTAGON; 2]),
            "star" => around(10, 0.0, [cos(0.2 * TAU) / cos(0.1 * TAU), 1.0]),
            _ => Self::Picture(Box::new(Grey::read(args)?)),
        })
    }

    /// The share of light that passes at a place within the unit circle.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Round => 1.0,
            // Its integral over the disk is pi (1 - 2 / e).
            Self::Gaussian => (f64::from(exp(-(x * x + y * y) as f32)) - 1.0 / E).max(0.0) / (1.0 - 2.0 / E),
            Self::Square if x.abs() < 0.5 && y.abs() < 0.5 => PI,
            Self::Square => 0.0,
            Self::Polygon(corners, factor) if is_inside(corners, [x, y]) => *factor,
            Self::Polygon(..) => 0.0,
            Self::Picture(grey) => grey.at([x, y]),
        }
    }
}

/// Whether a ray to the right crosses an odd number of edges.
fn is_inside(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if (a[1] <= y) != (b[1] <= y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
            inside = !inside;
        }
    }
    inside
}

impl Grey {
    fn read(args: &mut Args<'_>) -> Option<Self> {
        let Some(image) = args.image("aperture") else {
            if args.is_sound() {
                args.error("aperture", "the aperture's picture is missing");
            }
            return None;
        };
        let texels = Texels::new(image.clone(), matches!(image.data, ImageData::U8(_)));
        let (width, height) = (texels.width(), texels.height());
        let value = |x: u32, y: u32| {
            let [r, g, b, _] = texels.rgba(x, y);
            ((r + g + b) / 3.0).max(0.0)
        };
        let mut values: Vec<f32> =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| value(x, y)).collect();
        let sum: f64 = values.iter().map(|v| f64::from(*v)).sum();
        let scale = PI / 4.0 * values.len() as f64 / sum;
        if !(scale.is_finite() && scale > 0.0) {
            args.error(
                "aperture",
                "the aperture's picture lets no light through: it is black, or not finite",
            );
            return None;
        }
        values.iter_mut().for_each(|v| *v = (f64::from(*v) * scale) as f32);
        Some(Self { width: width.into(), height: height.into(), values })
    }

    fn texel(&self, x: i64, y: i64) -> f64 {
        let inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        let value = self.values.get((y * self.width + x) as usize).filter(|_| inside);
        value.map_or(0.0, |v| f64::from(*v))
    }

    /// Bilinear between the texels' middles, black around them.
    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let u = (x + 1.0) * 0.5 * self.width as f64 - 0.5;
        let v = (1.0 - y) * 0.5 * self.height as f64 - 0.5;
        let ([i, j], [s, t]) = ([u.floor(), v.floor()], [u - u.floor(), v - v.floor()]);
        let (i, j) = (i as i64, j as i64);
        let row = |j: i64| self.texel(i, j) * (1.0 - s) + self.texel(i + 1, j) * s;
        row(j) * (1.0 - t) + row(j + 1) * t
    }
}
