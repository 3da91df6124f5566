//! Scenes of every awkward kind.
use durer_accel::{
    Accel, AccelBuilder, BuildOptions, Engine, Isa, Placement, Precision, Preset, Quads, Triangles,
    Visibility,
};
use durer_core::glam::{DAffine3, DQuat, DVec3};
use durer_core::math::{Point3, Transform, Vector3};

use crate::corpus::{Random, Shape, Shapes};

/// A geometry.
pub(crate) enum Body {
    Mesh(Triangles),
    Quads(Quads),
    Keyed { indices: Vec<[u32; 3]>, keys: Vec<(f32, Vec<Point3>)> },
    Balls(Vec<Shape>),
}

impl Body {
    /// Triangles or balls; a quad is two.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.indices.len(),
            Self::Quads(mesh) => 2 * mesh.indices.len(),
            Self::Keyed { indices, .. } => indices.len(),
            Self::Balls(balls) => balls.len(),
        }
    }
}

/// An instance.
#[derive(Debug)]
pub(crate) struct Placed {
    pub(crate) body: usize,
    pub(crate) placement: Placement,
    pub(crate) seen: Visibility,
}

/// Everything, before an engine is chosen.
#[derive(Default)]
pub(crate) struct Scene {
    pub(crate) bodies: Vec<Body>,
    pub(crate) placed: Vec<Placed>,
}

impl Scene {
    pub(crate) fn add(&mut self, body: Body, placement: Placement) {
        self.bodies.push(body);
        self.place(self.bodies.len() - 1, placement, Visibility::default());
    }

    pub(crate) fn place(&mut self, body: usize, placement: Placement, seen: Visibility) {
        self.placed.push(Placed { body, placement, seen });
    }

    fn of(mesh: Triangles) -> Self {
        let mut scene = Self::default();
        scene.add(Body::Mesh(mesh), Placement::Identity);
        scene
    }

    pub(crate) fn shapes(&self) -> Shapes {
        let balls = |placed: &Placed| match &self.bodies[placed.body] {
            Body::Balls(balls) => balls.clone(),
            _ => Vec::new(),
        };
        Shapes(self.placed.iter().map(balls).collect())
    }

    pub(crate) fn build(&self, options: BuildOptions) -> Accel {
        let mut builder = AccelBuilder::new(options);
        let ids: Vec<_> = self
            .bodies
            .iter()
            .map(|body| match body {
                Body::Mesh(mesh) => builder.borrowed_triangles(&mesh.positions, &mesh.indices),
                Body::Quads(mesh) => builder.quads(mesh.clone()),
                Body::Keyed { indices, keys } => {
                    builder.keyed_triangles(indices, keys.iter().map(|(t, p)| (*t, p.as_slice())))
                }
                Body::Balls(balls) => builder.user(balls.iter().map(Shape::bounds).collect()),
            })
            .collect();
        for placed in &self.placed {
            let id = ids[placed.body].clone().expect("a sound geometry");
            builder.instance_seen(id, placed.placement.clone(), placed.seen).expect("a sound placement");
        }
        builder.build().expect("within limits")
    }

    pub(crate) fn brute(&self) -> Accel {
        self.build(BuildOptions { engine: Engine::BruteForce, ..BuildOptions::default() })
    }

    /// Trees of every kind for every set of instructions.
    pub(crate) fn trees(&self, presets: &[Preset], precision: Precision) -> Vec<Accel> {
        let options = |preset: Preset, isa: Isa| BuildOptions {
            preset,
            precision,
            isa: Some(isa),
            ..BuildOptions::default()
        };
        let isas = Isa::available();
        presets.iter().flat_map(|&p| isas.iter().map(move |&isa| self.build(options(p, isa)))).collect()
    }
}

fn triangle(mesh: &mut Triangles, corners: [Point3; 3]) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(corners);
    mesh.indices.push([first, first + 1, first + 2]);
}

fn mapped(mut mesh: Triangles, map: impl Fn(Point3) -> Point3) -> Triangles {
    mesh.positions.iter_mut().for_each(|p| *p = map(*p));
    mesh
}

fn soup_mesh(random: &mut Random) -> Triangles {
    let mut mesh = Triangles::default();
    for _ in 0..10 + random.below(100) {
        let (at, size) = (random.point(1.0), random.between(0.02, 0.8));
        let corners = std::array::from_fn(|_| at + random.direction() * size);
        triangle(&mut mesh, corners);
    }
    mesh
}

/// Triangles of all sizes anywhere.
pub(crate) fn soup(random: &mut Random) -> Scene {
    Scene::of(soup_mesh(random))
}

