//! Values on a grid over the unit cube, straight lines between them.
//!
//! Value `i` of `n` along an axis stands at `(i + 1/2) / n`; outside the grid there is nothing. (As in pbrt-v4: what is drawn
//! fades over the last half step.) Or the outermost values go on to the sides of the cube, as in Mitsuba.
use std::ops::{Add, Mul};

/// A grid; x changes fastest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grid<T> {
    size: [usize; 3],
    values: Vec<T>,
    /// The outermost values go on.
    clamped: bool,
}

/// What can be mixed.
pub(crate) trait Mixed: Copy + Default + Add<Output = Self> + Mul<f32, Output = Self> {}
impl<T: Copy + Default + Add<Output = T> + Mul<f32, Output = T>> Mixed for T {}

impl<T: Mixed> Grid<T> {
    /// As many values as the size says; `None` if there are more or fewer.
    pub(crate) fn new(size: [usize; 3], values: Vec<T>) -> Option<Self> {
        let [nx, ny, nz] = size;
        let count = nx.checked_mul(ny)?.checked_mul(nz)?;
        (count == values.len() && count > 0).then_some(Self { size, values, clamped: false })
    }
    /// The same, with values that go on where `clamped`.
    pub(crate) fn clamped(self, clamped: bool) -> Self {
        Self { clamped, ..self }
    }
    pub(super) fn size(&self) -> [usize; 3] {
        self.size
    }
    pub(crate) fn values(&self) -> &[T] {
        &self.values
    }
    fn value(&self, [x, y, z]: [i64; 3]) -> T {
        let [nx, ny, nz] = self.size.map(|n| n as i64);
        if self.clamped {
            let [x, y, z] = [(x, nx), (y, ny), (z, nz)].map(|(i, n)| i.clamp(0, n - 1));
            return self.values[((z * ny + y) * nx + x) as usize];
        }
        let is_in = (0..nx).contains(&x) && (0..ny).contains(&y) && (0..nz).contains(&z);
        if is_in { self.values[((z * ny + y) * nx + x) as usize] } else { T::default() }
    }
    /// The largest `number` of the values from one to another index along each axis, both included, which may lie outside.
    pub(super) fn most_in(&self, span: [[i64; 2]; 3], number: impl Fn(&T) -> f32) -> f32 {
        let [nx, ny, nz] = self.size;
        let clip = |[from, to]: [i64; 2], n: usize| {
            (from.clamp(0, n as i64) as usize, (to + 1).clamp(0, n as i64) as usize)
        };
        let ([x0, x1], [y0, y1], [z0, z1]) =
            (clip(span[0], nx).into(), clip(span[1], ny).into(), clip(span[2], nz).into());
        let mut most = 0.0f32;
        for (y, z) in (z0..z1).flat_map(|z| (y0..y1).map(move |y| (y, z))) {
            let row = (z * ny + y) * nx;
            most = self.values[row + x0..row + x1].iter().map(&number).fold(most, f32::max);
        }
        most
    }
    /// The value at a point of the unit cube.
    pub(crate) fn at(&self, p: [f32; 3]) -> T {
        between(self.size, p, |index| self.value(index))
    }
}

/// The value at a point of the unit cube, where voxels of this number in each direction have these values.
pub(super) fn between<T: Mixed>(size: [usize; 3], p: [f32; 3], value: impl Fn([i64; 3]) -> T) -> T {
    let place: [f32; 3] = std::array::from_fn(|i| p[i] * size[i] as f32 - 0.5);
    let first = place.map(|v| v.floor() as i64);
    let [dx, dy, dz]: [f32; 3] = std::array::from_fn(|i| place[i] - place[i].floor());
    let row = |y: i64, z: i64| {
        let [a, b] = [0, 1].map(|x| value([first[0] + x, first[1] + y, first[2] + z]));
        a * (1.0 - dx) + b * dx
    };
    let face = |z: i64| row(0, z) * (1.0 - dy) + row(1, z) * dy;
    face(0) * (1.0 - dz) + face(1) * dz
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_met_in_the_middles_and_mixed_between() {
        let grid = Grid::new([2, 2, 2], (0..8u8).map(f32::from).collect()).expect("eight values");
        assert_eq!(grid.at([0.25, 0.25, 0.25]), 0.0);
        assert_eq!(grid.at([0.75, 0.25, 0.25]), 1.0);
        assert_eq!(grid.at([0.25, 0.75, 0.25]), 2.0);
        assert_eq!(grid.at([0.25, 0.25, 0.75]), 4.0);
        assert_eq!(grid.at([0.5, 0.5, 0.5]), 3.5);
        // Half of what is there at the side, nothing further out.
        assert_eq!(grid.at([1.0, 0.25, 0.25]), 0.5);
        assert_eq!(grid.at([1.3, 0.25, 0.25]), 0.0);
        let on = grid.clamped(true);
        assert_eq!(
            (on.at([1.0, 0.25, 0.25]), on.at([0.0, 0.0, 0.0]), on.at([0.5, 0.5, 0.5])),
            (1.0, 0.0, 3.5)
        );
        assert!(Grid::new([2, 2, 3], vec![0.0f32; 8]).is_none());
    }
}
