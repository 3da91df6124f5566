//! `--diff`: the same samples under other options.
use durer::{
    probe::Detail,
    tree::{Comparison, Other, Page, Subject, Tree},
};

use crate::exit::WrongUsage;

/// Adds to a page the trees of its samples under other options, and what differs. The first `chosen` trees were asked
/// for; of the others those go that the pixel has not under the other options.
pub(super) fn add(
    (page, chosen): (&mut Page, usize),
    subject: &Subject<'_>,
    twin: &Subject<'_>,
    options: &str,
) -> Result<(), WrongUsage> {
    let Some(pixel) = page.trees.first().map(|t| t.pixel) else { return Ok(()) };
    let (view, settings) = (&twin.prepared.scene.view, twin.prepared.settings);
    let [x, y] = pixel;
    if x >= view.width || y >= view.height {
        let size = format!("{} x {}", view.width, view.height);
        return Err(WrongUsage(format!(
            "--diff \"{options}\": pixel {x},{y} lies outside its picture of {size} pixels\n  \
             help: add --width and --height to the options"
        )));
    }
    let samples = twin.prepared.job().sample_count(pixel);
    let is_there = |tree: &Tree| tree.sample < samples;
    if let Some(tree) = page.trees.iter().take(chosen).find(|tree| !is_there(tree)) {
        return Err(WrongUsage(format!(
            "--diff \"{options}\": there is no sample {}: the pixel has {} there\n  help: add --spp to the options",
            tree.sample, samples
        )));
    }
    page.trees.retain(is_there);
    // With other numbers of samples or another seed the random numbers are others too, and something of every ray differs.
    let whole = if settings.samples == 1 && subject.prepared.settings.samples == 1 {
        "this pixel"
    } else {
        "this sample"
    };
    let others: Vec<Tree> =
        page.trees.iter().map(|t| twin.tree_of(pixel, samples, t.sample, Detail::default())).collect();
    for (tree, other) in page.trees.iter_mut().zip(&others) {
        tree.diff = Some(Comparison::new(tree, other, options, whole));
    }
    let diff = page.trees.first().and_then(|t| t.diff.clone()).unwrap_or_default();
    page.other = Some(Other { options: options.to_owned(), trees: others, diff });
    Ok(())
}
