//! Invariants on inputs proptest invents and shrinks.
use durer_accel::{AccelBuilder, BuildOptions, Engine, Placement, Triangles};
use durer_core::math::{Point3, Ray};
use proptest::prelude::*;

/// Small integers make degenerate, coincident and axis-aligned things likely.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![(-3i32..=3).prop_map(|i| i as f32), -3.0f32..3.0, Just(-0.0), Just(1e-30), Just(1e6)]
}
fn triple() -> impl Strategy<Value = [f32; 3]> {
    [coordinate(), coordinate(), coordinate()]
}
fn mesh() -> impl Strategy<Value = Triangles> {
    (prop::collection::vec(triple(), 3..12), prop::collection::vec([0usize..12, 0..12, 0..12], 0..24))
        .prop_map(|(positions, indices)| {
            let n = positions.len();
            let indices = indices.into_iter().map(|t| t.map(|i| (i % n) as u32)).collect();
            Triangles { positions: positions.into_iter().map(Point3::from).collect(), indices }
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn engines_agree_and_hits_lie_on_their_triangle(mesh in mesh(), o in triple(), d in triple()) {
        let build = |engine| {
            let mut b = AccelBuilder::new(BuildOptions { engine, ..BuildOptions::default() });
            let id = b.triangles(mesh.clone()).expect("valid mesh");
            b.instance(id, Placement::Identity).expect("valid placement");
            b.build().expect("within limits")
        };
        let (tree, brute) = (build(Engine::Bvh), build(Engine::BruteForce));
        let ray = Ray::new(o.into(), d.into());
        let hit = tree.query(&ray).closest();
        prop_assert_eq!(hit, brute.query(&ray).closest());
        prop_assert_eq!(hit.is_some(), tree.query(&ray).any());
        prop_assert_eq!(hit.is_some(), brute.query(&ray).any());
        if let Some(h) = hit {
            prop_assert!(h.t > 0.0 && h.t.is_finite());
            prop_assert!(h.u >= 0.0 && h.v >= 0.0 && h.u + h.v <= 1.0 + 2e-6);
            let [a, b, c] = mesh.indices[h.prim as usize].map(|i| mesh.positions[i as usize]);
            prop_assert_eq!(h.n_g, (b - a).cross(c - a));
        }
    }

    #[test]
    fn a_nearer_end_never_creates_a_hit(mesh in mesh(), o in triple(), d in triple(), cut in 0.0f32..2.0) {
        let mut b = AccelBuilder::new(BuildOptions::default());
        let id = b.triangles(mesh).expect("valid mesh");
        b.instance(id, Placement::Identity).expect("valid placement");
        let accel = b.build().expect("within limits");
        let ray = Ray::new(o.into(), d.into());
        let closest = |ray: &Ray| accel.query(ray).closest();
        let (whole, part) = (closest(&ray), closest(&Ray { t_max: cut, ..ray }));
        prop_assert_eq!(part, whole.filter(|h| h.t <= cut));
    }
}
