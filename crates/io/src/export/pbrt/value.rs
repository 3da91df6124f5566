//! Parameters and their values.
use std::fmt::{Display, Write};

use durer_scene::{Data, Node, ValueType};

use crate::FileAssets;

/// Values on a line.
const PER_LINE: usize = 12;

/// A text in quotation marks.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            '\t' => quoted.push_str("\\t"),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// Appends the parameters of a node; returns what cannot be written.
pub(super) fn params(node: &Node, assets: &FileAssets, text: &mut String) -> Vec<String> {
    let mut refused = Vec::new();
    for param in node.params.iter() {
        let name = &param.name;
        if name.contains(|c: char| c.is_whitespace() || c == '"' || c == '\\') || name.is_empty() {
            refused.push(format!("a parameter is called \"{name}\""));
            continue;
        }
        let _ = write!(text, " \"{} {name}\" [", param.ty.word());
        match &param.data {
            Data::Bools(v) => list(v.iter(), text),
            Data::Ints(v) => list(v.iter(), text),
            Data::Floats(v) => {
                if v.iter().any(|v| !v.is_finite()) {
                    refused.push(format!("\"{name}\" has a number that is infinite or none"));
                }
                list(v.iter(), text);
            }
            Data::Strings(v) => {
                if let Some(file) = v.iter().find(|v| param.ty == ValueType::String && assets.is_embedded(v))
                {
                    refused.push(format!("\"{name}\" is the file {file}, which lies within the scene file"));
                }
                list(v.iter().map(|v| quoted(v)), text);
            }
        }
        text.push_str(" ]");
    }
    refused
}

fn list<T: Display>(values: impl Iterator<Item = T>, text: &mut String) {
    for (index, value) in values.enumerate() {
        text.push(if index > 0 && index.is_multiple_of(PER_LINE) { '\n' } else { ' ' });
        let _ = write!(text, "{value}");
    }
}
