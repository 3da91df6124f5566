//! Weighted sums over the neighbours of each vertex.
use std::f64::consts::{PI, TAU};

use durer_core::glam::DVec3;

use super::halfedges::{HalfEdges, previous};

/// The neighbours of every vertex, counter-clockwise; those on a boundary first and last.
pub(super) struct Masks {
    /// Where the ring of each vertex begins in `rings`; one more than there are vertices.
    starts: Vec<u32>,
    rings: Vec<u32>,
    boundary: Vec<bool>,
}

impl Masks {
    pub(super) fn new(edges: &HalfEdges, vertices: usize) -> Self {
        let mut any = vec![None; vertices];
        for h in 0..edges.count() {
            any[edges.from(h)].get_or_insert(h);
        }
        let mut masks = Self { starts: vec![0], rings: Vec::new(), boundary: Vec::new() };
        for h in any {
            // Every vertex begins some half-edge.
            let fan = h.map(|h| edges.fan(h)).unwrap_or_default();
            masks.rings.extend(fan.iter().map(|&h| edges.to(h) as u32));
            let last = fan.last().map(|&h| previous(h)).filter(|&h| edges.twin(h).is_none());
            masks.rings.extend(last.map(|h| edges.from(h) as u32));
            masks.boundary.push(last.is_some());
            masks.starts.push(masks.rings.len() as u32);
        }
        masks
    }

    fn ring(&self, vertex: usize) -> &[u32] {
        &self.rings[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// `f` of each vertex, its ring and whether it lies on a boundary.
    fn map(&self, positions: &[DVec3], f: impl Fn(DVec3, &[DVec3], bool) -> DVec3) -> Vec<DVec3> {
        let mut ring = Vec::new();
        let of = |vertex: usize| {
            ring.clear();
            ring.extend(self.ring(vertex).iter().map(|&i| positions[i as usize]));
            f(positions[vertex], &ring, self.boundary[vertex])
        };
        (0..self.boundary.len()).map(of).collect()
    }

    /// Where one more level moves the vertices.
    pub(super) fn refined(&self, positions: &[DVec3]) -> Vec<DVec3> {
        self.map(
            positions,
            |v, ring, boundary| {
                if boundary { along(v, ring, 0.125) } else { around(v, ring, beta(ring.len())) }
            },
        )
    }

    /// Where infinitely many levels move the vertices.
    pub(super) fn limits(&self, positions: &[DVec3]) -> Vec<DVec3> {
        self.map(positions, |v, ring, boundary| {
            if boundary {
                along(v, ring, 1.0 / 6.0)
            } else {
                let n = ring.len();
                around(v, ring, 1.0 / (n as f64 + 3.0 / (8.0 * beta(n))))
            }
        })
    }

    /// The direction of the normal of the limit surface at each vertex, towards the side from which triangles are seen
    /// counter-clockwise; the mean of the triangles around if the tangents are parallel. Zero if that fails too.
    pub(super) fn normals(&self, positions: &[DVec3]) -> Vec<DVec3> {
        self.map(positions, |v, ring, boundary| {
            let (s, t) = if boundary { crease_tangents(v, ring) } else { tangents(ring) };
            let normal = s.cross(t);
            if normal.length_squared() > 1e-24 * s.length_squared() * t.length_squared() {
                return normal;
            }
            let closing = if boundary { None } else { ring.last().zip(ring.first()) };
            let pairs = ring.windows(2).map(|w| (w[0], w[1])).chain(closing.map(|(a, b)| (*a, *b)));
            pairs.map(|(a, b)| (a - v).cross(b - v)).sum()
        })
    }
}

fn beta(n: usize) -> f64 {
    if n == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * n as f64) }
}

/// `(1 - n weight) v + weight * sum of the ring`.
fn around(v: DVec3, ring: &[DVec3], weight: f64) -> DVec3 {
    v * (1.0 - ring.len() as f64 * weight) + ring.iter().sum::<DVec3>() * weight
}

/// `(1 - 2 weight) v + weight * the two neighbours on the boundary`.
fn along(v: DVec3, ring: &[DVec3], weight: f64) -> DVec3 {
    let [first, .., last] = ring else { return v };
    v * (1.0 - 2.0 * weight) + (*first + *last) * weight
}

/// Two tangents inside, the second to the left of the first.
fn tangents(ring: &[DVec3]) -> (DVec3, DVec3) {
    let n = ring.len() as f64;
    let angle = |j: usize| TAU * j as f64 / n;
    let sum =
        |weight: fn(f64) -> f64| ring.iter().enumerate().map(|(j, p)| *p * weight(angle(j))).sum::<DVec3>();
    (sum(libm::cos), sum(libm::sin))
}

/// The tangent against the boundary, from the last neighbour to the first, and one across it, inwards.
fn crease_tangents(v: DVec3, ring: &[DVec3]) -> (DVec3, DVec3) {
    let [first, inner @ .., last] = ring else { return (DVec3::ZERO, DVec3::ZERO) };
    let across = match inner {
        [] => *first + *last - v * 2.0,
        [only] => *only - v,
        [a, b] => -*first + (*a + *b) * 2.0 - *last - v * 2.0,
        _ => {
            let theta = PI / (ring.len() - 1) as f64;
            let weight = |k: usize| (2.0 * libm::cos(theta) - 2.0) * libm::sin(k as f64 * theta);
            let sum: DVec3 = (1..).zip(inner).map(|(k, p)| *p * weight(k)).sum();
            -((*first + *last) * libm::sin(theta) + sum)
        }
    };
    (*first - *last, across)
}
