//! Two trees of the same sample under different settings: which rays are gone, which are new, which differ.
//!
//! Rays are the same if their parents are, and if they are the n-th of their kind (and light) among their siblings. Random
//! numbers depend on the place in the tree, so such rays were drawn with the same ones.
use serde::{Deserialize, Serialize};

use super::{
    document::{Node, Tree},
    number::{Number, Rgb, plain},
};
use crate::spectrum::luminance;

/// What differs between a tree and another of the same sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Comparison {
    /// The options of the other tree: the text of `--diff`.
    pub options: String,
    /// The difference in a sentence.
    pub summary: String,
    /// The value of the tree.
    pub before: Rgb,
    /// The value of the other tree.
    pub after: Rgb,
    /// What the other has of the luminance of this one, less 1: -0.14 if 14 % are gone. Null if this one is black,
    /// and if one of them is no light.
    pub relative: Option<Number>,
    /// Ids in this tree of rays that the other does not trace, with all below them.
    pub removed: Vec<u32>,
    /// Ids in the other tree of rays that this one does not trace, with all below them.
    pub added: Vec<u32>,
    /// Rays that both trace, or both give up, but not alike.
    pub changed: Vec<Change>,
    /// Ids of all rays that are the same place of both trees: in this one, in the other.
    pub pairs: Vec<[u32; 2]>,
}

/// A ray that is not the same in both trees.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Change {
    /// Its id in this tree.
    pub before: u32,
    /// Its id in the other.
    pub after: u32,
    /// Keys with different values, of those that say what became of the ray.
    pub keys: Vec<String>,
}

impl Comparison {
    /// Compares `tree` with `other`; `options` is how the user asked for the other, `whole` what the value is called.
    pub fn new(tree: &Tree, other: &Tree, options: &str, whole: &str) -> Self {
        let mut found = Self {
            options: options.to_owned(),
            before: tree.rgb,
            after: other.rgb,
            relative: relative(tree, other).map(Number),
            ..Self::default()
        };
        found.align(tree, other);
        found.summary = found.sentence(tree, other, whole);
        found
    }

    /// What it says of the whole, without a word about single rays.
    pub(super) fn without_lists(&self) -> Self {
        let (options, summary) = (self.options.clone(), self.summary.clone());
        let Self { before, after, relative, .. } = *self;
        Self { options, summary, before, after, relative, ..Self::default() }
    }

    fn align(&mut self, tree: &Tree, other: &Tree) {
        let (mine, theirs) = (tree.children(), other.children());
        let mut partner_of = vec![None; tree.nodes.len()];
        let mut has_partner = vec![false; other.nodes.len()];
        let mut open = match (tree.nodes.first(), other.nodes.first()) {
            (Some(_), Some(_)) => vec![(0, 0)],
            _ => Vec::new(),
        };
        while let Some((a, b)) = open.pop() {
            partner_of[a] = Some(b);
            has_partner[b] = true;
            let mut left: Vec<usize> = theirs[b].clone();
            for &child in &mine[a] {
                let place =
                    left.iter().position(|&o| place_of(&other.nodes[o]) == place_of(&tree.nodes[child]));
                if let Some(place) = place {
                    open.push((child, left.remove(place)));
                }
            }
        }
        let mut removed = vec![false; tree.nodes.len()];
        let mut added = vec![false; other.nodes.len()];
        for (a, node) in tree.nodes.iter().enumerate() {
            let Some(b) = partner_of[a] else {
                removed[a] = true;
                continue;
            };
            self.pairs.push([a as u32, b as u32]);
            let twin = &other.nodes[b];
            match (node.is_untraced(), twin.is_untraced()) {
                (false, true) => removed[a] = true,
                (true, false) => added[b] = true,
                _ => {
                    let keys = differences(node, twin);
                    if !keys.is_empty() {
                        self.changed.push(Change { before: a as u32, after: b as u32, keys });
                    }
                }
            }
        }
        (0..other.nodes.len()).filter(|&b| !has_partner[b]).for_each(|b| added[b] = true);
        let ids = |flags: Vec<bool>| (0..).zip(flags).filter(|(_, is)| *is).map(|(id, _)| id).collect();
        (self.removed, self.added) = (ids(removed), ids(added));
    }

