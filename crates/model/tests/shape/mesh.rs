//! Surfaces of triangle meshes.
use durer_core::math::{Normal3, Point2, Point3, Vector3};
use durer_model::shape::{Geometry, mesh_surface};
use durer_scene::{Data, Mesh, Params, ValueType, VertexKey};
use durer_testkit::random::Random;

use super::{build, points};

fn triangle() -> Mesh {
    Mesh {
        positions: vec![Point3::new(0.0, 0.0, 1.0), Point3::new(2.0, 0.0, 1.0), Point3::new(0.0, 3.0, 1.0)],
        indices: vec![[0, 1, 2]],
        ..Mesh::default()
    }
}

#[test]
fn the_point_is_the_weighted_sum_within_its_error() {
    let mut random = Random::new(4);
    for _ in 0..5000 {
        let scale = 10f64.powf(random.between(-4.0, 6.0));
        let mut vertex = || Point3::from_f64((random.direction() + random.direction()) * scale);
        let positions = vec![vertex(), vertex(), vertex()];
        let mesh = Mesh { positions: positions.clone(), indices: vec![[0, 1, 2]], ..Mesh::default() };
        let (a, b) = (random.unit(), random.unit());
        let (u, v) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
        let (u, v) = (u as f32, v as f32);
        let s = mesh_surface(&mesh, 0, [u, v], 0.0);
        let [p0, p1, p2] = [0, 1, 2].map(|i| positions[i].to_f64());
        let (u, v) = (f64::from(u), f64::from(v));
        let exact = p0 + (p1 - p0) * u + (p2 - p0) * v;
        assert!((s.p.to_f64() - exact).abs().cmple(s.p_error.to_f64()).all(), "{s:?}");
    }
}

#[test]
fn flat_triangles_have_the_normal_of_their_winding_and_default_uvs() {
    let s = mesh_surface(&triangle(), 0, [0.25, 0.5], 0.0);
    assert_eq!((s.n_g, s.n_s), (Normal3::new(0.0, 0.0, 1.0), Normal3::new(0.0, 0.0, 1.0)));
    assert_eq!((s.uv, s.vertex_color), (Point2::new(0.75, 0.5), [1.0; 4]));
    // p = p0 + u' (p1 - p0) + v' (p2 - p1) for the default uvs.
    assert_eq!((s.dpdu, s.dpdv), (Vector3::new(2.0, 0.0, 0.0), Vector3::new(-2.0, 3.0, 0.0)));
}

#[test]
fn vertex_normals_turn_the_geometric_normal() {
    let mesh = Mesh { normals: vec![Normal3::new(0.0, 0.6, -0.8); 3], ..triangle() };
    let s = mesh_surface(&mesh, 0, [0.25, 0.5], 0.0);
    assert_eq!(s.n_g, Normal3::new(0.0, 0.0, -1.0));
    assert!((s.n_s.length() - 1.0).abs() < 1e-6 && s.n_s.dot(s.n_g) > 0.0);
    // Normals that cancel leave the triangle flat.
    let [up, down] = [1.0, -1.0].map(|z| Normal3::new(0.0, 0.0, z));
    let mesh = Mesh { normals: vec![up, down, up], ..triangle() };
    assert_eq!(mesh_surface(&mesh, 0, [0.5, 0.0], 0.0).n_s, up);
}

#[test]
fn tangents_and_colors_are_interpolated() {
    let mesh = Mesh {
        normals: vec![Normal3::new(0.0, 0.0, 1.0); 3],
        tangents: vec![[0.0, 1.0, 0.0, -1.0]; 3],
        colors: vec![[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]],
        ..triangle()
    };
    let s = mesh_surface(&mesh, 0, [0.25, 0.5], 0.0);
    // w cross(n, t) = -(z x y) = x
    assert_eq!((s.dpdu, s.dpdv), (Vector3::new(0.0, 1.0, 0.0), Vector3::new(1.0, 0.0, 0.0)));
    assert_eq!(s.vertex_color, [0.25, 0.25, 0.5, 0.5]);
}

