//! `durer trace`: pixel samples again, every ray recorded.

mod compare;
mod find;
mod help;
mod output;
mod text;
mod which;

use std::{
    path::PathBuf,
    sync::atomic::{AtomicBool, Ordering},
};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::{
    Prepared,
    probe::{Clock, Detail},
    tree::{Find, Page, Subject, Surroundings},
};

use crate::{
    exit::{Exit, WrongUsage, emit, harmless, tell},
    interrupt::Interrupt,
    load::load,
    options::{SampleOptions, TalkOptions},
    report,
    value::{pixel, whole},
};
use help::EXAMPLES;
use output::Output;
use which::Which;
pub(crate) use which::{check_many, check_sample};

/// Nodes of all trees of a page together: other samples than those asked for are left out beyond.
const PAGE_NODES: usize = 10_000;
/// Rays of a page whose boxes are recorded.
const PAGE_WALKS: u32 = 16;

/// Rays of a tree that are recorded: more are cut off, with a word about it. Each takes about two kilobytes of JSON.
const MOST_RAYS: usize = 250_000;

/// Shows the rays of a pixel sample as a tree.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    sample_options: SampleOptions,
    /// Which pixel; 0,0 is the upper left one.
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true, help_heading = "Ray tree")]
    #[arg(required_unless_present = "find", conflicts_with = "find")]
    pixel: Option<[u32; 2]>,
    /// Which of its samples: a number from 0, the brightest, the first that is infinite or NaN, or all [default: 0, or
    /// what was found].
    #[arg(long, value_name = "K|all|brightest|nan", value_parser = Which::read, allow_negative_numbers = true)]
    #[arg(help_heading = "Ray tree")]
    sample: Option<Which>,
    /// Takes all samples of the picture and shows the worst instead of those of a pixel.
    #[arg(long, value_name = "WHAT", value_parser = finds(), help_heading = "Ray tree")]
    find: Option<Find>,
    /// The same samples with the same random numbers under these options as well, and what differs: any of the options on
    /// scene, film, light transport and distribution, or another scene.
    #[arg(long, value_name = "OPTIONS", allow_hyphen_values = true, help_heading = "Ray tree")]
    diff: Option<String>,
    /// Records which boxes the first N rays are tested against, in order. The page has those of the first 16 rays.
    #[arg(long, value_name = "N", value_parser = whole(0u32..=1_000_000), allow_negative_numbers = true)]
    #[arg(default_value_t = 0, hide_default_value = true, help_heading = "Ray tree")]
    walk: u32,
    /// The tree as JSON on stdout.
    #[arg(long, help_heading = "Ray tree")]
    json: bool,
    /// Writes a file as well; may be given several times. The suffix says which format: .html, .json, .svg, .dot, .glb,
    /// .csv, .md.
    #[arg(long, short, value_name = "FILE", help_heading = "Ray tree")]
    output: Vec<PathBuf>,
    /// Worker threads of --find and of small pictures [default: all cores].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=4096))]
    #[arg(allow_negative_numbers = true, help_heading = "Running")]
    threads: Option<u32>,
    #[command(flatten)]
    talk: TalkOptions,
}

fn finds() -> impl TypedValueParser<Value = Find> {
    PossibleValuesParser::new(Find::WORDS).try_map(|word| Find::from_word(&word).ok_or("unknown"))
}

