//! A ray as the z axis, in f64: what curves and points compute of it once.
//!
//! Everything is measured from the ray's origin, so that a shape far from the world's origin but near the ray keeps its
//! precision. Lengths are the world's, whatever the length of the direction.
use durer_core::{
    glam::DVec3,
    math::{Point3, Ray, Vector3},
};

/// Half a unit in the last place of 1: what rounding to f32 does to a number.
const HALF_ULP: f64 = f32::EPSILON as f64 / 2.0;

/// A ray's constants for testing curves and points.
#[derive(Clone, Copy, Debug)]
pub struct RayFrame {
    o: DVec3,
    /// Unit vectors; `z` is the direction.
    x: DVec3,
    y: DVec3,
    z: DVec3,
    /// Of the ray parameter, per unit of length.
    t_per_length: f64,
    pub(crate) t_min: f32,
    start_error: f64,
}

impl RayFrame {
    /// `None` for a ray that can hit nothing: a zero or non-finite direction or a non-finite origin.
    pub fn new(ray: &Ray) -> Option<Self> {
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        let length = d.length();
        if !(o.is_finite() && length.is_finite() && length > 0.0) {
            return None;
        }
        let z = d / length;
        // Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
        let sign = 1f64.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        let x = DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
        let y = DVec3::new(b, sign + z.y * z.y * a, -z.y);
        let start_error = HALF_ULP * o.abs().element_sum();
        Some(Self { o, x, y, z, t_per_length: 1.0 / length, t_min: ray.t_min, start_error })
    }

    /// A position in the frame.
    pub(crate) fn project(&self, p: Point3) -> DVec3 {
        let q = p.to_f64() - self.o;
        DVec3::new(q.dot(self.x), q.dot(self.y), q.dot(self.z))
    }
    /// A direction in the frame.
    pub(crate) fn turn(&self, v: Vector3) -> DVec3 {
        let v = v.to_f64();
        DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }
    /// A direction of the frame in the world, rounded.
    pub(crate) fn turn_back(&self, v: DVec3) -> Vector3 {
        Vector3::from_f64(self.x * v.x + self.y * v.y + self.z * v.z)
    }

    /// By how much a position that [`Self::project`] returned may be off along each axis, if none of its coordinates
    /// is larger than `reach`: the roundings of projection and a few of what follows.
    pub(crate) fn own_error(reach: f64) -> f64 {
        16.0 * f64::EPSILON * reach
    }
    /// By how much the origin may be off a surface from which it was rounded to f32.
    pub(crate) fn start_error(&self) -> f64 {
        self.start_error
    }

    /// The ray parameter of a hit at distance `z`, which may be off by `error`: `None` before `t_min`, or if it may be
    /// the place where the ray starts.
    pub(crate) fn t_ahead(&self, z: f64, error: f64) -> Option<f32> {
        let t = (z * self.t_per_length) as f32;
        (z.abs() > error && t >= self.t_min && t.is_finite()).then_some(t)
    }
    /// False if nothing between the distances `near` and `far` can have a parameter in `[t_min, t_max]`.
    pub(crate) fn overlaps(&self, near: f64, far: f64, t_max: f32) -> bool {
        // Far more than the rounding of t and of both distances.
        let slack = 1e-6 * (near.abs().max(far.abs()) * self.t_per_length);
        far * self.t_per_length + slack >= f64::from(self.t_min)
            && near * self.t_per_length - slack <= f64::from(t_max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ray_is_the_z_axis_and_the_frame_is_right_handed() {
        for d in
            [[0.0, 0.0, 2.0], [0.0, 0.0, -3.0], [1.0, -2.0, 0.5], [-1e-30, 0.0, 0.0], [3e38, -3e38, 1e38]]
        {
            let ray = Ray::new(Point3::new(5.0, -1.0, 2.0), d.into());
            let frame = RayFrame::new(&ray).expect("valid ray");
            let along = frame.turn(ray.d);
            let length = ray.d.to_f64().length();
            assert!((along / length - DVec3::Z).length() < 1e-15, "{along}");
            assert!((frame.x.cross(frame.y) - frame.z).length() < 1e-15);
            let v = Vector3::new(0.25, -1.0, 3.0);
            let there_and_back = frame.turn_back(frame.turn(v));
            assert!((there_and_back - v).length() < 1e-6, "{there_and_back:?}");
        }
    }

    #[test]
    fn rays_that_can_hit_nothing_have_no_frame() {
        for d in [[0.0; 3], [f32::NAN, 1.0, 0.0], [f32::INFINITY, 0.0, 0.0]] {
            assert!(RayFrame::new(&Ray::new(Point3::ZERO, d.into())).is_none());
        }
        let nowhere = Ray::new(Point3::new(0.0, f32::NAN, 0.0), Vector3::new(1.0, 0.0, 0.0));
        assert!(RayFrame::new(&nowhere).is_none());
    }
}
