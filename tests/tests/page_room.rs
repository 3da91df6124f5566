//! Pages are small however large their trees are: what adds most to the pixel stays, with all above it, and the page says
//! what is left out.
use std::{collections::HashMap, io::Read, sync::OnceLock};

use base64::{Engine, engine::general_purpose::STANDARD};
use durer::{
    Options, Prepared,
    probe::Detail,
    tree::{Comparison, Format, Other, Page, Subject, Surroundings, Tree, plain},
};
use durer_tests::scene;

/// Panes of glass between facing mirrors: rays double at every surface.
fn panes(max_depth: u32, samples: u32, sky: f32) -> Prepared {
    let mut text = format!(
        "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n\
         Sampler \"independent\" \"integer pixelsamples\" {samples}\nCamera \"perspective\" \"float fov\" 100\n\
         Integrator \"whitted\" \"integer maxdepth\" {max_depth} \"float mincontribution\" 0\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [{sky} {sky} {sky}]\n\
         LightSource \"point\" \"point3 from\" [0.3 0.4 0.5] \"rgb I\" [1 2 3]\n\
         Material \"dielectric\" \"float eta\" 1.5\n"
    );
    for pane in 0..6 {
        for (z, side) in [(1.0, -1), (1.2, 1)] {
            let z = z + 0.5 * f64::from(pane);
            text += &format!("Shape \"plane\" \"point3 point\" [0 0 {z}] \"vector3 normal\" [0 0 {side}]\n");
        }
    }
    text += "Material \"mirror\" \"rgb reflectance\" [0.9 0.8 0.7]\n\
         Shape \"disk\" \"float radius\" 1.5 \"float height\" 4\nShape \"disk\" \"float radius\" 1.5 \"float height\" -1\n";
    scene(&text, &Options::default())
}

fn page(prepared: &Prepared, chosen: &[u32]) -> Page {
    let subject = Subject { name: "panes", prepared };
    let detail = Detail { walks: 5, rays: 250_000, ..Detail::default() };
    subject.page([1, 2], chosen, Surroundings::Scene, detail)
}

/// The trees of the same samples under other settings, as `--diff` adds them.
fn compared(mut page: Page, other: Page) -> Page {
    for (tree, twin) in page.trees.iter_mut().zip(&other.trees) {
        tree.diff = Some(Comparison::new(tree, twin, "other", "this sample"));
    }
    let diff = page.trees[0].diff.clone().expect("compared");
    page.other = Some(Other { options: "other".to_owned(), trees: other.trees, diff });
    page
}

/// What a browser reads from the file, and how large that is.
fn read(page: &Page) -> (Page, usize) {
    unpacked(&Format::Html.write(page).expect("there is room"))
}

fn unpacked(packed: &[u8]) -> (Page, usize) {
    let bytes = STANDARD.decode(packed).expect("base64");
    let mut json = String::new();
    flate2::read::GzDecoder::new(bytes.as_slice()).read_to_string(&mut json).expect("gzip");
    (serde_json::from_str(&json).expect("a page"), packed.len())
}

fn rays(trees: &[Tree]) -> usize {
    trees.iter().map(|t| t.nodes.len()).sum()
}

/// A tree of more than 100 000 rays.
fn huge() -> &'static Page {
    static PAGE: OnceLock<Page> = OnceLock::new();
    PAGE.get_or_init(|| page(&panes(17, 1, 1.0), &[0]))
}

/// Sizes of numbers, summed.
fn size(v: [f32; 3]) -> f64 {
    v.iter().map(|v| f64::from(v.abs())).sum()
}

/// What a ray and those below it add.
fn sums(tree: &Tree) -> Vec<f64> {
    let mut sums: Vec<f64> = tree.nodes.iter().map(|n| size(plain(n.contribution))).collect();
    for id in (1..sums.len()).rev() {
        sums[tree.nodes[id].parent.expect("below the eye ray") as usize] += sums[id];
    }
    sums
}