    fn sentence(&self, tree: &Tree, other: &Tree, whole: &str) -> String {
        let what = named(&self.options);
        let no_light = no_light(tree, other);
        let effect = match self.relative.map(|r| r.0) {
            _ if tree.data != other.data => {
                format!("{what} shows something else of {whole} ({})", no_light.unwrap_or_default())
            }
            _ if self.before == self.after => format!("{what} changes nothing of {whole}"),
            Some(r) if r < 0.0 => format!("{what} removes {} of {whole}", percent(-r)),
            Some(r) if r > 0.0 => format!("{what} adds {} to {whole}", percent(r)),
            Some(_) => format!("{what} changes the colour of {whole}, not its luminance"),
            None if no_light.is_some() => {
                format!("{what} changes {whole} ({})", no_light.unwrap_or_default())
            }
            None if plain(self.before).iter().all(|v| *v == 0.0) => {
                format!("{what} brings light to {whole}, which was black")
            }
            None => format!("{what} changes {whole}, which is infinite or NaN"),
        };
        let traced = |t: &Tree, ids: &[u32]| {
            let of = ids.iter().filter_map(|&id| t.nodes.get(id as usize));
            of.filter(|n| !n.is_untraced()).count()
        };
        let (gone, new) = (traced(tree, &self.removed), traced(other, &self.added));
        format!(
            "{effect}: {gone} {} gone, {new} new, {} changed",
            if gone == 1 { "ray is" } else { "rays are" },
            self.changed.len()
        )
    }
}

/// What makes a ray the counterpart of another among its siblings.
fn place_of(node: &Node) -> (&str, Option<u32>) {
    (node.kind.as_str(), node.light.as_ref().map(|l| l.index))
}

/// Names of the keys that say what became of a ray and differ.
fn differences(a: &Node, b: &Node) -> Vec<String> {
    let tests: [(&str, bool); 14] = [
        ("origin", a.origin != b.origin),
        ("direction", a.direction != b.direction),
        ("t", a.t != b.t),
        ("object", a.object != b.object),
        ("normal", a.normal != b.normal),
        ("material", a.material != b.material),
        ("weight", a.weight != b.weight),
        ("throughput", a.throughput != b.throughput),
        ("local", a.local != b.local),
        ("result", a.result != b.result),
        ("stop", a.stop != b.stop),
        ("light", a.light != b.light),
        ("blocker", a.blocker != b.blocker),
        ("media", a.media != b.media),
    ];
    tests.into_iter().filter(|(_, differs)| *differs).map(|(key, _)| key.to_owned()).collect()
}

/// By how much the luminance differs; `None` if that says nothing.
fn relative(before: &Tree, after: &Tree) -> Option<f32> {
    if before.data.is_some() || after.data.is_some() {
        return None;
    }
    let [before, after] = [before, after].map(|tree| luminance(plain(tree.rgb).map(f64::from)));
    (before != 0.0 && before.is_finite() && after.is_finite()).then(|| ((after - before) / before) as f32)
}

/// Why what two trees say cannot be compared as light; `None` if it can.
fn no_light(before: &Tree, after: &Tree) -> Option<String> {
    match (&before.data, &after.data) {
        (None, None) => None,
        (Some(data), None) => Some(format!("the one is {data}, the other light")),
        (None, Some(data)) => Some(format!("the one is light, the other {data}")),
        (Some(data), Some(other)) if data == other => Some(format!("it is {data}, not light")),
        (Some(data), Some(other)) => Some(format!("the one is {data}, the other {other}")),
    }
}

fn percent(share: f32) -> String {
    let percent = 100.0 * share;
    match percent {
        p if p >= 10.0 => format!("{p:.0} %"),
        p if p >= 0.1 => format!("{p:.1} %"),
        _ => "less than 0.1 %".to_owned(),
    }
}

/// Options as the subject of a sentence.
fn named(options: &str) -> String {
    let words: Vec<&str> = options.split_whitespace().collect();
    match words.as_slice() {
        ["--max-depth", n] => format!("depth limit {n}"),
        ["--min-contribution", c] => format!("contribution limit {c}"),
        ["--integrator", name] => format!("integrator {name}"),
        ["--shadows", how] => format!("{how} shadows"),
        _ => options.trim().to_owned(),
    }
}
