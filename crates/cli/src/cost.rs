//! `durer cost`: the lecture's formula, predicted and measured.

mod json;
mod text;

use std::sync::atomic::AtomicBool;

use durer::{
    Options, Prepared,
    cost::{Advice, Alternative, Measured, Predicted, advice, alternatives, measure, predict},
};

use crate::{
    exit::{Exit, WrongUsage, emit, emit_json, harmless},
    load::load,
    options::{SampleOptions, TalkOptions},
    progress::Bar,
    report,
    value::whole,
};

const EXAMPLES: &str = "\
Examples:
  durer cost                                       of the scene whitted
  durer cost cook --sampling nested --spp 16 --shadow-rays 4 --gloss-rays 4
  durer cost room.glb --predict                    without rendering
  durer cost glass-plate --accel none --json | jq .predicted.primitive_tests

The formula: height x width x primitives x intersection cost x ray tree size x
shadow rays x supersamples x gloss x temporal x focal.
  primitives         primitives tested per ray
  ray tree size      eye rays and the sharp reflections and refractions after them
  shadow rays, gloss what those rays multiply the number of the others with
  supersamples       points of a pixel; with --sampling shared one sample set
                     serves all effects, and temporal and focal are 1

The prediction takes a hundredth of the pixels, but a thousand if there are so many.
With --accel none, where the trees of all pixels are full, it takes the parameters
alone: (b^(d+1) - 1) / (b - 1) rays for b branches and d bounces, each tested against
every primitive.

JSON: an object with version 1; scene, integrator, width, height, samples, accel,
primitives; predicted and measured (null with --predict), each with primitive_tests,
box_tests, rays, seconds (of one thread) and factors (height, width, primitives,
intersection_ns, tree, shadow, supersamples, gloss, temporal, focal), predicted also
with method (parameters or probe); alternatives (accel, sampling, rays,
primitive_tests, box_tests, seconds); cut_first (factor, saves, how), best first.
Within a version keys may be added, none renamed.";

/// Says what a picture costs, factor by factor, predicted and measured.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    sample: SampleOptions,
    /// Do not render: only predict.
    #[arg(long, help_heading = "Cost")]
    predict: bool,
    /// As JSON on stdout.
    #[arg(long, help_heading = "Cost")]
    json: bool,
    /// Worker threads [default: all cores].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=4096))]
    #[arg(allow_negative_numbers = true, help_heading = "Running")]
    threads: Option<u32>,
    #[command(flatten)]
    talk: TalkOptions,
}

/// Everything there is to say.
struct Bill<'a> {
    scene: &'a str,
    prepared: &'a Prepared,
    predicted: Predicted,
    measured: Option<Measured>,
    alternatives: Vec<Alternative>,
    advice: Vec<Advice>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let scene = &args.sample.scene.scene;
    let wishes = Options { threads: args.threads.map(|n| n as usize), ..args.sample.wishes() };
    let mut loaded = load(scene, &wishes);
    report::print(scene, &loaded.imported, &args.talk);
    let Some(prepared) = &loaded.prepared else {
        return Ok(loaded.failure);
    };
    if prepared.window().area() == 0 {
        return Err(WrongUsage("--crop lies outside the picture".to_owned()).into());
    }
    // There is no picture to keep: Ctrl-C ends the program.
    let never = AtomicBool::new(false);
    let Some(predicted) = predict(prepared, &never) else { return Ok(Exit::Interrupted) };
    let measured = if args.predict {
        None
    } else {
        let bar = Bar::new(prepared.job().steps(), args.talk.quiet);
        let measured = measure(prepared, &bar, &never);
        bar.finish();
        measured
    };
    let alternatives = alternatives(&mut loaded.imported, &wishes, &prepared.integrator_name, &never);
    let bvh = alternatives.iter().map(|a| &a.factors).next();
    let advice = advice(prepared, &predicted.factors, bvh);
    let bill = Bill { scene, prepared, predicted, measured, alternatives, advice };
    if args.json {
        emit_json(&json::Bill::new(&bill))?;
    } else {
        emit(&harmless(&text::bill(&bill)))?;
    }
    Ok(Exit::Done)
}
