//! Scenes of a size that shows what each thing costs: `cargo run --release -p durer-accel --example scale -- MODE [COUNT]`.
//!
//! `instances`: a mesh of 200 triangles in a million places. `moving`: in 200 000, all on their way. `terrain`: a grid of 20
//! million triangles; `terrain-fast` with the preset `Fast`. `animation`: changes from frame to frame with 100 000
//! instances. `hair`: 10 000 long curves. Memory is the growth of the process's largest size so far, as Linux tells it.
use std::time::Instant;

use durer_accel::curve::{CurveBasis, CurveKind, Curves};
use durer_accel::math::{Point3, Ray, Transform, Vector3, float};
use durer_accel::{
    Accel, AccelBuilder, BuildError, BuildOptions, GeometryData, Placement, Preset, Triangles,
};

const RAYS: u32 = 1 << 18;

/// A number in `[0, 1)` from a counter.
fn unit(i: u32, stream: u32) -> f32 {
    let mut x = i.wrapping_mul(0x9e37_79b9) ^ stream.wrapping_mul(0x85eb_ca6b);
    for _ in 0..2 {
        x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
        x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    }
    (x >> 8) as f32 / (1 << 24) as f32
}

/// In the cube from -1 to 1.
fn vector(i: u32, stream: u32) -> Vector3 {
    let at = |k| 2.0 * unit(i, 3 * stream + k) - 1.0;
    Vector3::new(at(0), at(1), at(2))
}

/// A square of `2 n` squared triangles with hills on it.
fn terrain(n: u32) -> Triangles {
    let mut mesh = Triangles::default();
    mesh.positions.reserve_exact(((n + 1) * (n + 1)) as usize);
    mesh.indices.reserve_exact((2 * n * n) as usize);
    for k in 0..(n + 1) * (n + 1) {
        let (x, y) =
            ((k % (n + 1)) as f32 / n as f32 * 2.0 - 1.0, (k / (n + 1)) as f32 / n as f32 * 2.0 - 1.0);
        let z = 0.1 * float::sin(7.0 * x) * float::sin(9.0 * y) + 0.002 * float::sin(311.0 * x + 50.0 * y);
        mesh.positions.push(Point3::new(x, y, z));
    }
    for k in 0..n * n {
        let a = k / n * (n + 1) + k % n;
        mesh.indices.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
    }
    mesh
}

/// The largest size of the process so far, in bytes; 0 where the system does not tell.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()).map_or(0, |kb| kb * 1024)
}

/// Builds, and says how long it took and what it held for each of `count` things.
fn build(builder: AccelBuilder<'_>, count: u32, before: u64) -> Result<Accel, BuildError> {
    let described = peak();
    let start = Instant::now();
    let accel = builder.build()?;
    let seconds = start.elapsed().as_secs_f64();
    let each = |bytes: u64| bytes as f64 / f64::from(count);
    println!(
        "built in {seconds:.2} s; bytes for each: {:.0} described, {:.0} at most, {:.0} kept",
        each(described - before),
        each(peak() - before),
        each(accel.stats().bytes)
    );
    Ok(accel)
}

/// Rays from a ball around the scene into it, on one thread.
fn trace(accel: &Accel) {
    let ray = |i: u32| {
        let (o, aim) = (Point3::ZERO + vector(i, 1).normalize() * 3.0, Point3::ZERO + vector(i, 2));
        Ray { time: unit(i, 9), ..Ray::new(o, aim - o) }
    };
    let rays: Vec<Ray> = (0..RAYS).map(ray).collect();
    let mut best = f64::INFINITY;
    let mut hits = 0;
    for _ in 0..3 {
        let start = Instant::now();
        hits = rays.iter().filter(|ray| accel.closest(ray).is_some()).count();
        best = best.min(start.elapsed().as_secs_f64());
    }
    let rays = f64::from(RAYS);
    println!("{:.3} million rays a second, {:.0} % hit", rays / best * 1e-6, hits as f64 / rays * 100.0);
}

fn place(i: u32, time: f32) -> Transform {
    Transform::translate(vector(i, 3) + vector(i, 4) * (0.02 * time))
}

fn instances(count: u32, moving: bool) -> Result<(), BuildError> {
    let mut mesh = terrain(10);
    mesh.positions.iter_mut().for_each(|p| *p = Point3::ZERO + (*p - Point3::ZERO) * 0.005);
    let before = peak();
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let id = builder.triangles(mesh)?;
    for i in 0..count {
        let placement = match moving {
            true => Placement::Moving(vec![(0.0, place(i, 0.0)), (1.0, place(i, 1.0))]),
            false => Placement::Still(place(i, 0.0)),
        };
        builder.instance(id, placement)?;
    }
    trace(&build(builder, count, before)?);
    Ok(())
}

