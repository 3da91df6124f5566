//! How light goes on at a particle.
use durer_core::math::{Point3, Vector3};

/// From one way to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Where, in render space.
    pub p: Point3,
    /// Unit direction that a ray came along.
    pub from: Vector3,
    /// Unit direction that it goes on along.
    pub to: Vector3,
}

impl Turn {
    /// Cosine of the deflection: 1 is straight on.
    pub fn cos(&self) -> f32 {
        self.from.dot(self.to)
    }
    /// The same way, walked from its end.
    pub fn back(&self) -> Self {
        Self { p: self.p, from: -self.to, to: -self.from }
    }
}
