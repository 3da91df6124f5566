//! `durer trace` and the pixels it replays.
use serde_json::Value;

use crate::run::Place;

const PIXELS: [[u32; 2]; 6] = [[0, 0], [63, 35], [37, 15], [22, 20], [40, 28], [30, 8]];

#[test]
fn the_last_line_has_the_bits_of_the_picture() {
    let place = Place::new();
    place.done("render --width 64 --height 36 --spp 1 -o x.exr");
    let exr = place.exr("x.exr");
    for [x, y] in PIXELS {
        let ran = place.done(&format!("trace --width 64 --height 36 --spp 1 --pixel {x},{y}"));
        assert_eq!(ran.pixel().map(f32::to_bits), exr.bits(["R", "G", "B"], [x, y]), "{x},{y}");
    }
}

#[test]
fn data_pictures_are_replayed_too() {
    let place = Place::new();
    let options = "--width 64 --height 36 --integrator cast --show normal";
    place.done(&format!("render {options} -o n.exr"));
    let exr = place.exr("n.exr");
    for [x, y] in PIXELS {
        let ran = place.done(&format!("trace {options} --pixel {x},{y}"));
        let bits = exr.bits(["normal.X", "normal.Y", "normal.Z"], [x, y]);
        assert_eq!(ran.pixel().map(f32::to_bits), bits, "{x},{y}");
    }
}

#[test]
fn the_samples_of_a_pixel_sum_to_the_picture() {
    let place = Place::new();
    place.done("render --width 64 --height 36 --spp 4 -o x.exr");
    let mut sum = [0.0f32; 3];
    for sample in 0..4 {
        let ran =
            place.done(&format!("trace --width 64 --height 36 --spp 4 --pixel 40,20 --sample {sample}"));
        ran.pixel().iter().zip(&mut sum).for_each(|(v, sum)| *sum += v);
    }
    assert_eq!(sum.map(|s| (s / 4.0).to_bits()), place.exr("x.exr").bits(["R", "G", "B"], [40, 20]));
}

#[test]
fn nested_samples_are_all_the_pixel_and_one_of_them_is_not() {
    let place = Place::new();
    let options = "cook --integrator distributed --width 24 --height 18 --spp 1 --sampling nested --lens-samples 3 --time-samples 2";
    place.done(&format!("render {options} -o x.exr"));
    let pixel = place.exr("x.exr").bits(["R", "G", "B"], [12, 9]);
    let all = place.done(&format!("trace {options} --pixel 12,9 --sample all"));
    assert_eq!(all.pixel().map(f32::to_bits), pixel);
    let one = place.done(&format!("trace {options} --pixel 12,9"));
    assert!(one.stdout.contains("sample 0 of 6\n"), "{}", one.stdout);
    assert_ne!(one.pixel().map(f32::to_bits), pixel);
    let help = place.done("trace --help").stdout;
    assert!(!help.contains("With --spp 1 the last line"), "{help}");
    assert!(help.contains("nested, a\npixel has --spp times --time-samples times --lens-samples"), "{help}");
}

#[test]
fn any_number_of_samples_is_traced_one_at_a_time_or_refused() {
    let place = Place::new();
    let most = "--width 64 --height 36 --spp 4294967295 --pixel 37,20";
    let ran = place.done(&format!("trace {most} --sample 4294967294"));
    assert!(ran.stdout.contains("sample 4294967294 of 4294967295"), "{}", ran.stdout);
    let ran = place.done(&format!("explain {most} --sample 7"));
    assert!(ran.stdout.starts_with("Sample 7 of 4294967295 of pixel 37,20"), "{}", ran.stdout);
    for words in [
        format!("trace {most} --sample all"),
        format!("trace {most} -o tree.page.json"),
        format!("explain {most}"),
        "trace --width 8 --height 8 --spp 4294967295 --find firefly".to_owned(),
        // Not too many samples, but too many rays.
        "trace --width 64 --height 36 --spp 65536 --pixel 37,20 --sample all".to_owned(),
    ] {
        let ran = place.run(&words);
        assert_eq!(ran.code, 2, "{words}: {}", ran.stderr);
        assert!(
            ran.stderr.contains("are not kept") && ran.stderr.contains("help: lower --spp"),
            "{}",
            ran.stderr
        );
    }
}

