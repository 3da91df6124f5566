//! `--find` and `--diff` at the library's door: planted fireflies, NaN, the deepest and the costliest against all trees
//! recorded; what a depth limit removes.
use std::{collections::HashSet, sync::atomic::AtomicBool};

use durer::{
    Options, Prepared, builtin,
    probe::{Detail, RayKind},
    tree::{Comparison, Find, Found, Subject, Tree},
};
use durer_tests::{prepared, render, scene};

fn find(what: Find, prepared: &Prepared) -> Option<Found> {
    what.search(prepared, &(), &AtomicBool::new(false))
}

fn whitted(options: &Options) -> Prepared {
    let options = Options { width: Some(32), samples: Some(2), ..options.clone() };
    prepared(builtin::find("whitted").expect("built in").import(), &options)
}

fn tree(prepared: &Prepared, pixel: [u32; 2]) -> Tree {
    let subject = Subject { name: "test", prepared };
    subject.tree(pixel, &subject.samples(pixel), 0, Detail::default())
}

/// A grey wall, a large bright panel on its left, and a bead that few samples of a pixel on the right meet.
const BEAD: &str = "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 8\n\
    Sampler \"stratified\" \"integer xsamples\" 4 \"integer ysamples\" 4\nPixelFilter \"box\"\n\
    Camera \"orthographic\" \"float screenwindow\" [-8 8 -4 4]\nIntegrator \"whitted\"\nWorldBegin\n\
    AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [.2 .2 .2]\n\
    Shape \"polygon\" \"point3 P\" [-9 -9 9  -9 9 9  9 9 9  9 -9 9] AttributeEnd\n\
    AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [90 90 90]\n\
    Shape \"polygon\" \"point3 P\" [-7.3 -3.1 5  -7.3 3.2 5  -2.4 3.2 5  -2.4 -3.1 5] AttributeEnd\n\
    AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [60 60 60]\n\
    Translate 3.5 1.5 5 Shape \"sphere\" \"float radius\" 0.25 AttributeEnd\n";

#[test]
fn a_firefly_is_found_beside_a_brighter_panel() {
    let bead = scene(BEAD, &Options::default());
    let found = find(Find::Firefly, &bead).expect("something");
    // The bead is in column 11, row 2: 3.5 + 8 and 4 - 1.5 pixels from the left upper corner.
    assert_eq!(found.pixel, [11, 2], "{found:?}");
    let value = bead.job().record(found.pixel, found.sample).1;
    assert!(value[0] > 50.0, "{value:?}");
    assert!(found.why.contains("luminance 60"), "{}", found.why);
}

#[test]
fn nan_is_the_one_that_a_render_reports() {
    let light = r#"LightSource "point" "rgb I" [3e38 3e38 3e38] "float scale" 1e10 "point3 from" [2 3 -3]"#;
    let head = "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 9\nLookAt 0 0 -4 0 0 0 0 1 0\n\
                Camera \"perspective\" \"float fov\" 60\nWorldBegin\n";
    let options = Options { samples: Some(4), ..Options::default() };
    let bad = scene(&format!("{head}{light}\nShape \"sphere\" \"float radius\" 1"), &options);
    let rendered = render(&bad);
    let first = rendered.first_bad.expect("a bad sample");
    let found = find(Find::Nan, &bad).expect("a bad sample");
    assert_eq!((found.pixel, found.sample), (first.pixel, first.sample));
    assert!(found.why.contains(&format!("{} samples", rendered.bad_samples)), "{}", found.why);
    assert_eq!(find(Find::Nan, &whitted(&Options::default())), None);
}

#[test]
fn deepest_and_costliest_are_those_of_all_trees_recorded() {
    let whitted = whitted(&Options::default());
    let (mut deepest, mut costliest) = (0, 0);
    for y in 0..18 {
        for x in 0..32 {
            for sample in 0..2 {
                let (tree, _) = whitted.job().record([x, y], sample);
                let bounces = tree.nodes.iter().filter(|n| n.is_traced() && n.kind != RayKind::Shadow);
                deepest = deepest.max(bounces.map(|n| n.depth).max().unwrap_or(0));
                let tests = tree.nodes.iter().map(|n| n.node_tests + n.primitive_tests).sum::<u32>();
                costliest = costliest.max(tests);
            }
        }
    }
    for (what, most, of) in
        [(Find::Deepest, deepest, "bounces"), (Find::Costliest, costliest, "tests of boxes and primitives")]
    {
        let found = find(what, &whitted).expect("something");
        assert!(found.why.starts_with(&format!("{most} {of}")), "{what:?}: {} of {most}", found.why);
    }
}

