//! Directions of a sky through a portal: a rectangular opening, outside of which nothing of it is seen.
//!
//! Bitterli, Novák and Jarosz 2015 ("Portal-Masked Environment Map Sampling"): in the coordinates
//! `u = atan(x / z) / pi + 1/2`, `v = atan(y / z) / pi + 1/2` of a frame along the portal's edges, lines that are parallel to an
//! edge are vertical or horizontal, so that from every point the portal is a rectangle of the picture. Its light is summed
//! in a table of all rectangles from the corner (Crow 1984), whose rows and columns are inverted by bisection.
//! `d omega = pi² (1 - x²) (1 - y²) / z du dv`.
//!
//! The portal is a help, not a mask: directions beside it are left to the sampling of surfaces, and points on its far side
//! see the whole sky.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Point3, Vector3},
};
use rayon::prelude::*;

/// Cells across the half sphere.
const CELLS: usize = 512;
/// Looks into each cell, across and down.
const LOOKS: usize = 2;
/// What the darkest cell has of the mean at least.
const LEAST: f64 = 1e-3;
/// Halvings of an interval of numbers.
const HALVINGS: usize = 40;
/// How far, as a cosine, edges may be from perpendicular.
const PERPENDICULAR: f64 = 1e-3;

/// A portal, before it is known what is seen through it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portal {
    /// The first corner and the third.
    corners: [DVec3; 2],
    /// Along the edges at the first corner, and outward.
    axes: [DVec3; 3],
}

/// A portal with what is seen through it.
#[derive(Debug)]
pub(super) struct View {
    portal: Portal,
    /// Light of all cells below and to the left of each node.
    sums: Vec<f64>,
}

/// A rectangle of the picture.
#[derive(Clone, Copy, Debug)]
struct Window {
    u: [f64; 2],
    v: [f64; 2],
    light: f64,
}

impl Portal {
    /// From its corners in order; the reason if they make no rectangle.
    pub(super) fn new(corners: &[[f32; 3]]) -> Result<Self, &'static str> {
        let [a, b, c, d] = corners else { return Err("a portal has four corners") };
        let [a, b, c, d] = [a, b, c, d].map(|p| DVec3::from_array(p.map(f64::from)));
        let (x, y) = ((d - a).normalize_or_zero(), (b - a).normalize_or_zero());
        let size = (c - a).length();
        let is_rectangle = (a + c - b - d).length() <= PERPENDICULAR * size
            && x.dot(y).abs() <= PERPENDICULAR
            && x.cross(y) != DVec3::ZERO;
        let z = x.cross(y).normalize_or_zero();
        is_rectangle
            .then_some(Self { corners: [a, c], axes: [x, z.cross(x), z] })
            .ok_or("the corners of the portal make no rectangle")
    }
    /// The portal where `m`, which must not deform it, places it.
    pub(super) fn placed(&self, m: &DAffine3) -> Self {
        let axes = self.axes.map(|axis| m.transform_vector3(axis).normalize_or_zero());
        Self { corners: self.corners.map(|p| m.transform_point3(p)), axes }
    }
    /// A direction in the frame of the portal.
    fn local(&self, d: DVec3) -> DVec3 {
        DVec3::from_array(self.axes.map(|axis| axis.dot(d)))
    }
}

/// The place in the picture of a direction in the frame; `None` behind the portal.
fn place(d: DVec3) -> Option<[f64; 2]> {
    let angle = |x: f64| libm::atan2(x, d.z) / std::f64::consts::PI + 0.5;
    (d.z > 0.0).then(|| [angle(d.x), angle(d.y)])
}

/// The direction in the frame of a place in the picture, and the solid angle of an element there by its area.
fn direction([u, v]: [f64; 2]) -> (DVec3, f64) {
    let slope = |t: f64| libm::tan(std::f64::consts::PI * (t - 0.5));
    let d = DVec3::new(slope(u), slope(v), 1.0).normalize();
    (d, std::f64::consts::PI.powi(2) * (1.0 - d.x * d.x) * (1.0 - d.y * d.y) / d.z)
}

