//! `durer render --frames`: one picture after another of a scene that moves, into numbered files, or into a video.
mod name;
mod video;

use std::{
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

use durer::{Prepared, Sequence, film::Developed, scene::SceneDesc};

use crate::{
    exit::{Exit, WrongUsage, emit, emit_json, tell},
    interrupt::Interrupt,
    load,
    number::{counted, seconds},
    options::SampleOptions,
    output::{Destination, check_writable, default_path, destinations},
    progress::Bar,
    render::{Args, Taken},
    report,
    stats::{Facts, Seconds, Stats, StatsForm},
};
use name::numbered;
use video::{Video, check_ffmpeg, is_video};

/// Most frames of one run: more are a typing error.
const MOST: u32 = 1_000_000;

/// Frames at equal distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frames {
    first: u32,
    last: u32,
    step: u32,
}

/// Which frames.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Frames")]
pub(crate) struct FrameOptions {
    /// Takes a picture of each of these frames, of both ends too: frame N at --time-at plus N / --fps seconds. Of a glTF
    /// file the first animation is played unless --animation names another. Files get numbers: -o out.####.png or
    /// out.%04d.png; .mp4, .mov, .mkv, .webm and .gif become videos through ffmpeg.
    #[arg(long, value_name = "A..B[:STEP]", value_parser = range)]
    pub(crate) frames: Option<Frames>,
    /// Leaves out frames all of whose pictures exist; with a video that exists, and all pictures, everything.
    #[arg(long, requires = "frames")]
    pub(crate) skip_existing: bool,
}

fn range(text: &str) -> Result<Frames, String> {
    let form = "expected A..B or A..B:STEP, whole numbers of frames from 0, such as 0..47 or 1..100:2";
    let whole = |text: &str| text.trim().parse::<u32>().map_err(|_| form.to_owned());
    let (ends, step) = match text.split_once(':') {
        Some((ends, step)) => (ends, whole(step)?),
        None => (text, 1),
    };
    let (first, last) = ends.split_once("..").ok_or(form)?;
    let frames = Frames { first: whole(first)?, last: whole(last)?, step };
    match frames {
        Frames { step: 0, .. } => Err("the step must be 1 at least".to_owned()),
        Frames { first, last, .. } if first > last => Err("the last frame lies before the first".to_owned()),
        Frames { first, last, step } if (last - first) / step >= MOST => {
            Err(format!("more than {MOST} frames"))
        }
        frames => Ok(frames),
    }
}

impl Frames {
    fn numbers(self) -> impl Iterator<Item = u32> {
        (self.first..=self.last).step_by(self.step as usize)
    }
}

/// What a sequence is written to.
struct Plan {
    /// With a place for the number.
    pictures: Vec<Destination>,
    videos: Vec<PathBuf>,
    /// The frames to take.
    frames: Vec<u32>,
}

impl Plan {
    fn new(args: &Args, frames: Frames) -> anyhow::Result<Self> {
        let asked = match args.output.as_slice() {
            [] => vec![default_path(&args.sample.scene.scene)],
            asked => asked.to_vec(),
        };
        let (videos, patterns): (Vec<PathBuf>, Vec<PathBuf>) = asked.into_iter().partition(|p| is_video(p));
        if !videos.is_empty() {
            check_ffmpeg()?;
            videos.iter().try_for_each(|video| check_writable(video))?;
        }
        let first: Vec<PathBuf> = patterns.iter().map(|p| numbered(p, frames.first)).collect();
        let pictures = match first.as_slice() {
            [] => Vec::new(),
            first => destinations(first, &args.sample.scene.scene)?,
        };
        let pictures: Vec<Destination> =
            pictures.into_iter().zip(patterns).map(|(picture, pattern)| picture.called(pattern)).collect();
        let skips = args.frames.skip_existing;
        let exists = |frame: &u32| pictures.iter().all(|p| numbered(&p.path, *frame).exists());
        let is_there = |frame: &u32| skips && !pictures.is_empty() && exists(frame);
        let mut taken: Vec<u32> = frames.numbers().collect();
        if videos.is_empty() {
            taken.retain(|frame| !is_there(frame));
        } else if skips && videos.iter().all(|video| video.exists()) && taken.iter().all(exists) {
            taken.clear();
        }
        Ok(Self { pictures, videos, frames: taken })
    }

