//! A whole sphere as a point outside sees it: a cone of directions.
//!
//! `sin(theta_max) = r / d`; directions are uniform in the cone, the point is where each enters the sphere (Shirley, Wang
//! and Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations"). `1 - cos(theta_max)` is taken as
//! `sin^2 / (1 + cos)`, which keeps all digits for spheres however small.
use std::f64::consts::TAU;

use durer_core::glam::DVec3;

use super::frame;

/// Points this near to the sphere, by the square of their distance to its middle, may as well be on it or inside.
const ON_SPHERE: f64 = 4e-6;

/// The cone of a sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    from: DVec3,
    center: DVec3,
    radius: f64,
    distance: f64,
    /// `1 - cos(theta_max)`.
    opening: f64,
}

impl Cone {
    /// The cone in which `from` sees the sphere; `None` from inside, and where that cannot be told: points of the sphere
    /// itself are known to a few roundings of `f32`.
    pub(super) fn of(center: DVec3, radius: f64, from: DVec3) -> Option<Self> {
        let squared = (center - from).length_squared();
        let sin2 = radius * radius / squared;
        let opening = sin2 / (1.0 + (1.0 - sin2).sqrt());
        (sin2 < 1.0 - ON_SPHERE && opening > 0.0).then(|| Self {
            from,
            center,
            radius,
            distance: squared.sqrt(),
            opening,
        })
    }
    /// Density of every direction, 1/sr.
    pub(super) fn density(&self) -> f64 {
        1.0 / (TAU * self.opening)
    }
    /// A point of the sphere; `u` in `[0, 1)²`.
    pub(super) fn point(&self, u: [f64; 2]) -> DVec3 {
        let down = u[0] * self.opening;
        let sin2 = down * (2.0 - down);
        let d = self.distance;
        let reach = d * (1.0 - down) - (self.radius * self.radius - d * d * sin2).max(0.0).sqrt();
        let z = (self.center - self.from) / d;
        let [x, y] = frame(z);
        let (sin, cos) = libm::sincos(TAU * u[1]);
        let w = (x * cos + y * sin) * sin2.sqrt() + z * (1.0 - down);
        let out = self.from + w * reach - self.center;
        self.center + out * (self.radius / out.length())
    }
}
