//! `durer draw`: a line drawing from cast rays, as SVG.
use std::{
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::Instant,
};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::{
    Gather, Options, Prepared,
    draw::{Drawing, FINEST_HATCH, Kind, Line, Machine, Paper, Style, Tones, draw, hatch, svg},
};

use crate::{
    exit::{Exit, WrongUsage, emit, tell},
    load::load,
    number::{counted, significant},
    options::{SampleOptions, TalkOptions},
    output::check_writable,
    progress::Bar,
    report,
    value::{positive, whole},
};

const EXAMPLES: &str = "\
Examples:
  durer draw durer                             the lute, to durer.svg
  durer draw room.glb -o room.svg --width 800  a file of your own
  durer draw room.glb --crease 15              gentle folds too
  durer draw hair.pbrt --rays 4                what is thinner than a pixel
  durer draw statue.ply --stroke 3 --paper none
  durer draw durer --hatch --spp 8             shaded as a woodcut, by the rendered light

Rays are compared with their neighbours, as Dürer's thread was moved from point to
point: a line passes where a surface ends (silhouette), two things meet (boundary) or
a surface folds (crease). What no ray sees is not drawn. Crossings are found to a
64th of a pixel; more rays find smaller things and move no line. A picture that is
small gets more of them, up to 8 along the edge of a pixel.

Options on samples, light transport and distribution count for --hatch only: lines
are found without light. --crop draws that part of the picture.

SVG: a group per kind of line (ids silhouette, boundary, crease, hatch), a path per line, in
pixels. stdout holds the path of the file.";

/// Draws the visible lines of a scene as SVG, as Dürer's machine did: from cast rays only.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    sample: SampleOptions,
    /// The SVG file [default: SCENE-STEM.svg].
    #[arg(long, short, value_name = "FILE", help_heading = "Drawing")]
    output: Option<PathBuf>,
    /// Folds from this angle on are drawn.
    #[arg(long, value_name = "DEGREES", value_parser = angle, allow_negative_numbers = true)]
    #[arg(default_value_t = 40.0, help_heading = "Drawing")]
    crease: f32,
    /// Rays along the edge of a pixel [default: 1, more where the picture is small].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=16), allow_negative_numbers = true)]
    #[arg(help_heading = "Drawing")]
    rays: Option<u32>,
    /// How far curves may pass by the points that were found.
    #[arg(long, value_name = "PIXELS", value_parser = positive, allow_negative_numbers = true)]
    #[arg(default_value_t = 0.04, help_heading = "Drawing")]
    tolerance: f32,
    /// Width of silhouettes in pixels; boundaries and creases are thinner [default: a 500th of the shorter edge].
    #[arg(long, value_name = "PIXELS", value_parser = positive, allow_negative_numbers = true)]
    #[arg(help_heading = "Drawing")]
    stroke: Option<f32>,
    /// Hatches what is dark in the rendered picture, with strokes so far apart, 1 at least [default without PIXELS: 5].
    #[arg(long, value_name = "PIXELS", value_parser = spacing, num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "5", help_heading = "Drawing")]
    hatch: Option<f32>,
    /// What lies under the lines.
    #[arg(long, value_name = "COLOUR", value_parser = paper(), default_value = "cream", help_heading = "Drawing")]
    paper: Paper,
    /// Worker threads [default: all cores]. The drawing does not depend on their number.
    #[arg(long, value_name = "N", value_parser = whole(1u32..=4096))]
    #[arg(allow_negative_numbers = true, help_heading = "Running")]
    threads: Option<u32>,
    #[command(flatten)]
    talk: TalkOptions,
}

/// An angle between two planes, in degrees.
fn angle(text: &str) -> Result<f32, String> {
    let inside = positive(text).ok().filter(|v| *v < 180.0);
    inside.ok_or_else(|| "expected an angle above 0 and below 180 degrees".to_owned())
}

/// A distance between strokes.
fn spacing(text: &str) -> Result<f32, String> {
    let pixels = positive(text)?;
    match f64::from(pixels) < FINEST_HATCH {
        true => Err(format!("strokes are at least {FINEST_HATCH} pixel apart")),
        false => Ok(pixels),
    }
}

