//! What it takes to learn what a ray passes closely, beside what its first hit takes:
//! `cargo run --release -p durer-accel --example near_misses`.
//!
//! One thread, rays of a pinhole camera, an enlargement as wide as a pixel of a picture 400 pixels wide.
use std::time::Instant;

use durer_accel::math::{Bounds3, Point3, Ray, Transform, Vector3};
use durer_accel::{
    Accel, AccelBuilder, BuildError, BuildOptions, GeometryId, Placement, Preset, Triangles, UserGeometry,
};

/// Rays along each side of the picture.
const SIDE: u32 = 100;
/// Distance of pixels on an image plane at distance 1.
const PIXEL: f32 = 1.0 / 400.0;
const BALLS: u32 = 10_000;

/// A number in `[0, 1)` from a counter.
fn unit(i: u32, stream: u32) -> f32 {
    let mut x = i.wrapping_mul(0x9e37_79b9) ^ stream.wrapping_mul(0x85eb_ca6b);
    for _ in 0..2 {
        x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
        x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    }
    (x >> 8) as f32 / (1 << 24) as f32
}

/// Where ball `i` is, in the cube from -1 to 1.
fn center(i: u32) -> Point3 {
    let at = |stream| 2.0 * unit(i, stream) - 1.0;
    Point3::new(at(1), at(2), at(3))
}

/// An octahedron around a point.
fn ball(mesh: &mut Triangles, center: Point3, r: f32) {
    let first = mesh.positions.len() as u32;
    for axis in 0..3 {
        for way in [-r, r] {
            let mut v = [0.0; 3];
            v[axis] = way;
            mesh.positions.push(center + Vector3::from(v));
        }
    }
    for x in [0, 1] {
        for y in [2, 3] {
            mesh.indices.extend([4, 5].map(|z| [first + x, first + y, first + z]));
        }
    }
}

/// A square with waves on it.
fn waves(rings: u32) -> Triangles {
    let mut mesh = Triangles::default();
    for i in 0..=rings {
        for j in 0..=rings {
            let (x, y) = (2.0 * i as f32 / rings as f32 - 1.0, 2.0 * j as f32 / rings as f32 - 1.0);
            let z = 0.1 * durer_accel::math::float::sin(13.0 * x) * durer_accel::math::float::sin(17.0 * y);
            mesh.positions.push(Point3::new(x, y, z));
            let k = i * (rings + 1) + j;
            if i < rings && j < rings {
                mesh.indices.extend([[k, k + 1, k + rings + 2], [k, k + rings + 2, k + rings + 1]]);
            }
        }
    }
    mesh
}

/// Long triangles, slanted alike.
fn needles(count: u32) -> Triangles {
    let mut mesh = Triangles::default();
    for i in 0..count {
        let first = mesh.positions.len() as u32;
        let (a, d) = (center(i), Vector3::new(0.2, 0.2, 0.1 * unit(i, 4)));
        mesh.positions.extend([a - d, a + d, a + Vector3::new(0.0, 0.004, 0.004)]);
        mesh.indices.push([first, first + 1, first + 2]);
    }
    mesh
}

/// Balls in the boxes.
struct Solid;

impl UserGeometry for Solid {
    fn intersect(&self, _: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<durer_accel::PrimitiveHit> {
        let t = (center(prim) - ray.o).dot(ray.d) / ray.d.length_squared();
        let near = (ray.at(t) - center(prim)).length() < 0.004 && t <= t_max;
        near.then_some(durer_accel::PrimitiveHit { t, u: 0.0, v: 0.0 })
    }
}

fn rays() -> Vec<Ray> {
    let at = |i: u32| (i as f32 + 0.5) / SIDE as f32 - 0.5;
    let ray = |i: u32| {
        Ray::new(Point3::new(0.3, 0.2, 3.0), Vector3::new(at(i % SIDE) * 0.8, at(i / SIDE) * 0.8, -1.0))
    };
    (0..SIDE * SIDE).map(ray).collect()
}

fn report(name: &str, accel: &Accel) {
    let rays = rays();
    let mut found = 0;
    accel.near_misses(&rays[0], |t| PIXEL * t, |_| {});
    let mut micros = [f64::INFINITY; 2];
    for _ in 0..3 {
        let start = Instant::now();
        let hits = rays.iter().filter(|ray| accel.query(ray).user(&Solid).closest().is_some()).count();
        let closest = start.elapsed().as_secs_f64() * 1e6 / rays.len() as f64;
        let start = Instant::now();
        found = 0;
        rays.iter().for_each(|ray| accel.near_misses(ray, |t| PIXEL * t, |_| found += 1));
        let misses = start.elapsed().as_secs_f64() * 1e6 / rays.len() as f64;
        micros = [micros[0].min(closest), micros[1].min(misses)];
        assert!(hits > 0);
    }
    let [closest, misses] = micros;
    println!(
        "{name:32} closest {closest:7.3} us, near misses {misses:8.3} us ({:5.1} found), {:6.1} times as long",
        found as f64 / rays.len() as f64,
        misses / closest
    );
}

fn build(
    options: BuildOptions,
    add: impl FnOnce(&mut AccelBuilder<'_>) -> Result<GeometryId, BuildError>,
) -> Result<Accel, BuildError> {
    let mut builder = AccelBuilder::new(options);
    let id = add(&mut builder)?;
    builder.instance(id, Placement::Identity)?;
    builder.build()
}

fn main() -> Result<(), BuildError> {
    let boxes = (0..BALLS).map(|i| {
        let r = Vector3::splat(0.004);
        Bounds3::new(center(i) - r, center(i) + r)
    });
    report("10 000 boxes", &build(BuildOptions::default(), |b| b.user(boxes.collect()))?);
    let mut mesh = Triangles::default();
    (0..BALLS).for_each(|i| ball(&mut mesh, center(i), 0.004));
    report("10 000 balls, one mesh", &build(BuildOptions::default(), |b| b.triangles(mesh))?);
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let mut one = Triangles::default();
    ball(&mut one, Point3::ZERO, 0.004);
    let id = builder.triangles(one)?;
    for i in 0..BALLS {
        builder.instance(id, Placement::Still(Transform::translate(center(i) - Point3::ZERO)))?;
    }
    report("10 000 balls, instances", &builder.build()?);
    report("870 000 triangles, a surface", &build(BuildOptions::default(), |b| b.triangles(waves(660)))?);
    let high = BuildOptions { preset: Preset::High, ..BuildOptions::default() };
    report("20 000 needles, balanced", &build(BuildOptions::default(), |b| b.triangles(needles(20_000)))?);
    report("20 000 needles, cut", &build(high, |b| b.triangles(needles(20_000)))?);
    Ok(())
}
