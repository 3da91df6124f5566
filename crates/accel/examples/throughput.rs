//! Rays per second on all threads: `cargo run --release -p durer-accel --example throughput [TRIANGLES [THREADS]]`.
//!
//! The scene is a bumpy sphere seen from outside (`primary`), random chords from its surface inwards (`diffuse`) and
//! short shadow rays (`occlusion`), for each preset and each set of instructions. Times are those of the clock: run it
//! on an idle machine.
use std::time::Instant;

use durer_accel::math::{Point3, Ray, Vector3, float};
use durer_accel::{Accel, AccelBuilder, BuildError, BuildOptions, Isa, Placement, Preset, Triangles};

const RAYS: u32 = 1 << 20;
/// Rays that a thread takes at a time.
const CHUNK: usize = 1 << 12;

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

fn bumpy_sphere(rings: u32) -> Triangles {
    let mut mesh = Triangles::default();
    for i in 0..=rings {
        for j in 0..=rings {
            let n = on_sphere(i as f32 / rings as f32, j as f32 / rings as f32);
            let bump = float::sin(40.0 * n.x) * float::sin(37.0 * n.y) * float::sin(43.0 * n.z);
            mesh.positions.push(Point3::ZERO + n * (1.0 + 0.05 * bump));
            let k = i * (rings + 1) + j;
            if i < rings && j < rings {
                mesh.indices.extend([[k, k + 1, k + rings + 2], [k, k + rings + 2, k + rings + 1]]);
            }
        }
    }
    mesh
}

/// Millions of rays a second, and the part of them for which `trace` is true.
fn measure(threads: usize, rays: &[Ray], trace: impl Fn(&Ray) -> bool + Sync) -> (f64, f64) {
    let start = Instant::now();
    let share = rays.len().div_ceil(threads * CHUNK) * CHUNK;
    let hits: usize = std::thread::scope(|scope| {
        let trace = &trace;
        let count = |part: &'_ [Ray]| part.iter().filter(|ray| trace(ray)).count();
        let running: Vec<_> = rays.chunks(share).map(|part| scope.spawn(move || count(part))).collect();
        running.into_iter().map(|thread| thread.join().expect("rays do not panic")).sum()
    });
    let count = rays.len() as f64;
    (count / start.elapsed().as_secs_f64() * 1e-6, hits as f64 / count)
}

/// Primary, diffuse and occlusion rays.
fn rays() -> [Vec<Ray>; 3] {
    let side = (RAYS as f32).sqrt() as u32;
    let primary = (0..RAYS).map(|i| {
        let at = |k: u32| (k as f32 + 0.5) / side as f32 - 0.5;
        Ray::new(Point3::new(0.0, 0.0, 3.0), Vector3::new(at(i % side), at(i / side), -1.2).normalize())
    });
    let diffuse = (0..RAYS).map(|i| {
        let o = on_sphere(unit(i, 1), unit(i, 2)) * 0.94;
        Ray::new(Point3::ZERO + o, (on_sphere(unit(i, 3), unit(i, 4)) - o).normalize())
    });
    let diffuse: Vec<_> = diffuse.collect();
    let occlusion = diffuse.iter().map(|r| Ray { t_max: 0.1, ..Ray::new(r.o, r.o - Point3::ZERO) });
    [primary.collect(), occlusion.collect(), diffuse]
}

fn report(accel: &Accel, threads: usize, [primary, occlusion, diffuse]: &[Vec<Ray>; 3]) {
    let results = [
        ("primary", measure(threads, primary, |ray| accel.closest(ray).is_some())),
        ("diffuse", measure(threads, diffuse, |ray| accel.closest(ray).is_some())),
        ("occlusion", measure(threads, occlusion, |ray| accel.any(ray))),
    ];
    let shown = results.map(|(name, (rate, hit))| format!("{name} {rate:7.2} ({:.0} % hit)", hit * 100.0));
    println!("    {:>8}: {} Mrays/s", accel.isa().name(), shown.join(", "));
}

fn main() -> Result<(), BuildError> {
    let mut words = std::env::args().skip(1).map_while(|word| word.parse::<usize>().ok());
    let triangles = words.next().unwrap_or(2_000_000);
    let all = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    let threads = words.next().unwrap_or(all).max(1);
    let mesh = bumpy_sphere((triangles as f32 / 2.0).sqrt() as u32);
    let rays = rays();
    println!("{} triangles, {threads} threads", mesh.indices.len());
    for preset in [Preset::Fast, Preset::Balanced, Preset::High] {
        for isa in Isa::available() {
            let options = BuildOptions { preset, isa: Some(isa), ..BuildOptions::default() };
            let start = Instant::now();
            let mut builder = AccelBuilder::new(options);
            let id = builder.borrowed_triangles(&mesh.positions, &mesh.indices)?;
            builder.instance(id, Placement::Identity)?;
            let accel = builder.build()?;
            let stats = accel.stats();
            println!(
                "{preset:?}, built in {:.2} s, {} MiB, {} nodes",
                start.elapsed().as_secs_f64(),
                stats.bytes >> 20,
                stats.nodes
            );
            report(&accel, threads, &rays);
        }
    }
    Ok(())
}
