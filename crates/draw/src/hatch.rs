//! Hatching by shade, as in a woodcut: strokes that follow the surface, more of them and across each other where it is dark.
//!
//! A stroke runs where a plane of a stack of parallel planes would cut the surface, so that it bends with the form. Strokes are
//! kept apart as in B. Jobard and W. Lefer, "Creating evenly-spaced streamlines of arbitrary density", 1997: each is grown from
//! its seed both ways until it comes near another, leaves the surface or the shade.
use std::sync::atomic::{AtomicBool, Ordering};

use durer_core::{glam::DVec2, math::Vector3, spectrum::Color};
use durer_render::Scene;

use crate::{
    Kind, Line, Machine,
    change::Judge,
    eye::{Eye, Spot},
    line::{Pen, radians},
};

/// Strokes are no nearer to each other, in pixels.
pub const FINEST_HATCH: f64 = 1.0;
/// Way between two rays of a stroke, in pixels.
const STEP: f64 = 1.5;
/// Strokes end before they come nearer to others than this share of their distance.
const NEAREST: f64 = 0.6;
/// Strokes shorter than this are left out, in pixels.
const SHORTEST: f64 = 7.0;
/// Longest stroke to either side of its seed, in steps.
const LONGEST: usize = 60;
/// The layers: up to which brightness, with which stack of planes, given by what its normal has of the camera's right, up and
/// ahead.
const LAYERS: [(f32, [f32; 3]); 3] =
    [(0.62, [0.55, 0.75, 0.35]), (0.34, [-0.75, 0.55, 0.35]), (0.14, [0.1, 0.95, 0.3])];

/// How bright each pixel of a picture is to the eye, stretched from its darkest part, 0, to its brightest, 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Tones {
    /// The upper left pixel.
    corner: [u32; 2],
    size: [u32; 2],
    values: Vec<f32>,
}

impl Tones {
    /// Of the linear colours of all pixels, row by row; `None` if there are not as many as the size says.
    pub fn new(size: [u32; 2], pixels: &[[f32; 3]]) -> Option<Self> {
        let [width, height] = size.map(|n| n as usize);
        if pixels.is_empty() || pixels.len() != width * height {
            return None;
        }
        let light = |p: &[f32; 3]| Color { rgb: *p }.luminance().clamp(0.0, 1.0).sqrt();
        let sharp: Vec<f32> = pixels.iter().map(light).map(|v| if v.is_finite() { v } else { 0.0 }).collect();
        // The noise of few samples would cut strokes to pieces.
        let mean = |i: usize| {
            let (x, y) = (i % width, i / width);
            let rows = y.saturating_sub(2)..(y + 3).min(height);
            let near =
                rows.flat_map(|y| (x.saturating_sub(2)..(x + 3).min(width)).map(move |x| y * width + x));
            let (sum, n) = near.fold((0.0, 0.0), |(sum, n), j| (sum + sharp[j], n + 1.0));
            sum / n
        };
        let mut values: Vec<f32> = (0..sharp.len()).map(mean).collect();
        let mut sorted = values.clone();
        sorted.sort_by(f32::total_cmp);
        let [low, high] = [0.03, 0.97].map(|share| sorted[(share * (sorted.len() - 1) as f64) as usize]);
        let range = (high - low).max(f32::MIN_POSITIVE);
        values.iter_mut().for_each(|v| *v = ((*v - low) / range).clamp(0.0, 1.0));
        Some(Self { corner: [0, 0], size, values })
    }

    /// The same of a part of a picture, whose upper left pixel is `corner`.
    #[must_use]
    pub fn with_corner(self, corner: [u32; 2]) -> Self {
        Self { corner, ..self }
    }

    /// A point of the picture from the corner of the part.
    fn inside(&self, at: DVec2) -> DVec2 {
        at - DVec2::new(self.corner[0].into(), self.corner[1].into())
    }

    fn at(&self, at: DVec2) -> f32 {
        let at = self.inside(at);
        let clamped = |v: f64, n: u32| (v.max(0.0) as usize).min(n as usize - 1);
        self.values[clamped(at.y, self.size[1]) * self.size[0] as usize + clamped(at.x, self.size[0])]
    }
}

/// The strokes of one layer.
struct Layer<'a> {
    eye: &'a Eye<'a>,
    judge: Judge,
    tones: &'a Tones,
    darkness: f32,
    /// Normal of the planes, in render space.
    planes: Vector3,
    spacing: f64,
    /// Points of the strokes so far, in squares of the edge of the spacing.
    squares: Vec<Vec<DVec2>>,
    columns: usize,
}