    fn files(&self, frame: u32) -> Vec<Destination> {
        self.pictures.iter().map(|p| p.called(numbered(&p.path, frame))).collect()
    }
}

/// A sequence that is being taken.
struct Shoot<'a> {
    args: &'a Args,
    plan: &'a Plan,
    bar: Bar,
    videos: Vec<Video>,
    failed: bool,
}

pub(crate) fn run(args: &Args, frames: Frames) -> anyhow::Result<Exit> {
    let plan = Plan::new(args, frames)?;
    let Some(&first) = plan.frames.first() else {
        if !args.talk.quiet {
            tell("all frames exist already: nothing was rendered");
        }
        return Ok(Exit::Done);
    };
    let interrupt = Interrupt::listen("keeping the frames that are whole")?;
    let scene = &args.sample.scene.scene;
    let wishes = args.wishes(&sample_at(args, first), &plan.pictures);
    let start = Instant::now();
    let imported = load::import(scene, &wishes);
    let failure = load::failure(&imported, &wishes);
    let mut sequence = Sequence::new(imported, wishes);
    let (bar, videos) = (Bar::new(0, args.talk.quiet), Vec::new());
    let mut shoot = Shoot { args, plan: &plan, bar, videos, failed: false };
    let load = start.elapsed();
    let cancel = interrupt.rendering();
    let mut done = 0;
    for (number, &frame) in plan.frames.iter().enumerate() {
        let begin = Instant::now();
        let prepared = sequence.at(moment(args, frame));
        if number == 0 || prepared.is_none() {
            shoot.bar.pause(|| report::print(scene, &sequence.imported, &args.talk));
        }
        let Some(prepared) = prepared else {
            shoot.bar.finish();
            return Ok(failure);
        };
        if number == 0 {
            args.check_crop(&prepared)?;
            args.warn_about_looks(&prepared);
            args.tell_of_layers(&sequence.imported.desc, &plan.pictures);
        }
        let left = (plan.frames.len() - number) as u64;
        shoot.bar.expect(prepared.job().steps().saturating_mul(left));
        let seconds = Seconds { load, build: begin.elapsed(), ..Seconds::default() };
        let desc = &sequence.imported.desc;
        if !shoot.take((frame, number == 0), (desc, &prepared), (seconds, cancel))? {
            break;
        }
        done += 1;
    }
    shoot.bar.finish();
    let failed = shoot.failed;
    let videos = if done > 0 { shoot.end()? } else { Vec::new() };
    videos.iter().try_for_each(|video| emit(&format!("{}\n", video.display())))?;
    if !args.talk.quiet {
        tell(&format!("{} in {}", counted(done, "frame", "frames"), seconds(start.elapsed())));
    }
    Ok(match (cancel.load(Ordering::Relaxed), failed) {
        (true, _) => Exit::Interrupted,
        (false, true) => Exit::Failed,
        (false, false) => Exit::Done,
    })
}

/// When a frame is taken, in seconds.
fn moment(args: &Args, frame: u32) -> f32 {
    let scene = &args.sample.scene;
    (f64::from(scene.start()) + f64::from(frame) / f64::from(scene.fps())) as f32
}

/// The options for one frame alone.
fn sample_at(args: &Args, frame: u32) -> SampleOptions {
    SampleOptions { scene: args.sample.scene.at(moment(args, frame)), ..args.sample.clone() }
}

