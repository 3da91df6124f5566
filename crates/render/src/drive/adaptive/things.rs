//! What can lie between the rays: objects as a whole, by their bounding spheres.
//!
//! A thing is a shape that is no mesh, or a mesh in its place: a triangle is not lost if one beside it is met. Of these a
//! tree of its own is built and asked what the middle ray of a tile passes by closely, then those of its blocks: most
//! tiles of most pictures hold nothing small, and are done with that.
//!
//! Places are looked at from one point of the lens and at one moment, by random numbers that all pixels share. What is
//! blurred is larger than it is here and is met by more rays.
use std::{collections::HashMap, sync::Arc};

use durer_accel::{Accel, AccelBuilder, BuildOptions, Hit, Placement};
use durer_core::{
    math::{Bounds3, Point2, Point3, Ray, Vector3},
    sampling::Sampler,
};
use durer_scene::Mesh;

use super::spot::{LOST_BELOW, Spot};
use crate::{
    Scene,
    drive::{Job, pass},
    film::Tile,
    scene::Target,
};

/// Edge of a block of pixels.
const BLOCK: u32 = 4;

/// All that has an end.
pub(super) struct Things {
    accel: Accel,
    /// The thing of each primitive of `accel`, and its bounding sphere in render space.
    spheres: Vec<(u32, Point3, f32)>,
    /// The first thing of each instance of the scene.
    first: Vec<u32>,
    /// Instances whose primitives are things of their own.
    is_apart: Vec<bool>,
}