#[test]
fn degenerate_triangles_give_no_nan() {
    let same =
        Mesh { positions: vec![Point3::new(1.0, 2.0, 3.0); 3], indices: vec![[0, 1, 2]], ..Mesh::default() };
    let folded = Mesh { uvs: vec![Point2::new(0.5, 0.5); 3], ..triangle() };
    let zero_normals = Mesh { normals: vec![Normal3::ZERO; 3], tangents: vec![[0.0; 4]; 3], ..triangle() };
    for mesh in [same, folded, zero_normals] {
        let s = mesh_surface(&mesh, 0, [0.3, 0.3], 0.0);
        assert!(
            s.p.is_finite()
                && s.n_g.is_finite()
                && s.n_s.is_finite()
                && s.dpdu.is_finite()
                && s.dpdv.is_finite()
        );
        assert!((s.n_s.length() - 1.0).abs() < 1e-6 && s.dpdu.cross(s.dpdv).length() > 0.0);
    }
}

#[test]
fn meshes_are_checked() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let with = |n: usize, indices: &[i32]| {
        let (ty, data) = points(&corners[..n]);
        let params = Params::new().with("P", ty, data);
        if indices.is_empty() {
            params
        } else {
            params.with("indices", ValueType::Integer, Data::Ints(indices.to_vec()))
        }
    };
    let Ok(Geometry::Mesh(single)) = build("trianglemesh", with(3, &[])) else { panic!("one triangle") };
    assert_eq!(single.indices, [[0, 1, 2]]);
    assert!(build("trianglemesh", with(4, &[0, 1, 2, 2, 1, 3])).is_ok());
    assert!(build("trianglemesh", with(4, &[])).is_err_and(|m| m.contains("needs \"integer indices\"")));
    assert!(build("trianglemesh", with(4, &[0, 1])).is_err_and(|m| m.contains("multiple of 3")));
    assert!(build("trianglemesh", with(4, &[0, 1, 4])).is_err_and(|m| m.contains("vertex 4")));
    assert!(build("trianglemesh", with(4, &[0, 1, -1])).is_err());
    let short = with(3, &[]).with("uv", ValueType::Point2, Data::Floats(vec![0.0; 4]));
    assert!(build("trianglemesh", short).is_err_and(|m| m.contains("texture coordinates")));
}

