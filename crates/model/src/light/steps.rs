//! Drawing one of many in proportion to weights: sums of shares, inverted by bisection.
//!
//! The share of each is the difference of two sums as they are stored, so that it is exactly the chance of being drawn. A
//! share that rounding would lose is raised to `2^-20` of the whole: what weighs anything can be drawn.
use durer_core::math::Guide;

/// The least share of what weighs anything.
const LEAST: f64 = 1.0 / (1 << 20) as f64;

/// Turns weights into the sums of their shares, the last of which is 1; the total weight. Without any weight above 0 all
/// become 0.
pub(super) fn accumulate(weights: &mut [f32]) -> f64 {
    let total: f64 = weights.iter().map(|w| f64::from(*w)).sum();
    let raised = |w: f32| if w > 0.0 { f64::from(w).max(LEAST * total) } else { 0.0 };
    let whole: f64 = weights.iter().map(|w| raised(*w)).sum();
    let Some(last) = weights.iter().rposition(|w| *w > 0.0).filter(|_| whole.is_finite()) else {
        weights.fill(0.0);
        return 0.0;
    };
    let mut sum = 0.0;
    for (i, weight) in weights.iter_mut().enumerate() {
        sum += raised(*weight);
        *weight = if i < last { (sum / whole) as f32 } else { 1.0 };
    }
    total
}

/// The place in `sums` for `u` in `[0, 1)`, how far `u` is within its share, in `[0, 1)`, and the share.
pub(super) fn pick(sums: &[f32], u: f32) -> (usize, f32, f32) {
    let index = sums.partition_point(|sum| *sum <= u).min(sums.len().saturating_sub(1));
    let share = share(sums, index);
    let before = index.checked_sub(1).map_or(0.0, |i| sums[i]);
    (index, ((u - before) / share).clamp(0.0, 1.0 - f32::EPSILON / 2.0), share)
}

/// The chance of a place.
pub(super) fn share(sums: &[f32], index: usize) -> f32 {
    sums[index] - index.checked_sub(1).map_or(0.0, |i| sums[i])
}

/// Sums of shares by themselves.
#[derive(Clone, Debug)]
pub struct Steps {
    sums: Vec<f32>,
    guide: Guide,
}

impl Steps {
    /// From weights, none below 0; `None` if none is above 0 either.
    pub fn new(mut weights: Vec<f32>) -> Option<Self> {
        let total = accumulate(&mut weights);
        let guide = Guide::new(&weights);
        (total > 0.0).then_some(Self { sums: weights, guide })
    }
    /// The index that `u` in `[0, 1)` chooses, and the chance of that.
    pub fn choose(&self, u: f32) -> (usize, f32) {
        let last = self.sums.len() - 1;
        let index = self.guide.upto(u, last, |i| self.sums[i]);
        (index, self.chance(index))
    }
    /// The chance of an index.
    pub fn chance(&self, index: usize) -> f32 {
        share(&self.sums, index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_weighs_anything_is_drawn_as_often_as_its_share_says() {
        let mut sums = [0.0, 1.0, 1e-12, 0.0, 2.0, 1.0, 0.0];
        assert!((accumulate(&mut sums) - 4.0).abs() < 1e-6);
        let n = 1 << 22;
        let mut counts = [0.0f64; 7];
        for i in 0..n {
            let (index, rest, chance) = pick(&sums, i as f32 / n as f32);
            assert!((0.0..1.0).contains(&rest) && chance == share(&sums, index));
            counts[index] += 1.0 / f64::from(n);
        }
        let steps = Steps::new(vec![0.0, 1.0, 1e-12, 0.0, 2.0, 1.0, 0.0]).expect("some weight");
        for i in 0..10_000 {
            let u = i as f32 / 1e4;
            let (index, _, chance) = pick(&sums, u);
            assert_eq!(steps.choose(u), (index, chance));
        }
        for (index, count) in counts.iter().enumerate() {
            assert!((count - f64::from(share(&sums, index))).abs() < 1e-6, "{index}: {count}");
        }
        assert!(counts[2] > 0.0 && counts[0] == 0.0 && counts[3] == 0.0 && counts[6] == 0.0);
    }

    #[test]
    fn nothing_is_no_weight() {
        let mut sums = [0.0; 3];
        assert_eq!(accumulate(&mut sums), 0.0);
        assert_eq!(sums, [0.0; 3]);
        assert!(Steps::new(vec![0.0]).is_none() && Steps::new(Vec::new()).is_none());
    }
}
