//! Tables of values on a lattice over the unit square, bilinear in between, which change with two parameters: one table for
//! each pair of them, and linear in between again.
use crate::math::Point2;

/// The parameters that there are tables for: for each pair one, or several on top of each other; the second parameter changes
/// faster.
#[derive(Clone, Debug, PartialEq)]
pub struct Axes([Vec<f32>; 2]);

/// The tables around a pair of parameters, with their weights, which add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    tables: [(usize, f32); 4],
    count: usize,
}

/// A lattice of values, at least one, in some tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    size: [usize; 2],
    /// Tables on top of each other for each pair of parameters.
    layers: usize,
    values: Vec<f32>,
}

/// A place among the values of any table: where the four around it are, and how near it is to the later ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub(super) corners: [usize; 4],
    pub(super) t: [f32; 2],
}

/// True if there are numbers, finite and each above the one before.
pub fn rises(values: &[f32]) -> bool {
    !values.is_empty() && values.iter().all(|v| v.is_finite()) && values.is_sorted_by(|a, b| a < b)
}

/// The number of the value at or before `x` among some that rise, and the way to the next one, in `[0, 1]`. What lies outside is
/// at the end.
pub fn between(values: &[f32], x: f32) -> (usize, f32) {
    let last = values.len() - 1;
    let low = values.partition_point(|v| *v <= x).saturating_sub(1).min(last.saturating_sub(1));
    let high = (low + 1).min(last);
    if high == low {
        return (low, 0.0);
    }
    (low, ((x - values[low]) / (values[high] - values[low])).clamp(0.0, 1.0))
}

impl Axes {
    /// From two lists of numbers that rise; `None` if one does not, or is empty.
    pub fn new(axes: [Vec<f32>; 2]) -> Option<Self> {
        axes.iter().all(|axis| rises(axis)).then_some(Self(axes))
    }
    /// How many pairs there are.
    pub fn pairs(&self) -> usize {
        self.0[0].len() * self.0[1].len()
    }
    /// The pair of this number.
    pub fn pair(&self, number: usize) -> [f32; 2] {
        let fast = self.0[1].len();
        [self.0[0][number / fast], self.0[1][number % fast]]
    }
    /// The tables around these parameters; beyond the first and last ones, theirs.
    pub fn blend(&self, [a, b]: [f32; 2]) -> Blend {
        let ((i, s), (j, t)) = (between(&self.0[0], a), between(&self.0[1], b));
        let fast = self.0[1].len();
        let mut blend = Blend { tables: [(0, 0.0); 4], count: 0 };
        for (i, s) in [(i, 1.0 - s), (i + 1, s)] {
            for (j, t) in [(j, 1.0 - t), (j + 1, t)] {
                if s * t > 0.0 {
                    blend.tables[blend.count] = (i * fast + j, s * t);
                    blend.count += 1;
                }
            }
        }
        blend
    }
}

impl Blend {
    /// The only table there is.
    pub const ONE: Self = Self { tables: [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)], count: 1 };

    /// What the tables have at `index`, each of them `stride` long, in this proportion.
    #[inline]
    pub(super) fn of(&self, values: &[f32], stride: usize, index: usize) -> f32 {
        self.tables[..self.count].iter().map(|(table, share)| values[table * stride + index] * share).sum()
    }
}

impl Lattice {
    /// From values of which the x of a table changes fastest, then its y, then its layer; `None` if they fill no number of
    /// tables, or a side has no value.
    pub fn new(size: [usize; 2], layers: usize, values: Vec<f32>) -> Option<Self> {
        let pair = size[0].checked_mul(size[1])?.checked_mul(layers)?;
        (pair > 0 && !values.is_empty() && values.len().is_multiple_of(pair)).then_some(Self {
            size,
            layers,
            values,
        })
    }
    /// Heap memory, in bytes.
    pub fn bytes(&self) -> u64 {
        (self.values.len() * size_of::<f32>()) as u64
    }
    /// Where a point of the unit square is.
    #[inline]
    pub fn place(&self, p: Point2) -> Place {
        place(self.size, p)
    }
    /// The value of a layer at a place, in a blend of tables.
    #[inline]
    pub fn at(&self, blend: &Blend, layer: usize, place: &Place) -> f32 {
        let table = self.size[0] * self.size[1];
        let one = |i: usize| blend.of(&self.values, table * self.layers, table * layer + place.corners[i]);
        let [s, t] = place.t;
        (one(0) * (1.0 - s) + one(1) * s) * (1.0 - t) + (one(2) * (1.0 - s) + one(3) * s) * t
    }
}

#[inline]
pub(super) fn place([width, height]: [usize; 2], p: Point2) -> Place {
    let along = |x: f32, count: usize| {
        let x = x.clamp(0.0, 1.0) * (count - 1) as f32;
        let low = (x as usize).min(count.saturating_sub(2));
        (low, (low + 1).min(count - 1), x - low as f32)
    };
    let ((x0, x1, s), (y0, y1, t)) = (along(p.x, width), along(p.y, height));
    let corners = [y0 * width + x0, y0 * width + x1, y1 * width + x0, y1 * width + x1];
    Place { corners, t: [s, t] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `1 + 2 x + 3 y + 5 a + 7 b + layer`, on lattices that are not even.
    #[test]
    fn what_is_linear_is_met_everywhere() {
        let (first, second) = (vec![-1.0, 0.5, 2.0], vec![0.0, 0.25]);
        let mut values = Vec::new();
        for a in &first {
            for b in &second {
                for layer in 0..2 {
                    for (y, x) in (0..3).flat_map(|y| (0..5).map(move |x| (y as f32 / 2.0, x as f32 / 4.0))) {
                        values.push(1.0 + 2.0 * x + 3.0 * y + 5.0 * a + 7.0 * b + layer as f32);
                    }
                }
            }
        }
        let axes = Axes::new([first, second]).expect("they rise");
        let lattice = Lattice::new([5, 3], 2, values).expect("six tables of two layers");
        assert_eq!((axes.pairs(), axes.pair(3)), (6, [0.5, 0.25]));
        for (a, b, x, y) in [(-1.0, 0.0, 0.0, 0.0), (0.1, 0.1, 0.3, 0.9), (2.0, 0.25, 1.0, 1.0)] {
            let found = lattice.at(&axes.blend([a, b]), 1, &lattice.place(Point2::new(x, y)));
            let expected = 2.0 + 2.0 * x + 3.0 * y + 5.0 * a + 7.0 * b;
            assert!((found - expected).abs() < 1e-5, "{a} {b} {x} {y}: {found} {expected}");
        }
        // Beyond the ends nothing changes.
        assert_eq!(axes.blend([-9.0, 9.0]), axes.blend([-1.0, 0.25]));
    }

    #[test]
    fn what_is_no_lattice_is_refused() {
        assert!(Axes::new([vec![0.0, 0.0], vec![0.0]]).is_none() && Axes::new([vec![], vec![0.0]]).is_none());
        assert!(Axes::new([vec![f32::NAN], vec![0.0]]).is_none());
        assert!(Lattice::new([2, 2], 1, vec![0.0; 6]).is_none());
        assert!(Lattice::new([0, 2], 1, vec![]).is_none() && Lattice::new([2, 2], 1, vec![]).is_none());
        let one = Lattice::new([1, 1], 1, vec![3.0]).expect("a number");
        assert_eq!(one.at(&Blend::ONE, 0, &one.place(Point2::new(0.3, 1.0))), 3.0);
    }
}
