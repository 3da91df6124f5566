//! Which triangle lies beyond which edge.
//!
//! Half-edge `3 t + k` of triangle `t` runs from its corner `k` to corner `k + 1`; its twin runs the other way in the
//! neighbouring triangle. Twins are found by hashing once; those of a split mesh follow from the numbers alone (Dupuy and
//! Vanhoey 2021, "A Halfedge Refinement Rule for Parallel Catmull-Clark Subdivision", in the form for triangles).
use std::collections::HashMap;

use durer_core::glam::DVec3;

/// No twin: a boundary.
const NONE: u32 = u32::MAX;

/// The connectivity of a mesh in which every vertex has one fan of triangles.
#[derive(Clone, Debug)]
pub(super) struct HalfEdges {
    /// Where each half-edge begins.
    vertex: Vec<u32>,
    twin: Vec<u32>,
    /// Number of the edge, the same for twins.
    edge: Vec<u32>,
    edges: usize,
    /// Edges that were taken for boundaries although several triangles share them.
    odd: usize,
}

/// The next half-edge of the same triangle.
pub(super) fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before it.
pub(super) fn previous(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

/// Half-edges along one edge, by the order of its ends.
#[derive(Default)]
struct Uses {
    forth: u32,
    back: u32,
    /// The last of each direction.
    last: [u32; 2],
}

impl HalfEdges {
    /// Of triangles among `points` vertices, all in range; triangles that name a vertex twice are left out. Also returns
    /// the original number of each vertex.
    pub(super) fn new(points: usize, triangles: &[[u32; 3]]) -> (Self, Vec<u32>) {
        let sound = triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a);
        let vertex: Vec<u32> = sound.flatten().copied().collect();
        let mut known: HashMap<(u32, u32), Uses> = HashMap::with_capacity(vertex.len() / 2);
        for h in 0..vertex.len() as u32 {
            let (from, to) = (vertex[h as usize], vertex[next(h) as usize]);
            let uses = known.entry((from.min(to), from.max(to))).or_default();
            let back = usize::from(from > to);
            uses.last[back] = h;
            if back == 1 { uses.back += 1 } else { uses.forth += 1 }
        }
        let mut twin = vec![NONE; vertex.len()];
        let mut odd = 0;
        for uses in known.values() {
            if (uses.forth, uses.back) == (1, 1) {
                let [a, b] = uses.last;
                (twin[a as usize], twin[b as usize]) = (b, a);
            } else if uses.forth + uses.back > 1 {
                odd += 1;
            }
        }
        let mut edges = Self { edge: Vec::new(), edges: 0, vertex, twin, odd };
        let origins = edges.part(points);
        edges.number();
        (edges, origins)
    }

    /// How many edges several triangles share in a way that makes no surface.
    pub(super) fn odd(&self) -> usize {
        self.odd
    }

    /// Gives each fan of triangles around a vertex a vertex of its own; returns the old number of each new vertex.
    fn part(&mut self, points: usize) -> Vec<u32> {
        let mut seen = vec![false; self.vertex.len()];
        let mut parted = vec![0; self.vertex.len()];
        let mut origins = Vec::with_capacity(points);
        for start in 0..self.vertex.len() as u32 {
            if seen[start as usize] {
                continue;
            }
            let new = origins.len() as u32;
            origins.push(self.vertex[start as usize]);
            for h in self.fan(start) {
                seen[h as usize] = true;
                parted[h as usize] = new;
            }
        }
        self.vertex = parted;
        origins
    }

    fn number(&mut self) {
        self.edge = vec![0; self.vertex.len()];
        self.edges = 0;
        for h in 0..self.vertex.len() {
            let twin = self.twin[h];
            if twin == NONE || (twin as usize) > h {
                self.edge[h] = self.edges as u32;
                if let Some(other) = self.edge.get_mut(twin as usize) {
                    *other = self.edges as u32;
                }
                self.edges += 1;
            }
        }
    }

    /// The half-edges that begin at the vertex where `start` begins, counter-clockwise; from the boundary if there is
    /// one.
    pub(super) fn fan(&self, start: u32) -> Vec<u32> {
        let mut first = start;
        // Clockwise to the boundary, or once around.
        while let Some(clockwise) = self.twin(first).map(next) {
            first = clockwise;
            if first == start {
                break;
            }
        }
        let mut fan = vec![first];
        let mut last = first;
        while let Some(following) = self.twin(previous(last)) {
            if following == first {
                break;
            }
            fan.push(following);
            last = following;
        }
        fan
    }

    pub(super) fn count(&self) -> u32 {
        self.vertex.len() as u32
    }
    pub(super) fn from(&self, h: u32) -> usize {
        self.vertex[h as usize] as usize
    }
    pub(super) fn to(&self, h: u32) -> usize {
        self.from(next(h))
    }
    pub(super) fn twin(&self, h: u32) -> Option<u32> {
        Some(self.twin[h as usize]).filter(|twin| *twin != NONE)
    }

    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        self.vertex.as_chunks::<3>().0.to_vec()
    }

    /// The new vertex of each edge, in the order of the edges.
    pub(super) fn edge_points(&self, positions: &[DVec3], new: &mut [DVec3]) {
        for h in 0..self.count() {
            let ends = positions[self.from(h)] + positions[self.to(h)];
            let point = match self.twin(h) {
                Some(twin) if twin < h => continue,
                Some(twin) => {
                    let corners = positions[self.from(previous(h))] + positions[self.from(previous(twin))];
                    ends * 0.375 + corners * 0.125
                }
                None => ends * 0.5,
            };
            new[self.edge[h as usize] as usize] = point;
        }
    }

    /// The mesh of four triangles for each of these, and its number of vertices: the `vertices` old ones, then one per
    /// edge. The first three have a corner of the old triangle each, in their first corner; the fourth has none: its
    /// half-edge `k` lies along that of the triangle of corner `k`.
    pub(super) fn split(&self, vertices: usize) -> (Self, usize) {
        let mut new = Self {
            vertex: vec![0; self.vertex.len() * 4],
            twin: vec![NONE; self.vertex.len() * 4],
            edge: Vec::new(),
            edges: 0,
            odd: 0,
        };
        let middle = |h: u32| self.edge[h as usize] + vertices as u32;
        // The first half-edge of the corner triangle that h begins in.
        let corner = |h: u32| 12 * (h / 3) + 3 * (h % 3);
        for h in 0..self.count() {
            let (first, inner) = (corner(h), 12 * (h / 3) + 9 + h % 3);
            let [a, b, c, d] = [first, first + 1, first + 2, inner].map(|i| i as usize);
            new.vertex[a] = self.vertex[h as usize];
            new.vertex[b] = middle(h);
            new.vertex[c] = middle(previous(h));
            // From the middle of the edge before to that of h, against the corner triangle's b.
            new.vertex[d] = middle(previous(h));
            (new.twin[b], new.twin[d]) = (d as u32, b as u32);
            // h's first half belongs to its own corner; the twin's second half, which meets it, to the corner of the
            // half-edge after the twin.
            if let Some(twin) = self.twin(h) {
                let met = corner(next(twin)) + 2;
                (new.twin[a], new.twin[met as usize]) = (met, a as u32);
            }
        }
        new.number();
        (new, vertices + self.edges)
    }
}
