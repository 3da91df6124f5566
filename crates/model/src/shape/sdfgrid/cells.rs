//! Distances on a grid, trilinear in each cell, and where rays meet 0: of a ray through a cell they are a cubic, which is
//! monotonic between the roots of its derivative (Hansson-Söderlund, Evans and Akenine-Möller 2022, "Ray Tracing of Signed
//! Distance Function Grids", with the solver of Marmitt and others 2004).
//!
//! A ray goes from cell to cell with the sign that it had at the end of the last one, so that rounding on faces between cells
//! opens no gaps. All in f64 and in coordinates in which cells are of size 1.
use durer_core::glam::DVec3;

/// The values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cells {
    /// Values along each axis, at least two; x changes fastest.
    size: [usize; 3],
    values: Vec<f32>,
    /// Cells in which there is a surface.
    filled: Vec<bool>,
}

/// The ray on which zeros are looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) o: DVec3,
    pub(super) d: DVec3,
}

/// Within a cell: `k0 + k1 x + k2 y + k3 z + k4 xy + k5 yz + k6 zx + k7 xyz`.
struct Cell([f64; 8]);

impl Cell {
    fn value(&self, p: DVec3) -> f64 {
        let [k0, k1, k2, k3, k4, k5, k6, k7] = self.0;
        k0 + p.x * (k1 + k6 * p.z) + p.y * (k2 + k4 * p.x) + p.z * (k3 + k5 * p.y + k7 * p.x * p.y)
    }
    fn gradient(&self, p: DVec3) -> DVec3 {
        let [_, k1, k2, k3, k4, k5, k6, k7] = self.0;
        DVec3::new(
            k1 + k4 * p.y + k6 * p.z + k7 * p.y * p.z,
            k2 + k4 * p.x + k5 * p.z + k7 * p.x * p.z,
            k3 + k5 * p.y + k6 * p.x + k7 * p.x * p.y,
        )
    }
    /// Coefficients of the cubic along a line, the constant one first.
    fn cubic(&self, Line { o, d }: Line) -> [f64; 4] {
        let [_, _, _, _, k4, k5, k6, k7] = self.0;
        let pairs = k4 * d.x * d.y + k5 * d.y * d.z + k6 * d.z * d.x;
        let triples = d.x * d.y * o.z + d.x * o.y * d.z + o.x * d.y * d.z;
        [self.value(o), self.gradient(o).dot(d), pairs + k7 * triples, k7 * d.x * d.y * d.z]
    }
}

fn at([c0, c1, c2, c3]: [f64; 4], t: f64) -> f64 {
    ((c3 * t + c2) * t + c1) * t + c0
}

/// Where the derivative is 0 between 0 and `end`, in order.
fn turns([_, c1, c2, c3]: [f64; 4], end: f64) -> impl Iterator<Item = f64> {
    let (a, b, c) = (3.0 * c3, c2, c1);
    let room = b * b - a * c;
    let q = -(b + room.max(0.0).sqrt().copysign(b));
    let roots = if room > 0.0 { [q / a, c / q] } else { [f64::NAN; 2] };
    let [x, y] = roots;
    let ordered = if x < y || y.is_nan() { [x, y] } else { [y, x] };
    ordered.into_iter().filter(move |t| *t > 0.0 && *t < end)
}

/// The zero of a monotonic part, which has the sign of `below` at its start, and the other one at its end.
fn zero(cubic: [f64; 4], [mut a, mut b]: [f64; 2], below: bool) -> f64 {
    let mut t = 0.5 * (a + b);
    for _ in 0..100 {
        let f = at(cubic, t);
        if (f < 0.0) == below && f != 0.0 {
            a = t
        } else {
            b = t
        }
        // Newton's step where it stays between the two, else the middle.
        let slope = (3.0 * cubic[3] * t + 2.0 * cubic[2]) * t + cubic[1];
        let step = t - f / slope;
        let next = if step > a && step < b { step } else { 0.5 * (a + b) };
        if next == t || next <= a || next >= b {
            break;
        }
        t = next;
    }
    t
}

