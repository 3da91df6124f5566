//! `durer render`: a scene to picture files.
use std::{path::PathBuf, sync::atomic::AtomicBool, time::Instant};

use anyhow::anyhow;
use durer::{
    Gather, Id, MediumStack, Output, Prepared, Rendered, doctor,
    film::{Tile, ToneMap},
    image::{PictureFormat, replace_file},
    picture::{Look, Picture},
    scene::{LayersDesc, SceneDesc},
};

use crate::{
    exit::{Exit, WrongUsage, emit, emit_json, tell},
    frames::{self, FrameOptions},
    interrupt::Interrupt,
    load::load,
    number::{counted, significant},
    options::{SampleOptions, TalkOptions},
    output::{Destination, destinations},
    progress::Bar,
    report,
    stats::{Facts, Seconds, Stats, StatsForm},
    value::{finite, tonemap, whole},
};

const EXAMPLES: &str = "\
Examples:
  durer render                                   the scene whitted, to whitted.png
  durer render room.glb -o room.png -o room.exr  one render, two files
  durer render room.pbrt --scale 0.25 --spp 4    a quick look
  durer render room.glb --integrator cast --show depth -o depth.exr
  durer render car.glb --env studio.hdr          lit by a picture all around
  durer render room.glb --crop 100,50,200,120 --spp 256
  durer render --stats=json | jq .rays
  durer render fox.glb --animation Run --time-at 0.4 --shutter 0.02
  durer render fox.glb --animation Run --frames 0..28 --shutter 0.5f -o fox.####.png
  durer render fox.glb --frames 0..81 -o fox.mp4  a video, where ffmpeg is installed

Files: .png is developed (exposure, tone map, sRGB) to 8 bits; .exr holds linear
floats as they are. Its channels: R, G, B; depth.Z (metres along the camera's
axis) and depth.length (along the ray); normal.X, .Y, .Z (world space); uv.U, .V;
id (1 is the first object); cost.primitives and cost.boxes (tests of a ray). All but
those of cost are 0 where nothing was hit. Of a scene with the film gbuffer there are also
P.X, .Y, .Z, N.*, Ns.*, u, v, dzdx, dzdy, Albedo.*, Variance.* and RelativeVariance.*; with
the film spectral S0.374,688nm and so on, the light of each part of the spectrum.

stdout holds the paths of the files, a line each, or with --stats=json an object:
version 1; durer, scene, integrator, width, height, spp, seed, threads, outputs,
interrupted, samples, adaptive, bad_samples, first_bad, imbalances, seconds, rays, stops, tests,
max_depth, build. Within a version keys may be added, none renamed.

Ctrl-C writes the picture so far and exits with 130; a second one exits at once.";

/// Renders a scene.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) sample: SampleOptions,
    /// The picture file; may be given several times [default: SCENE-STEM.png].
    #[arg(long, short, value_name = "FILE", help_heading = "Picture")]
    pub(crate) output: Vec<PathBuf>,
    /// Brightens 8-bit pictures by so many stops.
    #[arg(long, value_name = "EV", value_parser = finite, allow_negative_numbers = true, default_value_t = 0.0)]
    #[arg(help_heading = "Picture")]
    exposure: f32,
    /// How light becomes 8-bit colours [default: none for cast, whitted and distributed, else agx].
    #[arg(long, value_name = "NAME", value_parser = tonemap(), help_heading = "Picture")]
    tonemap: Option<ToneMap>,
    /// Counts rays, stops and tests, which takes time; as text on stderr, or as JSON on stdout.
    #[arg(long, value_name = "FORM", value_enum, num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "text", help_heading = "Running")]
    pub(crate) stats: Option<StatsForm>,
    /// Worker threads [default: all cores]. The picture does not depend on their number.
    #[arg(long, value_name = "N", value_parser = whole(1u32..=4096))]
    #[arg(allow_negative_numbers = true, help_heading = "Running")]
    pub(crate) threads: Option<u32>,
    #[command(flatten)]
    pub(crate) frames: FrameOptions,
    #[command(flatten)]
    pub(crate) talk: TalkOptions,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    if let Some(frames) = args.frames.frames {
        return frames::run(args, frames);
    }
    frames::check_single(&args.output)?;
    let scene = &args.sample.scene.scene;
    let outputs = destinations(&args.output, scene)?;
    let interrupt = Interrupt::listen("writing the picture so far")?;
    let wishes = args.wishes(&args.sample, &outputs);
    let loaded = load(scene, &wishes);
    report::print(scene, &loaded.imported, &args.talk);
    let Some(prepared) = &loaded.prepared else {
        return Ok(loaded.failure);
    };
    args.check_crop(prepared)?;
    args.warn_about_looks(prepared);
    args.tell_of_layers(&loaded.imported.desc, &outputs);

    let bar = Bar::new(prepared.job().steps(), args.talk.quiet);
    let start = Instant::now();
    let rendered = args.render(prepared, &bar, interrupt.rendering());
    let render = start.elapsed();
    bar.finish();
    args.warn_about_bad_samples(&args.sample, &rendered);
    args.warn_about_imbalances(prepared, &rendered);
    let seconds = Seconds { load: loaded.load, build: loaded.build, render, ..Seconds::default() };
    let taken = Taken { desc: &loaded.imported.desc, prepared, rendered: &rendered, seconds };
    args.finish(&taken, &outputs)
}

