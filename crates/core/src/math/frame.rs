//! Orthonormal frames: shading happens where z is the normal.
use super::{Normal3, Vector3};

/// Right-handed orthonormal basis; local z is the normal it was built from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x axis.
    pub x: Vector3,
    /// Local y axis.
    pub y: Vector3,
    /// Local z axis.
    pub z: Vector3,
}

impl Frame {
    /// Any frame around the unit normal `n` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[inline]
    pub fn from_z(n: Normal3) -> Self {
        let sign = 1.0f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            x: Vector3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            y: Vector3::new(b, sign + n.y * n.y * a, -n.y),
            z: n.into(),
        }
    }
    /// World direction to local.
    #[inline]
    pub fn to_local(&self, v: Vector3) -> Vector3 {
        Vector3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }
    /// Local direction to world.
    #[inline]
    pub fn to_world(&self, v: Vector3) -> Vector3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for i in 0..1000 {
            let a = i as f32 * 0.7;
            let z = (i as f32 / 999.0) * 2.0 - 1.0;
            let r = (1.0 - z * z).max(0.0).sqrt();
            let n = Normal3::new(r * crate::math::float::cos(a), r * crate::math::float::sin(a), z);
            let f = Frame::from_z(n);
            assert!((f.x.cross(f.y) - f.z).length() < 1e-5);
            assert!(f.x.dot(f.y).abs() < 1e-5 && f.x.dot(f.z).abs() < 1e-5);
            let v = Vector3::new(0.2, 0.5, -0.9);
            assert!((f.to_world(f.to_local(v)) - v).length() < 1e-5);
        }
    }
}
