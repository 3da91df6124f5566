//! The phase function of Henyey and Greenstein ("Diffuse radiation in the Galaxy", 1941).
//!
//! `p(cos) = (1 - g²) / (4 pi (1 + g² - 2 g cos)^(3/2))` for the cosine of the deflection, whose mean is `g`. It is drawn from
//! exactly, so that what is drawn keeps its weight.
use std::f32::consts::PI;

use durer_core::math::{Point2, Vector3, float::sqr};

use super::turned;

/// A phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    g: f32,
}

impl HenyeyGreenstein {
    /// Asymmetries nearer to straight on or back are as sharp as these.
    const SHARPEST: f32 = 0.999;

    /// Of asymmetry `g`, the mean cosine of the deflection, -1 to 1.
    pub fn new(g: f32) -> Self {
        Self { g: g.clamp(-Self::SHARPEST, Self::SHARPEST) }
    }
    /// Its asymmetry.
    pub fn g(self) -> f32 {
        self.g
    }
    /// Density of going on with this cosine of the deflection, 1/sr. It is the share that goes there, too.
    pub fn density(self, cos: f32) -> f32 {
        // 1 + g² - 2 g cos, without cancellation where the peak is.
        let root = (sqr(1.0 - self.g) + 2.0 * self.g * (1.0 - cos)).max(1e-12);
        (1.0 - sqr(self.g)) / (4.0 * PI * root * root.sqrt())
    }
    /// A unit direction after unit direction `w`, at a point of the unit square.
    pub fn deflected(self, w: Vector3, u: Point2) -> Vector3 {
        let cosine = if self.g.abs() < 1e-3 {
            1.0 - 2.0 * u.x
        } else {
            let part = (1.0 - sqr(self.g)) / (1.0 - self.g + 2.0 * self.g * u.x);
            ((1.0 + sqr(self.g) - sqr(part)) / (2.0 * self.g)).clamp(-1.0, 1.0)
        };
        turned(w, cosine, u.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_on_and_back_are_as_the_formula_says_e17() {
        let half = HenyeyGreenstein::new(0.5);
        assert!((half.density(1.0) - 0.477_465).abs() < 1e-6, "{}", half.density(1.0));
        assert!((half.density(-1.0) - 0.017_684).abs() < 1e-6, "{}", half.density(-1.0));
    }

    #[test]
    fn drawn_cosines_have_their_density_and_its_mean_e17() {
        for g in [-0.9, -0.3, 0.0, 5e-4, 0.5, 0.99] {
            let phase = HenyeyGreenstein::new(g);
            let w = Vector3::new(0.36, 0.48, 0.8);
            let n = 20_000u32;
            let mut counts = [0.0f64; 20];
            let mut mean = 0.0;
            for i in 0..n {
                let u = Point2::new((i as f32 + 0.5) / n as f32, (i as f32 * 0.618_034).fract());
                let d = phase.deflected(w, u);
                assert!((d.length() - 1.0).abs() < 1e-5);
                let cos = f64::from(d.dot(w));
                mean += cos / f64::from(n);
                counts[(((cos + 1.0) * 10.0) as usize).min(19)] += 1.0 / f64::from(n);
            }
            assert!((mean - f64::from(g)).abs() < 2e-3, "g {g}: {mean}");
            for (i, count) in counts.iter().enumerate() {
                // Steps as the peak wants them: it is `(1 - g)^2` wide.
                let steps = if g > 0.9 { 4_000_000 } else { 4000 };
                let cos = |k: i32| -1.0 + 0.1 * (i as f64 + (f64::from(k) + 0.5) / f64::from(steps));
                let part: f64 = (0..steps).map(|k| f64::from(phase.density(cos(k) as f32))).sum();
                let expected = part * 2.0 * std::f64::consts::PI * 0.1 / f64::from(steps);
                assert!((count - expected).abs() < 2e-3, "g {g}, bin {i}: {count}, expected {expected}");
            }
        }
    }
}
