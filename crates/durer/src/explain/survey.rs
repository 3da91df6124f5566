//! What the samples of a pixel have in common: spread, what was cut off, what the first surface sees of each light.
use crate::{
    Prepared,
    probe::{RayKind, RayTree, StopReason, TreeNode},
};

use super::{
    Sample,
    explanation::Spread,
    part::light_name,
    words::{luminance, tint},
};

/// Whether a ray was given up that would have brought something, by a bound that somebody set.
pub(super) fn is_cut(node: &TreeNode) -> bool {
    matches!(
        node.stop,
        Some(StopReason::DepthLimit | StopReason::ContributionBelowCutoff | StopReason::Cancelled)
    )
}

/// Shares in the pixel of all rays that were cut off.
pub(super) fn cut_share(tree: &RayTree) -> [f64; 3] {
    tree.nodes.iter().filter(|n| is_cut(n)).fold([0.0; 3], |mut sum, node| {
        let lost = tint(&tree.basis, node.lost);
        (0..3).for_each(|i| sum[i] += lost[i]);
        sum
    })
}

/// The largest radiance in the samples.
pub(super) fn brightest(samples: &[Sample]) -> f64 {
    samples.iter().map(|s| f64::from(s.tree.max_radiance())).fold(0.0, f64::max)
}

/// What is missing at most, of the mean of the samples.
///
/// # Errors
/// Why there is no bound.
pub(super) fn missing(prepared: &Prepared, samples: &[Sample]) -> Result<[f64; 3], String> {
    let share = samples.iter().fold([0.0; 3], |mut sum, sample| {
        let cut = cut_share(&sample.tree);
        (0..3).for_each(|i| sum[i] += cut[i] / samples.len().max(1) as f64);
        sum
    });
    if share == [0.0; 3] {
        return Ok(share);
    }
    let most = f64::from(prepared.brightest()?);
    Ok(share.map(|share| share * most))
}

pub(super) fn spread(samples: &[Sample]) -> Spread {
    let lights: Vec<(u32, f64)> =
        samples.iter().filter(|s| s.is_finite()).map(|s| (s.number, luminance(s.rgb))).collect();
    let count = lights.len().max(1) as f64;
    let mean = lights.iter().map(|(_, v)| v).sum::<f64>() / count;
    let variance = lights.iter().map(|(_, v)| (v - mean).powi(2)).sum::<f64>() / count;
    let brightest = lights.iter().copied().reduce(|best, v| if v.1 > best.1 { v } else { best });
    Spread {
        deviation: variance.sqrt(),
        brightest: brightest.unwrap_or((0, 0.0)),
        darkest: lights
            .iter()
            .copied()
            .reduce(|best, v| if v.1 < best.1 { v } else { best })
            .unwrap_or((0, 0.0)),
        bad: samples.iter().filter(|s| !s.is_finite()).map(|s| s.number).collect(),
    }
}

/// The first surface that is there, or the last ray if there is none.
pub(super) fn first_surface(tree: &RayTree) -> Option<usize> {
    let children = tree.children();
    let mut index = 0;
    tree.nodes.first()?;
    while let Some(&next) = children[index].iter().find(|&&c| tree.nodes[c as usize].kind == RayKind::Passing)
    {
        index = next as usize;
    }
    Some(index)
}

/// What the first surfaces of the samples see of a light.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    pub(super) light: String,
    /// Samples that sent shadow rays to it, or would have if it did not lie behind the surface.
    pub(super) asked: usize,
    /// Those that some of its light reached.
    pub(super) lit: usize,
    /// What stood in the way, and how often.
    pub(super) blockers: Vec<(String, usize)>,
}

/// Of every light.
pub(super) fn lights(prepared: &Prepared, samples: &[Sample]) -> Vec<Seen> {
    let mut all: Vec<Seen> = Vec::new();
    for sample in samples {
        let Some(first) = first_surface(&sample.tree) else { continue };
        let mut known: Vec<usize> = Vec::new();
        for node in sample.tree.nodes.iter().filter(|n| n.parent == Some(first as u32)) {
            let Some(name) = light_name(prepared, node) else { continue };
            let place = all.iter().position(|s| s.light == name).unwrap_or_else(|| {
                all.push(Seen { light: name.to_owned(), ..Seen::default() });
                all.len() - 1
            });
            let seen = &mut all[place];
            let is_lit = node.light.is_some_and(|l| l.visible);
            if !known.contains(&place) {
                known.push(place);
                seen.asked += 1;
                let all_of_it = sample
                    .tree
                    .nodes
                    .iter()
                    .filter(|n| n.parent == Some(first as u32) && light_name(prepared, n) == Some(name));
                seen.lit += usize::from(all_of_it.into_iter().any(|n| n.light.is_some_and(|l| l.visible)));
            }
            if let (false, Some(blocker)) = (is_lit, node.light.and_then(|l| l.blocker)) {
                let blocker = &prepared.scene.object(blocker).name;
                match seen.blockers.iter_mut().find(|(b, _)| b == blocker) {
                    Some((_, count)) => *count += 1,
                    None => seen.blockers.push((blocker.clone(), 1)),
                }
            }
        }
    }
    all
}

/// What the samples see first, and how many: objects by name, `None` where rays leave the scene. The most frequent first.
pub(super) fn objects(prepared: &Prepared, samples: &[Sample]) -> Vec<(Option<String>, usize)> {
    let mut all: Vec<(Option<String>, usize)> = Vec::new();
    for sample in samples {
        let first = first_surface(&sample.tree).and_then(|i| sample.tree.nodes[i].hit.as_ref());
        let name = first.map(|hit| prepared.scene.object(hit.object).name.clone());
        match all.iter_mut().find(|(n, _)| *n == name) {
            Some((_, count)) => *count += 1,
            None => all.push((name, 1)),
        }
    }
    all.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    all
}
