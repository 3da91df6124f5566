//! Reflected directions from a table, as Cook, Porter and Carpenter (1984) made them: the distribution about the mirror
//! direction is cut into regions of equal weight, the table keeps a direction for each with the magnitude of its jitter.
use std::f64::consts::TAU;

use glam::DVec3;

/// A region: angle from the axis and around it, each with the room of its jitter.
#[derive(Clone, Copy, Debug)]
struct Entry {
    cos: [f64; 2],
    phi: [f64; 2],
}

/// A table for a lobe `cos^n`.
#[derive(Clone, Debug)]
pub struct GlossTable(Vec<Entry>);

impl GlossTable {
    /// `rings * sectors` regions that hold the same share of the lobe.
    pub fn new(exponent: f64, rings: usize, sectors: usize) -> Self {
        // The share of the lobe within the cone of cosine c is 1 - c^(n + 1).
        let at = |share: f64| (1.0 - share).powf(1.0 / (exponent + 1.0));
        // The outermost ring reaches as far beyond its median as it begins before it: its own tail is thin.
        let outer =
            |i: usize| 2.0 * at((i as f64 - 0.5) / rings as f64) - at((i as f64 - 1.0) / rings as f64);
        let cos = |i: usize| if i == rings { outer(i) } else { at(i as f64 / rings as f64) };
        let phi = |j: usize| j as f64 / sectors as f64 * TAU;
        let entry = |i: usize, j: usize| Entry { cos: [cos(i), cos(i + 1)], phi: [phi(j), phi(j + 1)] };
        Self((0..rings * sectors).map(|k| entry(k / sectors, k % sectors)).collect())
    }
    /// Number of regions.
    pub fn len(&self) -> usize {
        self.0.len()
    }
    /// True if there is no region.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
    /// A direction about z in a region, jittered by two numbers in `[0, 1)`.
    pub fn direction(&self, region: usize, jitter: [f64; 2]) -> DVec3 {
        let Entry { cos: [c0, c1], phi: [p0, p1] } = self.0[region];
        let (c, phi) = (c0 + (c1 - c0) * jitter[0], p0 + (p1 - p0) * jitter[1]);
        let s = (1.0 - c * c).max(0.0).sqrt();
        DVec3::new(s * phi.cos(), s * phi.sin(), c)
    }
}
