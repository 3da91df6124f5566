//! A drawing for paper: the tree as on the lecture's slide, and its rays on the picture.
mod layout;
mod project;

use std::fmt::Write;

use super::{
    document::{Node, Tree},
    look::{Look, Wording, met, short, triple},
    page::Page,
};
use layout::layout;

/// Between neighbours, in user units.
const ACROSS: f64 = 62.0;
/// Between parents and children.
const DOWN: f64 = 84.0;
/// Around everything.
const MARGIN: f64 = 36.0;
/// Radius of a node.
const RADIUS: f64 = 13.0;
/// Above each tree: its title.
const TITLE: f64 = 64.0;

/// A drawing of all trees of a page, one below the other; beside the first the picture with the rays, if the page has one.
pub fn svg(page: &Page) -> String {
    let mut body = String::new();
    let (mut width, mut y) = (0.0f64, MARGIN);
    for (number, tree) in page.trees.iter().enumerate() {
        let (drawn, size) = drawing(tree);
        let beside = if number == 0 { project::picture(page, tree) } else { None };
        let _ = writeln!(body, "<g transform=\"translate({MARGIN},{})\">\n{drawn}</g>", cut(y));
        let mut row = [size[0] + 2.0 * MARGIN, size[1]];
        if let Some((picture, [w, h])) = beside {
            let _ = writeln!(
                body,
                "<g transform=\"translate({},{})\">\n{picture}</g>",
                cut(row[0]),
                cut(y + TITLE)
            );
            row = [row[0] + w + MARGIN, row[1].max(TITLE + h)];
        }
        width = width.max(row[0]);
        y += row[1] + MARGIN;
    }
    let (width, height) = (cut(width.max(360.0)), cut(y));
    let title = page.trees.first().map(|t| escaped(&title(t))).unwrap_or_default();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica,Arial,sans-serif\" role=\"img\">\n\
         <title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    )
}

fn title(tree: &Tree) -> String {
    let [x, y] = tree.pixel;
    format!("{}, pixel {x},{y}, sample {} of {}", tree.scene, tree.sample, tree.samples)
}

/// A tree with its title, and its size.
fn drawing(tree: &Tree) -> (String, [f64; 2]) {
    let children = tree.children();
    let across = layout(&children);
    let levels = levels(tree);
    let at = |id: usize| [across[id] * ACROSS + RADIUS + 14.0, TITLE + 20.0 + levels[id] as f64 * DOWN];
    let mut text = format!(
        "<text y=\"14\" font-size=\"16\" font-weight=\"bold\">{}</text>\n<text y=\"34\" font-size=\"12\" fill=\"#444\">{}</text>\n",
        escaped(&title(tree)),
        escaped(&format!(
            "{}: {}; {} rays{}",
            tree.integrator,
            triple(tree.rgb),
            tree.nodes.len(),
            cut_off(tree)
        ))
    );
    let mut numbers = vec![0usize; tree.nodes.len()];
    let mut count = 0;
    for node in tree.nodes.iter().filter(|n| n.object.is_some()) {
        count += 1;
        numbers[node.id] = count;
    }
    for node in tree.nodes.iter().filter(|n| n.parent.is_some()) {
        let parent = node.parent.unwrap_or_default() as usize;
        edge(&mut text, node, at(parent), at(node.id), numbers[parent]);
    }
    for node in &tree.nodes {
        circle(&mut text, node, at(node.id), numbers[node.id]);
    }
    let right = (0..tree.nodes.len()).map(|id| at(id)[0]).fold(320.0, f64::max);
    let bottom = (0..tree.nodes.len()).map(|id| at(id)[1]).fold(TITLE, f64::max);
    (text, [right + RADIUS + 40.0, bottom + 46.0])
}

/// What was given up, if something was.
fn cut_off(tree: &Tree) -> String {
    match tree.killed.iter().any(|v| v.0 > 0.0) {
        true => format!("; given up: {} of the pixel", triple(tree.killed)),
        false => String::new(),
    }
}

/// Distance of every node from the root.
fn levels(tree: &Tree) -> Vec<usize> {
    let mut levels = vec![0; tree.nodes.len()];
    for (id, node) in tree.nodes.iter().enumerate() {
        if let Some(&above) = node.parent.and_then(|p| levels.get(p as usize)) {
            levels[id] = above + 1;
        }
    }
    levels
}

