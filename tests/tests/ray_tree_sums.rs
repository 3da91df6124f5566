//! Ray trees are the pixel (D1): folded from the leaves they give its sample bit for bit, their contributions sum to it,
//! and every part of them can be traced again from what its first ray holds.
use durer::{
    Options, Prepared, builtin,
    probe::{RayTree, StopReason},
};
use durer_tests::{FILES, prepared, settings, shared};

/// A row of numbers as good as random.
struct Row(u64);

impl Row {
    fn below(&mut self, n: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % u64::from(n)) as u32
    }
}

fn bits(v: [f32; 3]) -> [u32; 3] {
    v.map(f32::to_bits)
}

/// Checks one sample; how many rays its tree has.
fn check(prepared: &Prepared, pixel: [u32; 2], sample: u32) -> usize {
    let (tree, rgb) = prepared.job().record(pixel, sample);
    let what = format!("pixel {pixel:?}, sample {sample}");
    assert_eq!(bits(prepared.job().value(pixel, sample)), bits(rgb), "{what}: watching changes nothing");
    assert_eq!(bits(tree.basis.to_rgb(tree.fold())), bits(rgb), "{what}: folded");
    assert_eq!(bits(tree.basis.to_rgb(tree.nodes[0].result)), bits(rgb), "{what}: the eye ray's result");
    let mut sum = [0.0f64; 3];
    for node in &tree.nodes {
        sum.iter_mut().zip(tree.basis.to_rgb(node.contribution())).for_each(|(sum, c)| *sum += f64::from(c));
    }
    for (sum, v) in sum.iter().zip(rgb.map(f64::from)) {
        assert!((sum - v).abs() <= 1e-5 * v.max(1.0), "{what}: {sum} is not {v}");
    }
    let lost: f32 = tree.nodes.iter().map(|n| n.lost.lanes()[1]).sum();
    assert_eq!(tree.killed().lanes()[1].to_bits(), lost.to_bits());
    tree.nodes.len()
}

/// Checks so many pixels under all settings; how many that were, and the rays of all.
fn check_scene(import: impl Fn() -> durer::Imported, row: &mut Row, pixels: u32) -> (usize, usize) {
    let (mut samples, mut rays) = (0, 0);
    for options in settings() {
        let scene = prepared(import(), &options);
        let view = &scene.scene.view;
        for _ in 0..pixels {
            let pixel = [row.below(view.width), row.below(view.height)];
            rays += check(&scene, pixel, row.below(scene.settings.samples));
            samples += 1;
        }
    }
    (samples, rays)
}

#[test]
fn a_thousand_pixels_of_all_scenes_are_their_trees_d1() {
    let mut row = Row(1);
    let (mut samples, mut rays) = (0, 0);
    let mut add = |(more, traced): (usize, usize)| (samples, rays) = (samples + more, rays + traced);
    for scene in builtin::SCENES {
        add(check_scene(|| scene.import(), &mut row, 13));
    }
    if let Some(folder) = shared("a_thousand_pixels_of_all_scenes_are_their_trees_d1") {
        for file in FILES {
            let path = folder.join("assets").join(file);
            add(check_scene(|| durer::open(&path.to_string_lossy()), &mut row, 13));
        }
        assert!(samples >= 1000, "{samples}");
    }
    assert!(rays > 2 * samples, "{rays} rays in {samples} trees");
}

/// The nodes of the part below `node`, with ids from 0 and no parent above it.
fn part(tree: &RayTree, node: u32) -> RayTree {
    let mut new = vec![None; tree.nodes.len()];
    let mut part = RayTree { basis: tree.basis, ..RayTree::default() };
    for (id, old) in (0..).zip(&tree.nodes) {
        let parent = old.parent.and_then(|p| new[p as usize]);
        if id == node || parent.is_some() {
            new[id as usize] = Some(part.nodes.len() as u32);
            part.nodes.push(durer::probe::TreeNode { parent, ..old.clone() });
        }
    }
    part
}

#[test]
fn every_ray_and_all_that_follows_is_traced_again_from_what_it_holds() {
    let mut row = Row(7);
    let mut replayed = 0;
    for name in ["whitted", "cook", "beaker", "glass-plate", "penumbra", "shutter"] {
        let scene = builtin::find(name).expect("built in");
        for options in settings() {
            let scene = prepared(scene.import(), &options);
            // What samples share is kept by the job.
            let job = scene.job();
            for _ in 0..60 {
                let pixel = [row.below(scene.scene.view.width), row.below(scene.scene.view.height)];
                let (tree, _) = job.record(pixel, row.below(scene.settings.samples));
                // Of large trees not every part: that would be the square of the work.
                for id in (0..tree.nodes.len() as u32).step_by(1 + tree.nodes.len() / 50) {
                    let again = job.replay(&tree, id);
                    let node = &tree.nodes[id as usize];
                    assert_eq!(again.is_some(), node.is_traced() || node.limit.is_some());
                    let Some(again) = again else { continue };
                    assert_eq!(again.nodes, part(&tree, id).nodes, "{name}, pixel {pixel:?}, ray {id}");
                    replayed += 1;
                }
            }
        }
    }
    assert!(replayed > 1000, "{replayed}");
}

#[test]
fn the_number_of_threads_changes_no_tree() {
    let of = |threads| {
        let options = Options { threads: Some(threads), ..settings()[1].clone() };
        let scene = prepared(builtin::find("cook").expect("built in").import(), &options);
        let trees: Vec<_> = (0..40u32).map(|i| scene.job().record([i, (i * 7) % 40], i % 4).0).collect();
        (trees, scene.job().killed(&Default::default()))
    };
    let (one, many) = (of(1), of(64));
    assert_eq!(one.0, many.0);
    assert_eq!(one.1, many.1);
    assert!(one.1.shares.iter().any(|s| s[1] > 0.0) && one.1.max_radiance > 0.5);
}

#[test]
fn a_full_recorder_gives_up_what_follows_and_says_how_much() {
    let scene = prepared(builtin::find("whitted").expect("built in").import(), &settings()[0]);
    let pixels = (0..64 * 36).map(|i| [i % 64, i / 64]);
    let trees = pixels.map(|pixel| (pixel, scene.job().record(pixel, 0).0));
    let (pixel, whole) = trees.max_by_key(|(_, tree)| tree.nodes.len()).expect("pixels");
    assert!(whole.nodes.len() > 40, "{} rays", whole.nodes.len());
    let detail = durer::probe::Detail { rays: 10, ..Default::default() };
    let (some, rgb) = scene.job().record_in(pixel, 0, detail);
    let cancelled = some.nodes.iter().filter(|n| n.stop == Some(StopReason::Cancelled));
    let lost: f32 = cancelled.map(|n| n.lost.max()).sum();
    assert!(lost > 0.0 && some.nodes.len() < whole.nodes.len());
    assert_eq!(bits(some.basis.to_rgb(some.fold())), bits(rgb), "what is left is a tree all the same");
    let missing = whole.nodes[0].result.max() - some.nodes[0].result.max();
    assert!(missing <= some.killed().max() * whole.max_radiance() * 1.0001, "{missing}");
}