impl Shoot<'_> {
    /// Takes a frame; false if that was interrupted.
    fn take(
        &mut self,
        (frame, is_first): (u32, bool),
        (desc, prepared): (&SceneDesc, &Prepared),
        (seconds, cancel): (Seconds, &AtomicBool),
    ) -> anyhow::Result<bool> {
        let start = Instant::now();
        let rendered = self.args.render(prepared, &self.bar, cancel);
        if rendered.cancelled {
            return Ok(false);
        }
        let seconds = Seconds { render: start.elapsed(), ..seconds };
        let files = self.plan.files(frame);
        let taken = Taken { desc, prepared, rendered: &rendered, seconds };
        let Shoot { args, bar, .. } = &*self;
        let written = bar.pause(|| -> anyhow::Result<usize> {
            let sample = sample_at(args, frame);
            args.warn_about_bad_samples(&sample, &rendered);
            if is_first {
                args.warn_about_imbalances(prepared, &rendered);
                args.explain_darkness(desc, &taken.picture(&sample.scene.scene), &files);
            }
            said(args, &taken, &files)
        })?;
        self.failed |= written < files.len();
        self.film(&taken)?;
        Ok(true)
    }

    /// Adds a frame to the videos.
    fn film(&mut self, taken: &Taken<'_>) -> anyhow::Result<()> {
        if self.plan.videos.is_empty() {
            return Ok(());
        }
        let scene = &self.args.sample.scene;
        let Developed { width, height, rgb8 } =
            taken.picture(&scene.scene).develop(self.args.look(taken.prepared));
        if self.videos.is_empty() {
            // It plays as long as what it shows takes.
            let fps = scene.fps() / self.args.frames.frames.map_or(1.0, |frames| frames.step as f32);
            let start = |path: &PathBuf| Video::start(path, (width, height), fps);
            self.videos = self.plan.videos.iter().map(start).collect::<anyhow::Result<_>>()?;
        }
        self.videos.iter_mut().try_for_each(|video| video.push((width, height), &rgb8))
    }

    /// Ends the videos; those that were made.
    fn end(self) -> anyhow::Result<Vec<PathBuf>> {
        self.videos.into_iter().try_for_each(Video::finish)?;
        Ok(self.plan.videos.clone())
    }
}

/// Writes the pictures of a frame and says which; how many could be written.
fn said(args: &Args, taken: &Taken<'_>, files: &[Destination]) -> anyhow::Result<usize> {
    let scene = &args.sample.scene.scene;
    let start = Instant::now();
    let written = args.write(&taken.picture(scene), files);
    let seconds = Seconds { write: start.elapsed(), ..taken.seconds };
    let (prepared, rendered) = (taken.prepared, taken.rendered);
    let stats = Stats::new(&Facts { scene, prepared, rendered, seconds, outputs: &written });
    match args.stats {
        Some(StatsForm::Json) => emit_json(&stats)?,
        Some(StatsForm::Text) => tell(stats.text().trim_end()),
        None if args.talk.verbose => tell(&stats.summary()),
        None => {}
    }
    if args.stats != Some(StatsForm::Json) {
        written.iter().try_for_each(|path| emit(&format!("{path}\n")))?;
    }
    Ok(written.len())
}

/// A video is made of frames: a single picture is none.
pub(crate) fn check_single(outputs: &[PathBuf]) -> Result<(), WrongUsage> {
    let video = outputs.iter().map(PathBuf::as_path).find(|path: &&Path| is_video(path));
    video.map_or(Ok(()), |video| {
        let name = video.display();
        Err(WrongUsage(format!("{name}: a video needs frames\n  help: add --frames 0..47, or so")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_frames_hold_both_ends() {
        let all = |text: &str| range(text).map(|frames| frames.numbers().collect::<Vec<_>>());
        assert_eq!(all("3..5"), Ok(vec![3, 4, 5]));
        assert_eq!(all("0..5:2"), Ok(vec![0, 2, 4]));
        assert_eq!(all("7..7"), Ok(vec![7]));
        for wrong in ["5", "5..3", "1..2:0", "a..b", "-1..2", "1...2", "0..4000000000", "1..2:x", ""] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
    }
}
