//! `docs/assets.md`: a table per format.
use std::{fmt::Write, thread};

use super::{Options, Outcome, THUMBNAIL, Tried, USUAL, trial::SAMPLES};

/// Warnings that are quoted before the rest is counted.
const QUOTED: usize = 2;

/// The whole page.
pub(super) fn text(groups: &[(String, Vec<Tried>)], options: &Options) -> String {
    let mut text = String::from("# Every model of the test files\n\n");
    let _ = write!(
        text,
        "Written by `{}` on {}. Pictures are drawn {} pixels wide with {SAMPLES} samples per pixel and shown smaller. \
         *load* is reading and parsing, *build* decoding images and building trees, *render* drawing with rays \
         counted. Triangles of shared meshes count as often as they are placed. Models without a camera or a light \
         are framed and lit by the program. The models are not ours: each row names the licence and the source, under \
         which its thumbnail stands too.\n\n",
        command(options),
        machine(),
        options.width
    );
    text.push_str("| format | files | drawn | refused |\n|---|---|---|---|\n");
    for (format, tried) in groups {
        let drawn = tried.iter().filter(|t| matches!(t.outcome, Outcome::Drawn { .. })).count();
        let _ = writeln!(text, "| {format} | {} | {drawn} | {} |", tried.len(), tried.len() - drawn);
    }
    for (format, tried) in groups {
        let _ = write!(text, "\n## {format}\n\n");
        text.push_str("| picture | file | triangles | load ms | build ms | render s | what was said | licence, source |\n");
        text.push_str("|---|---|---:|---:|---:|---:|---|---|\n");
        tried.iter().for_each(|one| text.push_str(&row(one)));
    }
    text
}

/// The command that writes this page, without the folder, which is different elsewhere.
fn command(options: &Options) -> String {
    let mut command = "cargo xtask assets".to_owned();
    if options.formats != USUAL {
        let _ = write!(command, " --formats {}", options.formats.join(","));
    }
    if options.width != 320 {
        let _ = write!(command, " --width {}", options.width);
    }
    command
}

/// What kind of machine this is.
fn machine() -> String {
    let cores = thread::available_parallelism().map_or(1, |n| n.get());
    format!("{} {} with {cores} processor threads", std::env::consts::OS, std::env::consts::ARCH)
}

fn row(one: &Tried) -> String {
    let picture = match &one.thumbnail {
        Some(name) => format!("<img src=\"assets/{name}\" width=\"{THUMBNAIL}\" alt=\"{}\">", one.model.file),
        None => "none".to_owned(),
    };
    let credit = one.model.credit.as_deref().unwrap_or("not named");
    let file = one.model.file.split_once('/').map_or(one.model.file.as_str(), |(_, rest)| rest);
    let [picture, file, credit] = [&picture, file, credit].map(cell);
    match &one.outcome {
        Outcome::Drawn { triangles, load, build, render, warnings } => {
            let said = cell(&said(warnings));
            let (load, build) = (milliseconds(*load), milliseconds(*build));
            format!(
                "| {picture} | {file} | {triangles} | {load} | {build} | {render:.2} | {said} | {credit} |\n"
            )
        }
        Outcome::Refused(reason) => {
            format!("| {picture} | {file} | | | | | **refused**: {} | {credit} |\n", cell(reason))
        }
    }
}

fn said(warnings: &[String]) -> String {
    let mut said = warnings.iter().take(QUOTED).cloned().collect::<Vec<_>>().join("; ");
    if warnings.len() > QUOTED {
        let _ = write!(said, "; and {} more warnings", warnings.len() - QUOTED);
    }
    said
}

fn milliseconds(seconds: f64) -> String {
    let ms = 1e3 * seconds;
    if ms < 10.0 { format!("{ms:.1}") } else { format!("{ms:.0}") }
}

/// As a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::corpus::Model;

    fn tried(outcome: Outcome, thumbnail: Option<&str>) -> Tried {
        let model = Model { file: "ply/a b.ply".to_owned(), credit: Some("CC0; here".to_owned()) };
        Tried { model, outcome, thumbnail: thumbnail.map(str::to_owned), picture: None }
    }

    #[test]
    fn rows_have_as_many_cells_as_the_head() {
        let warnings = ["one|two", "three", "four"].map(str::to_owned).to_vec();
        let drawn = Outcome::Drawn { triangles: 7, load: 0.0012, build: 0.5, render: 1.25, warnings };
        let row = row(&tried(drawn, Some("ply-a-b.ply.png")));
        assert!(row.contains(
            "| a b.ply | 7 | 1.2 | 500 | 1.25 | one\\|two; three; and 1 more warnings | CC0; here |"
        ));
        assert!(row.contains("src=\"assets/ply-a-b.ply.png\""));
        let refused = super::row(&tried(Outcome::Refused("ends\nearly".to_owned()), None));
        assert_eq!(refused, "| none | a b.ply | | | | | **refused**: ends early | CC0; here |\n");
        for row in [row.replace("\\|", ""), refused] {
            assert_eq!(row.matches('|').count(), 9, "{row}");
        }
    }

    #[test]
    fn the_page_counts_and_says_how_it_was_written() {
        let options = Options::parse(&["--formats", "ply", "--width", "400"]).expect("good options");
        let groups = vec![("ply".to_owned(), vec![tried(Outcome::Refused("empty".to_owned()), None)])];
        let page = text(&groups, &options);
        assert!(page.contains("`cargo xtask assets --formats ply --width 400`"));
        assert!(page.contains("| ply | 1 | 0 | 1 |") && page.contains("\n## ply\n"));
    }
}
