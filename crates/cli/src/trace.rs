//! `durer trace`: one pixel sample again, every ray recorded.

mod json;
mod text;

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::Context;
use durer::{Prepared, drive::Antialias, film::Pixel, probe::RayTree};

use crate::{
    exit::{Exit, WrongUsage, emit, emit_json, harmless, tell},
    load::load,
    options::{SampleOptions, TalkOptions},
    output::check_writable,
    report,
    value::{pixel, whole},
};

const EXAMPLES: &str = "\
Examples:
  durer trace --pixel 640,360
  durer trace room.glb --pixel 320,240 --sample 7 --spp 64
  durer trace --pixel 640,360 --json | jq '.nodes[] | select(.kind == \"shadow\")'
  durer trace --pixel 640,360 --spp 1 -o tree.json

Give the options of the render whose sample you want: the size and --spp decide
where in the pixel a sample lies. With --spp 1 the last line, `pixel R G B`, has
the very bits of that pixel in `durer render --spp 1 -o x.exr`. With --antialias
adaptive the samples are, in this order: the pixel's corners (upper left, upper
right, lower left, lower right), then for each split what is new of the middles
of its upper and left edges, its centre and the middles of its right and lower
edges; a part that is split no further may have one more inside.

JSON: an object with version 1; scene, integrator, width, height, pixel, sample,
rgb and nodes, parents before children. A node has id, parent (null for the eye
ray), kind, depth, origin, direction (unit), t (metres), point, object, instance,
primitive (both as the kernel counts them), normal, uv, side (outside, inside),
weight (what the parent multiplies its result with), throughput (its share in the
pixel), local (radiance from no other ray), contribution (throughput x local),
result (its radiance: local plus the sum of weight x result of its children, in
order), stop, lost (the share that an untraced ray would have had), light (index,
name, point, visible, unoccluded), blocker, and tests (boxes, primitives). What
does not apply, and what is infinite or NaN, is null. Places are in world space.
Within a version keys may be added, none renamed.";

/// Shows the rays of one pixel sample as a tree.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    sample_options: SampleOptions,
    /// Which pixel; 0,0 is the upper left one.
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true, help_heading = "Ray tree")]
    pixel: [u32; 2],
    /// Which of its samples.
    #[arg(long, value_name = "K", value_parser = whole(0..=u32::MAX), allow_negative_numbers = true)]
    #[arg(default_value_t = 0, help_heading = "Ray tree")]
    sample: u32,
    /// The tree as JSON on stdout.
    #[arg(long, help_heading = "Ray tree")]
    json: bool,
    /// The tree as JSON into a file (.json) as well.
    #[arg(long, short, value_name = "FILE", help_heading = "Ray tree")]
    output: Option<PathBuf>,
    #[command(flatten)]
    talk: TalkOptions,
}

/// A recorded sample and what its numbers refer to.
struct Traced<'a> {
    scene: &'a str,
    prepared: &'a Prepared,
    pixel: [u32; 2],
    sample: u32,
    /// What the film holds of it.
    rgb: [f32; 3],
    tree: RayTree,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let output = args.output.as_deref();
    output.map_or(Ok(()), check_output)?;
    let scene = &args.sample_options.scene.scene;
    let loaded = load(scene, &args.sample_options.wishes());
    report::print(scene, &loaded.imported, &args.talk);
    let Some(prepared) = &loaded.prepared else {
        return Ok(loaded.failure);
    };
    args.check_range(prepared)?;

    let (tree, value) = prepared.job().record(args.pixel, args.sample);
    let traced =
        Traced { scene, prepared, pixel: args.pixel, sample: args.sample, rgb: as_film(value), tree };
    if let Some(path) = output {
        let text = serde_json::to_string_pretty(&json::Tree::new(&traced))?;
        fs::write(path, text + "\n").with_context(|| format!("{}: cannot be written", path.display()))?;
        if !args.talk.quiet {
            tell(&format!("wrote {}", path.display()));
        }
    }
    if args.json {
        emit_json(&json::Tree::new(&traced))?;
    } else {
        emit(&harmless(&text::tree(&traced)))?;
    }
    Ok(Exit::Done)
}

/// The mean of a film that holds one sample. Differs from the sample in the sign of zero only, but bits are promised.
fn as_film(value: [f32; 3]) -> [f32; 3] {
    let mut pixel = Pixel::default();
    pixel.add(value, 1.0);
    pixel.mean()
}

fn check_output(path: &Path) -> anyhow::Result<()> {
    let suffix = path.extension().map(|s| s.to_string_lossy().to_lowercase());
    if suffix.as_deref() != Some("json") && !path.is_dir() {
        let message = format!("{}: trees are written as JSON\n  help: end the name in .json", path.display());
        return Err(WrongUsage(message).into());
    }
    check_writable(path)
}

impl Args {
    fn check_range(&self, prepared: &Prepared) -> Result<(), WrongUsage> {
        let view = &prepared.scene.view;
        let [x, y] = self.pixel;
        if x >= view.width || y >= view.height {
            let (right, bottom) = (view.width - 1, view.height - 1);
            let size = format!("{} x {}", view.width, view.height);
            let message = format!(
                "pixel {x},{y} lies outside the picture of {size} pixels: the last one is {right},{bottom}"
            );
            return Err(WrongUsage(message));
        }
        let samples = prepared.job().sample_count(self.pixel);
        if self.sample >= samples {
            let message = match prepared.settings.antialias {
                Antialias::Supersample => {
                    format!(
                        "there is no sample {}: a pixel has {samples} (--spp), counted from 0",
                        self.sample
                    )
                }
                Antialias::Adaptive(_) => {
                    format!("there is no sample {}: this pixel has {samples}, counted from 0", self.sample)
                }
            };
            return Err(WrongUsage(message));
        }
        Ok(())
    }
}
