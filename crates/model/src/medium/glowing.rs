//! Where a volume glows: places drawn about as often as what they send out is strong, with exact densities.
//!
//! What is the same everywhere is drawn from evenly, in boxes that its bodies lie in. Of a grid a cell of the majorants is drawn
//! by what it sends out at eight of its points, and a place in it evenly. A share of all cells is chosen by their bounds alone, so
//! that no place that glows is left out (a defensive mixture, Hesterberg 1995). Boxes and cells may hold places that are not
//! in the volume: nothing is sent from there.
use std::f32::consts::PI;

use durer_core::{
    math::{Bounds3, Point2, Point3, Vector3},
    spectrum::Basis,
};

use super::{Volume, volume::Local};
use crate::light::{Emitted, Source, Steps, uniform_direction};

/// What bounds alone decide.
const BLIND: f32 = 0.1;
/// The share of an even volume that is looked for in the last box.
const ELSEWHERE: f32 = 0.125;

/// The places of a volume that glows.
#[derive(Clone, Debug)]
pub struct Glowing {
    parts: Parts,
    steps: Steps,
    power: f32,
    /// The width of what it fills, in metres.
    width: f32,
}

/// What is drawn first.
#[derive(Clone, Debug)]
enum Parts {
    /// Boxes of render space.
    Boxes(Vec<Bounds3>),
    /// Cells of the volume, each of so many cubic metres.
    Cells(f32),
}

fn volume_of(b: &Bounds3) -> f32 {
    let d = b.diagonal();
    d.x * d.y * d.z
}

impl Volume {
    /// The places that glow; of what has no bounds of its own those in these boxes, and some in one around all of them. `None`
    /// if nothing does.
    pub fn glowing(&self, boxes: &[Bounds3], around: Bounds3) -> Option<Glowing> {
        match (self.is_dark(), self.is_even()) {
            (true, _) => None,
            (false, true) => self.glowing_evenly(boxes, around),
            (false, false) => self.glowing_by_cells(),
        }
    }

    fn glowing_evenly(&self, boxes: &[Bounds3], around: Bounds3) -> Option<Glowing> {
        let has_inside = |b: &Bounds3| b.is_finite() && !b.is_empty() && volume_of(b) > 0.0;
        let mut boxes: Vec<Bounds3> = boxes.iter().copied().filter(has_inside).collect();
        let all: f32 = boxes.iter().map(volume_of).sum();
        let mut shares: Vec<f32> = boxes.iter().map(|b| (1.0 - ELSEWHERE) * volume_of(b) / all).collect();
        boxes.push(around);
        shares.push(if all > 0.0 { ELSEWHERE } else { 1.0 });
        let filled = if all > 0.0 { all } else { volume_of(&around) };
        let Local { sigma_a, added, .. } = self.at(Basis::Rgb, Point3::ZERO);
        // No more leaves a body than what is seen of its surface.
        let seen: f32 = boxes[..boxes.len().max(2) - 1].iter().map(|b| 2.0 * PI * b.half_area()).sum();
        let power = (4.0 * PI * added.max() * filled).min(seen * added.max() / sigma_a.max());
        Some(Glowing { steps: Steps::new(shares)?, parts: Parts::Boxes(boxes), power, width: filled.cbrt() })
    }

    fn glowing_by_cells(&self) -> Option<Glowing> {
        let cells = self.majorants();
        let [nx, ny, nz] = cells.size();
        let render_from_cube = self.render_from_cube();
        let edge = |x, y, z| render_from_cube.vector(Vector3::new(x, y, z));
        let whole = edge(1.0, 0.0, 0.0).dot(edge(0.0, 1.0, 0.0).cross(edge(0.0, 0.0, 1.0))).abs();
        let size = whole / (nx * ny * nz) as f32;
        let sent = |cell: usize| -> f32 {
            let at = |corner: usize| {
                let [x, y, z] = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { 0.25 } else { 0.75 });
                self.at(Basis::Rgb, render_from_cube.point(cells.place(cell, [x, y, z]))).added.max()
            };
            if cells.bound(cell) > 0.0 { (0..8).map(at).sum::<f32>() / 8.0 } else { 0.0 }
        };
        let sent: Vec<f32> = (0..nx * ny * nz).map(sent).collect();
        let [all, bounds]: [f64; 2] = [
            sent.iter().map(|v| f64::from(*v)).sum(),
            (0..sent.len()).map(|cell| f64::from(cells.bound(cell))).sum(),
        ];
        let blind = if all > 0.0 { f64::from(BLIND) * all / bounds } else { 1.0 } as f32;
        let weights = sent.iter().enumerate().map(|(cell, sent)| sent + blind * cells.bound(cell)).collect();
        // What glows between the points that were looked at is little, but it is not nothing.
        let power = (4.0 * PI * all as f32 * size).max(f32::MIN_POSITIVE);
        Some(Glowing { steps: Steps::new(weights)?, parts: Parts::Cells(size), power, width: whole.cbrt() })
    }
}

