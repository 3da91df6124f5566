//! Rays that go on from where others arrive.
//!
//! Directions are cosine-distributed (the unit disk lifted to the hemisphere). Origins are moved off the surface by 1e-5 of
//! the scene's diagonal, so that no kernel's way to treat the surface a ray starts on makes a difference.
use durer::math::{Frame, Normal3, Ray, Vector3, float};

use crate::{
    rays::{Class, Found, RaySet},
    scene::Scene,
};

/// How far origins are moved, in diagonals.
const OFFSET: f32 = 1e-5;
/// How far occlusion rays reach, in diagonals.
const REACH: f32 = 0.05;

/// The rays of `class` that begin where `from` arrive. Misses have no successor.
pub fn spawn(scene: &Scene, class: Class, from: &RaySet, hits: &[Option<Found>]) -> RaySet {
    let diagonal = scene.bounds().diagonal().length();
    let mut rays = Vec::new();
    for (index, (ray, hit)) in from.rays.iter().zip(hits).enumerate() {
        let Some(found) = hit else { continue };
        let [a, b, c] = scene.corners(found.instance, found.prim);
        let normal = (b - a).cross(c - a).normalize().face_forward(-ray.d);
        if !normal.is_finite() {
            continue;
        }
        let mut random = Random::new(index as u64 * 4 + class as u64);
        let d = cosine(Normal3::from(normal), random.next(), random.next());
        let mut next = Ray::new(ray.at(found.t) + normal * (OFFSET * diagonal), d);
        if class == Class::Occlusion {
            next.t_max = REACH * diagonal;
        }
        rays.push(next);
    }
    RaySet { class, rays }
}

/// A direction around `normal` with a density of cos / pi, for two numbers of [0, 1).
fn cosine(normal: Normal3, a: f32, b: f32) -> Vector3 {
    let (radius, angle) = (a.sqrt(), std::f32::consts::TAU * b);
    let local = Vector3::new(radius * float::cos(angle), radius * float::sin(angle), (1.0 - a).sqrt());
    Frame::from_z(normal).to_world(local)
}

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(u64);

impl Random {
    /// Another sequence for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd134_2543_de82_ef95))
    }

    /// The next number of [0, 1).
    #[expect(clippy::should_implement_trait, reason = "endless, and no iterator is wanted")]
    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    }
}
