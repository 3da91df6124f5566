//! A closed mesh whose every edge has two triangles.
use std::collections::HashMap;

use durer_accel::Triangles;
use durer_core::math::{Point3, Vector3};

/// A unit sphere: an icosahedron subdivided `levels` times.
pub(crate) fn icosphere(levels: u32) -> Triangles {
    let g = (1.0 + 5f32.sqrt()) / 2.0;
    let mut positions: Vec<Point3> = Vec::new();
    for (a, b) in [(1.0, g), (-1.0, g), (1.0, -g), (-1.0, -g)] {
        positions.extend([[a, b, 0.0], [0.0, a, b], [b, 0.0, a]].map(Point3::from));
    }
    let edge = |i: usize, j: usize| ((positions[i] - positions[j]).length() - 2.0).abs() < 1e-4;
    let mut indices = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if edge(i, j) && edge(j, k) && edge(i, k) {
                    indices.push([i as u32, j as u32, k as u32]);
                }
            }
        }
    }
    assert_eq!(indices.len(), 20);
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32, positions: &mut Vec<Point3>| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = (positions[a as usize] - Point3::ZERO) + (positions[b as usize] - Point3::ZERO);
                positions.push(Point3::ZERO + sum * 0.5);
                positions.len() as u32 - 1
            })
        };
        indices = indices
            .iter()
            .flat_map(|&[a, b, c]| {
                let ab = middle(a, b, &mut positions);
                let bc = middle(b, c, &mut positions);
                let ca = middle(c, a, &mut positions);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
        for p in &mut positions {
            *p = Point3::ZERO + (*p - Point3::ZERO).normalize();
        }
    }
    Triangles { positions, indices }
}

/// The mesh scaled, then shifted, in f32.
pub(crate) fn moved(mesh: &Triangles, scale: f32, shift: Vector3) -> Triangles {
    let positions =
        mesh.positions.iter().map(|p| Point3::ZERO + (*p - Point3::ZERO) * scale + shift).collect();
    Triangles { positions, indices: mesh.indices.clone() }
}
