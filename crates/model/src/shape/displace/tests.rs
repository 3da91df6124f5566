//! Areas, volumes and seams of displaced meshes.
use super::*;

/// A square of `size` around the origin, facing z, with uv from 0 to 1.
fn square(size: f32) -> Mesh {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Mesh {
        positions: corners.map(|[u, v]| Point3::new((u - 0.5) * size, (v - 0.5) * size, 0.0)).to_vec(),
        uvs: corners.map(|[u, v]| Point2::new(u, v)).to_vec(),
        indices: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// An octahedron of radius 1, with all vertices once, or three for each triangle.
fn octahedron(is_split: bool) -> Mesh {
    let axes = [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
    let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let points = axes.map(Point3::from);
    if !is_split {
        return Mesh { positions: points.to_vec(), indices: faces.to_vec(), ..Mesh::default() };
    }
    let positions: Vec<Point3> = faces.iter().flatten().map(|&i| points[i as usize]).collect();
    Mesh { positions, indices: (0..8).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(), ..Mesh::default() }
}

fn length(a: Point3, b: Point3) -> f32 {
    (a - b).length()
}

fn surface(mesh: &Mesh) -> f64 {
    mesh.indices.iter().map(|t| 0.5 * normal(&mesh.positions, t).length()).sum()
}

fn volume(mesh: &Mesh) -> f64 {
    let of = |t: &[u32; 3]| {
        let [p, q, r] = t.map(|i| mesh.positions[i as usize].to_f64());
        p.dot(q.cross(r)) / 6.0
    };
    mesh.indices.iter().map(of).sum()
}

/// Edges that only one triangle has, by places.
fn open_edges(mesh: &Mesh) -> usize {
    let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
    for t in &mesh.indices {
        for k in 0..3 {
            let [a, b] =
                [t[k], t[(k + 1) % 3]].map(|i| mesh.positions[i as usize].to_array().map(f32::to_bits));
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    edges.values().filter(|n| **n != 0).count()
}

#[test]
fn a_plane_that_is_moved_evenly_is_the_same_plane_elsewhere() {
    let fine = displaced(&square(4.0), length, 0.5, |_| 0.25).expect("displaced");
    assert!(fine.indices.len() > 128, "{}", fine.indices.len());
    assert!((surface(&fine) - 16.0).abs() < 1e-5);
    assert!(fine.positions.iter().all(|p| p.z == 0.25));
    assert!(fine.normals.iter().all(|n| *n == Normal3::new(0.0, 0.0, 1.0)));
    assert_eq!((fine.uvs.len(), fine.validate()), (fine.positions.len(), Ok(())));
    // Coordinates of textures stay where they were on the square.
    for (p, uv) in fine.positions.iter().zip(&fine.uvs) {
        assert!((uv.x - (p.x / 4.0 + 0.5)).abs() < 1e-6 && (uv.y - (p.y / 4.0 + 0.5)).abs() < 1e-6);
    }
}

#[test]
fn no_edge_stays_long_and_none_opens() {
    for edge in [3.0, 0.9, 0.31, 0.1] {
        let fine = displaced(&octahedron(false), length, edge, |_| 0.0).expect("displaced");
        let longest = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| fine.positions[i as usize]);
            length(a, b).max(length(b, c)).max(length(c, a))
        };
        assert!(fine.indices.iter().all(|t| longest(t) < edge), "{edge}");
        assert_eq!(open_edges(&fine), 0, "{edge}");
        assert!((volume(&fine) - 4.0 / 3.0).abs() < 1e-5, "{edge}");
    }
    assert_eq!(displaced(&octahedron(false), length, 3.0, |_| 0.0).expect("as it was").indices.len(), 8);
}

#[test]
fn a_sphere_grows_by_what_it_is_displaced() {
    // What pushes each vertex of the octahedron to radius 1.25, along normals that point outwards.
    let mut mesh = octahedron(false);
    mesh.normals = mesh.positions.iter().map(|p| Normal3::from(p.to_array())).collect();
    let onto = |v: &Vertex| {
        // |p + d n| = 1.25.
        let (p, n) = (v.p.to_f64(), v.n.to_f64());
        let along = p.dot(n);
        (-along + (along * along - p.length_squared() + 1.5625).sqrt()) as f32
    };
    let fine = displaced(&mesh, length, 0.05, onto).expect("displaced");
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 1.25f64.powi(3);
    assert!((volume(&fine) / exact - 1.0).abs() < 2e-3, "{} {exact}", volume(&fine));
    let sphere = 4.0 * std::f64::consts::PI * 1.5625;
    assert!((surface(&fine) / sphere - 1.0).abs() < 2e-3, "{} {sphere}", surface(&fine));
    for (p, n) in fine.positions.iter().zip(&fine.normals) {
        assert!(p.to_f64().normalize().dot(n.to_f64()) > 0.999);
    }
    // Inside out it shrinks, and its outside stays inside.
    mesh.normals.iter_mut().for_each(|n| *n = -*n);
    let small = displaced(&mesh, length, 0.3, |_| 0.1).expect("displaced");
    assert!(volume(&small) < 1.0, "{}", volume(&small));
    assert!(small.positions.iter().zip(&small.normals).all(|(p, n)| p.to_f64().dot(n.to_f64()) < 0.0));
}

#[test]
fn seams_stay_closed() {
    let fine = displaced(&octahedron(true), length, 0.2, |v| 0.1 + 0.05 * v.p.x).expect("displaced");
    assert_eq!(open_edges(&fine), 0);
    let same = displaced(&octahedron(false), length, 0.2, |v| 0.1 + 0.05 * v.p.x).expect("displaced");
    assert!((volume(&fine) - volume(&same)).abs() < 1e-6);
}

#[test]
fn what_would_take_all_memory_is_refused_with_a_hint() {
    let said = displaced(&square(4.0), length, 1e-4, |_| 0.0).expect_err("too fine");
    assert!(said.contains("8388608 triangles") && said.contains("edgelength"), "{said}");
    // Edges that cannot get shorter end the same way.
    assert!(displaced(&square(1e6), length, 1e-30, |_| 0.0).is_err());
    assert!(displaced(&square(1.0), length, 0.5, |_| f32::NAN).expect_err("NaN").contains("vertex 0"));
}
