//! Directions of mirrored and refracted rays: the vector forms of the lecture.
//!
//! Reflection: `R = V - 2 (V . N) N`. Refraction (Snell-Descartes, `eta_i sin i = eta_t sin t`, `eta_r = eta_i / eta_t`,
//! `I` pointing back along the ray): `T = [eta_r (N . I) - sqrt(1 - eta_r² (1 - (N . I)²))] N - eta_r I`; an imaginary
//! root is total internal reflection. W1 and W3 compare it with Whitted's form (1980).
use durer_core::math::{Normal3, Vector3};

/// The mirror image of `v` in the plane of unit normal `n`: for `v` towards the surface, the direction in which the ray
/// leaves. As the map is linear, the mirror direction of `wo`, which points away, is `reflect(-wo, n)`.
pub fn reflect(v: Vector3, n: Normal3) -> Vector3 {
    v - Vector3::from(n) * (2.0 * n.dot(v))
}

/// The direction in which the ray seen from `wo` goes on behind the interface of unit normal `n`, either side up;
/// `eta_r = eta_i / eta_t` with `eta_i` the index of refraction on the side of `wo`. Of unit length. `None` on total
/// internal reflection.
pub fn refract(wo: Vector3, n: Normal3, eta_r: f32) -> Option<Vector3> {
    let n = n.face_forward(wo);
    let cos_i = n.dot(wo);
    let cos_t = cos_transmitted(cos_i, eta_r)?;
    Some((Vector3::from(n) * (eta_r * cos_i - cos_t) - wo * eta_r).normalize())
}

/// Cosine of the angle of refraction; `None` on total internal reflection.
pub(super) fn cos_transmitted(cos_i: f32, eta_r: f32) -> Option<f32> {
    let under_root = 1.0 - eta_r * eta_r * (1.0 - cos_i * cos_i).max(0.0);
    (under_root >= 0.0).then(|| under_root.sqrt())
}