/// A cut tree is part of the whole one, and accounts for all of it.
fn is_part_of(small: &Tree, whole: &Tree) {
    let told = small.left_out.expect("says so");
    assert_eq!(told.rays as usize + small.nodes.len(), whole.nodes.len());
    assert_eq!((small.rgb, small.killed, small.sample), (whole.rgb, whole.killed, whole.sample));
    let at: Vec<usize> = small.nodes.iter().map(|n| n.whole_id.expect("was cut") as usize).collect();
    let mut below = 0;
    for (id, node) in small.nodes.iter().enumerate() {
        let before = &whole.nodes[at[id]];
        assert_eq!((node.id, node.kind.as_str()), (id, before.kind.as_str()));
        assert_eq!(node.parent.map(|p| at[p as usize] as u32), before.parent, "all above it is there");
        below += node.left_out.map_or(0, |l| l.rays);
        let close = |a: f32, b: f32| (a - b).abs() <= 2e-5 * (1.0 + b.abs());
        assert!((0..3).all(|i| close(node.result[i].0, before.result[i].0)));
    }
    assert_eq!(below, told.rays, "every ray is told of where it is missed");
    // Its value folds from what is there and what is told.
    let children = small.children();
    for (id, node) in small.nodes.iter().enumerate() {
        for i in 0..3 {
            let own = f64::from(node.local[i].0) + f64::from(node.left_out.map_or(0.0, |l| l.result[i].0));
            let below = children[id].iter().map(|&child| &small.nodes[child]);
            let sum: f64 =
                own + below.map(|c| f64::from(c.weight[i].0) * f64::from(c.result[i].0)).sum::<f64>();
            let result = f64::from(node.result[i].0);
            assert!((sum - result).abs() <= 2e-5 * (1.0 + result.abs()), "ray {id}: {sum} {result}");
        }
    }
}

#[test]
fn of_a_huge_tree_the_rays_that_matter_stay() {
    let whole = &huge().trees[0];
    assert!(whole.nodes.len() > 100_000, "{}", whole.nodes.len());
    let (small, bytes) = read(huge());
    assert!(bytes <= Page::ROOM, "{bytes}");
    let [tree] = small.trees.as_slice() else { panic!("one tree") };
    assert!((5_000..=Page::RAYS).contains(&tree.nodes.len()), "{}", tree.nodes.len());
    is_part_of(tree, whole);
    let kept: std::collections::HashSet<u32> = tree.nodes.iter().filter_map(|n| n.whole_id).collect();
    // No ray that was left out brings more, with all below it, than one that stayed.
    let sums = sums(whole);
    let (mut least, mut most) = (f64::INFINITY, 0f64);
    for (id, &sum) in sums.iter().enumerate() {
        match kept.contains(&(id as u32)) {
            true => least = least.min(sum),
            false => most = most.max(sum),
        }
    }
    assert!(most <= least, "{most} was left out, {least} stayed");
    let missing = tree.left_out.map_or(f64::NAN, |l| size(plain(l.contribution)));
    assert!(missing < 0.05 * sums[0], "{missing} of {}", sums[0]);
}

#[test]
fn rays_go_until_the_page_fits_and_details_before_them() {
    let whole = page(&panes(12, 1, 1.0), &[0]);
    for room in [300_000, 100_000, 30_000] {
        let (small, bytes) = unpacked(&whole.packed(room).expect("there is room"));
        assert!(bytes <= room && bytes > room / 2, "{bytes} of {room}");
        assert!(small.left_out.iter().any(|word| word.starts_with("of rays: ")), "{:?}", small.left_out);
        let [tree] = small.trees.as_slice() else { panic!("one tree") };
        assert!(tree.left_out.is_some() || tree.nodes.len() == whole.trees[0].nodes.len());
        if room < 100_000 {
            assert!(tree.left_out.is_some(), "{}", tree.nodes.len());
        }
    }
}