/// A picture that was rendered.
pub(crate) struct Taken<'a> {
    /// What it is of.
    pub(crate) desc: &'a SceneDesc,
    pub(crate) prepared: &'a Prepared,
    pub(crate) rendered: &'a Rendered,
    /// But for writing it.
    pub(crate) seconds: Seconds,
}

impl Taken<'_> {
    /// On its way into files.
    pub(crate) fn picture<'p>(&'p self, scene: &'p str) -> Picture<'p> {
        let Self { desc: _, prepared, rendered, seconds } = self;
        let (pixels, layers) = (rendered.film.pixels(), rendered.film.layers());
        let (render, interrupted) = (seconds.render, rendered.cancelled);
        Picture { scene, prepared, pixels, layers, render, interrupted }
    }
}

impl Args {
    /// What is wished for of pictures in such files.
    pub(crate) fn wishes(&self, sample: &SampleOptions, outputs: &[Destination]) -> durer::Options {
        let threads = self.threads.map(|n| n as usize);
        durer::Options { threads, layers: holds_layers(outputs), ..sample.wishes() }
    }

    /// Says where the rest of the picture would go.
    pub(crate) fn tell_of_layers(&self, desc: &SceneDesc, outputs: &[Destination]) {
        let what = match desc.film.layers {
            Some(LayersDesc::Surfaces(_)) => "places, normals and more of what is seen",
            Some(LayersDesc::Buckets { .. }) => "light by its wavelength",
            None => return,
        };
        if !self.talk.quiet && !holds_layers(outputs) {
            tell(&format!("note: the scene's film also asks for {what}: -o FILE.exr holds all of it"));
        }
    }

    /// Writes the files of a picture and says how it went.
    pub(crate) fn finish(&self, taken: &Taken<'_>, outputs: &[Destination]) -> anyhow::Result<Exit> {
        let scene = &self.sample.scene.scene;
        let Taken { desc: _, prepared, rendered, seconds } = taken;
        let start = Instant::now();
        let picture = taken.picture(scene);
        let written = self.write(&picture, outputs);
        self.explain_darkness(taken.desc, &picture, outputs);
        let seconds = Seconds { write: start.elapsed(), ..*seconds };
        let stats = Stats::new(&Facts { scene, prepared, rendered, seconds, outputs: &written });
        self.tell_summary(&picture, &stats);
        if self.stats == Some(StatsForm::Json) {
            emit_json(&stats)?;
        } else {
            written.iter().try_for_each(|path| emit(&format!("{path}\n")))?;
        }
        Ok(match (rendered.cancelled, written.len() == outputs.len()) {
            (true, _) => Exit::Interrupted,
            (false, true) => Exit::Done,
            (false, false) => Exit::Failed,
        })
    }

    /// A crop that misses the picture is a slip: it would give a black one. One that reaches beyond may be one.
    pub(crate) fn check_crop(&self, prepared: &Prepared) -> Result<(), WrongUsage> {
        let view = &prepared.scene.view;
        let Some(asked) = prepared.settings.crop else { return Ok(()) };
        let window = prepared.settings.window(view.width, view.height);
        let size = format!("{} x {}", view.width, view.height);
        if window.area() == 0 {
            return Err(WrongUsage(format!("--crop lies outside the picture of {size} pixels")));
        }
        if window != asked && !self.talk.quiet {
            let edges = |t: Tile| format!("{},{},{},{}", t.x0, t.y0, t.x1, t.y1);
            let (asked, window) = (edges(asked), edges(window));
            tell(&format!(
                "warning: --crop {asked} reaches beyond the picture of {size} pixels: {window} is rendered"
            ));
        }
        Ok(())
    }

    pub(crate) fn render(&self, prepared: &Prepared, bar: &Bar, cancel: &AtomicBool) -> Rendered {
        let view = &prepared.scene.view;
        let pixels = prepared.settings.window(view.width, view.height).area();
        let gather = if self.stats.is_some() { Gather::Counters } else { Gather::Rays };
        if self.talk.verbose {
            let pixels = counted(pixels, "pixel", "pixels");
            let threads = counted(prepared.settings.threads as u64, "thread", "threads");
            tell(&format!("rendering {pixels} on {threads}"));
        }
        prepared.job().render(gather, bar, cancel)
    }

    /// The paths of the files that could be written; complains about the others.
    pub(crate) fn write(&self, picture: &Picture<'_>, outputs: &[Destination]) -> Vec<String> {
        let look = self.look(picture.prepared);
        let written = outputs.iter().filter(|output| {
            let done = write(picture, output, look);
            if let Err(error) = &done {
                tell(&format!("error: {error:#}"));
            }
            done.is_ok()
        });
        written.map(|output| output.path.display().to_string()).collect()
    }

