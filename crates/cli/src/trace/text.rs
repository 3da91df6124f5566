//! The ray tree to read.
use std::fmt::Write;

use durer::{
    probe::{LightEvent, RayKind, TreeHit, TreeNode},
    spectrum::{Basis, Spectrum},
};

use super::Traced;
use crate::number::{pixel_line, significant, triple};

/// The tree, a ray per line, children indented below; then `pixel R G B`.
pub(super) fn tree(traced: &Traced<'_>) -> String {
    let Traced { scene, prepared, pixel, sample, rgb, tree } = traced;
    let mut text = format!(
        "{scene}, {}, pixel {},{}, sample {sample} of {}\n",
        prepared.integrator_name, pixel[0], pixel[1], prepared.settings.samples,
    );
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); tree.nodes.len()];
    let mut open = Vec::new();
    for (index, node) in tree.nodes.iter().enumerate() {
        match node.parent.and_then(|p| children.get_mut(p as usize)) {
            Some(siblings) => siblings.push(index),
            None => open.push((index, 0)),
        }
    }
    open.reverse();
    // A stack of our own: deep trees must not end in a stack overflow.
    while let Some((index, level)) = open.pop() {
        let (Some(node), Some(below)) = (tree.nodes.get(index), children.get(index)) else {
            continue;
        };
        let _ = writeln!(text, "{:indent$}{}", "", line(traced, node), indent = 2 * level);
        open.extend(below.iter().rev().map(|&child| (child, level + 1)));
    }
    text + &pixel_line(*rgb) + "\n"
}

fn line(traced: &Traced<'_>, node: &TreeNode) -> String {
    let mut parts = vec![met(traced, node)];
    let reason = node.stop.map(|s| s.word());
    match node.stop.filter(|s| s.is_untraced()) {
        Some(_) => {
            parts.push(format!("weight {}", rgb(node.weight)));
            parts.push(format!("would have carried {} of the pixel", rgb(node.lost)));
        }
        None => {
            if node.kind != RayKind::Eye {
                parts.push(format!("weight {}", rgb(node.weight)));
            }
            parts.push(format!("adds {}", rgb(node.contribution())));
            if node.kind != RayKind::Shadow {
                parts.push(format!("result {}", rgb(node.result)));
            }
        }
    }
    parts.extend(reason.map(|r| format!("[{r}]")));
    parts.join(", ")
}

/// What the ray is for and what became of it.
fn met(traced: &Traced<'_>, node: &TreeNode) -> String {
    let kind = node.kind.word();
    if node.stop.is_some_and(|s| s.is_untraced()) {
        return format!("{kind} not traced");
    }
    match (&node.hit, &node.light) {
        (_, Some(event)) => format!("{kind} to {}{}", light_name(traced, event), fate(traced, node, event)),
        (Some(hit), None) => {
            let side = if hit.from_outside { "outside" } else { "inside" };
            format!("{kind} hits {} ({side}) at {}", object_name(traced, hit), metres(node))
        }
        (None, None) => format!("{kind} leaves the scene"),
    }
}

fn fate(traced: &Traced<'_>, node: &TreeNode, event: &LightEvent) -> String {
    match (event.visible, event.blocker) {
        (true, _) if event.point.is_some() => format!(" at {}", metres(node)),
        (true, _) => String::new(),
        (false, Some(blocker)) => {
            let lacks = triple(Basis::Rgb.to_rgb(node.throughput * event.unoccluded));
            format!(" blocked by {}, would have carried {lacks}", traced.prepared.scene.object(blocker).name)
        }
        (false, None) => " blocked".to_owned(),
    }
}

fn metres(node: &TreeNode) -> String {
    node.length().map_or_else(|| "?".to_owned(), |t| format!("{} m", significant(t, 4)))
}

fn object_name<'a>(traced: &Traced<'a>, hit: &TreeHit) -> &'a str {
    &traced.prepared.scene.object(hit.object).name
}

fn light_name(traced: &Traced<'_>, event: &LightEvent) -> String {
    let name = traced.prepared.scene.light_names.get(event.light as usize);
    name.cloned().unwrap_or_else(|| format!("light {}", event.light))
}

fn rgb(s: Spectrum) -> String {
    triple(Basis::Rgb.to_rgb(s))
}
