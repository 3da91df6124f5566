//! OBJ, PLY and STL files of any number of triangles.
use std::fmt::Write;

use super::{Case, Files, alone};

pub(crate) fn cases() -> Vec<Case> {
    vec![
        Case { name: "OBJ, triangles", suffix: "obj", size: 8000, write: |n| alone(obj(n)) },
        Case { name: "OBJ, materials and groups", suffix: "obj", size: 2000, write: obj_of_materials },
        Case { name: "PLY as text", suffix: "ply", size: 8000, write: |n| alone(ply_text(n)) },
        Case { name: "PLY as bytes", suffix: "ply", size: 8000, write: |n| alone(ply_bytes(n)) },
        Case { name: "STL as text", suffix: "stl", size: 8000, write: |n| alone(stl_text(n)) },
        Case { name: "STL as bytes", suffix: "stl", size: 8000, write: |n| alone(stl_bytes(n)) },
    ]
}

/// Hills over a square.
pub(crate) struct Grid {
    pub(crate) points: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// As many triangles as asked for, in rows of a hundred squares.
pub(crate) fn grid(triangles: usize) -> Grid {
    const ROW: u32 = 100;
    let rows = (triangles as u32).div_ceil(2 * ROW);
    let height = |x: u32, y: u32| ((x * 7 + y * 13) % 11) as f32 * 0.1;
    let points =
        (0..=rows).flat_map(|y| (0..=ROW).map(move |x| [x as f32, y as f32, height(x, y)])).collect();
    let squares = (0..rows).flat_map(|y| (0..ROW).map(move |x| y * (ROW + 1) + x));
    let halves = squares.flat_map(|a| [[a, a + 1, a + ROW + 2], [a, a + ROW + 2, a + ROW + 1]]);
    Grid { points, triangles: halves.take(triangles).collect() }
}

fn obj(n: usize) -> String {
    let Grid { points, triangles } = grid(n);
    let mut text = String::new();
    points.iter().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").expect("text"));
    for [a, b, c] in triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("text");
    }
    text
}

fn obj_of_materials(n: usize) -> Files {
    let (mut text, mut library) = ("mtllib scene.mtl\n".to_owned(), String::new());
    for i in 0..n {
        writeln!(library, "newmtl paint{i}\nKd 0.5 0.5 0.5").expect("text");
        writeln!(text, "v {i} 0 0\nv {i} 1 0\nv {i} 0 1\ng part{i}\nusemtl paint{i}\nf -3 -2 -1")
            .expect("text");
    }
    (text.into_bytes(), vec![("scene.mtl".to_owned(), library.into_bytes())])
}

fn ply_header(format: &str, grid: &Grid) -> String {
    format!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        grid.points.len(),
        grid.triangles.len()
    )
}

fn ply_text(n: usize) -> String {
    let grid = grid(n);
    let mut text = ply_header("ascii", &grid);
    grid.points.iter().for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").expect("text"));
    grid.triangles.iter().for_each(|[a, b, c]| writeln!(text, "3 {a} {b} {c}").expect("text"));
    text
}

fn ply_bytes(n: usize) -> Vec<u8> {
    let grid = grid(n);
    let mut bytes = ply_header("binary_little_endian", &grid).into_bytes();
    bytes.extend(grid.points.iter().flatten().flat_map(|v| v.to_le_bytes()));
    for triangle in &grid.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}

/// The corners of each triangle.
fn corners(n: usize) -> Vec<[[f32; 3]; 3]> {
    let Grid { points, triangles } = grid(n);
    triangles.iter().map(|t| t.map(|i| points[i as usize])).collect()
}

fn stl_text(n: usize) -> String {
    let mut text = "solid hills\n".to_owned();
    for corners in corners(n) {
        text.push_str("facet normal 0 0 1\nouter loop\n");
        corners.iter().for_each(|[x, y, z]| writeln!(text, "vertex {x} {y} {z}").expect("text"));
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid hills\n"
}

fn stl_bytes(n: usize) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((n as u32).to_le_bytes());
    for corners in corners(n) {
        bytes.extend([0.0f32, 0.0, 1.0].iter().chain(corners.iter().flatten()).flat_map(|v| v.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}
