//! The figures as curves: a panel for each scene, as its pictures are and after the blur.
use std::fmt::Write;

use durer::sampling::SamplerKind;

use crate::{Measured, noise::Noise};

/// Panels side by side.
const COLUMNS: usize = 3;
/// Of a panel with its margins.
const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 230.0;
/// Around the curves: left, top, right, bottom.
const MARGINS: [f64; 4] = [46.0, 26.0, 12.0, 30.0];
/// Above the panels.
const LEGEND: f64 = 34.0;

/// What tells the kinds apart: colours that differ for colour-blind eyes too (Okabe and Ito 2008), and dashes.
fn pen(kind: SamplerKind) -> (&'static str, &'static str) {
    match kind {
        SamplerKind::Independent => ("#666666", "2 3"),
        SamplerKind::Stratified => ("#e69f00", "6 3"),
        SamplerKind::Halton => ("#009e73", "8 2 2 2"),
        SamplerKind::PaddedSobol => ("#56b4e9", "none"),
        SamplerKind::Sobol => ("#cc79a7", "none"),
        _ => ("#d55e00", "none"),
    }
}

/// The figures as an SVG file.
pub(crate) fn svg(scenes: &[(&str, Vec<Measured>)]) -> String {
    let rows = scenes.len().div_ceil(COLUMNS);
    let (width, height) = (COLUMNS as f64 * WIDTH, LEGEND + 2.0 * rows as f64 * HEIGHT);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <title>Noise of each sampler</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    let kinds = scenes.first().map_or(&[][..], |(_, kinds)| kinds);
    for (i, measured) in kinds.iter().enumerate() {
        let x = MARGINS[0] + i as f64 * (width - MARGINS[0]) / kinds.len() as f64;
        let _ = writeln!(text, "{}", stroke(measured.kind, &[(x, 17.0), (x + 26.0, 17.0)]));
        let _ = writeln!(text, "<text x=\"{}\" y=\"21\">{}</text>", x + 32.0, measured.kind.word());
    }
    type Look = (&'static str, fn(&Noise) -> f64);
    let looks: [Look; 2] = [("", |n| n.sharp), (", blurred", |n| n.blurred)];
    for (part, (name, of)) in looks.into_iter().enumerate() {
        for (i, (scene, kinds)) in scenes.iter().enumerate() {
            let (column, row) = (i % COLUMNS, part * rows + i / COLUMNS);
            let (x, y) = (column as f64 * WIDTH, LEGEND + row as f64 * HEIGHT);
            let _ = writeln!(text, "<g transform=\"translate({x} {y})\">");
            panel(&mut text, &format!("{scene}{name}"), kinds, of);
            text.push_str("</g>\n");
        }
    }
    text.push_str("</svg>\n");
    text
}

/// The curves of a scene; one square of the grid is a factor of 10 up, of 4 across.
fn panel(text: &mut String, title: &str, kinds: &[Measured], of: fn(&Noise) -> f64) {
    let curves: Vec<(SamplerKind, Vec<(f64, f64)>)> = kinds
        .iter()
        .map(|m| {
            // A picture without any noise, such as of one sample through the middle of each pixel, has no place here.
            let noisy = m.noise.iter().filter(|(_, noise)| of(noise) > 1e-12);
            (m.kind, noisy.map(|(n, v)| (f64::from(*n).log2(), of(v).log10())).collect())
        })
        .collect();
    let points = || curves.iter().flat_map(|(_, curve)| curve);
    let right = points().map(|p| p.0).fold(2.0, f64::max);
    let bottom = points().map(|p| p.1).fold(0.0, f64::min).floor();
    let top = points().map(|p| p.1).fold(bottom + 1.0, f64::max).ceil();
    let [x0, y0, x1, y1] = [MARGINS[0], MARGINS[1], WIDTH - MARGINS[2], HEIGHT - MARGINS[3]];
    let at =
        |(x, y): (f64, f64)| (x0 + x / right * (x1 - x0), y1 - (y - bottom) / (top - bottom) * (y1 - y0));
    let _ = writeln!(text, "<text x=\"{x0}\" y=\"{}\" font-weight=\"bold\">{title}</text>", y0 - 8.0);
    for step in 0..=(right / 2.0) as u32 {
        let (x, _) = at((f64::from(2 * step), bottom));
        let _ = writeln!(text, "<path d=\"M{x:.1} {y0}V{y1}\" stroke=\"#dddddd\"/>");
        let (y, n) = (y1 + 15.0, 1u32 << (2 * step));
        let _ = writeln!(text, "<text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{n}</text>");
    }
    for power in bottom as i32..=top as i32 {
        let (_, y) = at((0.0, f64::from(power)));
        let _ = writeln!(text, "<path d=\"M{x0} {y:.1}H{x1}\" stroke=\"#dddddd\"/>");
        let (x, down) = (x0 - 5.0, y + 4.0);
        let _ = writeln!(text, "<text x=\"{x}\" y=\"{down:.1}\" text-anchor=\"end\">1e{power}</text>");
    }
    for (kind, curve) in &curves {
        let _ = writeln!(text, "{}", stroke(*kind, &curve.iter().map(|p| at(*p)).collect::<Vec<_>>()));
    }
}

/// A curve of a kind.
fn stroke(kind: SamplerKind, points: &[(f64, f64)]) -> String {
    let (color, dashes) = pen(kind);
    let places: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    format!(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.6\" stroke-dasharray=\"{dashes}\"/>",
        places.join(" ")
    )
}