fn paper() -> impl TypedValueParser<Value = Paper> {
    PossibleValuesParser::new(Paper::ALL.map(Paper::word))
        .try_map(|word| Paper::ALL.into_iter().find(|p| p.word() == word).ok_or("unknown"))
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let scene = &args.sample.scene.scene;
    let output = args.destination(scene)?;
    let wishes = Options { threads: args.threads.map(|n| n as usize), ..args.sample.wishes() };
    let loaded = load(scene, &wishes);
    report::print(scene, &loaded.imported, &args.talk);
    let Some(prepared) = &loaded.prepared else {
        return Ok(loaded.failure);
    };
    let window = prepared.window();
    if window.area() == 0 {
        return Err(WrongUsage("--crop lies outside the picture: there is nothing to draw".to_owned()).into());
    }
    let view = &prepared.scene.view;
    let machine = Machine {
        rays: args.rays.unwrap_or_else(|| Machine::rays_for([view.width, view.height])),
        crease: args.crease.into(),
        tolerance: args.tolerance.into(),
        threads: prepared.settings.threads,
        window: Some(window),
    };
    let start = Instant::now();
    let bar = Bar::new(machine.steps([view.width, view.height]), args.talk.quiet);
    // Half a drawing is none: Ctrl-C ends the program.
    let drawing = draw(&prepared.scene, &machine, &bar, &AtomicBool::new(false))?;
    bar.finish();
    let Some(mut drawing) = drawing else { return Ok(Exit::Interrupted) };
    if let Some(spacing) = args.hatch {
        drawing.lines.extend(args.hatching(prepared, &machine, spacing));
    }
    // As wide in a part of the picture as in the whole.
    let shorter = f64::from(view.width.min(view.height));
    let stroke = args.stroke.map_or((shorter / 500.0).max(0.5), f64::from);
    let title =
        Path::new(scene).file_stem().map_or_else(|| scene.clone(), |s| s.to_string_lossy().into_owned());
    let text = svg(&drawing, &title, &Style { stroke, paper: args.paper });
    durer::image::replace_file(&output, text.as_bytes())?;
    if !args.talk.quiet {
        tell(&summary(&drawing, start.elapsed().as_secs_f32()));
    }
    emit(&format!("{}\n", output.display()))?;
    Ok(Exit::Done)
}

impl Args {
    /// Strokes where the picture, as `durer render` makes it, is dark.
    fn hatching(&self, prepared: &Prepared, machine: &Machine, spacing: f32) -> Vec<Line> {
        let never = AtomicBool::new(false);
        let bar = Bar::new(prepared.job().steps(), self.talk.quiet);
        let rendered = prepared.job().render(Gather::Rays, &bar, &never);
        bar.finish();
        let (window, all) = (prepared.window(), rendered.film.pixels());
        let rows = (window.y0..window.y1).map(|y| (y * prepared.scene.view.width) as usize);
        let of_row = |start: usize| all[start + window.x0 as usize..start + window.x1 as usize].iter();
        let pixels: Vec<[f32; 3]> = rows.flat_map(of_row).map(|p| p.mean()).collect();
        let tones = Tones::new([window.x1 - window.x0, window.y1 - window.y0], &pixels);
        let tones = tones.map(|tones| tones.with_corner([window.x0, window.y0]));
        let lines = tones.and_then(|tones| hatch(&prepared.scene, machine, &tones, spacing.into(), &never));
        lines.unwrap_or_default()
    }

    /// The file, known to be writable.
    fn destination(&self, scene: &str) -> anyhow::Result<PathBuf> {
        let stem = Path::new(scene).file_stem().unwrap_or("drawing".as_ref());
        let path = self.output.clone().unwrap_or_else(|| {
            let mut name = stem.to_owned();
            name.push(".svg");
            name.into()
        });
        let suffix = path.extension().map(|s| s.to_string_lossy().to_lowercase());
        if suffix.as_deref() != Some("svg") && !path.is_dir() {
            let shown = path.display();
            let message = format!("{shown}: drawings are written as .svg\n  help: add .svg to the name");
            return Err(WrongUsage(message).into());
        }
        check_writable(&path)?;
        Ok(path)
    }
}

/// What was drawn, and what it took.
fn summary(drawing: &Drawing, seconds: f32) -> String {
    let kinds = Kind::ALL.into_iter().filter_map(|kind| {
        let n = drawing.lines.iter().filter(|line| line.kind == kind).count();
        let [one, many] = match kind {
            Kind::Silhouette => ["silhouette", "silhouettes"],
            Kind::Boundary => ["boundary", "boundaries"],
            Kind::Crease => ["crease", "creases"],
            Kind::Hatch => ["stroke", "strokes"],
        };
        (kind != Kind::Hatch || n > 0).then(|| counted(n as u64, one, many))
    });
    let kinds: Vec<String> = kinds.collect();
    let (w, h) = (drawing.part.x1 - drawing.part.x0, drawing.part.y1 - drawing.part.y0);
    let rays = significant(drawing.rays as f32 / 1e6, 3);
    let seconds = significant(seconds, 3);
    format!("{w} x {h} pixels: {} from {rays} million rays in {seconds} s", kinds.join(", "))
}