impl View {
    /// What is seen of a sky of this luminance in directions of render space through a portal there.
    pub(super) fn new(portal: Portal, sky: impl Fn(Vector3) -> f32 + Sync) -> Self {
        let cell = |i: usize| {
            let (x, y) = (i % CELLS, i / CELLS);
            let mut light = 0.0;
            for k in 0..LOOKS * LOOKS {
                let at =
                    |cell: usize, k: usize| (cell as f64 + (k as f64 + 0.5) / LOOKS as f64) / CELLS as f64;
                let (d, solid_angle) = direction([at(x, k % LOOKS), at(y, k / LOOKS)]);
                let [ax, ay, az] = portal.axes;
                light += f64::from(sky(Vector3::from_f64(ax * d.x + ay * d.y + az * d.z))) * solid_angle;
            }
            light / (LOOKS * LOOKS * CELLS * CELLS) as f64
        };
        let cells: Vec<f64> = (0..CELLS * CELLS).into_par_iter().map(cell).collect();
        let least = LEAST * cells.iter().sum::<f64>() / cells.len() as f64;
        let mut sums = vec![0.0; (CELLS + 1) * (CELLS + 1)];
        for y in 0..CELLS {
            let mut row = 0.0;
            for x in 0..CELLS {
                row += cells[y * CELLS + x].max(least);
                sums[(y + 1) * (CELLS + 1) + x + 1] = sums[y * (CELLS + 1) + x + 1] + row;
            }
        }
        Self { portal, sums }
    }

    /// The light below and to the left of a place.
    fn upto(&self, u: f64, v: f64) -> f64 {
        let split = |t: f64| {
            let x = (t * CELLS as f64).clamp(0.0, CELLS as f64);
            let i = (x as usize).min(CELLS - 1);
            (i, x - i as f64)
        };
        let ((i, s), (j, t)) = (split(u), split(v));
        let at = |i: usize, j: usize| self.sums[j * (CELLS + 1) + i];
        let row = |j: usize| at(i, j) * (1.0 - s) + at(i + 1, j) * s;
        row(j) * (1.0 - t) + row(j + 1) * t
    }
    /// The light in a rectangle.
    fn light(&self, u: [f64; 2], v: [f64; 2]) -> f64 {
        self.upto(u[1], v[1]) - self.upto(u[0], v[1]) - self.upto(u[1], v[0]) + self.upto(u[0], v[0])
    }
    /// The light of the cell at a place, by its area.
    fn density(&self, place: [f64; 2]) -> f64 {
        let edge = |t: f64| (t * CELLS as f64).floor().clamp(0.0, (CELLS - 1) as f64) / CELLS as f64;
        let [u, v] = place.map(edge);
        let n = 1.0 / CELLS as f64;
        self.light([u, u + n], [v, v + n]) * (CELLS * CELLS) as f64
    }

    /// The portal as `from` sees it; `None` from behind, and from its plane.
    fn window(&self, from: Point3) -> Option<Window> {
        let [a, c] = self.portal.corners.map(|p| place(self.portal.local(p - from.to_f64())));
        let (a, c) = (a?, c?);
        let sorted = |i: usize| [a[i].min(c[i]), a[i].max(c[i])];
        let (u, v) = (sorted(0), sorted(1));
        let light = self.light(u, v);
        (light > 0.0).then_some(Window { u, v, light })
    }

    /// A direction through the portal from `from`, chosen by `u` in `[0, 1)²`, and its density, 1/sr; `None` if the portal is
    /// not seen from there.
    pub(super) fn draw(&self, from: Point3, u: [f32; 2]) -> Option<(Vector3, f32)> {
        let window = self.window(from)?;
        let wanted = f64::from(u[0]) * window.light;
        let x = bisect(window.u, |x| self.light([window.u[0], x], window.v) <= wanted);
        // The column of cells that holds x.
        let n = CELLS as f64;
        let column = [(x * n).floor() / n, ((x * n).floor() + 1.0) / n];
        let strip = [column[0].max(window.u[0]), column[1].min(window.u[1])];
        let wanted = f64::from(u[1]) * self.light(strip, window.v);
        let y = bisect(window.v, |y| self.light(strip, [window.v[0], y]) <= wanted);
        let (d, solid_angle) = direction([x, y]);
        let [ax, ay, az] = self.portal.axes;
        let wi = Vector3::from_f64(ax * d.x + ay * d.y + az * d.z);
        Some((wi, (self.density([x, y]) / (window.light * solid_angle)) as f32))
    }

    /// The density with which [`View::draw`] gives unit direction `d`; `None` if the portal is not seen from `from`.
    pub(super) fn at(&self, from: Point3, d: Vector3) -> Option<f32> {
        let window = self.window(from)?;
        let local = self.portal.local(d.to_f64());
        let holds = |range: [f64; 2], t: f64| (range[0]..=range[1]).contains(&t);
        Some(match place(local).filter(|[u, v]| holds(window.u, *u) && holds(window.v, *v)) {
            Some(place) => {
                let solid_angle = direction(place).1;
                (self.density(place) / (window.light * solid_angle)) as f32
            }
            None => 0.0,
        })
    }
}

/// The largest place of an interval up to which `is_below` holds, which is true at first and then false.
fn bisect([mut low, mut high]: [f64; 2], is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
