//! `cargo xtask bench load`: how long scenes take from their files to a tree that can be rendered, beside other renderers.
//! Figures only: nothing is asserted.
mod peer;
mod report;

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, bail};
use serde_json::{Value, json};

use self::peer::Peers;
use super::built;
use crate::{measure::measure, release_program, target_folder};

/// Threads that durer reads with.
const THREADS: [usize; 2] = [1, 2];

/// A scene: what it is called, our file, and the same for Mitsuba and for pbrt where they read it.
struct Scene {
    name: &'static str,
    ours: &'static str,
    mitsuba: Option<&'static str>,
    pbrt: Option<&'static str>,
}

/// A million triangles in every format, which the benchmark writes.
const HILLS: [Scene; 6] = [
    Scene { name: "OBJ", ours: "hills.obj", mitsuba: Some("hills-obj.xml"), pbrt: None },
    Scene { name: "PLY, text", ours: "hills-text.ply", mitsuba: Some("hills-text.xml"), pbrt: None },
    Scene {
        name: "PLY, bytes",
        ours: "hills.ply",
        mitsuba: Some("hills-ply.xml"),
        pbrt: Some("hills-ply.pbrt"),
    },
    Scene { name: "STL, text", ours: "hills.stl", mitsuba: None, pbrt: None },
    Scene { name: "pbrt", ours: "hills.pbrt", mitsuba: None, pbrt: Some("hills.pbrt") },
    Scene { name: "GLB", ours: "hills.glb", mitsuba: None, pbrt: None },
];

/// Scenes among the test files.
const ASSETS: [Scene; 2] = [
    Scene {
        name: "matpreview",
        ours: "mitsuba/matpreview/matpreview.xml",
        mitsuba: Some("mitsuba/matpreview/matpreview.xml"),
        pbrt: None,
    },
    Scene {
        name: "killeroos",
        ours: "pbrt/killeroos/killeroo-simple.pbrt",
        mitsuba: None,
        pbrt: Some("pbrt/killeroos/killeroo-simple.pbrt"),
    },
];

/// What was asked for.
pub(crate) struct Options {
    json: bool,
    runs: usize,
}

impl Options {
    /// From the words after `bench load`.
    pub(crate) fn parse(words: &[&str]) -> anyhow::Result<Self> {
        let mut options = Self { json: false, runs: 3 };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            match *word {
                "--json" => options.json = true,
                "--runs" => {
                    let count = words.next().and_then(|n| n.parse().ok()).filter(|n| *n > 0);
                    options.runs = count.context("--runs wants a number of at least 1")?;
                }
                other => bail!("unknown option \"{other}\"; see `cargo xtask help`"),
            }
        }
        Ok(options)
    }
}

/// Builds, writes files, measures in turns, reports.
pub(crate) fn run(options: &Options) -> anyhow::Result<()> {
    let (durer, loader) = (release_program()?, built::program("load")?);
    let folder = target_folder()?.join("bench");
    let files = folder.join("load");
    fs::create_dir_all(&files).with_context(|| format!("{} cannot be made", files.display()))?;
    eprintln!("==> writing hills");
    measure(Command::new(&loader).arg("--write").arg(&files))?;
    let (ply, glb) = (files.join("hills.ply"), files.join("hills.glb"));
    measure(Command::new(&durer).arg("convert").arg(&ply).arg("-o").arg(&glb).arg("--quiet"))?;
    let bench = Bench { loader, peers: Peers::find(&folder), runs: options.runs };
    let mut skipped = bench.peers.skipped.clone();
    let assets = built::assets()?;
    let mut rows = Vec::new();
    let both = HILLS.iter().map(|scene| (scene, &files)).chain(ASSETS.iter().map(|scene| (scene, &assets)));
    for (scene, folder) in both {
        if !folder.join(scene.ours).is_file() {
            skipped.push(format!("{}: {} is not there", scene.name, scene.ours));
            continue;
        }
        eprintln!("==> {}", scene.name);
        rows.push(bench.row(scene, folder, &mut skipped)?);
    }
    let figures = json!({ "version": 1, "rows": rows, "skipped": skipped });
    if options.json {
        println!("{figures:#}");
    } else {
        print!("{}", report::as_table(&figures));
    }
    Ok(())
}

/// What loads, and how often.
struct Bench {
    loader: PathBuf,
    peers: Peers,
    runs: usize,
}

impl Bench {
    /// All that is measured of a scene: of each figure the least of all runs, which others disturb least.
    fn row(&self, scene: &Scene, folder: &Path, skipped: &mut Vec<String>) -> anyhow::Result<Value> {
        let mut row = json!({ "scene": scene.name });
        for threads in (0..self.runs).flat_map(|_| THREADS) {
            let mut command = Command::new(&self.loader);
            command.arg(folder.join(scene.ours)).env("RAYON_NUM_THREADS", threads.to_string());
            let run = measure(&mut command)?;
            let figures: Value = serde_json::from_slice(&run.output.stdout).context("figures of loading")?;
            (row["bytes"], row["triangles"]) = (figures["bytes"].clone(), figures["triangles"].clone());
            for part in ["read", "ready"] {
                keep_least(&mut row[format!("durer-{threads}")][part], &figures[part]);
            }
        }
        let named = [("mitsuba", scene.mitsuba), ("pbrt", scene.pbrt)];
        for (peer, file) in named.into_iter().filter_map(|(peer, file)| Some((peer, folder.join(file?)))) {
            for _ in 0..self.runs {
                match self.peers.load(peer, &file) {
                    None => break,
                    Some(Ok(figures)) => keep_least(&mut row[peer], &figures),
                    Some(Err(why)) => {
                        skipped.push(format!("{}, {peer}: {why}", scene.name));
                        break;
                    }
                }
            }
        }
        Ok(row)
    }
}

/// Of every number in `found` the lesser one of it and of what `kept` holds.
fn keep_least(kept: &mut Value, found: &Value) {
    match found {
        Value::Object(parts) => parts.iter().for_each(|(name, part)| keep_least(&mut kept[name], part)),
        Value::Number(_) if kept.as_f64().is_some_and(|k| found.as_f64().is_none_or(|f| k <= f)) => {}
        other => *kept = other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let options = Options::parse(&["--runs", "2", "--json"]).expect("good options");
        assert!(options.json && options.runs == 2);
        assert!(Options::parse(&["--runs", "0"]).is_err() && Options::parse(&["--fast"]).is_err());
    }

    #[test]
    fn the_least_is_kept() {
        let mut kept = Value::Null;
        for (cpu, wall) in [(2.0, 1.0), (1.0, 3.0)] {
            keep_least(&mut kept, &json!({ "read": { "cpu": cpu, "wall": wall } }));
        }
        assert_eq!(kept, json!({ "read": { "cpu": 1.0, "wall": 1.0 } }));
    }
}
