//! Spheres by callback, with holes by filter: `cargo run -p durer-accel --example user_geometry`.
use durer_accel::math::{Bounds3, Point3, Ray, Vector3};
use durer_accel::{AccelBuilder, BuildError, BuildOptions, Hit, Placement, PrimitiveHit, UserGeometry};

struct Sphere {
    center: Point3,
    radius: f32,
}

impl Sphere {
    fn bounds(&self) -> Bounds3 {
        let r = Vector3::splat(self.radius);
        Bounds3::new(self.center - r, self.center + r)
    }
}

/// Spheres that rays pass through above and below their equator's belt.
struct Belts(Vec<Sphere>);

impl UserGeometry for Belts {
    const FILTERS: bool = true;

    fn intersect(&self, _instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        let sphere = &self.0[prim as usize];
        let m = ray.o - sphere.center;
        let (a, b) = (ray.d.dot(ray.d), m.dot(ray.d));
        let root = (b * b - a * (m.dot(m) - sphere.radius * sphere.radius)).sqrt();
        // A ray that passes by has a root of NaN, which is in no range.
        let in_range = |t: &f32| *t >= ray.t_min && *t <= t_max;
        // Holes of a shape of one's own are best seen to here: through one the ray meets the inside of the back.
        let on_belt = |t: &f32| (ray.at(*t).y - sphere.center.y).abs() < 0.5 * sphere.radius;
        let t = [(-b - root) / a, (-b + root) / a].into_iter().filter(in_range).find(on_belt)?;
        Some(PrimitiveHit { t, u: (ray.at(t).y - sphere.center.y) / sphere.radius, v: 0.0 })
    }

    /// A slit in the middle of each belt.
    fn accepts(&self, hit: &Hit) -> bool {
        hit.u.abs() > 0.1
    }
}

fn main() -> Result<(), BuildError> {
    let spheres = (0..5).map(|i| Sphere {
        center: Point3::new(i as f32 * 2.0 - 4.0, 0.0, 0.0),
        radius: 0.5 + 0.1 * i as f32,
    });
    let belts = Belts(spheres.collect());
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let boxes = builder.user(belts.0.iter().map(Sphere::bounds).collect())?;
    builder.instance(boxes, Placement::Identity)?;
    let accel = builder.build()?;

    for row in 0..16 {
        let y = 0.75 - 0.1 * row as f32;
        let line = (0..100).map(|column| {
            let x = 0.1 * column as f32 - 5.0;
            let ray = Ray::new(Point3::new(x, y, 5.0), Vector3::new(0.0, 0.0, -1.0));
            let hit = accel.query(&ray).user(&belts).closest();
            // What the filter refuses is not asked again: through a slit one sees what is behind the sphere.
            hit.map_or(' ', |h| char::from(b"abcde"[h.prim as usize]))
        });
        println!("{}", line.collect::<String>().trim_end());
    }
    Ok(())
}
