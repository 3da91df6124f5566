//! The figures as tables or as JSON.
use std::fmt::Write;

use crate::{
    embree::Quality,
    ours::{Isa, Mode, Preset},
    ratio::{Quartiles, geometric_mean},
    rays::Class,
};
use serde_json::{Value, json};

/// Who is compared with Embree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// Our kernel.
    Ours(Isa),
    /// The crate of that name.
    Obvhs,
}

impl Who {
    fn name(self) -> &'static str {
        match self {
            Self::Ours(isa) => isa.name(),
            Self::Obvhs => "obvhs",
        }
    }

    /// The geometric means over scenes that we want, by class.
    fn wanted(self) -> Option<[f64; 4]> {
        match self {
            Self::Ours(Isa::Avx512) => Some([1.35, 1.25, 1.25, 1.3]),
            Self::Ours(Isa::Avx2) => Some([1.2, 1.15, 1.1, 1.2]),
            _ => None,
        }
    }
}

/// What every scene should reach, by class, with vector instructions.
const WANTED_ANYWHERE: [f64; 4] = [1.1, 1.1, 1.05, 1.1];

/// Rays of a kind in a scene.
pub struct Cell {
    /// Its name.
    pub scene: String,
    /// The kind.
    pub class: Class,
    /// Who traced them.
    pub who: Who,
    /// Chunks at a time.
    pub threads: usize,
    /// Of the kernels.
    pub mode: Mode,
    /// Rays per second by those of Embree.
    pub ratio: Quartiles,
    /// By processor time, all runs together.
    pub rays_per_second: f64,
    /// The same of Embree.
    pub embree_rays_per_second: f64,
    /// How many there are.
    pub rays: usize,
    /// How many of them have another result than with Embree.
    pub differing_hits: usize,
}

/// Builds of a scene. Ratios are of triangles per second, ours by Embree's.
pub struct BuildRow {
    /// Its name.
    pub scene: String,
    /// Ours.
    pub preset: Preset,
    /// Embree's.
    pub quality: Quality,
    /// Median over runs, by the clock on the wall.
    pub ratio: f64,
    /// By processor time.
    pub ratio_cpu: f64,
    /// Of the fastest run.
    pub triangles_per_second: f64,
    /// The same of Embree.
    pub embree_triangles_per_second: f64,
    /// Memory held.
    pub bytes_per_triangle: f64,
    /// The same of Embree.
    pub embree_bytes_per_triangle: f64,
}

/// All that was measured.
#[derive(Default)]
pub struct Report {
    /// Pixels along an edge of the picture.
    pub edge: u32,
    /// How often everything was timed.
    pub runs: usize,
    /// In the order they were measured.
    pub cells: Vec<Cell>,
    /// The same.
    pub builds: Vec<BuildRow>,
    /// Scenes whose files are not there.
    pub missing: Vec<String>,
}

/// Cells of which a mean over scenes is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Group {
    who: Who,
    mode: Mode,
    threads: usize,
}

impl Report {
    fn groups(&self) -> Vec<Group> {
        let mut groups = Vec::new();
        for Cell { who, mode, threads, .. } in &self.cells {
            let group = Group { who: *who, mode: *mode, threads: *threads };
            if !groups.contains(&group) {
                groups.push(group);
            }
        }
        groups
    }

    fn of(&self, group: Group, class: Class) -> impl Iterator<Item = &Cell> {
        self.cells.iter().filter(move |cell| {
            let own = Group { who: cell.who, mode: cell.mode, threads: cell.threads };
            own == group && cell.class == class
        })
    }

    fn means(&self, group: Group) -> [f64; 4] {
        Class::ALL.map(|class| geometric_mean(self.of(group, class).map(|cell| cell.ratio.median)))
    }

    /// For people.
    pub fn as_tables(&self) -> String {
        let mut text = String::new();
        for group in self.groups() {
            self.table(group, &mut text);
        }
        self.build_table(&mut text);
        for scene in &self.missing {
            _ = writeln!(text, "{scene} was left out: its file is not there");
        }
        text
    }

