//! Densities over the unit square that are bilinear between values on a lattice, drawn from exactly, with an inverse; they
//! change with two parameters.
//!
//! A row is drawn by the integrals of rows, then a column by the integrals along the row in between; both are quadratic within
//! a cell. Integrals are linear in the values: those of a blend of tables are the blend of theirs. (Dupuy and Jakob 2018, "An
//! Adaptive Parameterization for Efficient Material Acquisition and Rendering", supplement; pbrt's `PiecewiseLinear2D`.)
use super::lattice::{Blend, place};
use crate::math::{Point2, float::lerp};

/// Such densities: a table for each pair of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear2D {
    size: [usize; 2],
    /// Densities over steps of the lattice.
    values: Vec<f32>,
    /// Along each row of each table, the integral up to there.
    along: Vec<f32>,
    /// The integral of all rows up to this one.
    rows: Vec<f32>,
}

/// The `t` in `[0, 1]` up to which the line from `a` to `b` has this area.
fn root(a: f32, b: f32, area: f32) -> f32 {
    let below = a + (a * a + 2.0 * (b - a) * area).max(0.0).sqrt();
    if area > 0.0 && below > 0.0 { (2.0 * area / below).min(1.0) } else { 0.0 }
}

/// The area below the line from `a` to `b` up to `t`.
fn area(a: f32, b: f32, t: f32) -> f32 {
    t * (a + 0.5 * t * (b - a))
}

/// The last of `count` places, but the very last one, at which `of` is not above `x`.
fn step(count: usize, x: f32, of: impl Fn(usize) -> f32) -> usize {
    let (mut low, mut high) = (0, count - 1);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if of(middle) <= x { low = middle } else { high = middle }
    }
    low
}

impl PiecewiseLinear2D {
    /// From values, none negative, of which x changes fastest; each table becomes a density.
    ///
    /// # Errors
    /// The number of a table whose integral is not above 0 and finite; the first one if the values fill no tables, or a side
    /// is of less than two.
    pub fn new(size: [usize; 2], mut values: Vec<f32>) -> Result<Self, usize> {
        let [width, height] = size;
        let table = width.checked_mul(height).filter(|table| {
            width > 1 && height > 1 && !values.is_empty() && values.len().is_multiple_of(*table)
        });
        let table = table.ok_or(0usize)?;
        let mut along = Vec::with_capacity(values.len());
        let mut rows = Vec::with_capacity(values.len() / width);
        for (number, values) in values.chunks_exact_mut(table).enumerate() {
            let running = |v: &[f64]| {
                let mut sum = 0.0;
                let steps = v.windows(2).map(move |w| {
                    sum += 0.5 * (w[0] + w[1]);
                    sum
                });
                std::iter::once(0.0).chain(steps).collect::<Vec<f64>>()
            };
            let wide = |row: &[f32]| row.iter().map(|v| f64::from(*v)).collect::<Vec<f64>>();
            let own: Vec<Vec<f64>> = values.chunks_exact(width).map(|row| running(&wide(row))).collect();
            let totals: Vec<f64> = own.iter().map(|row| row[width - 1]).collect();
            let up = running(&totals);
            let all = up[height - 1];
            if !(all > 0.0 && all.is_finite()) {
                return Err(number);
            }
            along.extend(own.iter().flatten().map(|v| (v / all) as f32));
            rows.extend(up.iter().map(|v| (v / all) as f32));
            values.iter_mut().for_each(|v| *v = (f64::from(*v) / all) as f32);
        }
        Ok(Self { size, values, along, rows })
    }
    /// Heap memory, in bytes.
    pub fn bytes(&self) -> u64 {
        ((self.values.len() + self.along.len() + self.rows.len()) * size_of::<f32>()) as u64
    }
    /// Densities are over the unit square, values over steps.
    fn steps(&self) -> f32 {
        ((self.size[0] - 1) * (self.size[1] - 1)) as f32
    }
    fn table(&self) -> usize {
        self.size[0] * self.size[1]
    }
    /// The integral of the row between two ones, up to a column.
    fn row(&self, blend: &Blend, index: usize, t: f32) -> f32 {
        let one = |i: usize| blend.of(&self.along, self.table(), i);
        lerp(t, one(index), one(index + self.size[0]))
    }
    /// The density at a point of the unit square.
    pub fn density(&self, blend: &Blend, p: Point2) -> f32 {
        let place = place(self.size, p);
        let one = |i: usize| blend.of(&self.values, self.table(), place.corners[i]);
        let [s, t] = place.t;
        lerp(t, lerp(s, one(0), one(1)), lerp(s, one(2), one(3))) * self.steps()
    }
    /// The point that a point of the unit square is drawn to, and the density there.
    pub fn sample(&self, blend: &Blend, u: Point2) -> (Point2, f32) {
        let [width, height] = self.size;
        let rows = |y: usize| blend.of(&self.rows, height, y);
        let y = step(height, u.y, rows);
        let total = |y: usize| blend.of(&self.along, self.table(), y * width + width - 1);
        let (below, above) = (total(y), total(y + 1));
        let t = root(below, above, u.y - rows(y));
        let wanted = u.x * lerp(t, below, above);
        let x = step(width, wanted, |x| self.row(blend, y * width + x, t));
        let value = |x: usize| {
            let one = |i: usize| blend.of(&self.values, self.table(), i);
            lerp(t, one(y * width + x), one((y + 1) * width + x))
        };
        let (left, right) = (value(x), value(x + 1));
        let s = root(left, right, wanted - self.row(blend, y * width + x, t));
        let p = Point2::new((x as f32 + s) / (width - 1) as f32, (y as f32 + t) / (height - 1) as f32);
        (p, lerp(s, left, right) * self.steps())
    }
    /// The point that is drawn to `p`, and the density there.
    pub fn invert(&self, blend: &Blend, p: Point2) -> (Point2, f32) {
        let [width, height] = self.size;
        let place = place(self.size, p);
        let [s, t] = place.t;
        let (corner, y) = (place.corners[0], place.corners[0] / width);
        let one = |i: usize| blend.of(&self.values, self.table(), place.corners[i]);
        let (left, right) = (lerp(t, one(0), one(2)), lerp(t, one(1), one(3)));
        let last = y * width + width - 1;
        let whole = self.row(blend, last, t);
        let before = self.row(blend, corner, t) + area(left, right, s);
        let total = |y: usize| blend.of(&self.along, self.table(), y * width + width - 1);
        let up = blend.of(&self.rows, height, y) + area(total(y), total(y + 1), t);
        let u = Point2::new(if whole > 0.0 { (before / whole).min(1.0) } else { 0.0 }, up.min(1.0));
        (u, lerp(s, left, right) * self.steps())
    }
}

