//! Rays towards vertices, along edges, from surfaces, along axes.
use durer_core::math::{Point3, Ray, Vector3};

use super::{oracle::landmarks, scenes::Scene};
use crate::corpus::Random;

/// A point of a triangle: a corner, on an edge, anywhere.
fn on(random: &mut Random, [a, b, c]: [Point3; 3]) -> Point3 {
    let edge = |u: f32| a + (b - a) * u;
    match random.below(4) {
        0 => a,
        1 => edge(0.5),
        2 => edge(random.unit()),
        _ => {
            let u = random.unit();
            let v = random.unit() * (1.0 - u);
            a + (b - a) * u + (c - a) * v
        }
    }
}

/// A direction of about the length of `like`, some components of which are zero.
fn odd_direction(random: &mut Random, like: Vector3) -> Vector3 {
    let mut d = (random.direction() * like.length().max(f32::MIN_POSITIVE)).to_array();
    for _ in 0..1 + random.below(2) {
        d[random.below(3)] = [0.0, -0.0, 1e-9, -1e-22][random.below(4)];
    }
    d.into()
}

/// A ray of the scene at a random moment.
pub(crate) fn ray(random: &mut Random, scene: &Scene) -> Ray {
    let time = random.between(-0.2, 1.2);
    let pick = |random: &mut Random| {
        let instance = random.below(scene.placed.len());
        let prim = random.below(scene.bodies[scene.placed[instance].body].len());
        landmarks(scene, instance, prim, time)
    };
    let (first, second) = (pick(random), pick(random));
    let (p, q) = (on(random, first), on(random, second));
    let apart = q - p;
    // Never shorter than a direction may be.
    let size = (first[1] - first[0]).length().max(apart.length()).max(1e-9);
    let aside = random.direction() * size;
    let mut ray = match random.below(8) {
        // From one surface to another, and the same from behind.
        0 => Ray::new(p, apart),
        1 => Ray::new(p - apart, apart),
        2 => Ray::new(p + aside, p - (p + aside)),
        3 => Ray::new(p + aside * random.between(0.5, 20.0), apart - aside * random.unit()),
        // Along an edge.
        4 => {
            let along = first[1] - first[0];
            Ray::new(first[0] - along * [0.0, 0.5, 1.0, 3.0][random.below(4)], along)
        }
        // Along an axis or in a plane of the axes, from outside or from the point itself.
        5 | 6 => {
            let d = odd_direction(random, aside);
            Ray::new(p - d * [0.0, 1.0, 2.0][random.below(3)], d)
        }
        _ => Ray::new(p, aside),
    };
    if random.below(4) == 0 {
        let length = ray.d.length();
        if length > 0.0 {
            ray.d = ray.d * (random.between(0.01, 100.0) / length);
        }
    }
    // Before, between and behind what it aims at.
    let reach = size / ray.d.length().max(f32::MIN_POSITIVE);
    match random.below(8) {
        0 => ray.t_max = random.between(0.0, 2.0) * reach,
        1 => (ray.t_min, ray.t_max) = (random.unit() * reach, random.between(1.0, 3.0) * reach),
        2 => ray.t_min = -random.between(0.0, 3.0) * reach,
        3 => (ray.t_min, ray.t_max) = (-reach, random.between(-1.0, 0.5) * reach),
        _ => {}
    }
    ray.time = time;
    ray
}
