//! What part of a surface a sample stands for: its share of a pixel, thrown onto the surface.
//!
//! A pixel's width and height, seen along an eye ray, become two tangents of the surface it meets (Igehy 1999). After a
//! bounce the surface is taken as if the camera looked at it from where it is (`Camera::Approximate_dp_dxy` of pbrt-v4):
//! cheap, nothing travels with the ray, and too small rather than too large where mirrors or diffuse surfaces widen what is
//! seen. With n samples a pixel each stands for `1 / sqrt(n)` of its sides, but at least for an eighth, so that textures
//! stay smooth between samples.
use durer_core::math::{Ray, Vector3};
use durer_model::{
    Surface,
    camera::central_differentials,
    texture::{Filters, Footprint, Habit},
};

use crate::{PathRay, View};

/// Least share of a pixel's side.
const LEAST_SHARE: f32 = 0.125;

/// Who looks at a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Onlooker {
    /// Metres from the eye to the ray's origin; `None` after a bounce.
    walked: Option<f32>,
    /// Samples of the pixel.
    samples: u32,
    habit: Habit,
}

impl Onlooker {
    /// At the end of a ray.
    pub(crate) fn of(path: &PathRay, habit: Habit) -> Self {
        let walked = (path.depth == 0).then_some(path.walked);
        Self { walked, samples: path.sampler.count(), habit }
    }

    /// Whether textures of which the most curious wants this much need to know the footprint.
    pub(crate) fn asks(&self, filters: Filters) -> bool {
        match filters {
            Filters::Never => false,
            Filters::AsPbrt => self.habit == Habit::AsPbrt,
            Filters::Always => true,
        }
    }

    /// The footprint on `surface`, where `ray`, of unit direction, hit after `t` metres.
    pub(crate) fn footprint(&self, view: &View, ray: &Ray, t: f32, surface: &Surface) -> Footprint {
        let render_from_camera = view.render_from_camera(ray.time);
        let camera_from_render = render_from_camera.inverse();
        let (along, differentials) = match self.walked {
            Some(walked) => {
                let along = camera_from_render.vector(ray.d) * (walked + t);
                (along, view.camera.differentials(along.normalize()))
            }
            None => {
                let along = Vector3::from_f64(camera_from_render.point(surface.p).to_f64());
                (along, central_differentials(&*view.camera, along.normalize()))
            }
        };
        let (distance, d) = (along.length(), along.normalize());
        let n = camera_from_render.normal(surface.n_g);
        let share = (1.0 / (self.samples.max(1) as f32).sqrt()).max(LEAST_SHARE);
        let sides = [share / view.width.max(1) as f32, share / view.height.max(1) as f32];
        let tangents = std::array::from_fn(|i| {
            let across = (differentials[i].o + differentials[i].d * distance) * sides[i];
            // Along the ray to the plane of the surface.
            render_from_camera.vector(across - d * (n.dot(across) / n.dot(d)))
        });
        Footprint::on(surface, tangents, self.habit)
    }
}
