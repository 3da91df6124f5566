//! How a page is made to fit into its file: by details first, then by rays.
//!
//! Rays are shared out like this. The sample that was asked for, with its like under other settings, gets half of them, or
//! what the others leave. These get equal shares, of which small trees leave something for large ones; where shares would be
//! too small to show anything the last samples go.
use base64::{Engine, engine::general_purpose::STANDARD};
use flate2::{Compression, write::GzEncoder};
use serde_json::Value;

use super::{
    cut::{self, Pair},
    document::Tree,
    page::{Other, Page},
};

/// Trees, with both sides, of no more rays than these are shown as a whole or not at all.
const LEAST: usize = 256;
/// Most samples whose values are kept.
const VALUES: usize = 4096;

/// Which trees lose details.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lean {
    Nothing,
    /// All but the first.
    Others,
    All,
}

impl Lean {
    /// How many trees are left whole.
    fn whole(self) -> usize {
        match self {
            Self::Nothing => usize::MAX,
            Self::Others => 1,
            Self::All => 0,
        }
    }

    /// What goes, in words.
    fn told(self) -> Option<String> {
        let whose = match self {
            Self::Nothing => return None,
            Self::Others => "rays of other samples",
            Self::All => "rays",
        };
        Some(format!(
            "of {whose}: boxes tested, triangles, random numbers, lobes, textures, digits beyond the sixth"
        ))
    }
}

/// See [`Page::packed`].
pub(super) fn packed(page: &Page, most: usize) -> serde_json::Result<Vec<u8>> {
    let sides = 1 + usize::from(page.other.is_some());
    let mut rays = Page::RAYS * sides;
    let mut small = with_rays(page, rays);
    for lean in [Lean::Nothing, Lean::Others, Lean::All] {
        let packed = pack(&small, lean)?;
        if packed.len() <= most {
            return Ok(packed);
        }
    }
    rays = rays.min(count(&small));
    let mut around = Page { trees: Vec::new(), other: None, left_out: Vec::new(), ..small.clone() };
    let mut fixed = pack(&around, Lean::All)?.len();
    // Rays come before pictures.
    for without in [without_picture, without_geometry] {
        if fixed > most / 2 {
            without(&mut around);
            fixed = pack(&around, Lean::All)?.len();
        }
    }
    let mut of_rays = pack(&small, Lean::All)?.len().saturating_sub(fixed);
    loop {
        // A little less than would fit if all rays were alike.
        let share = most.saturating_sub(fixed) as f64 / of_rays.max(1) as f64;
        rays = (rays as f64 * (share * 0.95).min(0.9)) as usize;
        let Page { trees, other, mut left_out, .. } = with_rays(page, rays);
        left_out.extend_from_slice(&around.left_out);
        small = Page { trees, other, left_out, ..around.clone() };
        let packed = pack(&small, Lean::All)?;
        if packed.len() <= most || rays <= sides {
            return Ok(packed);
        }
        of_rays = packed.len().saturating_sub(fixed);
    }
}

fn without_picture(page: &mut Page) {
    if page.picture.take().is_some() {
        page.left_out.push("the picture".to_owned());
    }
}

fn without_geometry(page: &mut Page) {
    if let Some(scene) = &mut page.scene {
        scene.objects.clear();
        page.left_out.push("the scene's geometry".to_owned());
    }
}

/// Rays in all.
fn count(page: &Page) -> usize {
    let theirs = page.other.iter().flat_map(|o| &o.trees);
    page.trees.iter().chain(theirs).map(|t| t.nodes.len()).sum()
}

/// The page with at most `most` rays, and not more values than can be looked at.
fn with_rays(page: &Page, most: usize) -> Page {
    let twins = page.other.as_ref().map_or(&[][..], |o| &o.trees);
    let pairs: Vec<Pair<'_>> = page.trees.iter().enumerate().map(|(i, tree)| (tree, twins.get(i))).collect();
    let sizes: Vec<usize> = pairs.iter().map(|&pair| cut::rays(pair)).collect();
    let cut: Vec<(Tree, Option<Tree>)> =
        shares(&sizes, most).into_iter().zip(&pairs).map(|(share, &pair)| cut::cut(pair, share)).collect();
    let mut left_out = page.left_out.clone();
    if cut.len() < pairs.len() {
        left_out.push(format!("the rays of {} more samples", pairs.len() - cut.len()));
    }
    if page.values.len() > VALUES {
        left_out.push(format!("the values of the samples from {VALUES} on"));
    }
    let (trees, twins): (Vec<Tree>, Vec<Option<Tree>>) = cut.into_iter().unzip();
    Page {
        version: page.version,
        trees,
        other: page.other.as_ref().map(|other| Other {
            options: other.options.clone(),
            trees: twins.into_iter().flatten().collect(),
            // The first tree says the same, and of rays.
            diff: other.diff.without_lists(),
        }),
        values: page.values.iter().take(VALUES).copied().collect(),
        dims: page.dims.iter().take(VALUES).cloned().collect(),
        mean: page.mean,
        picture: page.picture.clone(),
        scene: page.scene.clone(),
        left_out,
    }
}

