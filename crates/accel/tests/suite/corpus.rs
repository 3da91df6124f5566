//! Seeded random numbers, rays and shapes shared by all tests.
use durer_accel::{PrimitiveHit, UserGeometry};
use durer_core::math::{Bounds3, Normal3, Point3, Ray, Vector3};

/// `few`, twenty times as many with `DURER_SLOW` set, a tenth but not less than 2000 with `DURER_QUICK`.
pub(crate) fn ray_count(few: usize) -> usize {
    let is_set = |name: &str| std::env::var_os(name).is_some();
    match (is_set("DURER_SLOW"), is_set("DURER_QUICK")) {
        (true, _) => few * 20,
        (_, true) => (few / 10).max(few.min(2000)),
        _ => few,
    }
}

/// splitmix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// In `[0, 1)`.
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 24) as f32
    }
    /// In `[a, b)`.
    pub(crate) fn between(&mut self, a: f32, b: f32) -> f32 {
        a + (b - a) * self.unit()
    }
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
    /// In the cube `[-r, r]^3`.
    pub(crate) fn point(&mut self, r: f32) -> Point3 {
        Point3::new(self.between(-r, r), self.between(-r, r), self.between(-r, r))
    }
    pub(crate) fn direction(&mut self) -> Vector3 {
        loop {
            let v = self.point(1.0) - Point3::ZERO;
            let l = v.length_squared();
            if l > 0.01 && l < 1.0 {
                return v.normalize();
            }
        }
    }
    /// Rays of every awkward kind towards a region of radius `r` with these landmarks in it.
    pub(crate) fn ray(&mut self, r: f32, landmarks: &[Point3]) -> Ray {
        let pick = |random: &mut Self| landmarks[random.below(landmarks.len())];
        let mut ray = match self.below(8) {
            // From a landmark, towards one, between two, through the middle of two.
            0 => Ray::new(pick(self), self.direction()),
            1 => {
                let o = self.point(r);
                Ray::new(o, pick(self) - o)
            }
            2 => {
                let o = pick(self);
                Ray::new(o, pick(self) - o)
            }
            3 => {
                let (o, a, b) = (self.point(r), pick(self), pick(self));
                Ray::new(o, Point3::ZERO + ((a - Point3::ZERO) + (b - Point3::ZERO)) * 0.5 - o)
            }
            // Along an axis, at random or through a landmark; in an axis plane.
            4 => Ray::new(self.point(r), self.axis()),
            5 => {
                let d = self.axis();
                Ray::new(pick(self) - d * 5.0, d)
            }
            6 => {
                let mut d = self.direction().to_array();
                d[self.below(3)] = if self.below(2) == 0 { 0.0 } else { -0.0 };
                Ray::new(pick(self), d.into())
            }
            _ => Ray::new(self.point(r), self.direction() * self.between(0.1, 10.0)),
        };
        match self.below(6) {
            0 => ray.t_max = self.between(0.0, r),
            1 => (ray.t_min, ray.t_max) = (self.between(0.0, r), self.between(r, 2.0 * r)),
            2 => ray.t_min = -r,
            _ => {}
        }
        ray.time = self.between(-0.2, 1.2);
        ray
    }
    fn axis(&mut self) -> Vector3 {
        let mut d = [0.0; 3];
        d[self.below(3)] = if self.below(2) == 0 { 1.0 } else { -1.0 };
        d.into()
    }
}

/// A shape that is not a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Sphere { center: Point3, radius: f32 },
    Plane { point: Point3, normal: Normal3 },
}

impl Shape {
    pub(crate) fn bounds(&self) -> Bounds3 {
        match *self {
            Self::Sphere { center, radius } => {
                let r = Vector3::splat(radius);
                Bounds3::new(center - r, center + r)
            }
            Self::Plane { .. } => Bounds3::UNBOUNDED,
        }
    }
    fn roots(&self, ray: &Ray) -> [f64; 2] {
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        match *self {
            Self::Sphere { center, radius } => {
                let m = o - center.to_f64();
                let (a, b) = (d.dot(d), m.dot(d));
                let h = (b * b - a * (m.dot(m) - f64::from(radius) * f64::from(radius))).sqrt();
                [(-b - h) / a, (-b + h) / a]
            }
            Self::Plane { point, normal } => {
                [(point.to_f64() - o).dot(normal.to_f64()) / d.dot(normal.to_f64()), f64::NAN]
            }
        }
    }
}

/// Shapes per instance; instances of triangles have none.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shapes(pub(crate) Vec<Vec<Shape>>);

impl UserGeometry for Shapes {
    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        let shape = &self.0[instance as usize][prim as usize];
        let ray = Ray { t_max, ..*ray };
        let t = shape.roots(&ray).into_iter().map(|t| t as f32).find(|t| ray.contains(*t))?;
        Some(PrimitiveHit { t, u: instance as f32, v: prim as f32 })
    }
}
