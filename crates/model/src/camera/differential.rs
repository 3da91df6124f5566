//! How rays change from one place of the picture to the next (Igehy 1999, "Tracing Ray Differentials").
use durer_core::math::{Frame, Point2, Vector3};

use super::{Camera, Lens};

/// What a step in the picture, as long as its width or height, would add to a ray if it were straight: derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differential {
    /// To its origin, in metres of camera space.
    pub o: Vector3,
    /// To its unit direction; perpendicular to it.
    pub d: Vector3,
}

/// Half a step of the difference quotient, by the picture.
const STEP: f32 = 1.0 / 512.0;

/// The differentials of the middle of the picture, to the right and down, turned round so that they belong to the unit
/// direction `d`: what a camera sees that looks there.
pub fn central_differentials<C: Camera + ?Sized>(camera: &C, d: Vector3) -> [Differential; 2] {
    let frame = Frame::from_z(d.into());
    let turned = |step: Point2, side: Vector3| {
        let ray = |sign: f32| camera.ray(Point2::new(0.5, 0.5) + step * sign, Lens::CENTRE, 0.0);
        let (before, after) = (ray(-STEP), ray(STEP));
        let per_picture = 1.0 / (2.0 * STEP);
        let length = |v: Vector3| side * (v.length() * per_picture);
        Differential { o: length(after.o - before.o), d: length(after.d - before.d) }
    };
    [turned(Point2::new(1.0, 0.0), frame.x), turned(Point2::new(0.0, 1.0), frame.y)]
}
