//! Triangles and rays whose coordinates are so large or small that products of them leave the range of f32.
use durer_accel::{Accel, AccelBuilder, BuildOptions, Isa, Placement, Precision, Triangles};
use durer_core::math::{Point3, Ray, Vector3};

fn accel(corners: [[f32; 3]; 3], precision: Precision, isa: Isa) -> Accel {
    let options = BuildOptions { precision, isa: Some(isa), ..BuildOptions::default() };
    let mut builder = AccelBuilder::new(options);
    let positions = corners.map(Point3::from).to_vec();
    let id = builder.triangles(Triangles { positions, indices: vec![[0, 1, 2]] }).expect("finite");
    builder.instance(id, Placement::Identity).expect("a placement");
    builder.build().expect("a tree")
}

/// `t` of the hit, the same on all instruction sets.
fn t(corners: [[f32; 3]; 3], o: [f32; 3], d: [f32; 3], precision: Precision) -> Option<f32> {
    let ray = Ray::new(Point3::from(o), Vector3::from(d));
    let hits: Vec<_> = Isa::available()
        .iter()
        .map(|&isa| accel(corners, precision, isa).closest(&ray).map(|hit| hit.t.to_bits()))
        .collect();
    assert!(hits.windows(2).all(|pair| pair[0] == pair[1]), "{hits:?}");
    hits[0].map(f32::from_bits)
}

fn is_near(t: Option<f32>, expected: f32) -> bool {
    t.is_some_and(|t| (t - expected).abs() <= 1e-5 * expected)
}

#[test]
fn a_hit_close_to_an_edge_of_a_huge_triangle_counts() {
    let corners = [[-1e13, 0.0, 0.0], [1e13, 0.0, 0.0], [0.0, 1e13, 0.0]];
    let found = t(corners, [0.0, 1e-4, -1e13], [0.0, 0.0, 1.0], Precision::Robust);
    assert!(is_near(found, 1e13), "{found:?}");
}

#[test]
fn the_middle_of_a_triangle_is_hit_whatever_its_size() {
    for precision in [Precision::Robust, Precision::Fast] {
        for size in [2e-10, 1e-6, 1.0, 1e6, 5e9] {
            let corners = [[-size, -size, 0.0], [size, -size, 0.0], [0.0, size, 0.0]];
            let found = t(corners, [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], precision);
            assert!(is_near(found, 1.0), "{precision:?} {size} {found:?}");
        }
    }
}

#[test]
fn short_directions_and_far_vertices_hide_nothing() {
    let unit = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    for precision in [Precision::Robust, Precision::Fast] {
        let found = t(unit, [0.0, 0.0, -1.0], [0.0, 0.0, 5e-20], precision);
        assert!(is_near(found, 2e19), "{precision:?} {found:?}");
    }
    // Edge functions overflow to infinities whose difference is no number, whichever vertex comes first.
    let [a, b, c] = [[1e25, 2e25, 0.0], [-3e25, -1e25, 0.0], [3e25, -1e25, 0.0]];
    for corners in [[a, b, c], [b, c, a], [c, a, b]] {
        let found = t(corners, [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], Precision::Robust);
        assert!(is_near(found, 1.0), "{corners:?} {found:?}");
    }
}

#[test]
fn a_whole_line_meets_what_lies_behind_its_origin() {
    let unit = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    for isa in Isa::available() {
        let accel = accel(unit, Precision::Robust, isa);
        let ray = Ray::new(Point3::new(0.0, 0.0, 3.0), Vector3::new(0.0, 0.0, 1.0));
        for t_min in [-4.0, -1e20, f32::MIN, f32::NEG_INFINITY] {
            let hit = accel.closest(&Ray { t_min, ..ray });
            assert_eq!(hit.map(|hit| hit.t), Some(-3.0), "{isa:?} {t_min}");
        }
        assert!(!accel.any(&Ray { t_min: -2.0, ..ray }));
    }
}
