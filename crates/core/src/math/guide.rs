//! Places in rising lists, found in constant time on average.

/// What makes looking up places in a rising list quick: for each of equal parts of its range, where to begin (Chen and Asau
/// 1974, "On Generating Random Variates from an Empirical Distribution").
///
/// ```
/// use durer_core::math::Guide;
///
/// let values = [0.0, 0.5, 0.5, 4.0];
/// let guide = Guide::new(&values);
/// let upto = |x| guide.upto(x, values.len(), |i| values[i]);
/// assert_eq!([-1.0, 0.0, 0.5, 3.0, 9.0].map(upto), [0, 1, 3, 3, 4]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    first: f32,
    /// Parts for each unit.
    parts: f32,
    /// How many values lie at or before the beginning of each part, or fewer.
    starts: Vec<u32>,
}

impl Guide {
    /// For a list of rising, finite values; it is not kept. An empty list will do.
    pub fn new(values: &[f32]) -> Self {
        let (first, last) = (values.first().copied().unwrap_or(0.0), values.last().copied().unwrap_or(0.0));
        let span = f64::from(last) - f64::from(first);
        let width = span / values.len().max(1) as f64;
        // A rounding may put a value at the end of a part into the next.
        let slack = 4.0 * f64::from(f32::EPSILON) * (f64::from(first).abs() + span);
        let begin = |part: usize| f64::from(first) + part as f64 * width - slack;
        let start = |part: usize| values.partition_point(|&v| f64::from(v) <= begin(part)) as u32;
        let parts = if width > 0.0 { (1.0 / width) as f32 } else { 0.0 };
        Self { first, parts, starts: (0..=values.len()).map(start).collect() }
    }

    /// How many of the `len` values are at most `x`: 0 if it is NaN. `value` gives the values that it was made of.
    #[inline]
    pub fn upto(&self, x: f32, len: usize, value: impl Fn(usize) -> f32) -> usize {
        let part = ((x - self.first) * self.parts) as usize;
        let mut count = self.starts[part.min(len)] as usize;
        while count < len && value(count) <= x {
            count += 1;
        }
        count
    }

    /// Heap memory held.
    pub fn bytes(&self) -> usize {
        size_of_val(self.starts.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_guide_finds_what_bisection_finds() {
        let uneven = |i: usize| ((i * 7919) % 97) as f32 * 1e-3 + if i == 40 { 50.0 } else { 0.0 };
        for offset in [0.0, -3.0, 1000.0] {
            let mut sum = offset;
            let values: Vec<f32> = (0..300)
                .map(|i| {
                    sum += uneven(i);
                    sum
                })
                .collect();
            let guide = Guide::new(&values);
            let found = |x: f32| guide.upto(x, values.len(), |i| values[i]);
            for i in -100..=100_000 {
                let x = offset + (sum - offset) * i as f32 / 99_000.0;
                assert_eq!(found(x), values.partition_point(|&v| v <= x), "{x}");
            }
            for &x in &values {
                assert_eq!(found(x), values.partition_point(|&v| v <= x), "{x}");
            }
        }
    }

    #[test]
    fn short_lists_and_odd_questions_are_answered() {
        assert_eq!(Guide::new(&[]).upto(1.0, 0, |_| 0.0), 0);
        let one = Guide::new(&[2.0]);
        assert_eq!([1.0, 2.0, 3.0, f32::NAN].map(|x| one.upto(x, 1, |_| 2.0)), [0, 1, 1, 0]);
        let wide = [-3e38, 0.0, 3e38];
        let guide = Guide::new(&wide);
        let asked = [f32::NEG_INFINITY, -3e38, 1.0, f32::INFINITY];
        assert_eq!(asked.map(|x| guide.upto(x, 3, |i| wide[i])), [0, 1, 2, 3]);
    }
}