impl Cells {
    /// Of distances at the corners of cells; `None` if they are not as many as the size says, or nowhere change their sign.
    pub(super) fn new(size: [usize; 3], values: Vec<f32>) -> Option<Self> {
        let [nx, ny, nz] = size;
        let count = nx.checked_mul(ny)?.checked_mul(nz)?;
        if count != values.len() || size.iter().any(|n| *n < 2) {
            return None;
        }
        let mut cells = Self { size, values, filled: Vec::new() };
        cells.filled = cells
            .all()
            .map(|cell| {
                let corners = cells.corners(cell);
                corners.iter().any(|v| *v < 0.0) && corners.iter().any(|v| *v >= 0.0)
            })
            .collect();
        cells.filled.contains(&true).then_some(cells)
    }
    /// The opposite corner of the grid.
    pub(super) fn end(&self) -> DVec3 {
        DVec3::from(self.size.map(|n| (n - 1) as f64))
    }
    fn all(&self) -> impl Iterator<Item = [usize; 3]> {
        let [nx, ny, nz] = self.size.map(|n| n - 1);
        (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
    }
    /// Those in which there is a surface.
    pub(super) fn filled(&self) -> impl Iterator<Item = [usize; 3]> {
        self.all().zip(&self.filled).filter(|(_, filled)| **filled).map(|(cell, _)| cell)
    }
    fn is_filled(&self, [x, y, z]: [usize; 3]) -> bool {
        self.filled[(z * (self.size[1] - 1) + y) * (self.size[0] - 1) + x]
    }
    /// The values at the corners of a cell, x changing fastest.
    pub(super) fn corners(&self, [x, y, z]: [usize; 3]) -> [f64; 8] {
        let [nx, ny, _] = self.size;
        std::array::from_fn(|i| {
            let index = ((z + (i >> 2)) * ny + y + (i >> 1 & 1)) * nx + x + (i & 1);
            f64::from(self.values[index])
        })
    }
    fn cell(&self, cell: [usize; 3]) -> Cell {
        let [a, b, c, d, e, f, g, h] = self.corners(cell);
        Cell([
            a,
            b - a,
            c - a,
            e - a,
            a - b - c + d,
            a - c - e + g,
            a - b - e + f,
            b + c + e + h - a - d - f - g,
        ])
    }
    /// The cell of a point, which may lie beyond the grid by rounding.
    fn cell_of(&self, p: DVec3) -> [usize; 3] {
        let p = p.to_array();
        std::array::from_fn(|i| (p[i].max(0.0) as usize).min(self.size[i] - 2))
    }
    /// The gradient at a point as a cell continues it.
    fn gradient_by(&self, cell: [usize; 3], p: DVec3) -> DVec3 {
        self.cell(cell).gradient(p - corner(cell))
    }
    /// The value and the gradient at a point.
    pub(super) fn look(&self, p: DVec3) -> (f64, DVec3) {
        let cell = self.cell_of(p);
        (self.cell(cell).value(p - corner(cell)), self.gradient_by(cell, p))
    }
    /// The mean of the directions in which the eight nearest cells rise, each by its nearness, times `scale`.
    pub(super) fn smooth(&self, p: DVec3, scale: DVec3) -> DVec3 {
        let place = (p - 0.5).to_array();
        let mut sum = DVec3::ZERO;
        for i in 0..8 {
            let mut weight = 1.0;
            let cell: [usize; 3] = std::array::from_fn(|axis| {
                let (low, up) = (place[axis].floor(), i >> axis & 1);
                let part = place[axis] - low;
                weight *= if up == 1 { part } else { 1.0 - part };
                // Beyond the outermost cells these count alone.
                ((low + up as f64).max(0.0) as usize).min(self.size[axis] - 2)
            });
            sum += (self.gradient_by(cell, p) * scale).normalize_or_zero() * weight;
        }
        sum
    }

    /// The first zero on a line between two parameters that `accepts` takes, of those told by parameter and slope.
    pub(super) fn first_zero<T>(
        &self,
        line: Line,
        [from, to]: [f64; 2],
        accepts: impl Fn(f64, f64) -> Option<T>,
    ) -> Option<T> {
        let Line { o, d } = line;
        let (low, high) = (-o / d, (self.end() - o) / d);
        let inside = |axis: usize| d[axis] != 0.0 || o[axis] >= 0.0 && o[axis] <= self.end()[axis];
        let cut = |axis: usize| {
            if d[axis] == 0.0 {
                [f64::MIN, f64::MAX]
            } else {
                [low[axis].min(high[axis]), low[axis].max(high[axis])]
            }
        };
        let slabs = [0, 1, 2].map(cut);
        let mut t = slabs.iter().fold(from, |t, slab| t.max(slab[0]));
        let to = slabs.iter().fold(to, |t, slab| t.min(slab[1]));
        if !(t <= to && (0..3).all(inside) && (o + d * t).is_finite()) {
            return None;
        }
        let mut cell = self.cell_of(o + d * t);
        let mut before = 0.0;
        // Each step leaves a cell through one axis.
        for _ in 0..=self.size.iter().sum::<usize>() {
            let ahead: [f64; 3] = std::array::from_fn(|axis| match d[axis] {
                0.0 => f64::MAX,
                v => (cell[axis] as f64 + f64::from(u8::from(v > 0.0)) - o[axis]) / v,
            });
            let axis = (0..3).min_by(|a, b| ahead[*a].total_cmp(&ahead[*b])).unwrap_or(0);
            let end = ahead[axis].max(t);
            if self.is_filled(cell) {
                let own = self.cell(cell);
                let cubic = own.cubic(Line { o: o + d * t - corner(cell), d });
                if before == 0.0 {
                    before = cubic[0];
                }
                let (mut a, width) = (0.0, end - t);
                for b in turns(cubic, width).chain([width]) {
                    let after = at(cubic, b);
                    if before != 0.0 && before * after <= 0.0 {
                        let s = zero(cubic, [a, b], before < 0.0);
                        let slope = (3.0 * cubic[3] * s + 2.0 * cubic[2]) * s + cubic[1];
                        if let Some(found) = accepts(t + s, slope) {
                            return Some(found);
                        }
                    }
                    (a, before) = (b, after);
                }
            } else {
                // All its values are of one sign: if it is the other one, the surface is the face that led here.
                let sign = self.corners(cell).into_iter().find(|v| *v != 0.0).unwrap_or(before);
                if before * sign < 0.0 {
                    let slope = self.gradient_by(cell, o + d * t).dot(d);
                    if let Some(found) = accepts(t, slope) {
                        return Some(found);
                    }
                }
                before = sign;
            }
            let next = cell[axis] as i64 + if d[axis] > 0.0 { 1 } else { -1 };
            if end > to || !(0..self.size[axis] as i64 - 1).contains(&next) {
                return None;
            }
            cell[axis] = next as usize;
            t = end;
        }
        None
    }
    /// The largest value by its size.
    pub(super) fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |most, v| f64::from(v.abs()).max(most))
    }
}

/// The corner of a cell at which its coordinates are 0.
pub(super) fn corner(cell: [usize; 3]) -> DVec3 {
    DVec3::from(cell.map(|i| i as f64))
}