/// What is shown: a pixel, which of its samples, and whether the search for it was given up.
struct Chosen {
    pixel: [u32; 2],
    samples: Vec<u32>,
    interrupted: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let outputs = output::outputs(&args.output)?;
    let other = args.diff.as_deref().map(|words| args.sample_options.overlaid(words)).transpose()?;
    let interrupt = Interrupt::listen("the worst so far is shown")?;
    let scene = &args.sample_options.scene.scene;
    let loaded = load(scene, &args.wishes(&args.sample_options));
    report::print(scene, &loaded.imported, &args.talk);
    let Some(prepared) = &loaded.prepared else {
        return Ok(loaded.failure);
    };
    let Some(chosen) = args.choose(prepared, &interrupt)? else {
        return Ok(Exit::Failed);
    };
    if outputs.iter().any(|o| o.format.is_page()) || other.is_some() {
        check_many("a page holds", prepared.job().sample_count(chosen.pixel))?;
    }
    let subject = Subject { name: scene, prepared };
    let mut page = subject.page(chosen.pixel, &chosen.samples, args.around(&outputs), args.detail(&outputs));
    if let Some(other) = other {
        let loaded = load(&other.scene.scene, &args.wishes(&other));
        report::print(&other.scene.scene, &loaded.imported, &args.talk);
        let Some(prepared) = &loaded.prepared else {
            return Ok(loaded.failure);
        };
        let twin = Subject { name: &other.scene.scene, prepared };
        if page.values.is_empty() {
            subject.add_samples(&mut page, chosen.pixel);
        }
        compare::add(
            (&mut page, chosen.samples.len()),
            &subject,
            &twin,
            args.diff.as_deref().unwrap_or_default(),
        )?;
    }
    if page.trees.iter().any(|tree| tree.nodes.len() >= MOST_RAYS) {
        tell(&format!(
            "warning: the tree has more than {MOST_RAYS} rays: the rest is not recorded\n  \
             help: lower --max-depth or raise --min-contribution"
        ));
    }
    let shown = output::only(&page, chosen.samples.len(), args.walk);
    let written = output::write(&outputs, &page, &shown, &args.talk);
    if args.json {
        emit(&(shown.json()? + "\n"))?;
    } else {
        emit(&harmless(&text::page(&shown)))?;
    }
    Ok(match (written, chosen.interrupted) {
        (_, true) => Exit::Interrupted,
        (true, false) => Exit::Done,
        (false, false) => Exit::Failed,
    })
}

impl Args {
    fn wishes(&self, options: &SampleOptions) -> durer::Options {
        durer::Options { threads: self.threads.map(|n| n as usize), ..options.wishes() }
    }

    /// What is recorded beside what is always.
    fn detail(&self, outputs: &[Output]) -> Detail {
        let page = outputs.iter().any(|o| o.format.is_page());
        Detail {
            walks: self.walk.max(if page { PAGE_WALKS } else { 0 }) as usize,
            clock: if page { Clock::On } else { Clock::Off },
            rays: MOST_RAYS,
        }
    }

    /// How much of the scene the files want to show.
    fn around(&self, outputs: &[Output]) -> Surroundings {
        if outputs.iter().any(|o| o.format.is_page()) {
            Surroundings::SceneAndSamples(PAGE_NODES)
        } else if outputs.iter().any(|o| o.format.shows_scene()) {
            Surroundings::Scene
        } else {
            Surroundings::None
        }
    }

    /// The pixel and the samples; `None`, with a word about it, if there is no such thing.
    fn choose(&self, prepared: &Prepared, interrupt: &Interrupt) -> anyhow::Result<Option<Chosen>> {
        let (pixel, found, interrupted) = match (self.pixel, self.find) {
            (Some(pixel), _) => (pixel, 0, false),
            (None, Some(find)) => match find::search(self, find, prepared, interrupt)? {
                Some((found, interrupted)) => (found.pixel, found.sample, interrupted),
                None => return Ok(None),
            },
            (None, None) => return Err(WrongUsage("--pixel or --find says which pixel".to_owned()).into()),
        };
        check_pixel(prepared, pixel)?;
        let which = self.sample.unwrap_or(Which::Index(found));
        // Samples that are looked through are left at Ctrl-C; everything else ends with it.
        let never = AtomicBool::new(false);
        let searches = matches!(which, Which::Brightest | Which::Nan);
        let cancel = if searches { interrupt.rendering() } else { &never };
        let samples = which.of(prepared, pixel, cancel)?;
        let interrupted = interrupted || cancel.load(Ordering::Relaxed);
        let Some(samples) = samples else {
            let [x, y] = pixel;
            let count = prepared.job().sample_count(pixel);
            tell(&format!("error: none of the {count} samples of pixel {x},{y} is infinite or NaN"));
            return Ok(None);
        };
        Ok(Some(Chosen { pixel, samples, interrupted }))
    }
}

/// Complains about a pixel that is none of the picture's.
pub(crate) fn check_pixel(prepared: &Prepared, [x, y]: [u32; 2]) -> Result<(), WrongUsage> {
    let view = &prepared.scene.view;
    if x < view.width && y < view.height {
        return Ok(());
    }
    let (right, bottom) = (view.width - 1, view.height - 1);
    let size = format!("{} x {}", view.width, view.height);
    Err(WrongUsage(format!(
        "pixel {x},{y} lies outside the picture of {size} pixels: the last one is {right},{bottom}\n  \
         help: give the --width and --height of the render that you mean"
    )))
}

/// The value that stands in the last line: the sample's, or the pixel's if all its samples are shown.
fn value(page: &Page) -> [f32; 3] {
    match page.trees.as_slice() {
        [tree] => durer::tree::plain(tree.rgb),
        _ => durer::tree::plain(page.mean),
    }
}
