//! How long it takes to read a scene and to make it ready: `load SCENE` prints figures as JSON, `load --write FOLDER` makes
//! files of hills in all formats. `cargo xtask bench load` starts it, with as many threads as RAYON_NUM_THREADS says.
#![forbid(unsafe_code)]

mod hills;

use std::{
    env, fs,
    path::{Path, PathBuf},
    time::Instant,
};

use anyhow::{Context, bail};
use cpu_time::ProcessTime;
use durer::{Options, open, prepare};
use serde_json::{Value, json};

fn main() -> anyhow::Result<()> {
    // Cargo adds `--bench` if it starts this itself.
    let words: Vec<String> = env::args().skip(1).filter(|word| word != "--bench").collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["--write", folder] => hills::write(Path::new(folder)).context("the hills cannot be written"),
        [scene] => measure(scene),
        _ => bail!("wants a scene; `cargo xtask bench load` gives them"),
    }
}

/// Clocks of the process and of the wall.
struct Clock(ProcessTime, Instant);

impl Clock {
    fn start() -> Self {
        Self(ProcessTime::now(), Instant::now())
    }
    fn seconds(&self) -> Value {
        json!({ "cpu": self.0.elapsed().as_secs_f64(), "wall": self.1.elapsed().as_secs_f64() })
    }
}

fn measure(scene: &str) -> anyhow::Result<()> {
    let clock = Clock::start();
    let mut imported = open(scene);
    let read = clock.seconds();
    let options = Options { width: Some(8), height: Some(8), ..Options::default() };
    let prepared = prepare(&mut imported, &options).context("not sound; `durer info` says why")?;
    let ready = clock.seconds();
    let files: Vec<PathBuf> =
        [PathBuf::from(scene)].into_iter().chain(imported.assets.files_read()).collect();
    let bytes: u64 = files.iter().map(|file| fs::metadata(file).map_or(0, |about| about.len())).sum();
    let triangles = prepared.scene.accel.stats().triangles;
    println!("{}", json!({ "bytes": bytes, "read": read, "ready": ready, "triangles": triangles }));
    Ok(())
}