    fn table(&self, group: Group, text: &mut String) {
        let Group { who, mode, threads } = group;
        let threads = if threads == 1 { "one thread".to_owned() } else { format!("{threads} threads") };
        _ = writeln!(text, "{}, {}, {threads}: rays per second by Embree's", who.name(), mode.name());
        _ = write!(text, "{:<10}", "");
        for class in Class::ALL {
            _ = write!(text, " {:>26}", class.name());
        }
        _ = writeln!(text, " {:>10}", "differing");
        let mut scenes: Vec<&str> = self.cells.iter().map(|cell| cell.scene.as_str()).collect();
        scenes.dedup();
        for scene in scenes {
            self.row(group, scene, text);
        }
        let means = self.means(group);
        _ = write!(text, "{:<10}", "mean");
        means.iter().for_each(|mean| _ = write!(text, " {mean:>26.3}"));
        text.push('\n');
        if let Some(wanted) = who.wanted() {
            _ = write!(text, "{:<10}", "wanted");
            for (mean, wanted) in means.iter().zip(wanted) {
                let verdict = if *mean >= wanted { "reached" } else { "not reached" };
                _ = write!(text, " {:>26}", format!("{verdict} {wanted:.2}"));
            }
            text.push('\n');
        }
        text.push('\n');
    }

    /// A ratio, its quartiles, our millions of rays per second; `!` marks what is below what any scene should reach.
    fn row(&self, group: Group, scene: &str, text: &mut String) {
        let cell = |class| self.of(group, class).find(|cell| cell.scene == scene);
        let cells = Class::ALL.map(cell);
        if cells.iter().all(Option::is_none) {
            return;
        }
        _ = write!(text, "{scene:<10}");
        for (cell, wanted) in cells.iter().zip(WANTED_ANYWHERE) {
            let figures = cell.map_or("-".to_owned(), |cell| {
                let Quartiles { q1, median, q3 } = cell.ratio;
                let below = if group.who.wanted().is_some() && median < wanted { "!" } else { "" };
                format!("{below}{median:.2} ({q1:.2}..{q3:.2}) {:5.2} M/s", cell.rays_per_second * 1e-6)
            });
            _ = write!(text, " {figures:>26}");
        }
        let differing: usize = cells.iter().flatten().map(|cell| cell.differing_hits).sum();
        _ = writeln!(text, " {differing:>10}");
    }

    fn build_table(&self, text: &mut String) {
        if self.builds.is_empty() {
            return;
        }
        _ = writeln!(text, "Builds with two threads: triangles per second by Embree's");
        let heads = ["ours", "Embree's", "ratio", "by CPU", "M tri/s", "Embree", "B/tri", "Embree"];
        _ = write!(text, "{:<10}", "");
        heads.iter().for_each(|head| _ = write!(text, " {head:>9}"));
        text.push('\n');
        for row in &self.builds {
            _ = write!(text, "{:<10} {:>9} {:>9}", row.scene, row.preset.name(), row.quality.name());
            let rates = [row.triangles_per_second * 1e-6, row.embree_triangles_per_second * 1e-6];
            for figure in [row.ratio, row.ratio_cpu].into_iter().chain(rates) {
                _ = write!(text, " {figure:>9.2}");
            }
            _ = writeln!(text, " {:>9.1} {:>9.1}", row.bytes_per_triangle, row.embree_bytes_per_triangle);
        }
        text.push('\n');
    }

    /// For programs. `docs/benchmarks.md` says what the keys mean.
    pub fn as_value(&self) -> Value {
        let (obvhs, ours): (Vec<&Cell>, Vec<&Cell>) =
            self.cells.iter().partition(|cell| cell.who == Who::Obvhs);
        let cells = |cells: &[&Cell]| cells.iter().map(|cell| cell_value(cell)).collect::<Vec<_>>();
        let means = self.groups().into_iter().flat_map(|group| {
            let wanted = group.who.wanted();
            let means = self.means(group);
            Class::ALL.into_iter().enumerate().map(move |(i, class)| {
                json!({
                    "isa": group.who.name(), "mode": group.mode.name(), "threads": group.threads,
                    "class": class.name(), "ratio": means[i], "wanted": wanted.map(|wanted| wanted[i]),
                })
            })
        });
        json!({
            "version": 1, "edge": self.edge, "runs": self.runs, "missing_scenes": self.missing,
            "cells": cells(&ours), "geometric_means": means.collect::<Vec<_>>(), "obvhs": cells(&obvhs),
            "build": self.builds.iter().map(build_value).collect::<Vec<_>>(),
        })
    }
}

