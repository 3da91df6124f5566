//! Subdivision surfaces: against limit masks worked out by hand and surfaces known in closed form.
use durer_core::math::{Normal3, Point3};
use durer_model::shape::{Geometry, loopsubdiv::subdivide};
use durer_scene::{Data, Mesh, Params, ValueType};

use super::{build, points};

const OCTAHEDRON: [[f32; 3]; 6] =
    [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
const FACES: [[u32; 3]; 8] =
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];

fn octahedron(levels: u32) -> Mesh {
    subdivide(&OCTAHEDRON.map(Point3::from), &FACES, levels)
}

/// A grid of n x n squares, each of two triangles, over the unit square, at the heights `z`.
fn grid(n: u32, z: impl Fn(f32, f32) -> f32) -> (Vec<Point3>, Vec<[u32; 3]>) {
    let at = |i: u32| i as f32 / n as f32;
    let points = (0..=n).flat_map(|j| (0..=n).map(move |i| (at(i), at(j))));
    let points = points.map(|(x, y)| Point3::new(x, y, z(x, y))).collect();
    let index = |i: u32, j: u32| j * (n + 1) + i;
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let faces = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)];
        [[a, b, d], [a, d, c]]
    });
    (points, faces.collect())
}

#[test]
fn the_limit_of_a_vertex_is_that_of_its_mask() {
    // Valence 4: beta = 3/32, gamma = 1 / (4 + 3 / (8 beta)) = 1/8; (1 - 4/8) v + 1/8 * 0 = v / 2, at every level.
    for levels in 0..4 {
        let mesh = octahedron(levels);
        let found = mesh.positions.iter().filter(|p| **p == Point3::new(0.5, 0.0, 0.0)).count();
        assert_eq!(found, 1, "level {levels}");
    }
    // Tetrahedron, valence 3: beta = 3/16, gamma = 1 / (3 + 2) = 1/5: 2/5 v + 1/5 (-v) = v / 5.
    let corners = [[1., 1., 1.], [-1., -1., 1.], [-1., 1., -1.], [1., -1., -1.]].map(Point3::from);
    let mesh = subdivide(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], 2);
    assert!(mesh.positions.iter().any(|p| (*p - Point3::new(0.2, 0.2, 0.2)).length() < 1e-7));
}

#[test]
fn levels_refine_one_and_the_same_surface() {
    // Vertices of level 2 are among those of level 4, whatever was numbered how.
    let (coarse, fine) = (octahedron(2), octahedron(4));
    for p in &coarse.positions {
        let nearest = fine.positions.iter().map(|q| (*q - *p).length()).fold(f32::MAX, f32::min);
        assert!(nearest < 1e-6, "{p:?} {nearest}");
    }
}

#[test]
fn closed_surfaces_stay_closed_and_turned_outwards() {
    for levels in 0..5 {
        let mesh = octahedron(levels);
        assert_eq!(mesh.indices.len(), 8 << (2 * levels));
        // Euler: V = 2 + E - F with E = 3 F / 2.
        assert_eq!(mesh.positions.len(), 2 + mesh.indices.len() / 2);
        assert!(mesh.validate().is_ok());
        for triangle in &mesh.indices {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].to_f64());
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
        }
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert!(
                (n.length() - 1.0).abs() < 1e-6 && n.to_f64().dot(p.to_f64().normalize()) > 0.9,
                "{p:?} {n:?}"
            );
        }
        // By symmetry the normal at a corner of the octahedron is its axis.
        let top = mesh.positions.iter().position(|p| p.x == 0.0 && p.y == 0.0 && p.z > 0.0).expect("the top");
        assert!((mesh.normals[top].to_f64() - Normal3::new(0.0, 0.0, 1.0).to_f64()).length() < 1e-6);
    }
}

