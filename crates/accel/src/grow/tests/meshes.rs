//! Things to grow trees over.
use durer_core::math::{Bounds3, Point3};

use super::super::{Primitives, clip::clip};

/// Triangles, or boxes around them that must stay alone.
#[derive(Clone, Default)]
pub(super) struct Mesh {
    pub(super) triangles: Vec<[Point3; 3]>,
    /// Every so many primitives one that does not pack; 0 for none.
    pub(super) alone: u32,
}

impl Primitives for Mesh {
    fn len(&self) -> usize {
        self.triangles.len()
    }
    fn bounds(&self, prim: u32) -> Bounds3 {
        Bounds3::around(self.triangles[prim as usize])
    }
    fn packs(&self, prim: u32) -> bool {
        self.alone == 0 || !prim.is_multiple_of(self.alone)
    }
    fn clip(&self, prim: u32, within: &Bounds3, axis: usize, at: f32) -> Option<[Bounds3; 2]> {
        self.packs(prim).then(|| clip(&self.triangles[prim as usize], within, axis, at))
    }
}

/// A sequence of numbers in [0, 1) (Knuth's constants).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }
    pub(super) fn point(&mut self) -> Point3 {
        Point3::new(self.next(), self.next(), self.next())
    }
}

impl Mesh {
    fn quad(&mut self, [a, b, c, d]: [Point3; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    /// Small triangles all over the unit cube.
    pub(super) fn soup(n: usize, size: f32) -> Self {
        let mut random = Random(1);
        let triangle = |_| {
            let at = random.point();
            let mut corner = || {
                Point3::new(
                    at.x + size * random.next(),
                    at.y + size * random.next(),
                    at.z + size * random.next(),
                )
            };
            [corner(), corner(), corner()]
        };
        Self { triangles: (0..n).map(triangle).collect(), alone: 0 }
    }

    /// A bumpy closed surface of 12 `n` squared triangles.
    pub(super) fn blob(n: usize) -> Self {
        let mut mesh = Self::default();
        let at = |face: usize, i: usize, j: usize| {
            let (u, v) = (2.0 * i as f32 / n as f32 - 1.0, 2.0 * j as f32 / n as f32 - 1.0);
            let w = if face < 3 { 1.0 } else { -1.0 };
            let [x, y, z] = [[u, v, w], [w, u, v], [v, w, u]][face % 3];
            let radius = (x * x + y * y + z * z).sqrt() * (1.0 + 0.3 * x * y * (1.0 - z * z));
            Point3::new(x / radius, y / radius, z / radius)
        };
        for face in 0..6 {
            for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
                mesh.quad([at(face, i, j), at(face, i + 1, j), at(face, i + 1, j + 1), at(face, i, j + 1)]);
            }
        }
        mesh
    }

    /// Boxes of very different shapes, turned a little, in a room: large and long triangles among small ones.
    pub(super) fn rooms(n: usize) -> Self {
        let mut mesh = Self::default();
        let mut random = Random(7);
        for index in 0..n {
            let long = if index % 8 == 0 { 0.5 } else { 0.02 };
            let size = [long * random.next(), 0.01 + 0.02 * random.next(), 0.1 * long * random.next()];
            let (center, turn) = (random.point(), random.next());
            let (c, s) = ((1.0 - turn * turn).sqrt(), turn);
            let corners: [Point3; 8] = std::array::from_fn(|i| {
                let [x, y, z] = [0, 1, 2].map(|a| if i >> a & 1 == 0 { -size[a] } else { size[a] });
                Point3::new(center.x + c * x - s * y, center.y + s * x + c * y, center.z + z)
            });
            for [a, b, c, d] in
                [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
            {
                mesh.quad([corners[a], corners[b], corners[c], corners[d]]);
            }
        }
        mesh
    }

    pub(super) fn map(mut self, change: impl Fn(Point3) -> Point3) -> Self {
        for p in self.triangles.iter_mut().flatten() {
            *p = change(*p);
        }
        self
    }
}
