//! Scenes of many things take the time and memory that is expected of them. With `DURER_SLOW` set they are as large as
//! people trace: a million instances, 200 000 that move, 20 million triangles.
//!
//! A test of its own, for the largest size of a process says nothing where other tests run beside it.
use durer_accel::math::{Point3, Ray, Transform, Vector3};
use durer_accel::{Accel, AccelBuilder, BuildOptions, Engine, Placement, Preset, Triangles};

/// What `durer info` expects of a triangle at most: kept, and while building.
const TRIANGLE: [u64; 2] = [100, 192];
/// Of an instance: kept.
const PLACEMENT: u64 = 288;
const MOVING_PLACEMENT: u64 = 528;

fn many(few: u32, slow: u32) -> u32 {
    if std::env::var_os("DURER_SLOW").is_some() { slow } else { few }
}

/// A number in `[-1, 1)` from a counter.
fn signed(i: u32, stream: u32) -> f32 {
    let mut x = i.wrapping_mul(0x9e37_79b9) ^ stream.wrapping_mul(0x85eb_ca6b);
    for _ in 0..2 {
        x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
        x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    }
    (x >> 8) as f32 / (1 << 23) as f32 - 1.0
}

fn vector(i: u32, stream: u32) -> Vector3 {
    Vector3::new(signed(i, 3 * stream), signed(i, 3 * stream + 1), signed(i, 3 * stream + 2))
}

/// A square from -1 to 1 in `2 n` squared triangles, with bumps.
fn grid(n: u32, size: f32) -> Triangles {
    let at = |k: u32| (k as f32 / n as f32 * 2.0 - 1.0) * size;
    let vertex = |k: u32| Point3::new(at(k % (n + 1)), at(k / (n + 1)), 0.05 * size * signed(k, 0));
    let corners = |k: u32| {
        let a = k / n * (n + 1) + k % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Triangles {
        positions: (0..(n + 1) * (n + 1)).map(vertex).collect(),
        indices: (0..n * n).flat_map(corners).collect(),
    }
}

/// The largest size of the process so far; `None` where the system does not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kilobytes| kilobytes * 1024)
}

fn terrain(triangles: u32) {
    let mesh = grid((triangles as f32 / 2.0).sqrt() as u32, 1.0);
    let count = mesh.indices.len() as u64;
    for preset in [Preset::Fast, Preset::Balanced] {
        let before = peak();
        let mut builder = AccelBuilder::new(BuildOptions { preset, ..BuildOptions::default() });
        let id = builder.borrowed_triangles(&mesh.positions, &mesh.indices).expect("sound mesh");
        builder.instance(id, Placement::Identity).expect("sound placement");
        let accel = builder.build().expect("within limits");
        let kept = accel.stats().bytes;
        assert!(kept <= count * TRIANGLE[0], "{kept} bytes for {count} triangles, {preset:?}");
        if let (Some(before), Some(after)) = (before, peak()) {
            // Threads and their stacks are not counted.
            let room = count * TRIANGLE[1] + (16 << 20);
            assert!(after - before <= room, "{} bytes while building {count}, {preset:?}", after - before);
        }
        for i in 0..1000 {
            let (x, y) = (signed(i, 5) * 0.99, signed(i, 6) * 0.99);
            let ray = Ray::new(Point3::new(x, y, 1.0), Vector3::new(0.0, 0.0, -1.0));
            assert!(accel.any(&ray), "no hole at {x} {y}");
        }
    }
}

fn instances(count: u32, placement: impl Fn(u32) -> Placement, most: u64) {
    let build = |engine| {
        let mut builder = AccelBuilder::new(BuildOptions { engine, ..BuildOptions::default() });
        let id = builder.triangles(grid(10, 0.02)).expect("sound mesh");
        for i in 0..count {
            builder.instance(id, placement(i)).expect("sound placement");
        }
        builder.build().expect("within limits")
    };
    let accel = build(Engine::Bvh);
    let (kept, limit) = (accel.stats().bytes, u64::from(count) * most + (1 << 16));
    assert!(kept <= limit, "{kept} bytes for {count} instances");
    let brute = build(Engine::BruteForce);
    let ray = |i: u32| {
        let o = Point3::ZERO + vector(i, 7).normalize() * 3.0;
        Ray { time: signed(i, 9).abs(), ..Ray::new(o, Point3::ZERO + vector(i, 8) * 0.5 - o) }
    };
    let hit =
        |accel: &Accel, i: u32| accel.closest(&ray(i)).map(|hit| (hit.instance, hit.prim, hit.t.to_bits()));
    let mut hits = 0;
    for i in 0..5 {
        assert_eq!(hit(&accel, i), hit(&brute, i), "{:?}", ray(i));
    }
    for i in 0..10_000 {
        hits += u32::from(hit(&accel, i).is_some());
    }
    assert!(hits > 3000, "{hits}: the test means little");
}

#[test]
fn many_triangles_and_instances_take_what_is_expected_of_them() {
    // The largest first: the peak never falls.
    terrain(many(400_000, 20_000_000));
    let place = |i: u32, time: f32| Transform::translate(vector(i, 1) + vector(i, 2) * (0.05 * time));
    instances(many(20_000, 1_000_000), |i| Placement::Still(place(i, 0.0)), PLACEMENT);
    let moving = |i| Placement::Moving(vec![(0.0, place(i, 0.0)), (1.0, place(i, 1.0))]);
    instances(many(20_000, 200_000), moving, MOVING_PLACEMENT);
}