#[test]
fn flat_grids_stay_flat_and_keep_their_outline() {
    let (points, faces) = grid(3, |_, _| 0.25);
    let mesh = subdivide(&points, &faces, 3);
    assert_eq!(mesh.indices.len(), 18 * 64);
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!((p.z - 0.25).abs() < 1e-7 && (n.z - 1.0).abs() < 1e-6, "{p:?} {n:?}");
        assert!((0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.y));
    }
    // Sides stay straight away from the corners, which are rounded: x = 0 is met at y = 1/2.
    assert!(mesh.positions.iter().any(|p| p.x == 0.0 && (p.y - 0.5).abs() < 1e-6));
    let corner = mesh.positions.iter().map(|p| p.x.max(0.0) + p.y).fold(f32::MAX, f32::min);
    // The cubic B-spline at a corner: 2/3 v + 1/6 (a + b) = (1/3 / 6, 1/3 / 6) of the side.
    assert!((corner - 2.0 / 18.0).abs() < 1e-6, "{corner}");
}

#[test]
fn regular_grids_are_box_splines() {
    // Three-direction quartic box splines reproduce quadratics up to a constant: inside, z = x^2 + y^2 - x y becomes
    // itself plus c. The mask 1/2 v + 1/12 ring adds 1/12 of the six second differences h^2 (1, 1, 1 twice) = h^2 / 2.
    let n = 12;
    let (points, faces) = grid(n, |x, y| x * x + y * y - x * y);
    let mesh = subdivide(&points, &faces, 2);
    let h = 1.0 / n as f32;
    let mut inside = 0;
    for (p, normal) in mesh.positions.iter().zip(&mesh.normals) {
        let margin = [p.x, p.y].iter().map(|c| c.min(1.0 - c)).fold(1.0, f32::min);
        if margin > 2.5 * h {
            inside += 1;
            let z = p.x * p.x + p.y * p.y - p.x * p.y;
            assert!((p.z - z - 0.5 * h * h).abs() < 1e-6, "{p:?} {}", (p.z - z) / h / h);
            let slope = Normal3::new(-(2.0 * p.x - p.y), -(2.0 * p.y - p.x), 1.0);
            let expected = slope.to_f64().normalize();
            assert!((normal.to_f64() - expected).length() < 1e-5, "{p:?} {normal:?} {expected:?}");
        }
    }
    assert!(inside > 500);
}

#[test]
fn what_is_no_surface_is_parted() {
    // Two triangles that touch in a vertex: each rounds its own corners.
    let points = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]].map(Point3::from);
    let mesh = subdivide(&points, &[[0, 1, 2], [0, 3, 4]], 0);
    assert_eq!(mesh.positions.len(), 6);
    // Three triangles at one edge, and one that names a vertex twice.
    let fan = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [2, 2, 3]];
    let mesh = subdivide(&points, &fan, 3);
    assert_eq!(mesh.indices.len(), 3 * 64);
    assert!(mesh.validate().is_ok() && mesh.normals.iter().all(|n| n.is_finite()));
}

#[test]
fn meshes_of_subdivision_are_checked() {
    let (ty, data) = points(&OCTAHEDRON);
    let with = |indices: &[i32], levels: i32| {
        let params = Params::new().with("P", ty, data.clone()).int("levels", levels);
        params.with("indices", ValueType::Integer, Data::Ints(indices.to_vec()))
    };
    let faces: Vec<i32> = FACES.as_flattened().iter().map(|&i| i as i32).collect();
    let Ok(Geometry::Mesh(mesh)) = build("loopsubdiv", with(&faces, 2)) else { panic!("a mesh") };
    assert_eq!(mesh.indices.len(), 128);
    assert!(build("loopsubdiv", with(&faces[1..], 1)).is_err_and(|m| m.contains("multiple of 3")));
    assert!(build("loopsubdiv", with(&[0, 1, 6], 1)).is_err_and(|m| m.contains("vertex 6")));
    let most = build("loopsubdiv", with(&faces, 12)).expect_err("134 million triangles");
    assert!(most.contains("take at most 10"), "{most}");
    assert!(build("loopsubdiv", with(&[], 1)).is_ok());
}
