//! Rays per second on one thread: `cargo run --release -p durer-accel --example throughput`.
//!
//! The scene is a bumpy sphere of 2 million triangles seen from outside (`primary`), random chords from its surface
//! inwards (`diffuse`) and short shadow rays (`occlusion`). Thread time is not measured: run it on an idle machine.
use std::time::Instant;

use durer_accel::{Accel, AccelBuilder, BuildOptions, Placement, Triangles};
use durer_core::math::{Point3, Ray, Vector3, float};

const RINGS: u32 = 1000;
const RAYS: u32 = 1 << 20;

/// A number in `[0, 1)` from a counter.
fn unit(i: u32, stream: u32) -> f32 {
    let mut x = i.wrapping_mul(0x9e37_79b9) ^ stream.wrapping_mul(0x85eb_ca6b);
    for _ in 0..2 {
        x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
        x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    }
    (x >> 8) as f32 / (1 << 24) as f32
}

fn on_sphere(u: f32, v: f32) -> Vector3 {
    let (z, phi) = (1.0 - 2.0 * u, v * std::f32::consts::TAU);
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vector3::new(r * float::cos(phi), r * float::sin(phi), z)
}

fn bumpy_sphere() -> Triangles {
    let mut mesh = Triangles::default();
    for i in 0..=RINGS {
        for j in 0..=RINGS {
            let n = on_sphere(i as f32 / RINGS as f32, j as f32 / RINGS as f32);
            let bump = float::sin(40.0 * n.x) * float::sin(37.0 * n.y) * float::sin(43.0 * n.z);
            mesh.positions.push(Point3::ZERO + n * (1.0 + 0.05 * bump));
            let k = i * (RINGS + 1) + j;
            if i < RINGS && j < RINGS {
                mesh.indices.extend([[k, k + 1, k + RINGS + 2], [k, k + RINGS + 2, k + RINGS + 1]]);
            }
        }
    }
    mesh
}

fn measure(name: &str, rays: &[Ray], mut trace: impl FnMut(&Ray) -> bool) {
    let start = Instant::now();
    let hits = rays.iter().filter(|r| trace(r)).count();
    let seconds = start.elapsed().as_secs_f64();
    let (count, share) = (rays.len() as f64, hits as f64 / rays.len() as f64);
    println!("{name:<10} {:6.2} Mrays/s, {:4.1} % hit", count / seconds * 1e-6, share * 100.0);
}

fn main() {
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let mesh = bumpy_sphere();
    let start = Instant::now();
    let id = builder.triangles(mesh).expect("the mesh is finite");
    builder.instance(id, Placement::Identity).expect("the identity is invertible");
    let accel = builder.build().expect("within limits");
    println!("built in {:.2} s: {:?}", start.elapsed().as_secs_f64(), accel.stats());

    let closest = |accel: &Accel, ray: &Ray| accel.query(ray).closest();
    let side = (RAYS as f32).sqrt() as u32;
    let primary: Vec<Ray> = (0..RAYS)
        .map(|i| {
            let at = |k: u32| (k as f32 + 0.5) / side as f32 - 0.5;
            Ray::new(Point3::new(0.0, 0.0, 3.0), Vector3::new(at(i % side), at(i / side), -1.2).normalize())
        })
        .collect();
    let diffuse: Vec<Ray> = (0..RAYS)
        .map(|i| {
            let o = on_sphere(unit(i, 1), unit(i, 2)) * 0.94;
            Ray::new(Point3::ZERO + o, (on_sphere(unit(i, 3), unit(i, 4)) - o).normalize())
        })
        .collect();
    let occlusion: Vec<Ray> =
        diffuse.iter().map(|r| Ray { t_max: 0.1, ..Ray::new(r.o, r.o - Point3::ZERO) }).collect();
    measure("primary", &primary, |r| closest(&accel, r).is_some());
    measure("diffuse", &diffuse, |r| closest(&accel, r).is_some());
    measure("occlusion", &occlusion, |r| accel.query(r).any());
}
