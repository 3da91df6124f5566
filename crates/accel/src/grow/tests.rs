//! What every tree must satisfy.
mod invariants;
mod meshes;
mod optimum;

use durer_core::math::{Bounds3, Point3};

use super::*;
use invariants::{check, sah_cost};
use meshes::Mesh;

const PRESETS: [Preset; 3] = [Preset::Fast, Preset::Balanced, Preset::High];

fn point(v: f32) -> Point3 {
    Point3::splat(v)
}

#[test]
fn nothing_gives_nothing() {
    for preset in PRESETS {
        let tree = grow(&Mesh::default(), 16, preset);
        assert!(tree.nodes.is_empty() && tree.children.is_empty() && tree.order.is_empty());
    }
}

#[test]
fn few_primitives_make_one_leaf() {
    for n in 1..=PACKET {
        let tree = grow(&Mesh::soup(n, 3.0), 16, Preset::Balanced);
        assert_eq!((tree.nodes.len(), tree.children_of(0).len()), (2, 1), "{n} that overlap");
    }
}

#[test]
fn promises_hold_for_all_sizes_widths_and_presets() {
    for n in [1, 2, 3, 4, 5, 8, 9, 16, 17, 33, 100, 257, 1000, 5000] {
        for (width, preset) in [8, 16].into_iter().flat_map(|w| PRESETS.map(|p| (w, p))) {
            check(&grow(&Mesh::soup(n, 0.05), width, preset), &Mesh::soup(n, 0.05), width);
            for alone in [1, 3] {
                let mesh = Mesh { alone, ..Mesh::soup(n, 0.05) };
                check(&grow(&mesh, width, preset), &mesh, width);
            }
        }
    }
}

#[test]
fn promises_hold_for_surfaces_and_rooms() {
    for mesh in [Mesh::blob(30), Mesh::rooms(500)] {
        for preset in PRESETS {
            check(&grow(&mesh, 16, preset), &mesh, 16);
        }
    }
}

#[test]
fn degenerate_input_is_halved() {
    let same = Mesh { triangles: vec![[point(1.0); 3]; 3000], alone: 0 };
    let nested = |i: usize| [point(-(i as f32)), point(i as f32), Point3::new(-(i as f32), i as f32, 0.0)];
    let nested = Mesh { triangles: (0..3000).map(nested).collect(), alone: 0 };
    let line =
        |i: usize| [Point3::new(i as f32, 0.0, 0.0), Point3::new(i as f32 + 1.0, 0.0, 0.0), Point3::ZERO];
    let line = Mesh { triangles: (0..3000).map(line).collect(), alone: 0 };
    // Centres whose distances halve again and again: SAH alone would give a level to each few.
    let towards = |i: i32| [point(2f32.powi(-i)), point(2f32.powi(-i) * 1.01), point(2f32.powi(-i) * 1.02)];
    let towards = Mesh { triangles: (-120..120).map(towards).collect(), alone: 1 };
    let shells =
        |i: i32| [point(-1.01f32.powi(i)), point(1.01f32.powi(i)), Point3::new(0.0, 1.01f32.powi(i), 0.0)];
    let shells = Mesh { triangles: (-4000..4000).map(shells).collect(), alone: 1 };
    for (mesh, preset) in
        [&same, &nested, &line, &towards, &shells].into_iter().flat_map(|m| PRESETS.map(|p| (m, p)))
    {
        check(&grow(mesh, 8, preset), mesh, 8);
    }
}

#[test]
fn the_scale_of_a_scene_does_not_matter() {
    let mesh = Mesh::rooms(300);
    let cost = sah_cost(&grow(&mesh, 16, Preset::Balanced));
    for scale in [1e-30, 1e-20, 1e20, 1e30, 2e38] {
        let scaled = mesh.clone().map(|p| p * scale);
        for preset in PRESETS {
            let tree = grow(&scaled, 16, preset);
            check(&tree, &scaled, 16);
            let near = scale == 2e38 || (sah_cost(&tree) / cost - 1.0).abs() < 0.05;
            assert!(near || preset != Preset::Balanced, "{scale}: {}, not {cost}", sah_cost(&tree));
        }
    }
}

#[test]
fn what_costs_most_to_build_costs_least_to_walk() {
    let mesh = Mesh::rooms(1000);
    let [fast, balanced, high] = PRESETS.map(|preset| sah_cost(&grow(&mesh, 16, preset)));
    assert!(high < 0.98 * balanced && balanced < 0.98 * fast, "{fast} {balanced} {high}");
    let tree = grow(&mesh, 16, Preset::High);
    assert!(tree.order.len() > mesh.len(), "some are cut");
    assert!(tree.order.len() <= mesh.len() * 5 / 4, "but not too many");
}

#[test]
fn more_work_hardly_ever_makes_a_tree_worse() {
    for mesh in
        [Mesh::blob(30), Mesh::rooms(30), Mesh::rooms(300), Mesh::soup(1000, 0.05), Mesh::soup(300, 1.0)]
    {
        let [balanced, high] = [Preset::Balanced, Preset::High].map(|p| sah_cost(&grow(&mesh, 16, p)));
        assert!(high <= balanced * 1.05, "{balanced} {high} over {} triangles", mesh.len());
    }
}

#[test]
fn threads_do_not_change_the_tree() {
    let bits = |b: &Bounds3| [b.min, b.max].map(|p| p.to_array().map(f32::to_bits));
    let grown = |mesh: &Mesh, preset, threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let tree = pool.install(|| grow(mesh, 16, preset));
        let children: Vec<_> = tree.children.iter().map(|c| (bits(&c.bounds), c.first, c.count)).collect();
        (tree.nodes, children, tree.order)
    };
    for mesh in [Mesh::blob(50), Mesh::rooms(3000)] {
        for preset in PRESETS {
            let one = grown(&mesh, preset, 1);
            for threads in [2, 3, 7] {
                assert!(grown(&mesh, preset, threads) == one, "{preset:?} with {threads} threads");
            }
        }
    }
}