/// Triangles in planes of the axes, many in the same.
pub(crate) fn aligned(random: &mut Random) -> Scene {
    let mut mesh = Triangles::default();
    for _ in 0..80 {
        let axis = random.below(3);
        let plane = random.below(5) as f32 * 0.25;
        let corners = std::array::from_fn(|_| {
            let mut p = [0.0; 3].map(|_| random.below(9) as f32 * 0.125);
            p[axis] = plane;
            p.into()
        });
        triangle(&mut mesh, corners);
    }
    Scene::of(mesh)
}

/// One triangle over another in the same plane, in ten tilted planes close together.
pub(crate) fn stacks(random: &mut Random) -> Scene {
    let mut mesh = Triangles::default();
    let (x, y) = (random.direction(), random.direction());
    let step = random.direction() * 1e-3;
    for layer in 0..80 {
        let p = [0; 3].map(|_| {
            let (u, v) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
            Point3::ZERO + x * u + y * v + step * (layer % 10) as f32
        });
        triangle(&mut mesh, p);
    }
    Scene::of(mesh)
}

/// Up to 100000 times as long as wide.
pub(crate) fn slivers(random: &mut Random) -> Scene {
    let mut mesh = Triangles::default();
    for _ in 0..80 {
        let (at, along) = (random.point(1.0), random.direction());
        let width = [1e-2, 1e-3, 1e-4, 1e-5][random.below(4)];
        let aside = at + along * random.unit() + random.direction() * width;
        triangle(&mut mesh, [at, at + along, aside]);
    }
    Scene::of(mesh)
}

/// Long tilted beams among crumbs: worth cutting in pieces.
pub(crate) fn crossing(random: &mut Random) -> Scene {
    let mut mesh = Triangles::default();
    for index in 0..50 {
        let long = if index % 5 == 0 { 1.0 } else { 0.04 };
        let (x, at) = (random.direction() * long, random.point(1.0));
        let (y, z) = (random.direction() * 0.02, random.direction() * (0.1 * long));
        let corner = |i: u32| {
            let side = |bit: u32, v: Vector3| if i >> bit & 1 == 0 { -v } else { v };
            at + side(0, x) + side(1, y) + side(2, z)
        };
        for face in [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] {
            let [a, b, c, d] = face.map(corner);
            triangle(&mut mesh, [a, b, c]);
            triangle(&mut mesh, [a, c, d]);
        }
    }
    Scene::of(mesh)
}

/// The same again, turned round, without area, and as points.
pub(crate) fn repeated(random: &mut Random) -> Scene {
    let mut mesh = soup_mesh(random);
    for _ in 0..60 {
        let [a, b, c] = mesh.indices[random.below(mesh.indices.len())];
        mesh.indices.push(match random.below(6) {
            0 => [a, b, c],
            1 => [c, a, b],
            2 => [a, c, b],
            3 => [a, a, b],
            4 => [b; 3],
            _ => {
                let middle = Point3::ZERO
                    + (mesh.positions[a as usize] - Point3::ZERO) * 0.5
                    + (mesh.positions[b as usize] - Point3::ZERO) * 0.5;
                mesh.positions.push(middle);
                [a, mesh.positions.len() as u32 - 1, b]
            }
        });
    }
    let mut scene = Scene::default();
    scene.bodies.push(Body::Mesh(mesh));
    // Two in the same place: every hit is a tie.
    for _ in 0..2 {
        scene.place(0, Placement::Identity, Visibility::default());
    }
    scene
}

/// Boxes without thickness, at places with all their bits.
pub(crate) fn flat(random: &mut Random) -> Scene {
    let mut mesh = Triangles::default();
    for _ in 0..60 {
        let (at, axis) = (random.point(1.0), random.below(3));
        let size = random.between(0.05, 2.0);
        let corners = std::array::from_fn(|_| {
            let mut p = (at + (random.point(1.0) - Point3::ZERO) * size).to_array();
            p[axis] = at[axis];
            p.into()
        });
        triangle(&mut mesh, corners);
    }
    Scene::of(mesh)
}

/// Very small and very large.
pub(crate) fn scaled(random: &mut Random) -> Scene {
    let scale = [1e-4, 1e-2, 1e3, 1e6][random.below(4)];
    let mesh = soup_mesh(random);
    Scene::of(mapped(mesh, |p| Point3::ZERO + (p - Point3::ZERO) * scale))
}

/// Far from the origin, where coordinates are coarse.
pub(crate) fn far(random: &mut Random) -> Scene {
    let away = random.direction() * [30.0, 1e3, 1e5][random.below(3)];
    let mesh = soup_mesh(random);
    Scene::of(mapped(mesh, |p| p + away))
}

fn affine(random: &mut Random, turn: f32, scale: DVec3) -> DAffine3 {
    let axis = random.direction().to_f64().normalize();
    let turn = DQuat::from_axis_angle(axis, f64::from(turn));
    DAffine3::from_scale_rotation_translation(scale, turn, random.point(1.5).to_f64())
}