#[test]
fn vertices_move_between_keys() {
    let at = |z: f32| points(&[[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]);
    let keyed = |keys: &[(&str, f32)]| {
        keys.iter().fold(Params::new(), |all, (name, z)| {
            let (ty, data) = at(*z);
            all.with(name, ty, data)
        })
    };
    let times = |t: &[f32]| (ValueType::Float, Data::Floats(t.to_vec()));
    let mesh_of = |params: Params| match build("trianglemesh", params) {
        Ok(Geometry::Mesh(mesh)) => mesh,
        other => panic!("a mesh: {other:?}"),
    };
    let mesh = mesh_of(keyed(&[("P", 0.0), ("P1", 2.0), ("P2", 3.0)]));
    assert_eq!((0..mesh.keys()).map(|k| mesh.key(k).0).collect::<Vec<_>>(), [0.0, 0.5, 1.0]);
    assert_eq!(mesh.corners([0, 1, 2], 0.25).map(|p| p.z), [1.0; 3]);
    assert_eq!(mesh.corners([0, 1, 2], 0.75).map(|p| p.z), [2.5; 3]);
    let (ty, data) = times(&[2.0, 6.0]);
    let mesh = mesh_of(keyed(&[("P", 0.0), ("P1", 2.0)]).with("times", ty, data));
    assert_eq!(mesh.corners([0, 1, 2], 3.0).map(|p| p.z), [0.5; 3]);
    assert!(mesh_of(keyed(&[("P", 0.0)])).is_still());
    let wrong = |params: Params| build("trianglemesh", params).err().unwrap_or_default();
    assert!(wrong(keyed(&[("P", 0.0), ("P2", 1.0)])).contains("\"P2\" is given, but not \"P1\""));
    let moments = |t: &[f32]| {
        let (ty, data) = times(t);
        wrong(keyed(&[("P", 0.0), ("P1", 2.0)]).with("times", ty, data))
    };
    assert!(moments(&[0.0]).contains("1 moments, but there are 2"));
    assert!(moments(&[1.0, 1.0]).contains("not later"));
    let (ty, data) = points(&[[0.0; 3]; 2]);
    assert!(wrong(keyed(&[("P", 0.0)]).with("P1", ty, data)).contains("vertex key has 2 entries for 3"));
    let floats = |list: &[f32]| (ValueType::Float, Data::Floats(list.to_vec()));
    let corners = [
        ("S", ValueType::Vector3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0][..]),
        ("handedness", ValueType::Float, &[1.0, -1.0, 1.0]),
        ("uv2", ValueType::Point2, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
        ("colors", ValueType::Float, &[0.1, 0.2, 0.3, 1.0, 0.4, 0.5, 0.6, 1.0, 0.7, 0.8, 0.9, 0.5]),
    ];
    let corners = corners.into_iter().fold(keyed(&[("P", 0.0)]), |params, (name, ty, list)| {
        params.with(name, ty, Data::Floats(list.to_vec()))
    });
    let mesh = mesh_of(corners);
    assert_eq!(mesh.tangents, [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, -1.0], [0.0, 0.0, 1.0, 1.0]]);
    assert_eq!(
        mesh.second_uvs.iter().map(|uv| uv.to_array()).collect::<Vec<_>>(),
        [[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]]
    );
    assert_eq!(mesh.colors, [[0.1, 0.2, 0.3, 1.0], [0.4, 0.5, 0.6, 1.0], [0.7, 0.8, 0.9, 0.5]]);
    let still = |name: &str, (ty, data)| wrong(keyed(&[("P", 0.0)]).with(name, ty, data));
    assert!(still("colors", floats(&[1.0; 11])).contains("four numbers for each vertex"));
    assert!(still("colors", floats(&[1.0; 8])).contains("colors has 2 entries for 3"));
    assert!(still("handedness", floats(&[1.0])).contains("1 or -1 for each of the 0 vectors"));
}

#[test]
fn vertex_normals_change_evenly_with_the_keys() {
    let mesh = Mesh {
        normals: vec![Normal3::new(0.0, 0.0, 1.0); 3],
        time: 1.0,
        later: vec![
            VertexKey {
                time: 3.0,
                positions: triangle().positions,
                normals: vec![Normal3::new(1.0, 0.0, 1.0); 3],
            },
            VertexKey { time: 4.0, positions: triangle().positions, normals: Vec::new() },
        ],
        ..triangle()
    };
    mesh.validate().expect("sound");
    // Between the first keys x grows evenly to z; the last key has the normals of the first.
    for (time, x) in [(0.0, 0.0), (1.0, 0.0), (1.5, 0.25), (2.0, 0.5), (3.0, 1.0), (3.5, 0.5), (9.0, 0.0)] {
        let n = mesh_surface(&mesh, 0, [0.2, 0.3], time).n_s;
        assert!((n.x / n.z - x).abs() < 1e-6 && (n.length() - 1.0).abs() < 1e-6, "{time}: {n:?}");
    }
    let short = VertexKey { normals: vec![Normal3::ZERO; 2], ..mesh.later[0].clone() };
    assert!(Mesh { later: vec![short], ..mesh.clone() }.validate().is_err());
    assert!(Mesh { normals: Vec::new(), ..mesh }.validate().is_err());
}
