//! How rays look and what they are called, the same in every drawing: the lecture's letters and colours.
use super::{
    document::{Light, Node},
    number::{Number, Rgb},
};

/// Letter, colour and dashes of a kind of ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The lecture's letter: L for shadow rays, R for reflected, T for transmitted ones.
    pub letter: &'static str,
    /// As HTML writes colours: the lecture's grey, green, red and blue, dark enough for paper.
    pub color: &'static str,
    /// The same as linear RGB.
    pub linear: [f32; 3],
    /// Dashes in the order of SVG; empty for a full line. Kinds can be told without colours.
    pub dashes: &'static str,
}

impl Look {
    /// Of a kind of ray, by its word.
    pub fn of(kind: &str) -> Self {
        let (letter, color, linear, dashes) = match kind {
            "eye" => ("E", "#6f6f6f", [0.7, 0.7, 0.7], ""),
            "shadow" => ("L", "#1a8f1a", [0.1, 0.9, 0.1], "2 3"),
            "reflection" | "glossy-reflection" => ("R", "#d01c1c", [0.9, 0.1, 0.1], ""),
            "refraction" | "glossy-refraction" => ("T", "#1c3fd0", [0.1, 0.1, 0.9], "7 3"),
            "connection" => ("C", "#a08c14", [0.8, 0.7, 0.1], "4 2 1 2"),
            "photon" => ("F", "#b48c14", [0.9, 0.7, 0.1], "1 2"),
            "passing" => ("P", "#8a6d3b", [0.6, 0.45, 0.2], "1 3"),
            _ => ("?", "#7a3b8a", [0.5, 0.2, 0.6], "7 3 2 3"),
        };
        Self { letter, color, linear, dashes }
    }
}

/// How much is said of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wording {
    /// What it met.
    Short,
    /// And from which side, how far away, and how much light was kept back.
    Full,
}

/// What became of a ray, in words.
pub fn met(node: &Node, wording: Wording) -> String {
    let kind = &node.kind;
    if node.is_untraced() {
        return format!("{kind} not traced");
    }
    let full = |text: String| if wording == Wording::Full { text } else { String::new() };
    let metres = || node.t.map_or_else(|| "?".to_owned(), |t| format!("{} m", short(t)));
    if let Some(light) = &node.light {
        let name = light.words();
        return match (&node.blocker, light.visible) {
            (_, true) if light.point.is_some() => {
                format!("{kind} to {name}{}", full(format!(" at {}", metres())))
            }
            (_, true) => format!("{kind} to {name}"),
            (Some(blocker), false) => {
                let lacks = std::array::from_fn(|i| Number(node.throughput[i].0 * light.unoccluded[i].0));
                let lacks = full(format!(", would have added {}", triple(lacks)));
                format!("{kind} to {name}, blocked by {blocker}{lacks}")
            }
            (None, false) => format!("{kind} to {name}, blocked"),
        };
    }
    match &node.object {
        Some(object) => {
            let side = node.side.as_deref().unwrap_or("?");
            format!("{kind} hits {object}{}", full(format!(" ({side}) at {}", metres())))
        }
        None => format!("{kind} leaves the scene"),
    }
}

impl Light {
    /// What it is called: its name, or its number.
    pub fn words(&self) -> String {
        self.name.clone().unwrap_or_else(|| format!("light {}", self.index))
    }
}

/// A number for people: four significant digits.
pub fn short(v: Number) -> String {
    if !v.0.is_finite() {
        // Which of them it was is lost where a document is read: all are null there.
        return "not finite".to_owned();
    }
    let rounded: f64 = format!("{:.3e}", v.0).parse().unwrap_or_default();
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// Three numbers for people; one if they are equal.
pub fn triple(v: Rgb) -> String {
    if v[0] == v[1] && v[1] == v[2] { short(v[0]) } else { v.map(short).join(" ") }
}
