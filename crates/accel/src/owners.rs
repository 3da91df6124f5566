//! Who is who in the scene's own tree: numbers of primitives, instance after instance.
use std::ops::Range;

/// Ranges of numbers and the instances they belong to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Owners {
    /// First number of each range, rising.
    starts: Vec<u32>,
    instances: Vec<u32>,
    /// The range that the first of every [`BUCKET`] numbers lies in.
    buckets: Vec<u32>,
    total: u32,
}

/// Numbers per bucket. PERF: looking there and going on from it takes fewer wrong turns than halving (bench kernel).
const BUCKET: u32 = 64;

impl Owners {
    /// Appends an instance with `count` primitives; returns the number of the first. Instances must come in order, so that
    /// numbers are ordered as `(instance, prim)` is.
    pub(crate) fn push(&mut self, instance: u32, count: u32) -> u32 {
        let first = self.total;
        let range = self.starts.len() as u32;
        self.starts.push(first);
        self.instances.push(instance);
        self.total += count;
        self.buckets.resize(self.total.div_ceil(BUCKET) as usize, range);
        first
    }

    /// All numbers are below this.
    pub(crate) fn total(&self) -> u32 {
        self.total
    }

    /// The instance of number `id`, and which of its primitives it is.
    #[inline]
    pub(crate) fn of(&self, id: u32) -> (u32, u32) {
        let mut at = self.buckets.get((id / BUCKET) as usize).map_or(0, |&range| range as usize);
        while self.starts.get(at + 1).is_some_and(|start| *start <= id) {
            at += 1;
        }
        match (self.instances.get(at), self.starts.get(at)) {
            (Some(&instance), Some(&start)) => (instance, id - start),
            _ => (u32::MAX, u32::MAX),
        }
    }

    /// The numbers of an instance's primitives; `None` if they lie in a tree of its own.
    pub(crate) fn range_of(&self, instance: u32) -> Option<Range<u32>> {
        let at = self.instances.binary_search(&instance).ok()?;
        Some(self.starts[at]..self.starts.get(at + 1).copied().unwrap_or(self.total))
    }

    /// All instances with their numbers.
    pub(crate) fn ranges(&self) -> impl Iterator<Item = (u32, Range<u32>)> + '_ {
        self.instances.iter().filter_map(|&instance| Some((instance, self.range_of(instance)?)))
    }

    pub(crate) fn bytes(&self) -> usize {
        [&self.starts, &self.instances, &self.buckets].map(|v| size_of_val(v.as_slice())).iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_find_their_instance_past_empty_ones() {
        let mut owners = Owners::default();
        for (instance, count) in [(2, 3), (3, 0), (7, 1), (9, 5)] {
            owners.push(instance, count);
        }
        let found: Vec<_> = (0..owners.total()).map(|id| owners.of(id)).collect();
        assert_eq!(found, [(2, 0), (2, 1), (2, 2), (7, 0), (9, 0), (9, 1), (9, 2), (9, 3), (9, 4)]);
        let ranges: Vec<_> = owners.ranges().collect();
        assert_eq!(ranges, [(2, 0..3), (3, 3..3), (7, 3..4), (9, 4..9)]);
        assert_eq!((owners.range_of(7), owners.range_of(8)), (Some(3..4), None));
    }

    #[test]
    fn large_and_small_ranges_in_turns() {
        let mut owners = Owners::default();
        let counts = [1, 200, 1, 1, 62, 64, 3, 0, 129, 64, 1];
        let all =
            (0..).zip(counts).flat_map(|(instance, count)| (0..count).map(move |prim| (instance, prim)));
        for (instance, count) in (0..).zip(counts) {
            owners.push(instance, count);
        }
        assert!((0..owners.total()).map(|id| owners.of(id)).eq(all));
    }
}
