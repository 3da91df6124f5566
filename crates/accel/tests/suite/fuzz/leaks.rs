//! Sheets of triangles that share edges: whatever falls on one from above is stopped, through vertices and along edges.
use durer_accel::{Accel, Placement, Precision, Preset};
use durer_core::glam::{DAffine3, DQuat, DVec3};
use durer_core::math::{Point3, Ray, Transform, Vector3};

use super::scenes::{Body, Scene, sheet, stretched};
use crate::corpus::{Random, ray_count};

const SIDE: u32 = 10;
const PRESETS: [Preset; 3] = [Preset::Fast, Preset::Balanced, Preset::High];

/// A point of the sheet's middle, in its unit square: a vertex, on an edge, anywhere; and its height.
fn aim(random: &mut Random, mesh: &[Point3]) -> Point3 {
    let corner = |random: &mut Random| {
        let mut one = || 1 + random.below(SIDE as usize - 2);
        let (i, j) = (one(), one());
        i * (SIDE as usize + 1) + j
    };
    let a = corner(random);
    let b = a + [1, SIDE as usize + 1][random.below(2)];
    let (a, b) = (mesh[a], mesh[b]);
    a + (b - a) * [0.0, 0.5, random.unit()][random.below(3)]
}

/// Rays that begin above the sheet and end below it, within its sides; in the space of `mesh`.
fn falling(random: &mut Random, mesh: &[Point3], above: f32) -> Ray {
    let p = aim(random, mesh);
    let cell = mesh[SIDE as usize + 1].x - mesh[0].x;
    // Straight down, along the edges of the sheet as seen from above, any.
    let mut side = || [-1.0, 0.0, 1.0, random.between(-1.2, 1.2)][random.below(4)];
    let (x, y) = (side(), side());
    let o = Point3::new(p.x + x * cell, p.y + y * cell, above);
    Ray::new(o, p - o)
}

fn assert_stopped(trees: &[Accel], name: &str, ray: &Ray) {
    for tree in trees {
        let hit = tree.closest(ray);
        assert!(hit.is_some(), "{name}, {:?}: {ray:?} {hit:?}", tree.isa());
        assert!(tree.any(ray), "{name}, {:?}: {ray:?}", tree.isa());
    }
}

#[test]
fn nothing_falls_through_a_sheet_at_any_scale_and_place() {
    let mut random = Random(51);
    let places = [
        (1.0, Vector3::ZERO),
        (1e-4, Vector3::ZERO),
        (1e6, Vector3::ZERO),
        (1.0, Vector3::new(500.0, -300.0, 700.0)),
        (1e3, Vector3::new(-1e5, 2e4, 1e5)),
        (1e-4, Vector3::new(0.05, -0.03, 0.01)),
    ];
    for (scale, shift) in places {
        for bump in [0.0, 0.2] {
            let flat = sheet(&mut random, SIDE, bump);
            let mesh = stretched(&flat, Vector3::new(scale, scale, scale), shift);
            let points = mesh.positions.clone();
            let mut scene = Scene::default();
            scene.add(Body::Mesh(mesh), Placement::Identity);
            let trees = scene.trees(&PRESETS, Precision::Robust);
            let above = shift.z + scale * if bump == 0.0 { 1.0 } else { 0.5 };
            for _ in 0..ray_count(2000) {
                let ray = falling(&mut random, &points, above);
                assert_stopped(&trees, &format!("scale {scale}, shift {shift:?}, bump {bump}"), &ray);
            }
        }
    }
}

#[test]
fn nothing_falls_through_a_sheet_that_is_placed_or_moves() {
    let mut random = Random(52);
    for round in 0..8 {
        let (first, second) = (sheet(&mut random, SIDE, 0.2), sheet(&mut random, SIDE, 0.2));
        let turn = DQuat::from_axis_angle(random.direction().to_f64().normalize(), 1.0);
        let scale = DVec3::new(2.0, [-0.5, 0.5][round % 2], 0.7);
        let map = DAffine3::from_scale_rotation_translation(scale, turn, random.point(5.0).to_f64());
        let further = DAffine3::from_translation(DVec3::new(0.5, -0.2, 0.1)) * map;
        let (start, end) = (Transform::from_f64(&map), Transform::from_f64(&further));
        let placement = match round % 4 {
            0 | 1 => Placement::Still(start),
            _ => Placement::Moving(vec![(0.0, start), (1.0, end)]),
        };
        let mut scene = Scene::default();
        let body = match round < 4 {
            true => Body::Mesh(first.clone()),
            false => Body::Keyed {
                indices: first.indices.clone(),
                keys: vec![(0.0, first.positions.clone()), (1.0, second.positions.clone())],
            },
        };
        scene.add(body, placement.clone());
        // Once more out of the way: the mesh has a tree of its own.
        let away = Transform::translate(Vector3::new(100.0, 0.0, 0.0));
        scene.place(0, Placement::Still(away), durer_accel::Visibility::default());
        let trees = scene.trees(&PRESETS, Precision::Robust);
        for _ in 0..ray_count(1000) {
            let time = random.unit();
            let local = falling(&mut random, &first.positions, 0.5);
            let there = trees[0].instance_transform(0, time);
            let (o, p) = (there.point(local.o), there.point(local.o + local.d * 1.2));
            let ray = Ray { time, ..Ray::new(o, p - o) };
            assert_stopped(&trees, &format!("round {round}"), &ray);
        }
    }
}
