//! Where in a pixel a small thing lies.
use durer_core::math::{Point3, Ray};

/// A bounding sphere as the pixel sees it: a disk around a point, in pixels from the pixel's upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    /// Which thing.
    pub(super) thing: u32,
    /// Ray parameter of its nearest point.
    pub(super) nearest: f32,
    center: [f32; 2],
    radius: f32,
}

/// A ball whose radius is at least the square root of 1/2 times the distance of samples in a square lattice is met by one of
/// them, wherever it lies. Its bounding sphere, being that of its box, is the square root of 3 times as large.
pub(super) const LOST_BELOW: f32 = 1.224_744_9;

impl Spot {
    /// Of a sphere, by the rays through the upper left, the upper right and the lower left corner of the pixel; `None` if
    /// it lies behind the eye. Between the corners the picture is taken for flat.
    pub(super) fn locate(thing: u32, center: Point3, radius: f32, rays: &[Ray; 3]) -> Option<Self> {
        let [corner, right, below] = rays;
        let t = (center - corner.o).dot(corner.d);
        if t <= 0.0 {
            return None;
        }
        let at = |ray: &Ray| ray.o + ray.d * t;
        let (x, y, to) = (at(right) - at(corner), at(below) - at(corner), center - at(corner));
        // to = u x + v y, by the products with x and y.
        let (xx, xy, yy) = (x.dot(x), x.dot(y), y.dot(y));
        let determinant = xx * yy - xy * xy;
        if determinant.is_nan() || determinant <= 0.0 {
            return None;
        }
        let (tx, ty) = (to.dot(x), to.dot(y));
        let center = [(tx * yy - ty * xy) / determinant, (ty * xx - tx * xy) / determinant];
        Some(Self { thing, nearest: t - radius, center, radius: radius / xx.min(yy).sqrt() })
    }

    /// Whether it is so small that the corners of a square of this side may all miss it, and may lie in this one.
    pub(super) fn may_hide_in(&self, at: [f32; 2], side: f32) -> bool {
        let away = |i: usize| {
            let c = self.center[i];
            (at[i] - c).max(c - at[i] - side).max(0.0)
        };
        let (x, y) = (away(0), away(1));
        self.radius < LOST_BELOW * side && x * x + y * y <= self.radius * self.radius
    }
}

#[cfg(test)]
mod tests {
    use durer_core::math::Vector3;

    use super::*;

    fn rays() -> [Ray; 3] {
        let to = |x: f32, y: f32| Ray::new(Point3::ZERO, Vector3::new(x, y, 1.0).normalize());
        [to(0.0, 0.0), to(0.001, 0.0), to(0.0, -0.001)]
    }

    #[test]
    fn a_sphere_is_found_where_the_pixel_sees_it() {
        let center = Point3::new(0.0025, -0.0075, 10.0);
        let spot = Spot::locate(3, center, 0.002, &rays()).expect("it is in front");
        assert_eq!(spot.thing, 3);
        assert!((spot.center[0] - 0.25).abs() < 1e-4 && (spot.center[1] - 0.75).abs() < 1e-4, "{spot:?}");
        assert!((spot.radius - 0.2).abs() < 1e-4 && (spot.nearest - 9.998).abs() < 1e-5, "{spot:?}");
        assert_eq!(Spot::locate(3, Point3::new(0.0, 0.0, -1.0), 0.002, &rays()), None);
    }

    #[test]
    fn it_hides_in_squares_that_it_touches_and_that_are_not_much_smaller() {
        let spot = Spot { thing: 0, nearest: 1.0, center: [0.3, 0.6], radius: 0.22 };
        assert!(spot.may_hide_in([0.0, 0.0], 1.0) && spot.may_hide_in([0.5, 0.5], 0.5));
        assert!(!spot.may_hide_in([0.75, 0.5], 0.25), "beside");
        assert!(!spot.may_hide_in([0.5, 0.0], 0.5), "near a corner");
        assert!(!spot.may_hide_in([0.25, 0.5], 0.125), "larger than the square");
    }
}