impl Layer<'_> {
    fn square(&self, at: DVec2) -> (usize, usize) {
        // One square more on each side than the picture has.
        let at = self.tones.inside(at);
        let index = |v: f64| (v / self.spacing + 1.0).max(0.0) as usize;
        (index(at.x).min(self.columns - 1), index(at.y))
    }

    /// Whether a stroke lies nearer than `distance`, at most the spacing.
    fn is_crowded(&self, at: DVec2, distance: f64) -> bool {
        let (x, y) = self.square(at);
        let squares =
            (y.saturating_sub(1)..y + 2).flat_map(|y| (x.saturating_sub(1)..x + 2).map(move |x| (x, y)));
        let near = squares
            .filter(|(x, _)| *x < self.columns)
            .filter_map(|(x, y)| self.squares.get(y * self.columns + x));
        near.flatten().any(|p| p.distance(at) < distance)
    }

    fn keep(&mut self, points: &[DVec2]) {
        for &p in points {
            let (x, y) = self.square(p);
            if let Some(square) = self.squares.get_mut(y * self.columns + x) {
                square.push(p);
            }
        }
    }

    fn is_dark(&self, at: DVec2) -> bool {
        let [w, h] = self.tones.size.map(f64::from);
        let inside = self.tones.inside(at);
        (0.0..w).contains(&inside.x) && (0.0..h).contains(&inside.y) && self.tones.at(at) < self.darkness
    }

    /// Where a stroke goes on from a spot, in the picture, of unit length; `None` where the planes touch the surface.
    fn direction(&self, spot: &Spot) -> Option<DVec2> {
        let touch = spot.touch?;
        let n = Vector3::from(touch.n_s);
        let along = n.cross(self.planes);
        let p = spot.ray.at(touch.t);
        // What a pixel to the right, and one down, is there, across the ray.
        let [right, down] = [DVec2::X, DVec2::Y].map(|step| self.eye.ray(spot.at + step).at(touch.t) - p);
        let on = |axis: Vector3| f64::from(along.dot(axis) / axis.length_squared());
        let way = DVec2::new(on(right), on(down));
        (along.length() > 0.15).then(|| way.normalize_or_zero()).filter(|way| *way != DVec2::ZERO)
    }

    /// The stroke from a spot to one side.
    fn grow(&self, seed: &Spot, mut way: DVec2) -> Vec<DVec2> {
        let mut points = Vec::new();
        let mut spot = *seed;
        for _ in 0..LONGEST {
            let next = self.eye.look(spot.at + way * STEP);
            let is_over = !self.is_dark(next.at)
                || next.touch.is_none()
                || self.judge.suspicion(&spot, &next) >= 1.0
                || self.is_crowded(next.at, NEAREST * self.spacing);
            let Some(ahead) = self.direction(&next).filter(|_| !is_over) else { break };
            let ahead = if ahead.dot(way) < 0.0 { -ahead } else { ahead };
            if ahead.dot(way) < 0.7 {
                break;
            }
            way = ahead;
            points.push(next.at);
            spot = next;
        }
        points
    }

    /// The stroke through a point, if there is room for one.
    fn stroke(&mut self, at: DVec2) -> Option<Vec<DVec2>> {
        if !self.is_dark(at) || self.is_crowded(at, self.spacing) {
            return None;
        }
        let seed = self.eye.look(at);
        let way = self.direction(&seed)?;
        let mut points: Vec<DVec2> = self.grow(&seed, -way).into_iter().rev().collect();
        points.push(at);
        points.extend(self.grow(&seed, way));
        if STEP * (points.len() as f64) < SHORTEST {
            return None;
        }
        self.keep(&points);
        Some(points)
    }
}

/// Strokes `spacing` pixels apart, [`FINEST_HATCH`] at least, where a scene's picture is dark; `None` if `cancel` was set meanwhile.
pub fn hatch(
    scene: &Scene,
    machine: &Machine,
    tones: &Tones,
    spacing: f64,
    cancel: &AtomicBool,
) -> Option<Vec<Line>> {
    let eye = Eye::new(scene);
    let spacing = spacing.max(FINEST_HATCH);
    let crease = radians(machine.crease) as f32;
    let pen = Pen { tolerance: 2.0 * machine.tolerance, crease };
    let [columns, rows] = tones.size.map(|n| (f64::from(n) / spacing).ceil() as usize + 2);
    let axes = scene.view.render_from_camera(eye.time());
    let mut lines = Vec::new();
    for (darkness, [right, up, ahead]) in LAYERS {
        let mut layer = Layer {
            eye: &eye,
            judge: Judge { crease },
            tones,
            darkness,
            planes: axes.vector(Vector3::new(right, up, ahead)).normalize(),
            spacing,
            squares: vec![Vec::new(); columns * rows],
            columns,
        };
        for row in 0..rows {
            if cancel.load(Ordering::Relaxed) {
                return None;
            }
            for column in 0..columns {
                // Seeds on the corners of a lattice of their own would show it.
                let shift = if row % 2 == 0 { 0.25 } else { 0.75 };
                let corner = DVec2::new(tones.corner[0].into(), tones.corner[1].into());
                let seed = corner + DVec2::new(column as f64 + shift, row as f64 + 0.5) * spacing;
                lines.extend(layer.stroke(seed).and_then(|points| pen.stroke(Kind::Hatch, &points)));
            }
        }
    }
    Some(lines)
}
