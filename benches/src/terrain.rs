//! A landscape of 4 million triangles: fractal hills with lumpy balls on them.
//!
//! Heights are sums of octaves of value noise: random numbers at the points of a grid, blended smoothly between them
//! (Perlin's fade 3 x^2 - 2 x^3). The same bits on every machine.
use std::collections::HashMap;

use durer::math::{Point3, Vector3};

use crate::{
    scene::{Mesh, Scene},
    spawn::Random,
    view::View,
};

/// Squares along an edge of the ground: 2 * 1024 * 1024 triangles.
const SQUARES: u32 = 1024;
/// Metres along an edge of the ground.
const SIZE: f32 = 100.0;
/// Balls of 20 * 4^6 triangles each.
const BALLS: u64 = 24;
/// How often an icosahedron's triangles are split in four.
const LEVEL: u32 = 6;

/// All of it in one mesh.
pub fn scene(name: &str) -> Scene {
    let mut mesh = ground();
    let ball = sphere(LEVEL);
    for seed in 0..BALLS {
        let mut random = Random::new(seed);
        let (x, z) = ((random.next() - 0.5) * 0.8 * SIZE, (random.next() - 0.5) * 0.8 * SIZE);
        let radius = 2.0 + 3.0 * random.next();
        let center = Point3::new(x, height(x, z) + 0.8 * radius, z);
        add_ball(&mut mesh, &ball, center, radius);
    }
    let view = View::looking(Point3::new(0.0, 24.0, 58.0), Point3::new(0.0, 4.0, 0.0), 60.0);
    Scene::of_mesh(name, mesh, view)
}

fn ground() -> Mesh {
    let row = SQUARES + 1;
    let at = |step: u32| (step as f32 / SQUARES as f32 - 0.5) * SIZE;
    let point = |i: u32| {
        let (x, z) = (at(i % row), at(i / row));
        Point3::new(x, height(x, z), z)
    };
    let square = |i: u32| {
        let a = i / SQUARES * row + i % SQUARES;
        [[a, a + row, a + 1], [a + 1, a + row, a + row + 1]]
    };
    Mesh {
        positions: (0..row * row).map(point).collect(),
        indices: (0..SQUARES * SQUARES).flat_map(square).collect(),
    }
}

/// Height of the ground in metres.
fn height(x: f32, z: f32) -> f32 {
    14.0 * fractal(Vector3::new(x, 0.0, z) * (4.0 / SIZE), 9) - 7.0
}

fn add_ball(mesh: &mut Mesh, ball: &Mesh, center: Point3, radius: f32) {
    let base = mesh.positions.len() as u32;
    let seed = Vector3::new(center.x, center.y, center.z);
    let place = |p: &Point3| {
        let d = *p - Point3::ZERO;
        center + d * (radius * (0.7 + 0.6 * fractal(d * 3.0 + seed, 6)))
    };
    mesh.positions.extend(ball.positions.iter().map(place));
    mesh.indices.extend(ball.indices.iter().map(|t| t.map(|vertex| vertex + base)));
}

/// An icosahedron blown up to the unit sphere.
fn sphere(level: u32) -> Mesh {
    // Corners of three golden rectangles.
    let golden = 0.5 + 1.25f32.sqrt();
    let mut positions = Vec::new();
    for axis in 0..3 {
        for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut p = [0.0; 3];
            (p[axis], p[(axis + 1) % 3]) = (a, b);
            positions.push(on_sphere(Vector3::from(p)));
        }
    }
    let mut mesh = Mesh { indices: nearest_triples(&positions), positions };
    for _ in 0..level {
        mesh = split(&mesh);
    }
    mesh
}

fn on_sphere(d: Vector3) -> Point3 {
    Point3::ZERO + d.normalize()
}

/// The faces of an icosahedron: all triples of corners that are neighbours.
fn nearest_triples(corners: &[Point3]) -> Vec<[u32; 3]> {
    // Neighbours on the unit sphere are 1.05 apart, others 1.7 and more.
    let near = |a: usize, b: usize| (corners[a] - corners[b]).length() < 1.3;
    let mut faces = Vec::new();
    for a in 0..corners.len() {
        for b in a + 1..corners.len() {
            let thirds = (b + 1..corners.len()).filter(|c| near(a, b) && near(b, *c) && near(*c, a));
            faces.extend(thirds.map(|c| [a as u32, b as u32, c as u32]));
        }
    }
    faces
}

/// Each triangle in four.
fn split(mesh: &Mesh) -> Mesh {
    let mut positions = mesh.positions.clone();
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let (a, b) = (positions[a as usize], positions[b as usize]);
            positions.push(on_sphere((a - Point3::ZERO) + (b - Point3::ZERO)));
            positions.len() as u32 - 1
        })
    };
    let mut indices = Vec::with_capacity(4 * mesh.indices.len());
    for &[a, b, c] in &mesh.indices {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        indices.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Mesh { positions, indices }
}

/// Octaves of noise, each of half the size and half the height of the one before; in [0, 1).
fn fractal(p: Vector3, octaves: u32) -> f32 {
    let (mut sum, mut weight, mut scale) = (0.0, 0.5, 1.0);
    for _ in 0..octaves {
        sum += weight * noise(p * scale);
        weight *= 0.5;
        scale *= 2.0;
    }
    sum
}

/// Random numbers of [0, 1) at the points with whole coordinates, smooth between them.
fn noise(p: Vector3) -> f32 {
    let cell = p.to_array().map(f32::floor);
    let fade = |x: f32| x * x * (3.0 - 2.0 * x);
    let [x, y, z] = [p.x - cell[0], p.y - cell[1], p.z - cell[2]].map(fade);
    let at = |dx: i32, dy: i32, dz: i32| {
        let [i, j, k] =
            [cell[0] as i32 + dx, cell[1] as i32 + dy, cell[2] as i32 + dz].map(|c| c as u32 as u64);
        Random::new(i.wrapping_mul(73_856_093) ^ j.wrapping_mul(19_349_663) ^ k.wrapping_mul(83_492_791))
            .next()
    };
    let blend = |t: f32, a: f32, b: f32| a + t * (b - a);
    let along_x = |dy: i32, dz: i32| blend(x, at(0, dy, dz), at(1, dy, dz));
    blend(z, blend(y, along_x(0, 0), along_x(1, 0)), blend(y, along_x(0, 1), along_x(1, 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_is_closed_and_round() {
        let mesh = sphere(2);
        assert_eq!((mesh.indices.len(), mesh.positions.len()), (320, 162));
        assert!(mesh.positions.iter().all(|p| ((*p - Point3::ZERO).length() - 1.0).abs() < 1e-6));
        let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
        for &[a, b, c] in &mesh.indices {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                *edges.entry((a.min(b), a.max(b))).or_default() += 1;
            }
        }
        assert!(edges.values().all(|&uses| uses == 2));
    }

    #[test]
    fn noise_is_continuous_and_varied() {
        let line: Vec<f32> = (0..400).map(|i| noise(Vector3::new(i as f32 * 0.01 - 2.0, 0.3, 7.2))).collect();
        assert!(line.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 0.02));
        let (low, high) =
            (line.iter().copied().fold(1.0, f32::min), line.iter().copied().fold(0.0, f32::max));
        assert!(low >= 0.0 && high < 1.0 && high - low > 0.2);
    }
}
