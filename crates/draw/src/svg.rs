//! Drawings as SVG: a group per kind of line, a path per line.
use std::fmt::Write;

use durer_core::glam::DVec2;
use durer_render::film::Tile;

use crate::{Drawing, Kind, Line, Piece};

/// What lies under the lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Paper {
    /// Nothing.
    None,
    /// White.
    White,
    /// The colour of old paper.
    #[default]
    Cream,
}

impl Paper {
    /// All.
    pub const ALL: [Self; 3] = [Self::Cream, Self::White, Self::None];

    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::White => "white",
            Self::Cream => "cream",
        }
    }
    /// Of these, the colour as SVG has it.
    fn color(self) -> Option<&'static str> {
        match self {
            Self::None => None,
            Self::White => Some("#ffffff"),
            Self::Cream => Some("#f4ecd8"),
        }
    }
}

/// How a drawing looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Width of silhouettes in pixels; other lines are thinner.
    pub stroke: f64,
    /// What lies under them.
    pub paper: Paper,
}

/// Width of the lines of a kind, by that of silhouettes.
fn share(kind: Kind) -> f64 {
    match kind {
        Kind::Silhouette => 1.0,
        Kind::Boundary => 0.7,
        Kind::Crease => 0.55,
        Kind::Hatch => 0.45,
    }
}

/// A number to a hundredth, without zeros that say nothing.
fn number(text: &mut String, v: f64) {
    let start = text.len();
    // Writing to a string cannot fail.
    let _ = write!(text, "{v:.2}");
    let end = text.trim_end_matches('0').trim_end_matches('.').len();
    text.truncate(end);
    if &text[start..] == "-0" {
        text.replace_range(start.., "0");
    }
}

fn point(text: &mut String, p: DVec2) {
    text.push(' ');
    number(text, p.x);
    text.push(' ');
    number(text, p.y);
}

/// The data of a path.
fn path(line: &Line) -> String {
    let mut text = "M".to_owned();
    point(&mut text, line.start);
    for piece in &line.pieces {
        match piece {
            Piece::Line(end) => {
                text.push_str(" L");
                point(&mut text, *end);
            }
            Piece::Curve(points) => {
                text.push_str(" C");
                points.iter().for_each(|p| point(&mut text, *p));
            }
        }
    }
    if line.closed {
        text.push_str(" Z");
    }
    text
}

/// The text of an SVG file with a drawing called `title`.
pub fn svg(drawing: &Drawing, title: &str, style: &Style) -> String {
    let Tile { x0, y0, x1, y1 } = drawing.part;
    let (w, h) = (x1 - x0, y1 - y0);
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"{x0} {y0} {w} {h}\">\n\
         <title>{title}</title>\n"
    );
    let corner = if [x0, y0] == [0, 0] { String::new() } else { format!(" x=\"{x0}\" y=\"{y0}\"") };
    if let Some(color) = style.paper.color() {
        let _ = writeln!(text, "<rect id=\"paper\"{corner} width=\"{w}\" height=\"{h}\" fill=\"{color}\"/>");
    }
    text.push_str(
        "<g id=\"drawing\" fill=\"none\" stroke=\"#1d1712\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n",
    );
    // Thin lines below thick ones.
    let is_used = |kind: &Kind| *kind != Kind::Hatch || drawing.lines.iter().any(|line| line.kind == *kind);
    for kind in Kind::ALL.into_iter().rev().filter(is_used) {
        let mut width = String::new();
        number(&mut width, style.stroke * share(kind));
        let _ = writeln!(text, "<g id=\"{}\" stroke-width=\"{width}\">", kind.word());
        for line in drawing.lines.iter().filter(|line| line.kind == kind) {
            let _ = writeln!(text, "<path d=\"{}\"/>", path(line));
        }
        text.push_str("</g>\n");
    }
    text.push_str("</g>\n</svg>\n");
    text
}
