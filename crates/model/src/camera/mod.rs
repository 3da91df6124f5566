//! Cameras: film positions to rays.
//!
//! Camera space has x to the right, y up and looks along +z (pbrt's left-handed camera space). A camera knows no film.
//! A new camera is one file here and one line in [`CAMERAS`].

mod differential;
mod lens;
mod orthographic;
mod perspective;
mod realistic;
mod screen;
mod shutter;
mod spherical;

use std::fmt::Debug;

use durer_core::math::{Point2, Point3, Ray, Vector3};
use durer_scene::Entry;

pub use differential::{Differential, central_differentials};
pub use lens::Lens;
pub use orthographic::Orthographic;
pub use perspective::Perspective;
pub use realistic::Realistic;
pub use shutter::Shutter;
pub use spherical::Spherical;

/// How a camera sees a point, in camera space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Where its ray to the point starts.
    pub from: Point3,
    /// Unit direction of that ray.
    pub d: Vector3,
    /// The point's place in the picture, which is `[0, 1]` across and down; there is more around it.
    pub film: Point2,
}

/// What a camera's picture falls on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmBack {
    /// In metres.
    pub diagonal: f32,
}

impl Default for FilmBack {
    /// pbrt's, 35 mm.
    fn default() -> Self {
        Self { diagonal: 0.035 }
    }
}

/// A ray from the film to the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeRay {
    /// In camera space, of unit length.
    pub ray: Ray,
    /// What its radiance counts in the picture; 0 where something of the camera is in the way.
    pub weight: f32,
}

/// A camera.
pub trait Camera: Debug + Send + Sync {
    /// Puts a film into it; called once, before [`Camera::fit`]. Only for cameras in which it has a size.
    fn load(&mut self, _film: FilmBack) {}
    /// Adapts the field of view to a picture of this many pixels; called once, before any ray is asked for.
    fn fit(&mut self, width: u32, height: u32);
    /// The ray through `film` (x right, y down, both in `[0, 1]` over the whole picture) in camera space, with a
    /// direction of unit length. It starts where [`Lens::at`] says for `lens`, at the centre for [`Lens::CENTRE`].
    fn ray(&self, film: Point2, lens: Point2, time: f32) -> Ray;
    /// The same with its weight, which is 1 unless light is lost on its way to the film.
    #[inline]
    fn eye(&self, film: Point2, lens: Point2, time: f32) -> EyeRay {
        EyeRay { ray: self.ray(film, lens, time), weight: 1.0 }
    }
    /// Where on the lens that ray starts, in metres right of and above its centre.
    fn on_lens(&self, _film: Point2, lens: Point2) -> [f32; 2] {
        self.lens().at(lens)
    }
    /// How the ray of unit direction `d` changes with `film.x` and with `film.y`, through whatever point of the lens; for
    /// cameras that do not say, as in the middle of the picture ([`central_differentials`]).
    fn differentials(&self, d: Vector3) -> [Differential; 2] {
        central_differentials(self, d)
    }
    /// Whether light can be connected to it: it answers to [`Camera::sees`] and [`Camera::importance`].
    fn is_connectible(&self) -> bool {
        false
    }
    /// How it sees a point of camera space through the point of the lens that [`Lens::at`] gives for `lens`; `None` if it
    /// does not.
    fn sees(&self, p: Point3, lens: Point2) -> Option<Sight> {
        let _ = (p, lens);
        None
    }
    /// The density with which rays through one point of the lens, spread evenly over the picture (as one of area 1, which
    /// goes on beyond its edges), cross an area that faces the ray of unit direction `d` at a distance from where it
    /// starts. 1/m². What leaves a surface towards the camera counts by this and the cosine there (Veach 1997, section
    /// 8.3.2: importance by the density of points on the lens).
    fn importance(&self, d: Vector3, distance: f32) -> f32 {
        let _ = (d, distance);
        0.0
    }
    /// The places around the picture that show the same as `film`, a place in it.
    fn repeats(&self, film: Point2) -> Vec<Point2> {
        let _ = film;
        Vec::new()
    }
    /// What it looks through.
    fn lens(&self) -> &Lens;
    /// Puts the plane in focus at a depth above 0, in metres.
    ///
    /// # Errors
    /// Why the lens cannot.
    fn focus_at(&mut self, depth: f32) -> Result<(), String>;
    /// What exposes its pictures.
    fn shutter(&self) -> &Shutter;
}

/// All kinds of camera.
pub const CAMERAS: &[Entry<Box<dyn Camera>>] = &[
    Entry::of::<Orthographic>(),
    Entry::of::<Perspective>(),
    Entry::of::<Realistic>(),
    Entry::of::<Spherical>(),
];
