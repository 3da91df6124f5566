//! Cameras: film positions to rays.
//!
//! Camera space has x to the right, y up and looks along +z (pbrt's left-handed camera space). A camera knows no film.
//! A new camera is one file here and one line in [`CAMERAS`].

mod differential;
mod lens;
mod orthographic;
mod perspective;
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

/// A camera.
pub trait Camera: Debug + Send + Sync {
    /// Adapts the field of view to a picture of this many pixels; called once, before any ray is asked for.
    fn fit(&mut self, width: u32, height: u32);
    /// The ray through `film` (x right, y down, both in `[0, 1]` over the whole picture) in camera space, with a
    /// direction of unit length. It starts where [`Lens::at`] says for `lens`, at the centre for [`Lens::CENTRE`].
    fn ray(&self, film: Point2, lens: Point2, time: f32) -> Ray;
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
    /// What it looks through, to be focused.
    fn lens_mut(&mut self) -> &mut Lens;
    /// What exposes its pictures.
    fn shutter(&self) -> &Shutter;
}

/// All kinds of camera.
pub const CAMERAS: &[Entry<Box<dyn Camera>>] =
    &[Entry::of::<Orthographic>(), Entry::of::<Perspective>(), Entry::of::<Spherical>()];
