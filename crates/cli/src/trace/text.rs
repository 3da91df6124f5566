//! The ray tree to read.
use std::fmt::Write;

use durer::tree::{Comparison, Light, Node, Number, Page, Rgb, Tree};

use crate::number::{pixel_line, significant, triple};

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
    if tree.killed.iter().any(|v| v.0 > 0.0) {
        let bound = tree.killed.map(|v| Number(v.0 * tree.max_radiance.0));
        let most = significant(tree.max_radiance.0, 4);
        let killed = rgb(tree.killed);
        let _ = match tree.max_radiance.0 > 0.0 {
            true => writeln!(
                text,
                "given up {killed} of the pixel: at most {} of light, if nothing is brighter than {most}",
                rgb(bound)
            ),
            false => writeln!(text, "given up {killed} of the pixel; no light was seen that could bound it"),
        };
    }
    text
}

fn line(node: &Node) -> String {
    let mut parts = vec![met(node)];
    if node.is_untraced() {
        parts.push(format!("weight {}", rgb(node.weight)));
        parts.push(format!("would have carried {} of the pixel", rgb(node.lost)));
    } else {
        parts.extend(interface(node));
        if node.parent.is_some() {
            parts.push(format!("weight {}", rgb(node.weight)));
        }
        parts.push(format!("adds {}", rgb(node.contribution)));
        if node.light.is_none() {
            parts.push(format!("result {}", rgb(node.result)));
        }
    }
    parts.extend(node.stop.as_ref().map(|stop| format!("[{stop}{}]", limit(node))));
    parts.join(", ")
}

/// What was compared when the ray was given up.
fn limit(node: &Node) -> String {
    let Some(limit) = node.limit else { return String::new() };
    let [value, threshold] = [limit.value, limit.threshold].map(|v| significant(v.0, 4));
    match node.stop.as_deref() {
        Some("depth-limit") => format!(": depth {value}, at most {threshold}"),
        _ => format!(": {value} <= {threshold}"),
    }
}

/// Indices of refraction and what becomes of the light between them.
fn interface(node: &Node) -> Option<String> {
    let (media, fresnel) = (node.media.as_ref()?, node.fresnel.as_ref()?);
    let share = match (fresnel.tir, fresnel.constant) {
        (true, _) => "reflects all".to_owned(),
        (false, true) => "shares by constants".to_owned(),
        (false, false) => format!("reflects {}", significant(fresnel.reflect.0, 3)),
    };
    Some(format!("n {} to {} {share}", significant(media.n1.0, 4), significant(media.n2.0, 4)))
}

/// What the ray is for and what became of it.
fn met(node: &Node) -> String {
    let kind = &node.kind;
    if node.is_untraced() {
        return format!("{kind} not traced");
    }
    match (&node.object, &node.light) {
        (_, Some(event)) => format!("{kind} to {}{}", light_name(event), fate(node, event)),
        (Some(object), None) => {
            let side = node.side.as_deref().unwrap_or("?");
            format!("{kind} hits {object} ({side}) at {}", metres(node))
        }
        (None, None) => format!("{kind} leaves the scene"),
    }
}

fn fate(node: &Node, event: &Light) -> String {
    match (event.visible, &node.blocker) {
        (true, _) if event.point.is_some() => format!(" at {}", metres(node)),
        (true, _) => String::new(),
        (false, Some(blocker)) => {
            let lacks: Rgb = std::array::from_fn(|i| Number(node.throughput[i].0 * event.unoccluded[i].0));
            format!(" blocked by {blocker}, would have carried {}", rgb(lacks))
        }
        (false, None) => " blocked".to_owned(),
    }
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
            "weight" => format!("weight {} instead of {}", rgb(b.weight), rgb(a.weight)),
            "result" => format!("result {} instead of {}", rgb(b.result), rgb(a.result)),
            "throughput" | "origin" | "direction" | "t" => continue,
            key => key.to_owned(),
        });
    }
    if parts.is_empty() { keys.join(", ") } else { parts.join(", ") }
}

fn metres(node: &Node) -> String {
    node.t.map_or_else(|| "?".to_owned(), |t| format!("{} m", significant(t.0, 4)))
}

fn light_name(event: &Light) -> String {
    event.name.clone().unwrap_or_else(|| format!("light {}", event.index))
}

fn rgb(v: Rgb) -> String {
    triple(v.map(|v| v.0))
}