/// How many rays of each sample there is room for, as many samples as there are.
fn shares(sizes: &[usize], most: usize) -> Vec<usize> {
    let Some((&first, others)) = sizes.split_first() else { return Vec::new() };
    let all: usize = others.iter().sum();
    let first = first.min((most / 2).max(most.saturating_sub(all)));
    let mut left = most.saturating_sub(first);
    let mut kept = others;
    while quota(kept, left) < LEAST {
        kept = &kept[..kept.len() - kept.len().div_ceil(64)];
    }
    let share = quota(kept, left);
    let shares = kept.iter().map(|&size| {
        let own = size.min(share);
        left -= own;
        own
    });
    let others: Vec<usize> = shares.collect();
    // What is left by rounding, and by samples that went.
    std::iter::once(first + left).chain(others).collect()
}

/// The largest share so that all together have at most `most`, if small ones take what they need; of nothing any.
fn quota(sizes: &[usize], most: usize) -> usize {
    let mut sorted = sizes.to_vec();
    sorted.sort_unstable();
    let mut left = most;
    for (i, &size) in sorted.iter().enumerate() {
        let share = left / (sorted.len() - i);
        if size > share {
            return share;
        }
        left -= size;
    }
    usize::MAX
}

fn pack(page: &Page, how: Lean) -> serde_json::Result<Vec<u8>> {
    let mut value = lean(page, how)?;
    if let (Some(told), Some(page)) = (how.told(), value.as_object_mut()) {
        let list = page.entry("left_out").or_insert_with(|| Value::Array(Vec::new()));
        list.as_array_mut().into_iter().for_each(|list| list.push(told.clone().into()));
    }
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    serde_json::to_writer(&mut packer, &value)?;
    let packed = packer.finish().map_err(serde_json::Error::io)?;
    Ok(STANDARD.encode(packed).into_bytes())
}

/// The page without what is null, and without details of some trees.
pub(super) fn lean(page: &Page, lean: Lean) -> serde_json::Result<Value> {
    // By way of text, in which numbers in single precision are short.
    let mut value: Value = serde_json::from_str(&serde_json::to_string(page)?)?;
    let own = value.get_mut("trees").and_then(Value::as_array_mut);
    own.into_iter().flatten().skip(lean.whole()).for_each(lighten);
    let other = value.pointer_mut("/other/trees").and_then(Value::as_array_mut);
    other.into_iter().flatten().skip(lean.whole()).for_each(lighten);
    drop_nothing(&mut value);
    Ok(value)
}

/// Details that a tree can do without.
const DETAILS: [&str; 8] = ["walk", "sampler", "triangle", "barycentric", "ns", "uv", "ambient", "emission"];
/// The same of lists, which become empty.
const LISTS: [&str; 3] = ["random", "textures", "lobes"];
/// Significant digits of numbers of such a tree.
const DIGITS: usize = 6;

/// Takes details and digits from a tree.
fn lighten(tree: &mut Value) {
    let nodes = tree.get_mut("nodes").and_then(Value::as_array_mut);
    for node in nodes.into_iter().flatten() {
        if let Some(keys) = node.as_object_mut() {
            keys.retain(|key, _| !DETAILS.contains(&key.as_str()));
            for key in LISTS {
                keys.insert(key.to_owned(), Value::Array(Vec::new()));
            }
            if keys.get("normal") == keys.get("geometric_normal") {
                keys.remove("geometric_normal");
            }
        }
        round(node);
    }
}

fn round(value: &mut Value) {
    match value {
        Value::Object(keys) => keys.values_mut().for_each(round),
        Value::Array(list) => list.iter_mut().for_each(round),
        Value::Number(number) if number.is_f64() => {
            let rounded = number.as_f64().map(|v| format!("{v:.*e}", DIGITS - 1));
            let rounded = rounded.and_then(|v| v.parse().ok()).and_then(serde_json::Number::from_f64);
            *number = rounded.unwrap_or_else(|| number.clone());
        }
        _ => {}
    }
}

/// Takes out what says nothing, at any depth; lists keep their length.
fn drop_nothing(value: &mut Value) {
    match value {
        Value::Object(keys) => {
            keys.values_mut().for_each(drop_nothing);
            keys.retain(|_, v| !v.is_null());
        }
        Value::Array(list) => list.iter_mut().for_each(drop_nothing),
        _ => {}
    }
}
