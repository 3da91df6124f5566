//! Parameters and their values.
use std::fmt::{Display, Write};

use durer_scene::{Data, Node, ValueType};

use crate::export::beside::Gathered;

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
pub(super) fn params(node: &Node, gathered: &mut Gathered<'_>, text: &mut String) -> Vec<String> {
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
                // What is read from a file is a text or the name of a spectrum.
                let file = matches!(param.ty, ValueType::String | ValueType::Spectrum);
                let mut called = |v: &String| match gathered.path_of(v) {
                    Ok(path) => path.unwrap_or_else(|| v.clone()),
                    Err(why) => {
                        refused.push(format!("\"{name}\": {why}"));
                        v.clone()
                    }
                };
                let names = v.iter().map(|v| if file { called(v) } else { v.clone() });
                list(names.map(|name| quoted(&name)), text);
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