#[test]
fn threads_change_nothing_and_cancelling_ends_it() {
    let one = whitted(&Options { threads: Some(1), ..Options::default() });
    let four = whitted(&Options { threads: Some(4), ..Options::default() });
    for what in Find::ALL {
        assert_eq!(find(what, &one), find(what, &four), "{what:?}");
    }
    assert_eq!(Find::Deepest.search(&one, &(), &AtomicBool::new(true)), None);
}

/// Ids of all nodes that are deeper than `limit`, or lie below such.
fn beyond(tree: &Tree, limit: u32) -> HashSet<u32> {
    let mut ids = HashSet::new();
    for (id, node) in (0..).zip(&tree.nodes) {
        let below = node.parent.is_some_and(|p| ids.contains(&p));
        // Shadow rays are no bounces: they go where their surface goes.
        if below || node.depth > limit && node.kind != "shadow" {
            ids.insert(id);
        }
    }
    ids
}

#[test]
fn a_depth_limit_removes_exactly_the_rays_beyond_it() {
    let whole = whitted(&Options::default());
    let mut removed = 0;
    for limit in [0, 1, 2, 4] {
        let limited = whitted(&Options { max_depth: Some(limit), ..Options::default() });
        for pixel in [[18, 10], [19, 8], [12, 10], [2, 2], [16, 16]] {
            let (before, after) = (tree(&whole, pixel), tree(&limited, pixel));
            let diff = Comparison::new(&before, &after, &format!("--max-depth {limit}"), "this pixel");
            // A ray that was given up in both trees is in both: it changed its reason, if anything.
            let expected: HashSet<u32> = beyond(&before, limit)
                .into_iter()
                .filter(|&id| {
                    let node = &before.nodes[id as usize];
                    let parent_gone = node.parent.is_some_and(|p| beyond(&before, limit).contains(&p));
                    parent_gone || !node.is_untraced()
                })
                .collect();
            let found: HashSet<u32> = diff.removed.iter().copied().collect();
            assert_eq!(found, expected, "limit {limit}, pixel {pixel:?}");
            assert!(diff.added.is_empty());
            removed += found.len();
            for change in &diff.changed {
                assert_eq!(
                    before.nodes[change.before as usize].kind,
                    after.nodes[change.after as usize].kind
                );
                assert!(!change.keys.is_empty());
            }
            let [a, b] = [&before, &after].map(|t| {
                0.2126 * f64::from(t.rgb[0].0)
                    + 0.7152 * f64::from(t.rgb[1].0)
                    + 0.0722 * f64::from(t.rgb[2].0)
            });
            let relative = diff.relative.map_or(0.0, |r| f64::from(r.0));
            assert!((a * (1.0 + relative) - b).abs() < 1e-6, "{} {a} {b}", diff.summary);
            if a > b {
                assert!(
                    diff.summary.starts_with(&format!("depth limit {limit} removes ")),
                    "{}",
                    diff.summary
                );
            }
        }
    }
    assert!(removed > 50, "{removed}");
}

#[test]
fn the_same_settings_change_nothing_and_the_way_back_adds_what_was_removed() {
    let (whole, limited) =
        (whitted(&Options::default()), whitted(&Options { max_depth: Some(1), ..Options::default() }));
    let (before, after) = (tree(&whole, [18, 10]), tree(&limited, [18, 10]));
    let same = Comparison::new(&before, &before, "", "this pixel");
    assert!(same.removed.is_empty() && same.added.is_empty() && same.changed.is_empty());
    assert_eq!(same.pairs.len(), before.nodes.len());
    let there = Comparison::new(&before, &after, "", "this pixel");
    let back = Comparison::new(&after, &before, "", "this pixel");
    assert_eq!((there.removed, there.added), (back.added, back.removed));
}