/// Scales that differ by axis; some mirror.
fn uneven(random: &mut Random) -> DVec3 {
    let mut one = || {
        let size = [0.05, 0.4, 1.0, 2.0][random.below(4)];
        if random.below(4) == 0 { -size } else { size }
    };
    DVec3::new(one(), one(), one())
}

pub(crate) fn placement(random: &mut Random) -> Placement {
    let still = |m: &DAffine3| Transform::from_f64(m);
    match random.below(4) {
        0 => Placement::Identity,
        1 => Placement::Still(Transform::translate(random.direction())),
        2 => {
            let scale = uneven(random);
            let turn = random.between(0.0, 3.0);
            Placement::Still(still(&affine(random, turn, scale)))
        }
        _ => {
            // Less than a quarter turn and the same signs: never singular between.
            let scale = uneven(random);
            let first = affine(random, 0.0, scale);
            let keys = [0.1f32, 0.35, 0.8].map(|time| {
                let turn = DAffine3::from_rotation_x(f64::from(time));
                let step = DAffine3::from_translation(random.point(0.3).to_f64());
                (time, still(&(step * turn * first)))
            });
            Placement::Moving(keys.to_vec())
        }
    }
}

fn visibility(random: &mut Random) -> Visibility {
    Visibility {
        mask: [u32::MAX, u32::MAX, 1, 2, 4, 3][random.below(6)],
        hides_backs: random.below(3) == 0,
        is_reversed: random.below(2) == 0,
        is_filtered: true,
    }
}

fn quads(random: &mut Random) -> Quads {
    let mut mesh = Quads::default();
    for _ in 0..12 {
        let (at, x, y) = (random.point(1.0), random.direction() * 0.4, random.direction() * 0.4);
        let first = mesh.positions.len() as u32;
        let bend = random.direction() * [0.0, 0.1][random.below(2)];
        mesh.positions.extend([at, at + x, at + x + y + bend, at + y]);
        mesh.indices.push([first, first + 1, first + 2, first + 3]);
    }
    mesh
}

fn keyed(random: &mut Random) -> Body {
    let mesh = soup_mesh(random);
    let drift = random.direction() * 0.5;
    let keys = [0.0f32, 0.3, 1.0].map(|time| {
        let moved = |p: &Point3| *p + drift * time + random.direction() * 0.1;
        (time, mesh.positions.iter().map(moved).collect())
    });
    Body::Keyed { indices: mesh.indices, keys: keys.to_vec() }
}

fn balls(random: &mut Random) -> Body {
    let ball = |_| Shape::Sphere { center: random.point(1.0), radius: random.between(0.02, 0.4) };
    Body::Balls((0..12).map(ball).collect())
}

/// Everything together, each body once or more often, placed in every way, seen by some rays only.
pub(crate) fn mixed(random: &mut Random) -> Scene {
    let mut scene = Scene::default();
    for _ in 0..2 + random.below(4) {
        let body = match random.below(5) {
            0 => Body::Quads(quads(random)),
            1 => keyed(random),
            2 => balls(random),
            _ => Body::Mesh(soup_mesh(random)),
        };
        scene.bodies.push(body);
        for _ in 0..1 + random.below(2) {
            let (placement, seen) = (placement(random), visibility(random));
            scene.place(scene.bodies.len() - 1, placement, seen);
        }
    }
    scene
}

/// A bumpy sheet of `side * side` cells with shared vertices, over the unit square.
pub(crate) fn sheet(random: &mut Random, side: u32, bump: f32) -> Triangles {
    let mut mesh = Triangles::default();
    for i in 0..=side {
        for j in 0..=side {
            let at = |k: u32| k as f32 / side as f32;
            mesh.positions.push(Point3::new(at(i), at(j), bump * random.unit()));
            let k = i * (side + 1) + j;
            if i < side && j < side {
                let (a, b, c, d) = (k, k + 1, k + side + 1, k + side + 2);
                let cell = if (i + j) % 2 == 0 { [[a, c, d], [a, d, b]] } else { [[a, c, b], [b, c, d]] };
                mesh.indices.extend(cell);
            }
        }
    }
    mesh
}

/// The sheet with other sides.
pub(crate) fn stretched(mesh: &Triangles, by: Vector3, shift: Vector3) -> Triangles {
    mapped(mesh.clone(), |p| Point3::new(p.x * by.x, p.y * by.y, p.z * by.z) + shift)
}

pub(crate) fn grid(random: &mut Random) -> Scene {
    let bump = [0.0, 0.3][random.below(2)];
    Scene::of(sheet(random, 8, bump))
}
