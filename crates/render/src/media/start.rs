//! The bodies that the camera is in.
//!
//! Found once: from the camera rays run in 64 directions through everything. What they leave without having entered it
//! was around the camera, if that is so in at least 40 percent of the directions: seen from under water without shores
//! and bottom, half of them leave it; of a body that is open or turned inside out and lies elsewhere, few do. What is left
//! first was entered last. Cameras with an extent (lenses, parallel rays) are taken to lie in the same bodies as their
//! middle, and moving ones as when the shutter opens.
use std::{collections::BTreeMap, f32::consts::PI};

use durer_core::{
    Id,
    math::{Point3, Ray, Vector3, float},
    spectrum::Basis,
};
use durer_model::{Fill, Hull, Medium};

use super::{Imbalance, MediumStack};
use crate::{SampleCx, Scene, probe::NoProbe};

/// Directions.
const DIRECTIONS: u32 = 64;
/// How many of them decide.
const ENOUGH: u32 = DIRECTIONS * 2 / 5;
/// Surfaces met at most in a direction.
const MOST_SURFACES: u32 = 1000;

/// The bodies that eye rays start in, and what floats there, if the file says so.
pub(crate) fn start(scene: &Scene, said: Option<Fill>) -> MediumStack {
    let mut stack = MediumStack::within(said.unwrap_or_default());
    if scene.media.is_empty() {
        return stack;
    }
    // For a body, and how many of its medium were left before it: directions, and the sum of the ranks in which it was left.
    let mut votes: BTreeMap<(u32, u32), (u32, u32)> = BTreeMap::new();
    for direction in 0..DIRECTIONS {
        for (rank, left) in (0..).zip(left_unentered(scene, spiral(scene, direction))) {
            let (count, ranks) = votes.entry(left).or_default();
            *count += 1;
            *ranks += rank;
        }
    }
    let mut around: Vec<_> = votes.into_iter().filter(|(_, (count, _))| *count > ENOUGH).collect();
    around.sort_by(|(a, (counts, ranks)), (b, (other_counts, other_ranks))| {
        // By mean rank, the largest first.
        (other_ranks * counts).cmp(&(ranks * other_counts)).then(a.cmp(b))
    });
    for ((medium, _), _) in around {
        // More than fit: rays that leave the others will be counted.
        let _ = stack.enter(Id::new(medium));
    }
    if let Some(said) = said {
        stack.agree(said, &scene.media);
    }
    stack
}

/// The bodies that a ray starts in, by what it leaves without having entered it: right where all bodies are closed.
pub(crate) fn around(scene: &Scene, ray: &Ray) -> MediumStack {
    let mut stack = MediumStack::default();
    if !scene.media.is_empty() {
        for (medium, _) in left_unentered(scene, *ray).into_iter().rev() {
            // More than fit: rays that leave the others will be counted.
            let _ = stack.enter(Id::new(medium));
        }
    }
    stack
}

/// The bodies that a point is in, and what floats there, as a straight way from the camera comes to know.
pub(crate) fn at(scene: &Scene, p: Point3, time: f32) -> MediumStack {
    // Render space begins at the camera.
    let mut ray = Ray { time, ..Ray::new(Point3::ZERO, (p - Point3::ZERO).normalize()) };
    let cx = SampleCx { scene, basis: Basis::Rgb };
    let (d, mut stack) = (ray.d, scene.start);
    if scene.media.is_empty() || !d.is_finite() {
        return stack;
    }
    for _ in 0..MOST_SURFACES {
        ray.t_max = (p - ray.o).dot(d).max(0.0);
        let Some(hit) = scene.closest_boundary(&cx, &ray, &mut NoProbe, ()) else { break };
        let (object, mut surface) = scene.surface(&ray, &hit);
        stack = scene.cross(&cx.basis, (object, &mut surface), (-d, time, hit.t), &stack, |_, _| {}).behind;
        ray = surface.spawn(d, time);
    }
    stack
}

/// One of the rays from the camera, on a spiral from pole to pole that turns by the golden angle.
fn spiral(scene: &Scene, direction: u32) -> Ray {
    let time = scene.view.shutter.interval().min;
    let z = 1.0 - (2.0 * direction as f32 + 1.0) / DIRECTIONS as f32;
    let (radius, angle) = ((1.0 - z * z).sqrt(), PI * (3.0 - 5.0f32.sqrt()) * direction as f32);
    let d = Vector3::new(radius * float::cos(angle), radius * float::sin(angle), z).normalize();
    // Render space begins at the camera.
    Ray { time, ..Ray::new(Point3::new(0.0, 0.0, 0.0), d) }
}

/// The media that a ray of unit direction leaves without having entered them, in this order, with the number of the same
/// that it left before.
fn left_unentered(scene: &Scene, mut ray: Ray) -> Vec<(u32, u32)> {
    let cx = SampleCx { scene, basis: Basis::Rgb };
    let (d, time) = (ray.d, ray.time);
    let mut stack = MediumStack::default();
    let mut left: Vec<(u32, u32)> = Vec::new();
    for _ in 0..MOST_SURFACES {
        let Some(hit) = scene.closest_boundary(&cx, &ray, &mut NoProbe, ()) else { break };
        let (object, mut surface) = scene.surface(&ray, &hit);
        let crossing =
            scene.cross(&cx.basis, (object, &mut surface), (-d, time, hit.t), &stack, |of, imbalance| {
                // Of sheets most are open: nobody is in them.
                let has_inside = |id: &Id<Medium>| scene.media.get(*id).hull != Hull::Sheet;
                let medium = scene.medium_of(of).filter(has_inside).map(|id| id.index() as u32);
                if let (Some(medium), Imbalance::LeftUnentered) = (medium, imbalance) {
                    let before = left.iter().filter(|(m, _)| *m == medium).count();
                    left.push((medium, before as u32));
                }
            });
        stack = crossing.behind;
        ray = surface.spawn(d, time);
    }
    left
}