#[test]
fn both_sides_of_a_comparison_are_cut_alike() {
    let other = page(&panes(16, 1, 1.0), &[0]);
    let whole = compared(huge().clone(), other);
    let (small, bytes) = read(&whole);
    assert!(bytes <= Page::ROOM, "{bytes}");
    let other = small.other.as_ref().expect("two sides");
    let (mine, theirs) = (&small.trees[0], &other.trees[0]);
    is_part_of(mine, &whole.trees[0]);
    is_part_of(theirs, &whole.other.as_ref().expect("two sides").trees[0]);
    let sizes = [mine.nodes.len(), theirs.nodes.len()];
    assert!(sizes.iter().all(|&n| n > 1_000) && sizes.iter().sum::<usize>() <= 2 * Page::RAYS, "{sizes:?}");
    // Rays that have a partner have it still: what was cut is no difference.
    let diff = mine.diff.as_ref().expect("compared");
    let before = whole.trees[0].diff.as_ref().expect("compared");
    let partner: HashMap<u32, u32> = before.pairs.iter().map(|&[a, b]| (a, b)).collect();
    let now: HashMap<u32, u32> = diff.pairs.iter().map(|&[a, b]| (a, b)).collect();
    for node in &mine.nodes {
        let had = node.whole_id.and_then(|id| partner.get(&id).copied());
        let has = now.get(&(node.id as u32)).and_then(|&b| theirs.nodes[b as usize].whole_id);
        assert_eq!(has, had, "ray {}", node.id);
    }
    let gone = |tree: &Tree, ids: &[u32]| ids.iter().filter(|&&id| id as usize >= tree.nodes.len()).count();
    assert_eq!((gone(mine, &diff.removed), gone(theirs, &diff.added)), (0, 0));
    assert_eq!((&diff.summary, diff.relative), (&before.summary, before.relative));
}

#[test]
fn large_samples_share_the_room_and_the_first_gets_half() {
    let prepared = panes(12, 12, 1.0);
    let whole = page(&prepared, &(0..12).collect::<Vec<_>>());
    assert!(rays(&whole.trees) > 3 * Page::RAYS, "{}", rays(&whole.trees));
    let (small, bytes) = read(&whole);
    assert!(bytes <= Page::ROOM, "{bytes}");
    assert_eq!(small.trees.len(), 12, "all samples are there");
    for (tree, whole) in small.trees.iter().zip(&whole.trees) {
        if tree.left_out.is_some() {
            is_part_of(tree, whole);
        } else {
            assert_eq!(tree.nodes.len(), whole.nodes.len());
        }
    }
    let sizes: Vec<usize> = small.trees.iter().map(|t| t.nodes.len()).collect();
    assert!(sizes[1..].iter().all(|&n| n >= 256 && n <= sizes[0]), "{sizes:?}");
    let cut: Vec<usize> =
        small.trees[1..].iter().filter(|t| t.left_out.is_some()).map(|t| t.nodes.len()).collect();
    let (least, most) = (cut.iter().min(), cut.iter().max());
    assert!(most.zip(least).is_some_and(|(most, least)| most - least <= 1), "shares are equal: {sizes:?}");
}

#[test]
fn more_samples_than_there_is_room_for_are_fewer_with_both_sides() {
    let first = page(&panes(4, 1000, 1.0), &(0..1000).collect::<Vec<_>>());
    let other = page(&panes(4, 1000, 0.5), &(0..1000).collect::<Vec<_>>());
    let each = first.trees[0].nodes.len();
    assert!(each > 20 && each * 2000 > 4 * Page::RAYS, "{each}");
    let (small, bytes) = read(&compared(first, other));
    assert!(bytes <= Page::ROOM, "{bytes}");
    let other = small.other.as_ref().expect("two sides");
    assert_eq!(small.trees.len(), other.trees.len());
    assert!(rays(&small.trees) + rays(&other.trees) <= 2 * Page::RAYS);
    assert!(
        small.trees.len() > 20 && small.trees.iter().all(|t| t.left_out.is_none()),
        "small trees stay whole"
    );
    let told = format!("the rays of {} more samples", 1000 - small.trees.len());
    assert!(small.left_out.contains(&told), "{:?}", small.left_out);
    assert_eq!(small.values.len(), 1000);
}

#[test]
fn what_fits_stays_as_it_is() {
    let whole = page(&panes(5, 2, 1.0), &[0, 1]);
    let (small, _) = read(&whole);
    assert!(small.left_out.is_empty() && small.trees.iter().all(|t| t.left_out.is_none()));
    assert_eq!(small.trees, whole.trees);
}
