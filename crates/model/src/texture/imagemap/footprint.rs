//! How wide a footprint is among the texels of an image, as an ellipse (Heckbert 1989, "Fundamentals of Texture Mapping and
//! Image Warping").
//!
//! With the steps `a` and `b` that span it, in texels, the matrix `V = a aT + b bT` is the square of its size: its
//! eigenvalues are the squares of the half axes, and `x` lies within if `xT V^-1 x < 1`.
use durer_core::math::float::sqr;

/// The matrix `V`: `xx`, `xy`, `yy`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ellipse {
    pub(super) xx: f32,
    pub(super) xy: f32,
    pub(super) yy: f32,
    /// Half the shorter axis, in texels.
    pub(super) minor: f32,
}

impl Ellipse {
    /// Of two steps; the shorter axis is widened until the longer one is `most` times as long at most. `None` for a point,
    /// and for what is not finite.
    pub(super) fn new([a, b]: [[f32; 2]; 2], most: f32) -> Option<Self> {
        let (xx, xy, yy) = (sqr(a[0]) + sqr(b[0]), a[0] * a[1] + b[0] * b[1], sqr(a[1]) + sqr(b[1]));
        let (mean, root) = ((xx + yy) * 0.5, (sqr((xx - yy) * 0.5) + sqr(xy)).sqrt());
        let (longer, shorter) = (mean + root, (mean - root).max(0.0));
        if !(longer > 0.0 && longer.is_finite()) {
            return None;
        }
        let wanted = shorter.max(longer / sqr(most));
        // Along the shorter axis only: longer I - V is zero along the longer one.
        let k = if wanted > shorter { (wanted - shorter) / (longer - shorter) } else { 0.0 };
        let (xx, xy, yy) = (xx + k * (longer - xx), xy - k * xy, yy + k * (longer - yy));
        Some(Self { xx, xy, yy, minor: wanted.sqrt() })
    }

    /// The ellipse in an image whose sides have so many times the texels, wide enough to have some inside: convolved with
    /// a texel.
    pub(super) fn scaled(&self, [sx, sy]: [f32; 2]) -> Self {
        let (xx, yy) = (self.xx * sqr(sx) + 1.0, self.yy * sqr(sy) + 1.0);
        Self { xx, xy: self.xy * sx * sy, yy, minor: self.minor }
    }

    /// Calls `texel` with all whole coordinates within the ellipse around `centre`, and with `xT V^-1 x`.
    pub(super) fn each(&self, centre: [f64; 2], mut texel: impl FnMut(i64, i64, f32)) {
        let determinant = (self.xx * self.yy - sqr(self.xy)).max(f32::MIN_POSITIVE);
        let height = f64::from(self.yy.sqrt());
        let (first, last) = ((centre[1] - height).ceil(), (centre[1] + height).floor());
        for y in first as i64..=last as i64 {
            let dy = (y as f64 - centre[1]) as f32;
            // The row's chord of the ellipse.
            let middle = f64::from(self.xy / self.yy * dy);
            let half = f64::from((determinant / self.yy * (1.0 - sqr(dy) / self.yy)).max(0.0).sqrt());
            let (left, right) = ((centre[0] + middle - half).ceil(), (centre[0] + middle + half).floor());
            for x in left as i64..=right as i64 {
                let dx = (x as f64 - centre[0]) as f32;
                let r2 = (self.yy * sqr(dx) - 2.0 * self.xy * dx * dy + self.xx * sqr(dy)) / determinant;
                texel(x, y, r2);
            }
        }
    }
}
