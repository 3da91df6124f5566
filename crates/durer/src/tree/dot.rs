//! The tree as a graph in the language of Graphviz.
use std::fmt::Write;

use super::{
    document::{Node, Tree},
    look::{Look, Wording, met, triple},
};

/// A `digraph`, a ray per node, for `dot -Tsvg`.
pub fn dot(trees: &[Tree]) -> String {
    let mut text = String::from(
        "digraph rays {\n  rankdir=TB; node [shape=box, style=rounded, fontname=\"sans-serif\", fontsize=10];\n  edge [fontname=\"sans-serif\", fontsize=10];\n",
    );
    for (number, tree) in trees.iter().enumerate() {
        let [x, y] = tree.pixel;
        let title = format!(
            "{}, {}, pixel {x},{y}, sample {} of {}",
            tree.scene, tree.integrator, tree.sample, tree.samples
        );
        let _ = writeln!(text, "  subgraph cluster_{number} {{\n    label={};", quoted(&title));
        for node in &tree.nodes {
            let color = Look::of(&node.kind).color;
            let dashed = if node.is_untraced() { ", style=\"rounded,dashed\"" } else { "" };
            let _ = writeln!(
                text,
                "    t{number}n{} [label={}, color=\"{color}\"{dashed}];",
                node.id,
                quoted(&label(node))
            );
            if let Some(parent) = node.parent {
                let letter = Look::of(&node.kind).letter;
                let weight = format!("{letter}  {}", triple(node.weight));
                let _ = writeln!(
                    text,
                    "    t{number}n{parent} -> t{number}n{} [label={}, color=\"{color}\", fontcolor=\"{color}\"];",
                    node.id,
                    quoted(&weight)
                );
            }
        }
        text.push_str("  }\n");
    }
    text + "}\n"
}

fn label(node: &Node) -> String {
    let stop = node.stop.as_ref().map(|s| format!("\n[{s}]")).unwrap_or_default();
    format!("{} {}\nadds {}{stop}", node.id, met(node, Wording::Short), triple(node.contribution))
}

/// A quoted string of the language: what looks like a command in it is none.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            c if c.is_control() => quoted.push('?'),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
