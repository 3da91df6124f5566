//! Four lanes of radiance or reflectance.
use std::ops::{Add, AddAssign, Div, Mul, MulAssign};

/// Values at four lanes. Only [`super::Basis`] knows whether they are RGB or wavelengths; everything else treats the
/// lanes alike. Units are those of the quantity (radiance: W / (m² sr); weights and reflectances: none).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spectrum([f32; 4]);

impl Spectrum {
    /// Nothing.
    pub const BLACK: Self = Self([0.0; 4]);
    /// One in every lane: a weight that changes nothing.
    pub const ONE: Self = Self([1.0; 4]);

    #[inline]
    pub(crate) const fn from_lanes(lanes: [f32; 4]) -> Self {
        Self(lanes)
    }
    /// The lanes, for those who write them down: what they mean only the basis knows.
    #[inline]
    pub const fn lanes(self) -> [f32; 4] {
        self.0
    }
    /// One of the four lanes, where one leads a choice that is made for all.
    ///
    /// # Panics
    /// If there is no such lane.
    #[inline]
    pub const fn lane(self, index: usize) -> f32 {
        self.0[index]
    }
    /// `v` in every lane.
    #[inline]
    pub const fn splat(v: f32) -> Self {
        Self([v; 4])
    }
    /// `f` of every lane. PERF: written out: without link-time optimisation `array::map` stays a call (callgrind).
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let [a, b, c, d] = self.0;
        Self([f(a), f(b), f(c), f(d)])
    }
    /// `f` of every pair of lanes.
    #[inline]
    pub fn zip(self, o: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let ([a, b, c, d], [e, g, h, i]) = (self.0, o.0);
        Self([f(a, e), f(b, g), f(c, h), f(d, i)])
    }
    /// Largest lane: what stop rules compare.
    #[inline]
    pub fn max(self) -> f32 {
        self.0[0].max(self.0[1]).max(self.0[2]).max(self.0[3])
    }
    /// Plain mean of the lanes; in RGB `(r + 2 g + b) / 4`, a fair stand-in for luminance.
    #[inline]
    pub fn mean(self) -> f32 {
        (self.0[0] + self.0[1] + self.0[2] + self.0[3]) * 0.25
    }
    /// True if every lane is zero.
    #[inline]
    pub fn is_black(self) -> bool {
        let [a, b, c, d] = self.0;
        a == 0.0 && b == 0.0 && c == 0.0 && d == 0.0
    }
    /// False if a lane is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }
}

impl Add for Spectrum {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
}
impl AddAssign for Spectrum {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl Mul for Spectrum {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
}
impl MulAssign for Spectrum {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}
impl Mul<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        self.map(|v| v * s)
    }
}
impl Div<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn div(self, s: f32) -> Self {
        self.map(|v| v / s)
    }
}
