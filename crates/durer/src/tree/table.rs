//! The tree as a table: CSV for programs, Markdown for people.
use std::fmt::Write;

use super::{
    document::{Node, Tree},
    look::{Look, Wording, met, short, triple},
    number::{Number, Rgb},
};

const COLUMNS: &str = "sample,id,parent,kind,depth,object,side,origin_x,origin_y,origin_z,direction_x,direction_y,\
    direction_z,t,weight_r,weight_g,weight_b,throughput_r,throughput_g,throughput_b,local_r,local_g,local_b,\
    contribution_r,contribution_g,contribution_b,result_r,result_g,result_b,stop,lost_r,lost_g,lost_b,light,blocker,\
    boxes,primitives";

/// A line per ray, after a line of names; numbers carry every bit.
pub fn csv(trees: &[Tree]) -> String {
    let mut text = format!("{COLUMNS}\n");
    for tree in trees {
        for node in &tree.nodes {
            let _ = writeln!(text, "{}", row(tree, node));
        }
    }
    text
}

fn row(tree: &Tree, node: &Node) -> String {
    let three = |v: Rgb| v.map(number).join(",");
    let text = |v: &Option<String>| v.as_deref().map(field).unwrap_or_default();
    let light = node.light.as_ref().and_then(|l| l.name.clone());
    [
        format!("{},{}", tree.sample, node.id),
        node.parent.map(|p| p.to_string()).unwrap_or_default(),
        format!("{},{}", node.kind, node.depth),
        text(&node.object),
        text(&node.side),
        node.origin.map(|v| v.0.to_string()).join(","),
        three(node.direction),
        node.t.map(number).unwrap_or_default(),
        [node.weight, node.throughput, node.local, node.contribution, node.result].map(three).join(","),
        text(&node.stop),
        three(node.lost),
        text(&light),
        text(&node.blocker),
        format!("{},{}", node.tests.boxes, node.tests.primitives),
    ]
    .join(",")
}

fn number(v: Number) -> String {
    if v.0.is_finite() { v.0.to_string() } else { String::new() }
}

/// Quoted where it must be. A sign that spreadsheets take for a formula gets an apostrophe before it.
fn field(text: &str) -> String {
    let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    let text = if formula { format!("'{text}") } else { text.to_owned() };
    if text.contains(['"', ',', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
}

/// A heading and a nested list per tree.
pub fn markdown(trees: &[Tree]) -> String {
    let mut text = String::new();
    for tree in trees {
        let [x, y] = tree.pixel;
        let _ = writeln!(
            text,
            "## {}: pixel {x},{y}, sample {} of {}\n",
            plain(&tree.scene),
            tree.sample,
            tree.samples
        );
        let _ = writeln!(text, "Integrator {}, value {}.\n", tree.integrator, triple(tree.rgb));
        let mut levels = vec![0usize; tree.nodes.len()];
        let children = tree.children();
        let mut open: Vec<usize> = tree.nodes.iter().filter(|n| n.parent.is_none()).map(|n| n.id).collect();
        open.reverse();
        while let Some(id) = open.pop() {
            let Some(node) = tree.nodes.get(id) else { continue };
            let _ = writeln!(text, "{:indent$}- {}", "", item(node), indent = 2 * levels[id]);
            for &child in children[id].iter().rev() {
                levels[child] = levels[id] + 1;
                open.push(child);
            }
        }
        if let Some(diff) = &tree.diff {
            let _ = writeln!(text, "\n{}.", plain(&diff.summary));
        }
        text.push('\n');
    }
    text
}

fn item(node: &Node) -> String {
    let stop = node.stop.as_ref().map(|s| format!(", *{s}*")).unwrap_or_default();
    let t = node.t.map(|t| format!(" at {} m", short(t))).unwrap_or_default();
    let weight =
        if node.parent.is_some() { format!(", weight {}", triple(node.weight)) } else { String::new() };
    let letter = Look::of(&node.kind).letter;
    format!(
        "**{letter}** {}{t}{weight}, adds {}{stop}",
        plain(&met(node, Wording::Short)),
        triple(node.contribution)
    )
}

/// Without what Markdown would take for its own.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for c in text.chars() {
        if "\\`*_{}[]<>#|".contains(c) {
            plain.push('\\');
        }
        plain.push(if c.is_control() { ' ' } else { c });
    }
    plain
}
