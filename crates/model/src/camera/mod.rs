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

use durer_core::math::{Point2, Ray, Vector3};
use durer_scene::Entry;

pub use differential::{Differential, central_differentials};
pub use lens::Lens;
pub use orthographic::Orthographic;
pub use perspective::Perspective;
pub use shutter::Shutter;
pub use spherical::Spherical;

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
