//! Four control values of any basis as the Bezier control values of the same cubic.

/// How control points make a cubic segment. Where two segments of a chain meet, both compute the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CurveBasis {
    /// Four points a segment; the curve passes through the first and the last. Chains step by three points.
    Bezier,
    /// Uniform cubic B-spline: four points a segment, twice continuously differentiable; passes through none of its
    /// points. Chains step by one point.
    BSpline,
    /// Catmull and Rom's spline: four points a segment; passes from the second to the third. Chains step by one point.
    CatmullRom,
    /// Straight from the first to the second of two points. Chains step by one point.
    Linear,
}

impl CurveBasis {
    /// Number of control points of a segment.
    pub const fn points(self) -> usize {
        match self {
            Self::Bezier | Self::BSpline | Self::CatmullRom => 4,
            Self::Linear => 2,
        }
    }

    /// Bezier control values of a segment whose control values are `p`; a linear one has two, the others are ignored.
    pub(super) fn to_bezier(self, p: [f64; 4]) -> [f64; 4] {
        let [a, b, c, d] = p;
        // The knot between three B-spline values: one expression, so that neighbours agree in every bit.
        let knot = |before: f64, at: f64, after: f64| (before + 4.0 * at + after) / 6.0;
        match self {
            Self::Bezier => p,
            Self::BSpline => [knot(a, b, c), (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, knot(b, c, d)],
            Self::CatmullRom => [b, b + (c - a) / 6.0, c - (d - b) / 6.0, c],
            Self::Linear => [a, (2.0 * a + b) / 3.0, (a + 2.0 * b) / 3.0, b],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bezier(c: [f64; 4], s: f64) -> f64 {
        let w = 1.0 - s;
        c[0] * w * w * w + 3.0 * c[1] * w * w * s + 3.0 * c[2] * w * s * s + c[3] * s * s * s
    }

    #[test]
    fn all_bases_have_their_textbook_values() {
        let p = [1.0, -2.0, 4.0, 0.5];
        for i in 0..=8 {
            let s = f64::from(i) / 8.0;
            let (s2, s3, w) = (s * s, s * s * s, 1.0 - s);
            let spline = (p[0] * w * w * w
                + p[1] * (3.0 * s3 - 6.0 * s2 + 4.0)
                + p[2] * (-3.0 * s3 + 3.0 * s2 + 3.0 * s + 1.0)
                + p[3] * s3)
                / 6.0;
            let catmull = 0.5
                * (2.0 * p[1]
                    + (p[2] - p[0]) * s
                    + (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]) * s2
                    + (3.0 * p[1] - p[0] - 3.0 * p[2] + p[3]) * s3);
            let line = p[0] * w + p[1] * s;
            for (basis, expected) in
                [(CurveBasis::BSpline, spline), (CurveBasis::CatmullRom, catmull), (CurveBasis::Linear, line)]
            {
                assert!((bezier(basis.to_bezier(p), s) - expected).abs() < 1e-14, "{basis:?} at {s}");
            }
        }
    }
}
