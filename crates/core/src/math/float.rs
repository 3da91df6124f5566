//! Transcendental functions whose bits do not depend on the system's libm (film.md item 4).

/// Sine of an angle in radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}
/// Cosine of an angle in radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}
/// Tangent of an angle in radians.
#[inline]
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}
/// Arc cosine in radians; the argument is clamped to `[-1, 1]`.
#[inline]
pub fn acos(x: f32) -> f32 {
    libm::acosf(x.clamp(-1.0, 1.0))
}
/// Arc sine in radians; the argument is clamped to `[-1, 1]`.
#[inline]
pub fn asin(x: f32) -> f32 {
    libm::asinf(x.clamp(-1.0, 1.0))
}
/// Angle of the point `(x, y)` in `(-pi, pi]`.
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}
/// Natural exponential.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}
/// Natural logarithm.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}
/// `x` to the power `y`.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}
/// The complementary error function: the share `2 / sqrt(pi)` of the integral of `exp(-t²)` from `x` on.
#[inline]
pub fn erfc(x: f32) -> f32 {
    libm::erfcf(x)
}
/// `x` squared.
#[inline]
pub fn sqr(x: f32) -> f32 {
    x * x
}
/// Linear interpolation from `a` (t = 0) to `b` (t = 1); exact at both ends.
#[inline]
pub fn lerp(t: f32, a: f32, b: f32) -> f32 {
    (1.0 - t) * a + t * b
}
