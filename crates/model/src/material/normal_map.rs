//! Normal maps: a texture tilts the shading normal.
//!
//! `n = 2 c - 1`, the first two components scaled, in the frame of tangent (towards growing u), bitangent (towards
//! growing v) and shading normal (Blinn 1978; the encoding is that of glTF 2.0, section 3.9.3). Textures hold green as
//! up, and v grows upwards in the picture.
use durer_core::{
    math::{Normal3, Vector3},
    spectrum::Color,
};

use crate::Surface;

/// Least cosine between a tilted normal and the viewer.
const MIN_COSINE: f32 = 1e-3;

/// The shading normal of `surface` tilted by a map's colour `c`, unit. It stays on the outside, and on the viewer's side
/// if the surface is seen from outside (on the other side if from inside): a normal that would turn away is bent back.
/// Where that is impossible, or the surface has no tangents, the normal stays as it is.
pub(super) fn tilted(surface: &Surface, c: Color, scale: f32, wo: Vector3) -> Normal3 {
    let n_s = Vector3::from(surface.n_s);
    let tangent = surface.dpdu - n_s * n_s.dot(surface.dpdu);
    if tangent.length() <= 1e-6 * surface.dpdu.length() {
        return surface.n_s;
    }
    let tangent = tangent.normalize();
    let bitangent = n_s.cross(tangent).normalize();
    // Mirrored texture coordinates turn the bitangent round.
    let bitangent = if bitangent.dot(surface.dpdv) < 0.0 { -bitangent } else { bitangent };
    let [x, y, z] = c.rgb.map(|v| 2.0 * v - 1.0);
    let n = (tangent * (x * scale) + bitangent * (y * scale) + n_s * z).normalize();
    kept(surface, n, wo)
}

/// The normal `n`, unit, as far as it can be kept: on the outside, and on the viewer's side.
pub(super) fn kept(surface: &Surface, n: Vector3, wo: Vector3) -> Normal3 {
    let viewer = if surface.is_outside(wo) { wo } else { -wo };
    let cos = n.dot(viewer);
    let n = if cos < MIN_COSINE { (n + viewer * (MIN_COSINE - cos)).normalize() } else { n };
    let sound = n.is_finite() && surface.n_g.dot(n) > 0.0;
    if sound { n.into() } else { surface.n_s }
}
