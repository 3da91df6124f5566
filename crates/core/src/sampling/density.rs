//! Drawing from a density that is a polygon: `g` is linear between values at equal steps, and its integral is inverted
//! exactly (Physically Based Rendering, 4th edition, section A.4.4, in a form that does not cancel).

use crate::math::Guide;

/// A density over `[0, n]` for `n + 1` values. It need not be normalised.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearDensity {
    /// The value at the ends of the steps, and the integral up to there.
    nodes: Vec<[f32; 2]>,
    /// To the integrals.
    guide: Guide,
}

impl LinearDensity {
    /// From at least two values that are not negative; `None` of fewer, or if the integral is not above 0.
    pub fn new(values: impl IntoIterator<Item = f32>) -> Option<Self> {
        let mut area = 0.0f64;
        let mut nodes: Vec<[f32; 2]> = Vec::new();
        for value in values {
            if let Some([before, _]) = nodes.last() {
                area += f64::from(before + value) * 0.5;
            }
            nodes.push([value, area as f32]);
        }
        if !(area > 0.0 && area.is_finite()) {
            return None;
        }
        let integrals: Vec<f32> = nodes.iter().map(|node| node[1]).collect();
        Some(Self { nodes, guide: Guide::new(&integrals) })
    }

    /// The place that number `u` in `[0, 1]` is drawn to, as a share of all the steps.
    pub fn at(&self, u: f32) -> f32 {
        self.sample(u).0 / (self.nodes.len() - 1) as f32
    }

    /// The place that number `u` in `[0, 1]` is drawn to, in steps from the first value, and the value there. Greater
    /// numbers go further.
    #[inline]
    pub fn sample(&self, u: f32) -> (f32, f32) {
        let last = self.nodes.len() - 1;
        let area = u * self.nodes[last][1];
        let step = self.guide.upto(area, last, |i| self.nodes[i][1]).clamp(1, last) - 1;
        let ([f0, before], [f1, _]) = (self.nodes[step], self.nodes[step + 1]);
        // The t in [0, 1] with f0 t + (f1 - f0) t^2 / 2 = rest.
        let rest = area - before;
        let root = (f0 * f0 + 2.0 * (f1 - f0) * rest).max(0.0).sqrt();
        let t = if rest > 0.0 { (2.0 * rest / (f0 + root)).min(1.0) } else { 0.0 };
        (step as f32 + t, f0 + (f1 - f0) * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_drawn_in_proportion_to_the_polygon() {
        let values = [0.0f32, 2.0, 1.0, 0.0, 0.0, 3.0];
        let density = LinearDensity::new(values).expect("sound");
        let n = 100_000;
        let mut counts = [0.0f64; 50];
        let mut before = 0.0;
        for i in 0..n {
            let (x, g) = density.sample((i as f32 + 0.5) / n as f32);
            assert!(x >= before && x <= 5.0);
            before = x;
            let (k, t) = ((x as usize).min(4), x - (x as usize).min(4) as f32);
            assert!((g - (values[k] * (1.0 - t) + values[k + 1] * t)).abs() < 1e-5, "{x}");
            counts[((x * 10.0) as usize).min(49)] += 1.0 / f64::from(n);
        }
        let total: f64 = 1.0 + 1.5 + 0.5 + 0.0 + 1.5;
        for (i, count) in counts.iter().enumerate() {
            let (k, t) = (i / 10, (i % 10) as f64 / 10.0 + 0.05);
            let expected = (f64::from(values[k]) * (1.0 - t) + f64::from(values[k + 1]) * t) * 0.1 / total;
            assert!((count - expected).abs() < 1e-4, "bin {i}: {count}, expected {expected}");
        }
    }

    #[test]
    fn ends_are_met_and_nothing_is_no_density() {
        let even = LinearDensity::new([1.0, 1.0]).expect("sound");
        assert_eq!([0.0, 0.25, 1.0].map(|u| even.sample(u)), [(0.0, 1.0), (0.25, 1.0), (1.0, 1.0)]);
        assert!(LinearDensity::new([1.0]).is_none() && LinearDensity::new([0.0; 3]).is_none());
        assert!(LinearDensity::new([f32::NAN, 1.0]).is_none());
    }
}
