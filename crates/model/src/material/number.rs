//! Chance for materials, which have no sampler: numbers that follow from where and whence a surface is looked at.
use durer_core::math::Vector3;

use crate::Surface;

/// A number in `[0, 1)` that follows from a direction and a place; another one for each `which`.
pub(super) fn number(wo: Vector3, surface: &Surface, which: u32) -> f32 {
    let p = surface.p;
    let start = 0x9e37_79b9u32.wrapping_mul(2 * which + 1);
    let mixed = [wo.x, wo.y, wo.z, p.x, p.y, p.z].iter().fold(start, |hash, v| {
        let hash = (hash ^ v.to_bits()).wrapping_mul(0x85eb_ca6b);
        (hash ^ (hash >> 15)).wrapping_mul(0xc2b2_ae35)
    });
    ((mixed ^ (mixed >> 16)) >> 8) as f32 * (1.0 / (1 << 24) as f32)
}