fn cell_value(cell: &Cell) -> Value {
    json!({
        "scene": cell.scene, "class": cell.class.name(), "isa": cell.who.name(), "threads": cell.threads,
        "mode": cell.mode.name(), "ratio_median": cell.ratio.median, "q1": cell.ratio.q1, "q3": cell.ratio.q3,
        "differing_hits": cell.differing_hits, "rays": cell.rays,
        "mrays_per_second": cell.rays_per_second * 1e-6,
        "embree_mrays_per_second": cell.embree_rays_per_second * 1e-6,
    })
}

fn build_value(row: &BuildRow) -> Value {
    json!({
        "scene": row.scene, "preset": row.preset.name(), "embree_quality": row.quality.name(),
        "ratio": row.ratio, "ratio_cpu": row.ratio_cpu,
        "bytes_per_triangle": row.bytes_per_triangle,
        "embree_bytes_per_triangle": row.embree_bytes_per_triangle,
        "mtriangles_per_second": row.triangles_per_second * 1e-6,
        "embree_mtriangles_per_second": row.embree_triangles_per_second * 1e-6,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(scene: &str, who: Who, ratio: f64) -> Cell {
        Cell {
            scene: scene.to_owned(),
            class: Class::Diffuse1,
            who,
            threads: 2,
            mode: Mode::Robust,
            ratio: Quartiles { q1: ratio - 0.1, median: ratio, q3: ratio + 0.1 },
            rays_per_second: ratio * 2e6,
            embree_rays_per_second: 2e6,
            rays: 1000,
            differing_hits: 3,
        }
    }

    fn report() -> Report {
        let who = Who::Ours(Isa::Avx2);
        let cells = vec![cell("hall", who, 1.0), cell("hall", Who::Obvhs, 0.5), cell("ball", who, 1.44)];
        let build = BuildRow {
            scene: "hall".to_owned(),
            preset: Preset::High,
            quality: Quality::High,
            ratio: 1.5,
            ratio_cpu: 1.25,
            triangles_per_second: 3e6,
            embree_triangles_per_second: 2e6,
            bytes_per_triangle: 70.0,
            embree_bytes_per_triangle: 80.0,
        };
        Report { cells, builds: vec![build], missing: vec!["cave".to_owned()], ..Report::default() }
    }

    #[test]
    fn programs_find_cells_means_and_builds() {
        let value = report().as_value();
        let cells = value["cells"].as_array().expect("a list");
        assert_eq!(cells.len(), 2);
        assert_eq!((&cells[1]["scene"], &cells[1]["isa"]), (&json!("ball"), &json!("avx2")));
        assert_eq!((&cells[1]["mode"], &cells[1]["threads"]), (&json!("robust"), &json!(2)));
        assert_eq!(cells[0]["mrays_per_second"], 2.0);
        assert_eq!(value["obvhs"][0]["ratio_median"], 0.5);
        let means = value["geometric_means"].as_array().expect("a list");
        let mean = means.iter().find(|mean| mean["class"] == "diffuse1" && mean["isa"] == "avx2");
        let mean = mean.expect("a mean of what was measured");
        assert!((mean["ratio"].as_f64().expect("a number") - 1.2).abs() < 1e-9 && mean["wanted"] == 1.15);
        assert_eq!(value["build"][0]["embree_quality"], "high");
        assert_eq!(value["missing_scenes"][0], "cave");
    }

    #[test]
    fn people_see_what_is_below_and_what_is_reached() {
        let tables = report().as_tables();
        assert!(tables.contains("avx2, robust, 2 threads"), "{tables}");
        assert!(tables.contains("!1.00 (0.90..1.10)") && tables.contains(" 1.44 (1.34..1.54)"), "{tables}");
        assert!(tables.contains(" reached 1.15") && tables.contains("cave was left out"), "{tables}");
        assert!(!tables.contains("!0.50"), "{tables}");
    }
}
