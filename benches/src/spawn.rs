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

/// Fewest rays of a set: where few arrive, several go on from each.
const FEWEST: usize = 32_768;

/// The rays of `class` that begin where `from` arrive. Misses have no successor.
pub fn spawn(scene: &Scene, class: Class, from: &RaySet, hits: &[Option<Found>]) -> RaySet {
    let diagonal = scene.bounds().diagonal().length();
    let arrived = || from.rays.iter().zip(hits).filter_map(|(ray, hit)| Some((ray, hit.as_ref()?)));
    let rounds = FEWEST.div_ceil(arrived().count().max(1)).min(FEWEST);
    let mut rays = Vec::new();
    for (index, (ray, found)) in (0..rounds).flat_map(|_| arrived()).enumerate() {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{scene::Mesh, view::View};
    use durer::math::Point3;

    #[test]
    fn rays_go_on_from_the_side_they_came_from() {
        let corners = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]].map(Point3::from);
        let mesh = Mesh { positions: corners.to_vec(), indices: vec![[0, 2, 1]] };
        let view = View::looking(Point3::new(0.0, 0.0, 3.0), Point3::ZERO, 40.0);
        let scene = Scene::of_mesh("wall", mesh, view);
        let primary = RaySet { class: Class::Primary, rays: view.rays(8) };
        let hits: Vec<_> =
            (0..64).map(|i| (i % 2 == 0).then_some(Found { t: 3.0, instance: 0, prim: 0 })).collect();
        let next = spawn(&scene, Class::Occlusion, &primary, &hits);
        assert_eq!(next.rays.len(), FEWEST);
        assert!(next.rays.iter().all(|ray| ray.d.z > 0.0 && ray.t_max < 2.0 && ray.t_max > 1.0));
        assert_ne!(next.rays[0].d, next.rays[32].d);
        // The density is cos / pi: the mean cosine is 2 / 3.
        let mean = next.rays.iter().map(|ray| ray.d.z).sum::<f32>() / FEWEST as f32;
        assert!((mean - 2.0 / 3.0).abs() < 0.01, "{mean}");
        assert!(spawn(&scene, Class::Diffuse1, &primary, &[None; 64]).rays.is_empty());
    }

    #[test]
    fn random_numbers_fill_the_unit_interval() {
        let mut random = Random::new(7);
        let numbers: Vec<f32> = (0..10_000).map(|_| random.next()).collect();
        assert!(numbers.iter().all(|x| (0.0..1.0).contains(x)));
        let mean = numbers.iter().sum::<f32>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.02 && numbers[0] != Random::new(8).next());
    }
}
