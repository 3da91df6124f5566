//! A camera whose pictures can be calculated, for tests of what lies where in them.
use durer::{Options, Prepared, draw::DVec2, glam::DVec3};

use crate::scene;

/// A camera at `eye` that looks at the origin with 40 degrees of view along the shorter edge, and its picture.
pub struct Look {
    /// In world space; metres.
    pub eye: DVec3,
    /// Pixels per row, and rows.
    pub size: [u32; 2],
}

impl Look {
    /// The text of a scene of which `world` is what follows the camera.
    fn text(&self, world: &str) -> String {
        let ([w, h], e) = (self.size, self.eye);
        format!(
            "Film \"rgb\" \"integer xresolution\" {w} \"integer yresolution\" {h}\n\
             LookAt {} {} {}  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n{world}",
            e.x, e.y, e.z
        )
    }
    /// A scene with this camera, ready to be drawn.
    pub fn scene(&self, world: &str) -> Prepared {
        scene(&self.text(world), &Options::default())
    }
    /// Right, up and ahead.
    pub fn axes(&self) -> [DVec3; 3] {
        let ahead = -self.eye.normalize();
        // pbrt's world is left-handed.
        let right = DVec3::Y.cross(ahead).normalize();
        [right, ahead.cross(right), ahead]
    }
    /// Pixels from the middle of the picture, by the tangent of the angle there.
    pub fn pixels_per_tan(&self) -> f64 {
        0.5 * f64::from(self.size[0].min(self.size[1])) / 20f64.to_radians().tan()
    }
    /// The middle of the picture, in pixels.
    fn middle(&self) -> DVec2 {
        0.5 * DVec2::new(self.size[0].into(), self.size[1].into())
    }
    /// Where a point of the world lies in the picture.
    pub fn project(&self, p: DVec3) -> DVec2 {
        let [x, y, z] = self.axes().map(|axis| axis.dot(p - self.eye));
        self.middle() + DVec2::new(x, -y) / z * self.pixels_per_tan()
    }
    /// The direction of the ray through a point of the picture.
    pub fn ray(&self, at: DVec2) -> DVec3 {
        let [right, up, ahead] = self.axes();
        let q = (at - self.middle()) / self.pixels_per_tan();
        (ahead + right * q.x - up * q.y).normalize()
    }
    /// How far a point of the picture is outside of a sphere's outline, in pixels.
    pub fn outside_sphere(&self, at: DVec2, center: DVec3, radius: f64) -> f64 {
        let to = center - self.eye;
        let f = |at: DVec2| self.ray(at).angle_between(to) - (radius / to.length()).asin();
        let e = 1e-3;
        let gradient = DVec2::new(
            f(at + DVec2::X * e) - f(at - DVec2::X * e),
            f(at + DVec2::Y * e) - f(at - DVec2::Y * e),
        );
        f(at) / (gradient / (2.0 * e)).length()
    }
}
