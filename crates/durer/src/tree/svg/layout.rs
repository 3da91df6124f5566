//! Where nodes of a tree go: parents in the middle above their children, subtrees as close as their outlines allow
//! (Reingold and Tilford 1981; Buchheim, Jünger and Leipert 2002 for any number of children).
//!
//! Outlines are kept whole instead of threaded, the smaller merged into the larger: `O(n log n)`.

/// The outline of a subtree on one side: for each level below its root the distance from where the outline begins.
struct Outline {
    /// From the deepest level up, so that roots are added at the end; without `shift`.
    levels: Vec<f64>,
    shift: f64,
}

impl Outline {
    fn at(&self, level: usize) -> f64 {
        self.levels[self.levels.len() - 1 - level] + self.shift
    }
    fn push(&mut self, v: f64) {
        self.levels.push(v - self.shift);
    }
    fn depth(&self) -> usize {
        self.levels.len()
    }
    /// Takes the levels of `over`, and below these keeps its own, or the other way round for a deeper `over`.
    fn covered_by(self, over: Self) -> Self {
        let (mut deep, shallow, shallow_wins) =
            if self.depth() > over.depth() { (self, over, true) } else { (over, self, false) };
        if shallow_wins {
            let n = deep.levels.len();
            for level in 0..shallow.depth() {
                deep.levels[n - 1 - level] = shallow.at(level) - deep.shift;
            }
        }
        deep
    }
}

/// A place for each node on its level, 0 or more; neighbours are at least 1 apart. `children` of a node come after it.
pub(super) fn layout(children: &[Vec<usize>]) -> Vec<f64> {
    let n = children.len();
    let mut outlines: Vec<Option<(Outline, Outline)>> = (0..n).map(|_| None).collect();
    // Where a node lies relative to its parent.
    let mut offset = vec![0.0; n];
    for node in (0..n).rev() {
        let mut merged: Option<(Outline, Outline)> = None;
        let mut places: Vec<f64> = Vec::new();
        for &child in &children[node] {
            let Some((mut left, mut right)) = outlines[child].take() else { continue };
            let (before, move_by) = match merged {
                None => (None, 0.0),
                Some((l, r)) => {
                    let shared = r.depth().min(left.depth());
                    let gap = (0..shared).map(|level| r.at(level) - left.at(level)).fold(f64::MIN, f64::max);
                    (Some((l, r)), gap + 1.0)
                }
            };
            left.shift += move_by;
            right.shift += move_by;
            places.push(move_by);
            merged = Some(match before {
                None => (left, right),
                // The left outline is that of the earlier ones where they reach; the right that of the new one.
                Some((l, r)) => (left.covered_by(l), r.covered_by(right)),
            });
        }
        let middle = (places.first().copied().unwrap_or(0.0) + places.last().copied().unwrap_or(0.0)) / 2.0;
        for (&child, place) in children[node].iter().zip(&places) {
            offset[child] = place - middle;
        }
        let (mut left, mut right) = merged.unwrap_or_else(|| {
            let none = || Outline { levels: Vec::new(), shift: 0.0 };
            (none(), none())
        });
        left.shift -= middle;
        right.shift -= middle;
        left.push(0.0);
        right.push(0.0);
        outlines[node] = Some((left, right));
    }
    let mut across = vec![0.0; n];
    for node in 0..n {
        for &child in &children[node] {
            across[child] = across[node] + offset[child];
        }
    }
    let least = across.iter().copied().fold(f64::MAX, f64::min);
    across.iter().map(|x| x - least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(children: &[Vec<usize>]) -> Vec<usize> {
        let mut levels = vec![0; children.len()];
        for (node, below) in children.iter().enumerate() {
            below.iter().for_each(|&c| levels[c] = levels[node] + 1);
        }
        levels
    }

    #[test]
    fn a_parent_is_in_the_middle_and_nobody_overlaps() {
        // Trees grown at random: parents before children.
        let mut bits = 1u64;
        for size in [1usize, 2, 7, 40, 300] {
            let mut children = vec![Vec::new(); size];
            for node in 1..size {
                bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                children[(bits >> 33) as usize % node].push(node);
            }
            let (x, level) = (layout(&children), levels(&children));
            for (node, below) in children.iter().enumerate() {
                if let (Some(&first), Some(&last)) = (below.first(), below.last()) {
                    assert!((x[node] - (x[first] + x[last]) / 2.0).abs() < 1e-9);
                }
                assert!(below.windows(2).all(|w| x[w[0]] < x[w[1]]), "in their order");
                for other in 0..node {
                    let apart = (x[node] - x[other]).abs();
                    assert!(level[node] != level[other] || apart > 1.0 - 1e-9, "{node} {other}: {apart}");
                }
            }
        }
    }

    #[test]
    fn a_chain_is_narrow_and_a_full_tree_as_wide_as_its_leaves() {
        let chain: Vec<Vec<usize>> =
            (1..=50_000).map(|i| if i < 50_000 { vec![i] } else { Vec::new() }).collect();
        assert!(layout(&chain).iter().all(|x| *x == 0.0));
        let full: Vec<Vec<usize>> =
            (0..31).map(|i| if i < 15 { vec![2 * i + 1, 2 * i + 2] } else { Vec::new() }).collect();
        assert_eq!(layout(&full).into_iter().fold(0.0, f64::max), 15.0);
    }
}