impl Glowing {
    /// The largest channel of about all that it sends out, W.
    pub fn power(&self) -> f32 {
        self.power
    }

    /// A particle that leaves the volume: `u` chooses place and direction. `None` if that place is black.
    pub fn emit(&self, volume: &Volume, basis: Basis, u: [Point2; 3]) -> Option<Emitted> {
        let (p, pdf_place) = self.sample(volume, [u[0], u[1]]);
        let light = volume.at(basis, p).added;
        let (d, pdf_direction) = uniform_direction(u[2]);
        let source = Source::Glow(self.met(volume, basis, p));
        (!light.is_black()).then_some(Emitted { p, d, source, light, pdf_place, pdf_direction })
    }

    /// A place and its density, 1/m³; both `u` in `[0, 1)²`.
    fn sample(&self, volume: &Volume, u: [Point2; 2]) -> (Point3, f32) {
        let (part, chance) = self.steps.choose(u[0].x);
        let within = [u[0].y, u[1].x, u[1].y];
        match &self.parts {
            Parts::Boxes(boxes) => {
                let (low, size) = (boxes[part].min, boxes[part].diagonal());
                let p = low + Vector3::new(size.x * within[0], size.y * within[1], size.z * within[2]);
                (p, self.density(volume, p))
            }
            Parts::Cells(size) => {
                let place = volume.majorants().place(part, within);
                (volume.render_from_cube().point(place), chance / size)
            }
        }
    }

    /// The density of [`Glowing::sample`] at a place, 1/m³.
    pub fn density(&self, volume: &Volume, p: Point3) -> f32 {
        match &self.parts {
            Parts::Boxes(boxes) => {
                let here = boxes.iter().enumerate().filter(|(_, b)| b.contains(p));
                here.map(|(part, b)| self.steps.chance(part) / volume_of(b)).sum()
            }
            Parts::Cells(size) => volume.cell(p).map_or(0.0, |cell| self.steps.chance(cell) / size),
        }
    }

    /// About how densely walks that look along rays draw places there ([`Volume::glimpse`]), 1/m: what shares are reckoned with.
    pub fn met(&self, volume: &Volume, basis: Basis, p: Point3) -> f32 {
        match &self.parts {
            Parts::Boxes(_) => {
                let (sigma_a, sigma_s) = volume.coefficients(basis, p);
                (sigma_a + sigma_s).mean() + 1.0 / self.width
            }
            Parts::Cells(_) => volume.bound(basis, p),
        }
    }
}

#[cfg(test)]
mod tests {
    use durer_core::{
        glam::DAffine3,
        math::{Ray, Vector3},
        spectrum::{Color, Spectrum},
    };

    use super::*;
    use crate::medium::{
        Flier, HenyeyGreenstein, Phase, glow::Glow, grid::Grid, matter::Matter, volume::Field,
    };

