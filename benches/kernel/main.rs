//! The kernel beside Embree 4 and obvhs; `cargo xtask bench kernel` makes what it needs and starts it.
#![forbid(unsafe_code)]

mod obvhs;
mod scene_run;

use std::env;

use anyhow::ensure;
use durer_benches::{embree::Embree, load, options::Options, pin, report::Report};

use crate::scene_run::SceneRun;

fn main() -> anyhow::Result<()> {
    let options = Options::parse(env::args().skip(1))?;
    ensure!(!options.isas.is_empty(), "this machine has none of the instruction sets asked for");
    let mut report = Report { edge: options.edge, runs: options.runs, ..Report::default() };
    let cores: Vec<usize> = pin::cores().into_iter().take(2).collect();
    let embree = Embree::start(&options.peer, &options.embree, &options.folder)?;
    for name in &options.scenes {
        let Some(scene) = load::scene(name, &options.assets)? else {
            eprintln!("==> {name}: no such file below {}", options.assets.display());
            report.missing.push(name.clone());
            continue;
        };
        let (triangles, places) = (scene.triangles(), scene.instances.len());
        eprintln!(
            "==> {name}: {triangles} triangles, {places} placed mesh{}",
            if places == 1 { "" } else { "es" }
        );
        let run = SceneRun { scene: &scene, embree: &embree, options: &options, cores: &cores };
        run.run(&mut report)?;
    }
    if options.json {
        println!("{}", serde_json::to_string_pretty(&report.as_value())?);
    } else {
        print!("{}", report.as_tables());
    }
    Ok(())
}