impl Things {
    /// Of a scene at the moment of [`ray`]; `None` if there are none.
    pub(super) fn of(job: &Job<'_>) -> Option<Self> {
        let scene = job.scene;
        let (mut first, mut is_apart, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
        for target in scene.targets.iter() {
            first.push(boxes.len() as u32);
            is_apart.push(matches!(target, Target::Shapes));
            match target {
                Target::Shapes => {
                    boxes.extend(scene.shapes.iter().map(|s| s.render_from_object.bounds(&s.shape.bounds())));
                }
                _ => boxes.push(Bounds3::EMPTY),
            }
        }
        let time = ray(job, Point2::new(0.0, 0.0)).time;
        place_instances(scene, time, &first, &mut boxes);
        let finite = |b: &Bounds3| !b.is_empty() && b.is_finite();
        let kept: Vec<(u32, Bounds3)> = (0..).zip(boxes).filter(|(_, b)| finite(b)).collect();
        if kept.is_empty() {
            return None;
        }
        let spheres =
            kept.iter().map(|(thing, b)| (*thing, b.center(), 0.5 * b.diagonal().length())).collect();
        let mut builder = AccelBuilder::new(BuildOptions::default());
        let geometry = builder.user(kept.into_iter().map(|(_, b)| b).collect()).ok()?;
        builder.instance(geometry, Placement::Identity).ok()?;
        Some(Self { accel: builder.build().ok()?, spheres, first, is_apart })
    }

    /// Which thing was hit.
    pub(super) fn of_hit(&self, hit: &Hit) -> u32 {
        let instance = hit.instance as usize;
        self.first[instance] + if self.is_apart[instance] { hit.prim } else { 0 }
    }

    /// Primitives that may be small to a pixel of a tile and lie in it.
    fn near(&self, job: &Job<'_>, tile: Tile) -> Vec<u32> {
        let cone = Cone::around(job, tile);
        let mut found = Vec::new();
        self.accel.near_misses(
            &cone.axis,
            |t| cone.radius(t),
            |miss| {
                if miss.radius <= LARGEST * cone.pixel(miss.t) {
                    found.push(miss.prim);
                }
            },
        );
        found
    }
}

/// What is larger than so many pixels, as a bounding sphere, is not lost in any: [`LOST_BELOW`], with room for how unequal
/// the pixels of a tile are.
const LARGEST: f32 = 4.0 * LOST_BELOW;

/// Boxes of what is no part of [`Target::Shapes`].
fn place_instances(scene: &Scene, time: f32, first: &[u32], boxes: &mut [Bounds3]) {
    // Meshes are placed again and again.
    let mut meshes: HashMap<*const Mesh, Bounds3> = HashMap::new();
    let mut own = |mesh: &Arc<Mesh>| *meshes.entry(Arc::as_ptr(mesh)).or_insert_with(|| bounds(mesh));
    for (instance, target) in (0..).zip(scene.targets.iter()) {
        let placed = || scene.accel.instance_transform(instance, time);
        boxes[first[instance as usize] as usize] = match target {
            Target::Shapes => continue,
            Target::Baked(_, mesh) => own(mesh),
            Target::Mesh(_, mesh) => placed().bounds(&own(mesh)),
            // Searching each strand would take longer than its picture.
            Target::Strands(..) => continue,
            Target::Mover(index) => placed().bounds(&scene.movers[*index as usize].shape.bounds()),
        };
    }
}

/// Of all its keys.
fn bounds(mesh: &Mesh) -> Bounds3 {
    Bounds3::around((0..mesh.keys()).flat_map(|key| mesh.key(key).1.iter().copied()))
}

/// The ray through a point of the picture from one point of the lens, at one moment.
fn ray(job: &Job<'_>, film: Point2) -> Ray {
    let sampler = Sampler::new(job.settings.sampler, job.settings.seed, [u32::MAX; 2], 0, 1);
    pass::eye_at(&job.scene.view, job.settings.nesting, film, &sampler).ray.ray
}

/// What holds all rays through a tile: all that lies on them at `t` is nearer to the axis than `at_zero + t * slope`.
struct Cone {
    axis: Ray,
    at_zero: f32,
    slope: f32,
    /// Pixels from the axis to its edge.
    pixels: f32,
}

impl Cone {
    /// Around a tile and a pixel more on each side.
    fn around(job: &Job<'_>, tile: Tile) -> Self {
        let [x0, x1] = [tile.x0 as f32 - 1.0, tile.x1 as f32 + 1.0];
        let [y0, y1] = [tile.y0 as f32 - 1.0, tile.y1 as f32 + 1.0];
        let axis = ray(job, Point2::new(0.5 * (x0 + x1), 0.5 * (y0 + y1)));
        let (mut at_zero, mut slope) = (0.0f32, 0.0f32);
        for film in [[x0, y0], [x1, y0], [x0, y1], [x1, y1]] {
            let edge = ray(job, Point2::new(film[0], film[1]));
            at_zero = at_zero.max(beside(edge.o - axis.o, axis.d).length());
            slope = slope.max(match edge.d.dot(axis.d) {
                along if along > 0.0 => beside(edge.d, axis.d).length() / along,
                _ => f32::INFINITY,
            });
        }
        let pixels = 0.5 * ((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)).sqrt();
        Self { axis, at_zero, slope, pixels }
    }
    /// Of a picture that sees to the side all is near.
    fn radius(&self, t: f32) -> f32 {
        (self.at_zero + self.slope * t).min(f32::MAX)
    }
    /// The edge of a pixel, on average.
    fn pixel(&self, t: f32) -> f32 {
        self.radius(t) / self.pixels
    }
}

/// The part of `v` across unit vector `d`.
fn beside(v: Vector3, d: Vector3) -> Vector3 {
    v - d * v.dot(d)
}

/// What is small in a tile.
pub(super) struct Search<'a> {
    things: &'a Things,
    job: &'a Job<'a>,
    tile: Tile,
    /// By block, row by row; empty if there is nothing anywhere.
    blocks: Vec<Vec<u32>>,
}

impl<'a> Search<'a> {
    /// Asks what is near the tile, and, if there is something, its blocks.
    pub(super) fn new(things: &'a Things, job: &'a Job<'a>, tile: Tile) -> Self {
        let blocks = match things.near(job, tile).as_slice() {
            [] => Vec::new(),
            _ => tile.squares(BLOCK).into_iter().map(|block| things.near(job, block)).collect(),
        };
        Self { things, job, tile, blocks }
    }

    /// What may be lost in a pixel.
    pub(super) fn spots(&self, [x, y]: [u32; 2]) -> Vec<Spot> {
        let across = (self.tile.x1 - self.tile.x0).div_ceil(BLOCK);
        let block = (y - self.tile.y0) / BLOCK * across + (x - self.tile.x0) / BLOCK;
        let Some(near) = self.blocks.get(block as usize).filter(|near| !near.is_empty()) else {
            return Vec::new();
        };
        let [x, y] = [x as f32, y as f32];
        let rays = [[x, y], [x + 1.0, y], [x, y + 1.0]].map(|p| ray(self.job, Point2::new(p[0], p[1])));
        let spheres = near.iter().map(|&prim| self.things.spheres[prim as usize]);
        let spots = spheres.filter_map(|(thing, center, radius)| Spot::locate(thing, center, radius, &rays));
        spots.filter(|spot| spot.may_hide_in([0.0, 0.0], 1.0)).collect()
    }
}