    fn stuff(field: impl Fn(Matter) -> Field) -> Volume {
        let [sigma_a, sigma_s] = [Color::new(0.5, 1.0, 2.0), Color::new(0.3, 0.0, 1.0)];
        let phase = Phase::HenyeyGreenstein(HenyeyGreenstein::new(0.0));
        let glow = Glow::even(Color::new(3.0, 2.0, 1.0));
        let mut volume =
            Volume::new(field(Matter { sigma_a, sigma_s }), glow, phase).within([[0.0; 3], [2.0, 1.0, 1.0]]);
        assert!(volume.place(&DAffine3::from_rotation_y(0.5)));
        volume
    }
    /// Nothing but for two places.
    fn embers() -> Volume {
        let mut values = vec![0.0; 20 * 20 * 20];
        (values[0], values[5555]) = (1.0, 3.0);
        stuff(|matter| {
            Field::Dense(matter, Grid::new([20; 3], values.clone()).expect("as many as there are places"))
        })
    }
    fn boxes() -> ([Bounds3; 2], Bounds3) {
        let of = |from: f32, to: f32| Bounds3::new(Point3::splat(from), Point3::splat(to));
        ([of(0.0, 1.0), of(0.5, 1.5)], of(-2.0, 3.0))
    }
    fn halton(i: u32, base: u32) -> f32 {
        let (mut i, mut f, mut sum) = (i, 1.0, 0.0);
        while i > 0 {
            f /= base as f64;
            sum += f * f64::from(i % base);
            i /= base;
        }
        sum as f32
    }
    fn numbers(i: u32) -> [Point2; 2] {
        [Point2::new(halton(i, 2), halton(i, 3)), Point2::new(halton(i, 5), halton(i, 7))]
    }

    /// All that is sent out is the mean of what is sent by the density, and of 1 by the density the volume is left that is
    /// drawn from.
    #[test]
    fn places_are_drawn_with_the_density_that_is_said() {
        let (inner, around) = boxes();
        for (name, volume) in [("even", stuff(Field::Even)), ("embers", embers())] {
            let glowing = volume.glowing(&inner, around).expect("it glows");
            const COUNT: u32 = 200_000;
            let (mut sent, mut space) = (0.0, 0.0);
            for i in 1..=COUNT {
                let (p, density) = glowing.sample(&volume, numbers(i));
                // Places on the side of a cell may be in the next one, by rounding.
                let known = glowing.density(&volume, p);
                assert!(
                    i % 100 != 0 || (known / density - 1.0).abs() < 1e-3 || name == "embers",
                    "{name}: {p:?}"
                );
                sent += f64::from(volume.at(Basis::Rgb, p).added.lane(0) / density) / f64::from(COUNT);
                space += 1.0 / f64::from(density) / f64::from(COUNT);
            }
            // Trilinear values at 20 to a metre, of 2 m³; half of each is beside the grid at its corner.
            let corner = 0.875f64.powi(3);
            let expected = match name {
                "even" => [0.5 * 3.0 * 125.0, 125.0],
                _ => [0.5 * 3.0 * 2.0 * (3.0 + corner) / 8000.0, f64::NAN],
            };
            assert!((sent / expected[0] - 1.0).abs() < 0.01, "{name}: {sent}, expected {}", expected[0]);
            assert!(expected[1].is_nan() || (space / expected[1] - 1.0).abs() < 0.01, "{name}: {space}");
        }
    }

    /// Places along rays bring in the mean what a flight knows in closed form.
    #[test]
    fn glimpses_sum_to_what_flights_see() {
        let volume = stuff(Field::Even);
        let ray = Ray::new(Point3::ZERO, Vector3::new(0.0, 0.0, 1.0));
        for (way, absorption) in [((0.2, 1.7), 0.0), ((0.0, f32::INFINITY), 0.7), ((0.0, 1e-5), 0.0)] {
            let flier =
                Flier { basis: Basis::Rgb, lanes: Spectrum::ONE, absorption: Spectrum::splat(absorption) };
            let expected = volume.fly(&flier, &ray, way, &|_| Point2::new(0.5, 0.5)).sent;
            let mut sum = Spectrum::BLACK;
            const COUNT: u32 = 20_000;
            for i in 1..=COUNT {
                volume.glimpse(&flier, &ray, way, &|_| numbers(i)[0], |sent, t| {
                    assert!(t >= way.0 && t <= way.1);
                    sum += sent / COUNT as f32;
                });
            }
            let off =
                (0..4).map(|lane| (sum.lane(lane) / expected.lane(lane) - 1.0).abs()).fold(0.0, f32::max);
            assert!(off < 0.01, "{way:?}: {sum:?}, expected {expected:?}");
        }
    }
}
