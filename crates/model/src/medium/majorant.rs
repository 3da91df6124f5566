//! Bounds on the density along a ray, cell by cell of a coarse grid: where there is little, long steps are taken.
//!
//! The grid is walked as in Amanatides and Woo ("A Fast Voxel Traversal Algorithm for Ray Tracing", 1987); see Physically
//! Based Rendering, 4th edition, section 11.4.4.
use std::cmp::Ordering;

use durer_core::math::Point3;

/// The largest density in each cell of the unit cube.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Majorants {
    size: [usize; 3],
    most: Vec<f32>,
}

impl Majorants {
    /// Edge of a cell in voxels, about; cells along an axis at most.
    const VOXELS: usize = 6;
    const MOST_CELLS: usize = 64;

    /// Of a field of this many voxels; `most_in` says the largest value of those from one to another index along each axis,
    /// both included, which may lie outside.
    pub(super) fn new(voxels: [usize; 3], most_in: impl Fn([[i64; 2]; 3]) -> f32) -> Self {
        let size = voxels.map(|n| n.div_ceil(Self::VOXELS).clamp(1, Self::MOST_CELLS));
        // What is mixed at a point of the cell.
        let reach = |axis: usize, cell: usize| {
            let [from, to] = [cell, cell + 1].map(|c| c as f64 / size[axis] as f64 * voxels[axis] as f64);
            // A voxel more, as points are rounded.
            [(from - 0.5).floor() as i64 - 1, (to - 0.5).floor() as i64 + 2]
        };
        let mut most = Vec::with_capacity(size.iter().product());
        for z in 0..size[2] {
            for y in 0..size[1] {
                most.extend((0..size[0]).map(|x| most_in([reach(0, x), reach(1, y), reach(2, z)])));
            }
        }
        Self { size, most }
    }

    /// One cell.
    pub(super) fn even(most: f32) -> Self {
        Self { size: [1; 3], most: vec![most] }
    }

    /// How many cells along each axis; x changes fastest.
    pub(super) fn size(&self) -> [usize; 3] {
        self.size
    }
    /// The largest density in a cell.
    pub(super) fn bound(&self, cell: usize) -> f32 {
        self.most[cell]
    }
    /// The cell of a point of the unit cube; `None` outside.
    pub(super) fn cell(&self, p: [f32; 3]) -> Option<usize> {
        if !p.iter().all(|v| (0.0..=1.0).contains(v)) {
            return None;
        }
        let [x, y, z]: [usize; 3] = std::array::from_fn(|axis| {
            ((p[axis] * self.size[axis] as f32) as usize).min(self.size[axis] - 1)
        });
        Some((z * self.size[1] + y) * self.size[0] + x)
    }
    /// The point of a cell at these shares of its edges, in the unit cube.
    pub(super) fn place(&self, cell: usize, within: [f32; 3]) -> Point3 {
        let [nx, ny, nz] = self.size;
        let first = [cell % nx, cell / nx % ny, cell / (nx * ny)];
        let [x, y, z]: [f32; 3] =
            std::array::from_fn(|axis| (first[axis] as f32 + within[axis]) / [nx, ny, nz][axis] as f32);
        Point3::new(x, y, z)
    }

    /// The way of a ray, given in the space of the cube, from `t0` to `t1`.
    pub(super) fn steps(&self, (o, d): ([f32; 3], [f32; 3]), (t0, t1): (f32, f32)) -> Steps<'_> {
        let (mut near, mut far) = (t0, t1);
        for axis in 0..3 {
            if d[axis] == 0.0 {
                if !(o[axis] >= 0.0 && o[axis] <= 1.0) {
                    far = f32::NEG_INFINITY;
                }
                continue;
            }
            let planes = [0.0, 1.0].map(|plane: f32| (plane - o[axis]) / d[axis]);
            near = near.max(planes[0].min(planes[1]));
            far = far.min(planes[0].max(planes[1]));
        }
        let mut steps = Steps {
            majorants: self,
            t: near,
            end: far,
            cell: [0; 3],
            next: [f32::INFINITY; 3],
            by: [0.0; 3],
            d,
        };
        if !steps.is_over() {
            for axis in 0..3 {
                let n = self.size[axis] as f32;
                let place = (o[axis] + d[axis] * near) * n;
                let cell = (place.floor() as i64).clamp(0, self.size[axis] as i64 - 1);
                steps.cell[axis] = cell;
                if d[axis] != 0.0 {
                    let plane = if d[axis] > 0.0 { cell + 1 } else { cell };
                    steps.next[axis] = (plane as f32 / n - o[axis]) / d[axis];
                    steps.by[axis] = 1.0 / (n * d[axis].abs());
                }
            }
        }
        steps
    }
}

/// Cells along a ray.
#[derive(Clone, Debug)]
pub(super) struct Steps<'a> {
    majorants: &'a Majorants,
    t: f32,
    end: f32,
    cell: [i64; 3],
    next: [f32; 3],
    by: [f32; 3],
    d: [f32; 3],
}

impl Steps<'_> {
    /// True also where a bound is NaN.
    fn is_over(&self) -> bool {
        self.t.partial_cmp(&self.end) != Some(Ordering::Less)
    }
}

impl Iterator for Steps<'_> {
    /// Where the ray enters and leaves a cell, and the largest density in it.
    type Item = (f32, f32, f32);

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over() {
            return None;
        }
        let axis = (1..3).fold(0, |best, axis| if self.next[axis] < self.next[best] { axis } else { best });
        let [nx, ny, nz] = self.majorants.size.map(|n| n as i64);
        let [x, y, z] = self.cell;
        let most = self.majorants.most[((z * ny + y) * nx + x) as usize];
        let (from, to) = (self.t, self.next[axis].min(self.end).max(self.t));
        self.t = to;
        self.cell[axis] += if self.d[axis] > 0.0 { 1 } else { -1 };
        self.next[axis] += self.by[axis];
        let left = !(0..[nx, ny, nz][axis]).contains(&self.cell[axis]);
        if left {
            self.end = to;
        }
        Some((from, to, most))
    }
}