/// The ray from parent to child with its letter, numbered as the surface that it leaves.
fn edge(text: &mut String, node: &Node, a: [f64; 2], b: [f64; 2], number: usize) {
    let look = Look::of(&node.kind);
    let dashes =
        if look.dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", look.dashes) };
    let faint = if node.is_untraced() { " opacity=\"0.45\"" } else { "" };
    // Width by the share in the pixel, as far as can be told apart.
    let share = node.throughput.iter().map(|v| v.0).filter(|v| v.is_finite()).fold(0.0, f32::max);
    let stroke = 0.8 + 2.2 * f64::from(share.clamp(0.0, 1.0)).sqrt();
    let _ = writeln!(
        text,
        "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"{}\"{dashes}{faint}/>",
        cut(a[0]),
        cut(a[1] + RADIUS),
        cut(b[0]),
        cut(b[1] - RADIUS),
        look.color,
        cut(stroke)
    );
    let (x, y) = (a[0] + 0.62 * (b[0] - a[0]), a[1] + 0.62 * (b[1] - a[1]) + 4.0);
    let prime = if node.kind.starts_with("glossy") { "&#8242;" } else { "" };
    let _ = writeln!(
        text,
        "<text x=\"{}\" y=\"{}\" font-size=\"12\" font-style=\"italic\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"3\" \
         paint-order=\"stroke\" text-anchor=\"middle\">{}{prime}<tspan font-size=\"8\" dy=\"3\">{number}</tspan></text>",
        cut(x),
        cut(y),
        look.color,
        look.letter
    );
}

/// What the ray met: a surface with its normal's number, a light, nothing; and below it why nothing follows.
fn circle(text: &mut String, node: &Node, [x, y]: [f64; 2], number: usize) {
    let look = Look::of(&node.kind);
    let title = format!(
        "{} {}, weight {}, adds {}, result {}",
        node.id,
        met(node, Wording::Short),
        triple(node.weight),
        triple(node.contribution),
        triple(node.result)
    );
    let _ = writeln!(text, "<g><title>{}</title>", escaped(&title));
    let fill = if node.light.as_ref().is_some_and(|l| l.visible) { "#fff3b0" } else { "#ffffff" };
    let dashes = if node.is_untraced() { " stroke-dasharray=\"3 2\"" } else { "" };
    let radius = if number > 0 { RADIUS } else { RADIUS * 0.6 };
    let _ = writeln!(
        text,
        "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{fill}\" stroke=\"{}\" stroke-width=\"1.5\"{dashes}/>",
        cut(x),
        cut(y),
        cut(radius),
        look.color
    );
    if number > 0 {
        let _ = writeln!(
            text,
            "<text x=\"{}\" y=\"{}\" font-size=\"12\" font-style=\"italic\" text-anchor=\"middle\">N<tspan font-size=\"8\" dy=\"3\">{number}</tspan></text>",
            cut(x),
            cut(y + 4.0)
        );
    }
    let mut line = y + RADIUS + 10.0;
    let light = node.light.as_ref().and_then(|l| l.name.clone());
    let stop = node.stop.as_deref().filter(|s| *s != "hit-light" && *s != "opaque-no-children");
    let below = [node.object.clone().or(light), stop.map(|s| s.replace('-', " "))];
    for (index, words) in below.into_iter().flatten().enumerate() {
        let color = if index == 0 { "#333" } else { "#8a4b00" };
        for part in wrapped(&words, 11) {
            let _ = writeln!(
                text,
                "<text x=\"{}\" y=\"{}\" font-size=\"8\" fill=\"{color}\" stroke=\"#fff\" stroke-width=\"2.5\" paint-order=\"stroke\" text-anchor=\"middle\">{}</text>",
                cut(x),
                cut(line),
                escaped(&part)
            );
            line += 9.0;
        }
    }
    if node.parent.is_none() {
        let _ = writeln!(
            text,
            "<text x=\"{}\" y=\"{}\" font-size=\"11\" fill=\"{}\" text-anchor=\"middle\">eye ({})</text>",
            cut(x),
            cut(y - RADIUS - 6.0),
            look.color,
            short(node.result[1])
        );
    }
    text.push_str("</g>\n");
}

/// Words in lines of about so many letters, three lines at most.
fn wrapped(words: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    if lines.len() > 3 {
        lines.truncate(3);
        lines[2].push('…');
    }
    lines
}

/// A length with two decimals at most.
fn cut(v: f64) -> String {
    let text = format!("{v:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// As XML takes it; what it does not allow becomes a question mark.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push('?'),
            c => escaped.push(c),
        }
    }
    escaped
}