#[test]
fn the_brightest_sample_is_that_of_all() {
    let place = Place::new();
    let words = "trace --width 64 --height 36 --spp 16 --pixel 24,14";
    let brightest = place.done(&format!("{words} --sample brightest")).pixel();
    let light = |[r, g, b]: [f32; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let all = (0..16).map(|k| place.done(&format!("{words} --sample {k}")).pixel());
    let best = all.reduce(|best, v| if light(v) > light(best) { v } else { best }).expect("samples");
    assert_eq!(brightest, best);
}

#[test]
fn blocked_light_is_added_light_and_given_up_rays_are_shares() {
    let place = Place::new();
    let mut blocked = 0;
    for y in [20, 24, 28, 32] {
        for x in (2..64).step_by(4) {
            let ran = place.done(&format!("trace --width 64 --height 36 --spp 1 --pixel {x},{y}"));
            for line in ran.stdout.lines() {
                assert!(!line.contains("would have carried") || line.contains(" of the pixel"), "{line}");
                assert!(!line.contains(", blocked by ") || line.contains(", would have added "), "{line}");
                blocked += usize::from(line.contains(", blocked by "));
            }
        }
    }
    assert!(blocked > 3, "{blocked}");
}

#[test]
fn what_was_given_up_has_a_bound_or_a_reason_why_not() {
    let head = "LookAt 0 0 -4 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 40\nIntegrator \"whitted\" \"integer maxdepth\" 0\nWorldBegin\n\
                Material \"mirror\" \"rgb reflectance\" [.5 .5 .5]\nShape \"sphere\"\nMaterial \"diffuse\"\n\
                Shape \"polygon\" \"point3 P\" [-9 -2 -9  -9 -2 9  9 -2 9  9 -2 -9]\n";
    let place = Place::new()
        .with("sky.pbrt", &format!("{head}LightSource \"infinite\" \"rgb L\" [3 3 3]\n"))
        .with("near.pbrt", &format!("{head}LightSource \"point\" \"point3 from\" [0 -2 0]\n"));
    let words = "--width 32 --height 32 --spp 1 --pixel 16,16";
    let ran = place.done(&format!("trace sky.pbrt {words}"));
    let line =
        "given up 0.5 of the pixel: at most 1.5 of light, as nothing in the scene is brighter than 3\n";
    assert!(ran.stdout.contains(line), "{}", ran.stdout);
    let json = place.done(&format!("trace sky.pbrt {words} --json")).json();
    assert_eq!(
        (&json["brightest"], &json["missing"][0], &json["no_bound"]),
        (&3.0.into(), &1.5.into(), &Value::Null)
    );
    let ran = place.done(&format!("trace near.pbrt {words}"));
    assert!(ran.stdout.contains("no bound: light \"point 0\" grows without limit near it"), "{}", ran.stdout);
    let json = place.done(&format!("trace near.pbrt {words} --json")).json();
    assert!(json["missing"].is_null() && json["no_bound"].is_string(), "{json}");
    let ran = place.done(&format!("explain near.pbrt {words}"));
    assert!(ran.stdout.contains("has no bound: light \"point 0\""), "{}", ran.stdout);
    let json = place.done(&format!("explain sky.pbrt {words} --json")).json();
    assert_eq!(json["missing"][0], 1.5);
}

#[test]
fn the_tree_names_what_it_meets() {
    let ran = Place::new().done("trace --width 64 --height 36 --spp 1 --pixel 37,20");
    for word in [
        "eye hits glass ball, outer (outside) at",
        "\n  re",
        "shadow to sun",
        "not traced",
        "would have carried",
    ] {
        assert!(ran.stdout.contains(word), "{word} in\n{}", ran.stdout);
    }
    assert_eq!(ran.stderr, "");
}

#[test]
fn json_has_every_key_and_folds_to_the_pixel() {
    let place = Place::new();
    let words = "trace --width 64 --height 36 --spp 1 --pixel 37,20";
    let tree = place.done(&format!("{words} --json")).json();
    assert_eq!(
        (&tree["version"], &tree["pixel"], &tree["sample"]),
        (&1.into(), &vec![37, 20].into(), &0.into())
    );
    let nodes = tree["nodes"].as_array().expect("nodes");
    assert!(nodes.len() > 5);
    let keys = "id parent kind depth origin direction t point object primitive normal side uv weight throughput local \
                contribution result stop lost light blocker tests";
    for (id, node) in nodes.iter().enumerate() {
        assert_eq!(node["id"], id);
        keys.split_whitespace().for_each(|key| assert!(node.get(key).is_some(), "{key} of node {id}"));
        check_geometry(node);
    }
    assert_eq!(folded(nodes), numbers(&tree["rgb"]).map(|v| v as f32));
}

#[test]
fn every_key_is_documented() {
    let (of_trees, others) =
        (include_str!("../../../../docs/ray-tree.md"), include_str!("../../../../docs/json.md"));
    let place = Place::new();
    let words = "--width 64 --height 36 --spp 1";
    let tree = place.done(&format!("trace {words} --pixel 37,20 --json")).json();
    let stats = place.done(&format!("render {words} --stats=json")).json();
    for (page, object) in [(of_trees, &tree), (of_trees, &tree["nodes"][0]), (others, &stats)] {
        for key in object.as_object().expect("an object").keys() {
            assert!(page.contains(&format!("`{key}`")), "no page mentions {key}");
        }
    }
}

#[test]
fn a_tree_goes_to_a_file_too() {
    let place = Place::new();
    let words = "trace --width 64 --height 36 --spp 1 --pixel 37,20";
    let ran = place.done(&format!("{words} -o tree.json"));
    let file = std::fs::read_to_string(place.path("tree.json")).expect("a tree");
    assert_eq!(file, place.done(&format!("{words} --json")).stdout);
    assert!(ran.stdout.lines().last().expect("a line").starts_with("pixel "));
}

#[test]
fn pixels_and_samples_outside_are_wrong_usage() {
    let place = Place::new();
    for (words, why) in [
        ("--pixel 64,3", "outside the picture of 64 x 36"),
        ("--pixel 3,36", "outside the picture"),
        ("--pixel 3,3 --sample 2", "no sample 2"),
        ("--pixel 3", "expected X,Y"),
        ("--pixel 3,-1", "expected X,Y"),
        ("--pixel 3,3 -o tree.swg", "did you mean .svg? There are .json, .html, .svg, .dot, .glb, .csv, .md"),
        ("--pixel 3,3 -o tree", "does not say which format"),
        ("--pixel 3,3 -o a.svg -o a.svg", "named twice"),
        ("--pixel 3,3 --sample most", "all, brightest, nan"),
        ("--pixel 3,3 --find nan", "cannot be used with"),
        ("--find dullest", "firefly, nan, deepest, costliest"),
        ("--pixel 3,3 --diff --max-deep", "--max-depth"),
        ("--pixel 3,3 --diff '", "quotation mark"),
        ("--pixel 3,3 --diff=", "there is nothing in it"),
        ("", "--pixel"),
    ] {
        let ran = place.run(&format!("trace --width 64 --height 36 --spp 2 {words}"));
        assert_eq!(ran.code, 2, "{words}");
        assert!(ran.stderr.contains(why), "{words}: {}", ran.stderr);
    }
}

#[test]
fn a_bad_sample_comes_with_the_line_that_replays_it() {
    let light = r#"LightSource "point" "rgb I" [3e38 3e38 3e38] "float scale" 1e10 "point3 from" [0 3 -3]"#;
    let place = Place::new().with("bad.pbrt", &format!("{}{light}", crate::pictures::SPHERE));
    let ran = place.done("render bad.pbrt --spp 2 --seed 7");
    let line = ran.stderr.lines().find_map(|l| l.trim().strip_prefix("durer ")).expect("a line to replay");
    assert!(ran.stderr.contains("infinite or NaN") && line.contains("--seed 7"), "{}", ran.stderr);
    assert!(place.done(line).pixel().iter().any(|v| !v.is_finite()));
    assert!(place.done("render bad.pbrt --spp 2 --stats=json").json()["bad_samples"].as_u64() > Some(0));
}

fn numbers(value: &Value) -> [f64; 3] {
    std::array::from_fn(|i| value[i].as_f64().expect("a number"))
}

/// Origin and length lead to the point; directions and normals are of unit length.
fn check_geometry(node: &Value) {
    let direction = numbers(&node["direction"]);
    let length = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    assert!((length(direction) - 1.0).abs() < 1e-5, "{node}");
    if node["object"].is_string() {
        assert!((length(numbers(&node["normal"])) - 1.0).abs() < 1e-5);
        let (origin, point) = (numbers(&node["origin"]), numbers(&node["point"]));
        let t = node["t"].as_f64().expect("a length");
        let off: [f64; 3] = std::array::from_fn(|i| origin[i] + t * direction[i] - point[i]);
        assert!(length(off) < 1e-4, "{node}");
    }
}

/// Each node is its own light plus weight times result of its children, in order.
fn folded(nodes: &[Value]) -> [f32; 3] {
    let of = |node: &Value, key: &str| numbers(&node[key]).map(|v| v as f32);
    let mut sums: Vec<[f32; 3]> = nodes.iter().map(|n| of(n, "local")).collect();
    for parent in (0..nodes.len()).rev() {
        for child in nodes.iter().filter(|n| n["parent"] == parent) {
            let (weight, result) = (of(child, "weight"), sums[child["id"].as_u64().expect("an id") as usize]);
            (0..3).for_each(|i| sums[parent][i] += weight[i] * result[i]);
        }
    }
    sums[0]
}