#[cfg(test)]
mod tests {
    use super::{super::lattice::Axes, *};

    /// Two tables of five by four values, one of them with an empty row and an empty column.
    fn two() -> (PiecewiseLinear2D, Axes) {
        let first = (0..20).map(|i| 1.0 + ((i * 7) % 5) as f32);
        let second = (0..20).map(|i| if i / 5 == 0 || i % 5 == 4 { 0.0 } else { (1 + i % 3) as f32 });
        let warp = PiecewiseLinear2D::new([5, 4], first.chain(second).collect()).expect("densities");
        (warp, Axes::new([vec![0.0, 1.0], vec![0.0]]).expect("they rise"))
    }

    #[test]
    fn points_are_drawn_in_proportion_to_the_density() {
        let (warp, axes) = two();
        for a in [0.0, 0.3, 1.0] {
            let blend = axes.blend([a, 0.0]);
            const CELLS: usize = 12;
            const POINTS: usize = 600;
            let mut counts = [[0.0f64; CELLS]; CELLS];
            let mut sums = [[0.0f64; CELLS]; CELLS];
            for i in 0..POINTS * POINTS {
                let at = |i: usize| (i as f32 + 0.5) / POINTS as f32;
                let u = Point2::new(at(i % POINTS), at(i / POINTS));
                let (p, density) = warp.sample(&blend, u);
                assert!((density - warp.density(&blend, p)).abs() < 1e-3 * density.max(0.1));
                let cell = |p: Point2| [p.y, p.x].map(|v| ((v * CELLS as f32) as usize).min(CELLS - 1));
                let share = 1.0 / (POINTS * POINTS) as f64;
                let [y, x] = cell(p);
                counts[y][x] += share;
                let [y, x] = cell(u);
                sums[y][x] += share * f64::from(warp.density(&blend, u));
            }
            for (count, sum) in counts.iter().flatten().zip(sums.iter().flatten()) {
                assert!((count - sum).abs() < 4e-4, "{a}: {count} drawn, {sum} expected");
            }
        }
    }

    #[test]
    fn what_is_drawn_leads_back() {
        let (warp, axes) = two();
        for a in [0.0, 0.6, 1.0] {
            let blend = axes.blend([a, 0.0]);
            for i in 0..400 {
                let u = Point2::new((i % 20) as f32 / 19.0, (i / 20) as f32 / 19.0);
                let (p, density) = warp.sample(&blend, u);
                let (back, same) = warp.invert(&blend, p);
                // From where there is no density, as on an empty row, there is more than one way.
                let off = (back.x - u.x).abs().max((back.y - u.y).abs());
                let leads_back = off < 2e-3 || density == 0.0;
                assert!(leads_back && (density - same).abs() < 2e-3 * density.max(0.1), "{a} {u:?} {back:?}");
            }
        }
    }

    #[test]
    fn what_has_no_density_is_told() {
        assert_eq!(PiecewiseLinear2D::new([2, 2], [[1.0; 4], [0.0; 4]].concat()), Err(1));
        assert_eq!(PiecewiseLinear2D::new([1, 4], vec![1.0; 4]), Err(0));
        assert_eq!(PiecewiseLinear2D::new([2, 2], vec![1.0; 5]), Err(0));
        assert_eq!(PiecewiseLinear2D::new([2, 2], vec![f32::NAN, 1.0, 1.0, 1.0]), Err(0));
    }
}