fn terrain_of(count: u32, preset: Preset) -> Result<(), BuildError> {
    let mesh = terrain((count as f32 / 2.0).sqrt() as u32);
    let before = peak();
    let mut builder = AccelBuilder::new(BuildOptions { preset, ..BuildOptions::default() });
    let id = builder.borrowed_triangles(&mesh.positions, &mesh.indices)?;
    builder.instance(id, Placement::Identity)?;
    trace(&build(builder, mesh.indices.len() as u32, before)?);
    Ok(())
}

/// The least time of several frames, in milliseconds.
fn frames(name: &str, mut frame: impl FnMut(u32) -> Result<(), BuildError>) -> Result<(), BuildError> {
    let mut best = f64::INFINITY;
    for step in 1..=5 {
        let start = Instant::now();
        frame(step)?;
        best = best.min(start.elapsed().as_secs_f64() * 1e3);
    }
    println!("{name:40} {best:8.3} ms");
    Ok(())
}

fn animation(count: u32) -> Result<(), BuildError> {
    let mut mesh = terrain(10);
    mesh.positions.iter_mut().for_each(|p| *p = Point3::ZERO + (*p - Point3::ZERO) * 0.01);
    let other = mesh.clone();
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let ids =
        [builder.borrowed_triangles(&other.positions, &other.indices)?, builder.triangles(mesh.clone())?];
    for i in 0..count {
        // Ten of the first, all others of the second.
        builder.instance(ids[usize::from(i >= 10)], Placement::Still(place(i, 0.0)))?;
    }
    let mut accel = build(builder, count, peak())?;
    let put = |i: u32, step: u32| (i, Placement::Still(place(i, step as f32)));
    frames("one instance is placed", |step| accel.set_placements([put(77, step)]))?;
    frames("a hundredth of all instances are placed", |step| {
        accel.set_placements((0..count).step_by(100).map(|i| put(i, step)))
    })?;
    frames("all instances are placed", |step| accel.set_placements((0..count).map(|i| put(i, step))))?;
    let mut refit = |name: &str, geometry: usize| {
        frames(name, |step| {
            mesh.positions.iter_mut().for_each(|p| p.z *= if step % 2 == 0 { 0.9 } else { 1.1 });
            let (positions, indices) = (&mesh.positions, &mesh.indices);
            accel.refit(ids[geometry], GeometryData::Triangles { positions, indices })
        })
    };
    refit("a mesh with ten instances is refitted", 0)?;
    refit("a mesh with all others is refitted", 1)?;
    trace(&accel);
    Ok(())
}

fn hair(count: u32) -> Result<(), BuildError> {
    for (kind, name) in [(CurveKind::Round, "round"), (CurveKind::Flat, "flat")] {
        let mut curves = Curves {
            kind,
            basis: CurveBasis::Bezier,
            points: Vec::new(),
            radii: Vec::new(),
            normals: Vec::new(),
            segments: (0..count).map(|i| 4 * i).collect(),
        };
        for i in 0..count {
            let n = vector(i, 1).normalize();
            let p = Point3::ZERO + n * 0.3;
            // Out, then down and aside.
            let bend = Vector3::new(0.0, 0.0, -0.5) + vector(i, 2) * 0.1;
            curves.points.extend([p, p + n * 0.3, p + n * 0.6 + bend * 0.3, p + n * 0.6 + bend]);
            curves.radii.extend([0.001, 0.001, 0.0008, 0.0002]);
        }
        let before = peak();
        let mut builder = AccelBuilder::new(BuildOptions::default());
        let id = builder.curves(curves)?;
        builder.instance(id, Placement::Identity)?;
        println!("{name}:");
        trace(&build(builder, count, before)?);
    }
    Ok(())
}

fn main() -> Result<(), BuildError> {
    let mut words = std::env::args().skip(1);
    let mode = words.next().unwrap_or_default();
    let count = words.next().and_then(|word| word.parse::<u32>().ok());
    match mode.as_str() {
        "instances" => instances(count.unwrap_or(1_000_000), false),
        "moving" => instances(count.unwrap_or(200_000), true),
        "terrain" => terrain_of(count.unwrap_or(20_000_000), Preset::Balanced),
        "terrain-fast" => terrain_of(count.unwrap_or(20_000_000), Preset::Fast),
        "animation" => animation(count.unwrap_or(100_000)),
        "hair" => hair(count.unwrap_or(10_000)),
        _ => {
            println!("instances, moving, terrain, terrain-fast, animation or hair, then how many");
            Ok(())
        }
    }
}
