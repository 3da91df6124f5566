//! Newtypes for positions, directions and surface normals, so that the compiler tells them apart.
use std::ops::{Add, AddAssign, Div, Index, Mul, Neg, Sub};

use glam::{DVec3, Vec3};
use serde::Serialize;

macro_rules! triple {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
        #[repr(C)]
        pub struct $name {
            /// First coordinate.
            pub x: f32,
            /// Second coordinate.
            pub y: f32,
            /// Third coordinate.
            pub z: f32,
        }

        impl $name {
            /// All coordinates zero.
            pub const ZERO: Self = Self::splat(0.0);

            /// From three coordinates.
            #[inline]
            pub const fn new(x: f32, y: f32, z: f32) -> Self {
                Self { x, y, z }
            }
            /// All coordinates equal to `v`.
            #[inline]
            pub const fn splat(v: f32) -> Self {
                Self { x: v, y: v, z: v }
            }
            /// As an array.
            #[inline]
            pub const fn to_array(self) -> [f32; 3] {
                [self.x, self.y, self.z]
            }
            /// In double precision.
            #[inline]
            pub fn to_f64(self) -> DVec3 {
                DVec3::new(self.x.into(), self.y.into(), self.z.into())
            }
            /// Rounded from double precision.
            #[inline]
            pub fn from_f64(v: DVec3) -> Self {
                Self::new(v.x as f32, v.y as f32, v.z as f32)
            }
            /// Coordinate by coordinate minimum.
            #[inline]
            pub fn min(self, o: Self) -> Self {
                Self::new(self.x.min(o.x), self.y.min(o.y), self.z.min(o.z))
            }
            /// Coordinate by coordinate maximum.
            #[inline]
            pub fn max(self, o: Self) -> Self {
                Self::new(self.x.max(o.x), self.y.max(o.y), self.z.max(o.z))
            }
            /// Coordinate by coordinate absolute value.
            #[inline]
            pub fn abs(self) -> Self {
                Self::new(self.x.abs(), self.y.abs(), self.z.abs())
            }
            /// Largest coordinate.
            #[inline]
            pub fn max_component(self) -> f32 {
                self.x.max(self.y).max(self.z)
            }
            /// False if any coordinate is infinite or NaN.
            #[inline]
            pub fn is_finite(self) -> bool {
                self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
            }
        }
        impl From<[f32; 3]> for $name {
            #[inline]
            fn from([x, y, z]: [f32; 3]) -> Self {
                Self { x, y, z }
            }
        }
        impl From<Vec3> for $name {
            #[inline]
            fn from(v: Vec3) -> Self {
                Self::new(v.x, v.y, v.z)
            }
        }
        impl Mul<f32> for $name {
            type Output = Self;
            #[inline]
            fn mul(self, s: f32) -> Self {
                Self::new(self.x * s, self.y * s, self.z * s)
            }
        }
        impl Mul<$name> for f32 {
            type Output = $name;
            #[inline]
            fn mul(self, v: $name) -> $name {
                v * self
            }
        }
        impl Div<f32> for $name {
            type Output = Self;
            #[inline]
            fn div(self, s: f32) -> Self {
                Self::new(self.x / s, self.y / s, self.z / s)
            }
        }
        impl Index<usize> for $name {
            type Output = f32;
            /// Coordinate 0, 1 or 2; any larger index is taken as 2.
            #[inline]
            fn index(&self, axis: usize) -> &f32 {
                match axis {
                    0 => &self.x,
                    1 => &self.y,
                    _ => &self.z,
                }
            }
        }
    };
}

macro_rules! linear {
    ($a:ident + $b:ident = $sum:ident) => {
        impl Add<$b> for $a {
            type Output = $sum;
            #[inline]
            fn add(self, o: $b) -> $sum {
                $sum::new(self.x + o.x, self.y + o.y, self.z + o.z)
            }
        }
    };
    ($a:ident - $b:ident = $difference:ident) => {
        impl Sub<$b> for $a {
            type Output = $difference;
            #[inline]
            fn sub(self, o: $b) -> $difference {
                $difference::new(self.x - o.x, self.y - o.y, self.z - o.z)
            }
        }
    };
}

triple!(
    /// A position.
    Point3
);
triple!(
    /// A direction or displacement; not necessarily of unit length.
    Vector3
);
triple!(
    /// A surface normal: transforms by the inverse transpose.
    Normal3
);

linear!(Point3 + Vector3 = Point3);
linear!(Vector3 + Vector3 = Vector3);
linear!(Normal3 + Normal3 = Normal3);
linear!(Point3 - Point3 = Vector3);
linear!(Point3 - Vector3 = Point3);
linear!(Vector3 - Vector3 = Vector3);
linear!(Normal3 - Normal3 = Normal3);

impl AddAssign for Vector3 {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

macro_rules! direction {
    ($name:ident) => {
        impl $name {
            /// Inner product with a direction.
            #[inline]
            pub fn dot(self, o: impl Into<Vector3>) -> f32 {
                let o = o.into();
                self.x * o.x + self.y * o.y + self.z * o.z
            }
            /// Vector product with a direction.
            #[inline]
            pub fn cross(self, o: impl Into<Vector3>) -> Vector3 {
                let o = o.into();
                Vector3::new(
                    self.y * o.z - self.z * o.y,
                    self.z * o.x - self.x * o.z,
                    self.x * o.y - self.y * o.x,
                )
            }
            /// Squared Euclidean length.
            #[inline]
            pub fn length_squared(self) -> f32 {
                self.x * self.x + self.y * self.y + self.z * self.z
            }
            /// Euclidean length.
            #[inline]
            pub fn length(self) -> f32 {
                self.length_squared().sqrt()
            }
            /// The unit vector in this direction; NaN for the zero vector.
            #[inline]
            pub fn normalize(self) -> Self {
                self / self.length()
            }
            /// `self`, turned to the side of `d` if it points away from it.
            #[inline]
            pub fn face_forward(self, d: impl Into<Vector3>) -> Self {
                if self.dot(d) < 0.0 { -self } else { self }
            }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline]
            fn neg(self) -> Self {
                Self::new(-self.x, -self.y, -self.z)
            }
        }
    };
}
direction!(Vector3);
direction!(Normal3);

impl From<Normal3> for Vector3 {
    #[inline]
    fn from(n: Normal3) -> Self {
        Self::new(n.x, n.y, n.z)
    }
}
impl From<Vector3> for Normal3 {
    #[inline]
    fn from(v: Vector3) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl Vector3 {
    /// 0, 1 or 2: the axis of the coordinate largest in magnitude; the lower axis on a tie.
    #[inline]
    pub fn max_axis(self) -> usize {
        let a = self.abs();
        if a.x >= a.y && a.x >= a.z {
            0
        } else if a.y >= a.z {
            1
        } else {
            2
        }
    }
}

/// A position in a plane: uv coordinates, film positions, random numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Point2 {
    /// First coordinate.
    pub x: f32,
    /// Second coordinate.
    pub y: f32,
}

impl Point2 {
    /// `[x, y]`.
    #[inline]
    pub const fn to_array(self) -> [f32; 2] {
        [self.x, self.y]
    }
    /// From two coordinates.
    #[inline]
    pub const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }
}
impl From<[f32; 2]> for Point2 {
    #[inline]
    fn from([x, y]: [f32; 2]) -> Self {
        Self { x, y }
    }
}
impl Add for Point2 {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y)
    }
}
impl Sub for Point2 {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y)
    }
}
impl Mul<f32> for Point2 {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        Self::new(self.x * s, self.y * s)
    }
}
