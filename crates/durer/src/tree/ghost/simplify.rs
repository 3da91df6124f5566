//! Fewer triangles: vertices in the same cell of a lattice become one (Rossignac and Borrel 1993, vertex clustering).
use std::collections::{HashMap, HashSet};

use crate::glam::DVec3;

use super::Soup;

/// Triangles that each mesh may keep so that all together keep at most `budget`, small ones all of theirs.
pub(super) fn quota(counts: &[usize], budget: usize) -> usize {
    let mut sorted = counts.to_vec();
    sorted.sort_unstable();
    let mut left = budget;
    for (i, &count) in sorted.iter().enumerate() {
        let share = left / (sorted.len() - i);
        if count > share {
            return share;
        }
        left -= count;
    }
    usize::MAX
}

/// The mesh with at most `most` triangles.
pub(super) fn clustered(soup: &Soup, most: usize) -> Soup {
    let used = soup.indices.iter().flatten().filter_map(|&i| soup.positions.get(i as usize));
    let bounds = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    // A closed surface of n cells along an edge has some 6 n² cells, and twice as many triangles.
    let mut cells = ((most as f64 / 2.0).sqrt().ceil() as u32).max(1);
    loop {
        let coarse = on_lattice(soup, bounds, cells);
        if coarse.indices.len() <= most || cells == 1 {
            return coarse;
        }
        cells = (cells * 4 / 5).max(1);
    }
}

fn on_lattice(soup: &Soup, (low, high): (DVec3, DVec3), cells: u32) -> Soup {
    let size = (high - low).max_element().max(f64::MIN_POSITIVE) / f64::from(cells);
    let mut cell_of: HashMap<[i32; 3], u32> = HashMap::new();
    let mut sums: Vec<(DVec3, f64)> = Vec::new();
    let clusters: Vec<u32> = soup
        .positions
        .iter()
        .map(|p| {
            let cell = ((*p - low) / size).floor().to_array().map(|v| v as i32);
            let index = *cell_of.entry(cell).or_insert_with(|| {
                sums.push((DVec3::ZERO, 0.0));
                sums.len() as u32 - 1
            });
            let sum = &mut sums[index as usize];
            sum.0 += *p;
            sum.1 += 1.0;
            index
        })
        .collect();
    let mut known = HashSet::new();
    let mut coarse = Soup { positions: sums.iter().map(|(sum, n)| *sum / *n).collect(), indices: Vec::new() };
    for triangle in &soup.indices {
        let t = triangle.map(|i| clusters.get(i as usize).copied().unwrap_or(0));
        let mut sorted = t;
        sorted.sort_unstable();
        if sorted[0] != sorted[1] && sorted[1] != sorted[2] && known.insert(sorted) {
            coarse.indices.push(t);
        }
    }
    coarse.without_unused()
}

impl Soup {
    /// The same without points that no triangle needs, in the order of the triangles.
    pub(super) fn without_unused(&self) -> Self {
        let mut new = vec![u32::MAX; self.positions.len()];
        let mut kept = Self::default();
        for triangle in &self.indices {
            kept.indices.push(triangle.map(|i| {
                let index = &mut new[i as usize];
                if *index == u32::MAX {
                    *index = kept.positions.len() as u32;
                    kept.positions.push(self.positions[i as usize]);
                }
                *index
            }));
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_meshes_keep_all_and_large_ones_share_the_rest() {
        assert_eq!(quota(&[10, 20], 100), usize::MAX);
        assert_eq!(quota(&[10, 1000, 1000], 110), 50);
        assert_eq!(quota(&[], 5), usize::MAX);
    }

    #[test]
    fn a_fine_square_becomes_a_coarse_one_of_the_same_size() {
        let n = 100u32;
        let mut soup = Soup::default();
        for j in 0..=n {
            for i in 0..=n {
                soup.positions.push(DVec3::new(i.into(), j.into(), 0.0));
            }
        }
        for j in 0..n {
            for i in 0..n {
                let c = j * (n + 1) + i;
                soup.indices.extend([[c, c + 1, c + n + 2], [c, c + n + 2, c + n + 1]]);
            }
        }
        let coarse = clustered(&soup, 500);
        assert!((100..=500).contains(&coarse.indices.len()), "{}", coarse.indices.len());
        let area: f64 = coarse
            .indices
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| coarse.positions[i as usize]);
                (b - a).cross(c - a).z / 2.0
            })
            .sum();
        assert!((7000.0..=10_000.0).contains(&area), "{area}");
    }
}