    /// How light becomes 8-bit colours.
    pub(crate) fn look(&self, prepared: &Prepared) -> Look {
        let tonemap = self.tonemap.unwrap_or(Look::usual_tonemap(&prepared.integrator_name));
        Look { exposure: self.exposure, tonemap }
    }

    pub(crate) fn warn_about_looks(&self, prepared: &Prepared) {
        let asked = self.tonemap.is_some() || self.exposure != 0.0;
        if asked && !self.talk.quiet && prepared.integrator.facts().output != Output::Radiance {
            tell("warning: the picture shows no light: exposure and tone map change nothing");
        }
    }

    /// A picture that shows nothing explains itself.
    pub(crate) fn explain_darkness(&self, desc: &SceneDesc, picture: &Picture<'_>, outputs: &[Destination]) {
        let seen = outputs.iter().any(|output| output.format == PictureFormat::Png);
        let shows_light = picture.prepared.integrator.facts().output == Output::Radiance;
        if self.talk.quiet || !seen || !shows_light {
            return;
        }
        for finding in doctor::explain(desc, picture.prepared, &picture.pixels, self.exposure) {
            let remedy = finding.remedy.map(|remedy| format!("\n  {remedy}")).unwrap_or_default();
            tell(&format!("warning: {}{remedy}", finding.message));
        }
    }

    pub(crate) fn warn_about_bad_samples(&self, sample: &SampleOptions, rendered: &Rendered) {
        let Some(first) = rendered.first_bad.filter(|_| !self.talk.quiet) else {
            return;
        };
        let replay = sample.replay(first.pixel, first.sample);
        let counted = match rendered.bad_samples {
            1 => "1 sample was infinite or NaN and was left out; it".to_owned(),
            n => format!("{n} samples were infinite or NaN and were left out; the first"),
        };
        tell(&format!("warning: {counted} is replayed by\n  durer trace {replay}"));
    }

    /// Names the objects that rays left without having entered them: the most often left first.
    pub(crate) fn warn_about_imbalances(&self, prepared: &Prepared, rendered: &Rendered) {
        /// Objects named at most.
        const NAMED: usize = 5;
        /// One in so many rays may be wrong without a word.
        const SLIPS: u64 = 100_000;
        let found = &rendered.imbalances;
        // Where surfaces meet in an edge a ray may slip between them by rounding: a few in a million.
        let rays = found.objects.values().sum::<u64>() + found.elsewhere + found.too_deep;
        if self.talk.quiet || rays.saturating_mul(SLIPS) <= rendered.rays {
            return;
        }
        let mut objects: Vec<(u32, u64)> = found.objects.iter().map(|(o, n)| (*o, *n)).collect();
        objects.sort_by_key(|&(object, rays)| (std::cmp::Reverse(rays), object));
        let named = objects.iter().take(NAMED).map(|&(object, rays)| {
            let name = &prepared.scene.object(Id::new(object)).name;
            format!("{name} ({})", counted(rays, "time", "times"))
        });
        let named = named.collect::<Vec<_>>().join(", ");
        if !objects.is_empty() {
            let more = objects.len().saturating_sub(NAMED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            tell(&format!(
                "warning: rays left transparent bodies that they had not entered: {named}{more}\n  \
                 the surface may be inside out (ReverseOrientation), open, or cut by another; or the camera is in a body \
                 that is closed on few sides"
            ));
        }
        if found.too_deep > 0 {
            let times = counted(found.too_deep, "time", "times");
            tell(&format!(
                "warning: {times} a ray was in more than {} transparent bodies at once: the last were left out",
                MediumStack::CAPACITY
            ));
        }
    }

    fn tell_summary(&self, picture: &Picture<'_>, stats: &Stats<'_>) {
        if let (Some(range), false) = (picture.depth_range(), self.talk.quiet) {
            let [near, far] = [range.near, range.far].map(|d| significant(d, 6));
            tell(&format!("depth: {near} m (nearest) to {far} m (farthest)"));
        }
        if let (Some(white), false) = (picture.white_tests(), self.talk.quiet) {
            tell(&format!("cost: white is {} tests of boxes and primitives per ray", significant(white, 6)));
        }
        if self.stats == Some(StatsForm::Text) {
            tell(stats.text().trim_end());
        } else if !self.talk.quiet {
            tell(&stats.summary());
        }
    }
}

/// Whether one of the files has room for more than colours.
fn holds_layers(outputs: &[Destination]) -> bool {
    outputs.iter().any(|output| output.format == PictureFormat::Exr)
}

fn write(picture: &Picture<'_>, to: &Destination, look: Look) -> anyhow::Result<()> {
    let bytes = picture.encode(to.format, look).map_err(|e| anyhow!("{}: {e}", to.path.display()))?;
    Ok(replace_file(&to.path, &bytes)?)
}
