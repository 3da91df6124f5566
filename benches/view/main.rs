//! How long it takes to record the ray trees of pixels: `view SCENE INTEGRATOR` prints figures as JSON.
//! `cargo xtask bench view` makes what it needs and starts it.
#![forbid(unsafe_code)]

mod pixels;
mod recording;

use std::{env, time::Instant};

use anyhow::{Context, bail};
use durer::{Options, open, prepare, tree::Subject};
use serde_json::json;

use crate::recording::{Recording, summary};

/// Samples of a pixel.
const SAMPLES: u32 = 16;
/// How many pixels are recorded.
const PIXELS: usize = 50;

fn main() -> anyhow::Result<()> {
    // Cargo adds `--bench` if it starts this itself.
    let words: Vec<String> = env::args().skip(1).filter(|word| word != "--bench").collect();
    let [scene, integrator] = words.as_slice() else {
        bail!("wants a scene and an integrator; `cargo xtask bench view` gives them");
    };
    let start = Instant::now();
    let mut imported = open(scene);
    let load = start.elapsed();
    let options =
        Options { integrator: Some(integrator.clone()), samples: Some(SAMPLES), ..Options::default() };
    let start = Instant::now();
    let prepared = prepare(&mut imported, &options).context("not sound; `durer info` says why")?;
    let build = start.elapsed();
    let subject = Subject { name: scene, prepared: &prepared };
    let view = &prepared.scene.view;
    let pixels = pixels::that_show_something(&prepared, PIXELS + 1);
    let Some((&warm_up, pixels)) = pixels.split_last().filter(|(_, others)| !others.is_empty()) else {
        bail!("nothing is to be seen");
    };
    Recording::of(&subject, warm_up);
    let recordings: Vec<Recording> = pixels.iter().map(|&pixel| Recording::of(&subject, pixel)).collect();
    let figures = json!({
        "triangles": prepared.scene.accel.stats().triangles,
        "width": view.width, "height": view.height, "samples": prepared.settings.samples, "pixels": pixels.len(),
        "load": load.as_secs_f64(), "build": build.as_secs_f64(),
        "one_sample": summary(&recordings, |r| (r.one, r.one_nodes)),
        "all_samples": summary(&recordings, |r| (r.all, r.all_nodes)),
        "document": summary(&recordings, |r| (r.document, r.all_nodes)),
    });
    println!("{figures}");
    Ok(())
}
