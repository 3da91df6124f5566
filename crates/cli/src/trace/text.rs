//! The ray tree to read.
use std::fmt::Write;

use durer::tree::{Comparison, Node, Number, Page, Tree, Wording, met, short, triple};

use crate::number::pixel_line;

/// Rays of a difference that are named; more are counted.
const NAMED: usize = 12;

/// All trees of a page; then `pixel R G B`.
pub(super) fn page(page: &Page) -> String {
    let mut text = String::new();
    for (number, own) in page.trees.iter().enumerate() {
        text += &tree(own);
        let other = page.other.as_ref().and_then(|o| o.trees.get(number));
        if let (Some(diff), Some(other)) = (&own.diff, other) {
            text += &difference(own, other, diff);
        }
        if page.trees.len() > 1 {
            text += &format!("sample {}\n\n", pixel_line(durer::tree::plain(own.rgb)).replace("pixel ", ""));
        }
    }
    text + &pixel_line(super::value(page)) + "\n"
}

/// A tree: a ray per line, children indented below.
fn tree(tree: &Tree) -> String {
    let Tree { scene, integrator, pixel: [x, y], sample, samples, .. } = tree;
    let mut text = format!("{scene}, {integrator}, pixel {x},{y}, sample {sample} of {samples}\n");
    let children = tree.children();
    let mut open: Vec<(usize, usize)> =
        tree.nodes.iter().filter(|n| n.parent.is_none()).map(|n| (n.id, 0)).collect();
    open.reverse();
    // A stack of our own: deep trees must not end in a stack overflow.
    while let Some((index, level)) = open.pop() {
        let (Some(node), Some(below)) = (tree.nodes.get(index), children.get(index)) else {
            continue;
        };
        let _ = writeln!(text, "{:indent$}{}", "", line(node), indent = 2 * level);
        open.extend(below.iter().rev().map(|&child| (child, level + 1)));
    }
    text + &given_up(tree)
}

/// What rays that were not traced would have carried; nothing if there are none.
fn given_up(tree: &Tree) -> String {
    if tree.killed.iter().all(|v| v.0 <= 0.0) {
        return String::new();
    }
    let killed = triple(tree.killed);
    match (tree.missing, &tree.no_bound) {
        (Some(missing), _) => {
            let most = tree
                .brightest
                .map(|most| format!(", as nothing in the scene is brighter than {}", short(most)));
            let most = most.unwrap_or_default();
            format!("given up {killed} of the pixel: at most {} of light{most}\n", triple(missing))
        }
        (None, why) => {
            let why = why.as_deref().unwrap_or("nothing is known of the scene's light");
            let seen = tree.max_radiance;
            let guess = triple(tree.killed.map(|v| Number(v.0 * seen.0)));
            let guess = match seen.0 > 0.0 {
                true => format!(
                    "; {guess} of light if nothing is brighter than the {} that was seen",
                    short(seen)
                ),
                false => String::new(),
            };
            format!("given up {killed} of the pixel; no bound: {why}{guess}\n")
        }
    }
}

fn line(node: &Node) -> String {
    let mut parts = vec![met(node, Wording::Full)];
    if node.is_untraced() {
        parts.push(format!("weight {}", triple(node.weight)));
        parts.push(format!("would have carried {} of the pixel", triple(node.lost)));
    } else {
        parts.extend(interface(node));
        if node.parent.is_some() {
            parts.push(format!("weight {}", triple(node.weight)));
        }
        parts.push(format!("adds {}", triple(node.contribution)));
        if node.light.is_none() {
            parts.push(format!("result {}", triple(node.result)));
        }
    }
    parts.extend(node.stop.as_ref().map(|stop| format!("[{stop}{}]", limit(node))));
    parts.join(", ")
}

/// What was compared when the ray was given up.
fn limit(node: &Node) -> String {
    let Some(limit) = node.limit else { return String::new() };
    let [value, threshold] = [limit.value, limit.threshold].map(short);
    match node.stop.as_deref() {
        Some("depth-limit") => format!(": depth {value}, at most {threshold}"),
        Some("roulette") => format!(": {value} >= {threshold}"),
        _ => format!(": {value} <= {threshold}"),
    }
}

/// Indices of refraction and what becomes of the light between them.
fn interface(node: &Node) -> Option<String> {
    let (media, fresnel) = (node.media.as_ref()?, node.fresnel.as_ref()?);
    let share = match (fresnel.tir, fresnel.constant) {
        (true, _) => "reflects all".to_owned(),
        (false, true) => "shares by constants".to_owned(),
        (false, false) => format!("reflects {}", short(fresnel.reflect)),
    };
    Some(format!("n {} to {} {share}", short(media.n1), short(media.n2)))
}

/// What the other options change.
fn difference(own: &Tree, other: &Tree, diff: &Comparison) -> String {
    let mut text = format!("\n{}\n", diff.summary);
    let listed = |text: &mut String, sign: char, tree: &Tree, ids: &[u32]| {
        for &id in ids.iter().take(NAMED) {
            if let Some(node) = tree.nodes.get(id as usize) {
                let _ = writeln!(text, "  {sign} {id} {}", line(node));
            }
        }
        if ids.len() > NAMED {
            let _ = writeln!(text, "  {sign} and {} more", ids.len() - NAMED);
        }
    };
    listed(&mut text, '-', own, &diff.removed);
    listed(&mut text, '+', other, &diff.added);
    for change in diff.changed.iter().take(NAMED) {
        if let (Some(a), Some(b)) =
            (own.nodes.get(change.before as usize), other.nodes.get(change.after as usize))
        {
            let _ = writeln!(text, "  ~ {} {}: {}", change.before, a.kind, what_changed(a, b, &change.keys));
        }
    }
    if diff.changed.len() > NAMED {
        let _ = writeln!(text, "  ~ and {} more", diff.changed.len() - NAMED);
    }
    text + "\n"
}

fn what_changed(a: &Node, b: &Node, keys: &[String]) -> String {
    let word = |v: &Option<String>| v.clone().unwrap_or_else(|| "nothing".to_owned());
    let mut parts = Vec::new();
    for key in keys {
        parts.push(match key.as_str() {
            "object" => format!("hits {} instead of {}", word(&b.object), word(&a.object)),
            "stop" => format!("[{}] instead of [{}]", word(&b.stop), word(&a.stop)),
            "weight" => format!("weight {} instead of {}", triple(b.weight), triple(a.weight)),
            "result" => format!("result {} instead of {}", triple(b.result), triple(a.result)),
            "throughput" | "origin" | "direction" | "t" => continue,
            key => key.to_owned(),
        });
    }
    if parts.is_empty() { keys.join(", ") } else { parts.join(", ") }
}
