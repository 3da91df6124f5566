//! Embree 4, which runs in a process of its own (`benches/embree_peer.c` tells how to talk to it).
use std::{
    cell::RefCell,
    fs,
    io::{self, BufRead, BufReader, Write},
    ops::Range,
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
};

use anyhow::{Context, bail};

use crate::{
    ours::Mode,
    rays::{Class, Found, RaySet},
    scene::Scene,
    turns::{Competitor, WARM_UP},
};

/// `RTCBuildQuality`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// By Morton codes.
    Low,
    /// By the surface area heuristic.
    Medium,
    /// With spatial splits too.
    High,
}

impl Quality {
    /// As tables and JSON call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }
}

/// What a build took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Built {
    /// By the clock on the wall.
    pub wall: f64,
    /// Processor seconds of all threads.
    pub cpu: f64,
    /// Memory that is held after it, without vertices and indices, which are ours.
    pub bytes: u64,
}

/// The process.
pub struct Embree {
    child: Child,
    talk: RefCell<(ChildStdin, BufReader<ChildStdout>)>,
    /// Where scenes, rays and hits are handed over.
    folder: PathBuf,
}

impl Embree {
    /// Starts `program` with the shared library. Files are exchanged in `folder`.
    ///
    /// # Errors
    /// It cannot be started or the library cannot be opened.
    pub fn start(program: &Path, library: &Path, folder: &Path) -> anyhow::Result<Self> {
        let mut command = Command::new(program);
        command.arg(library).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child =
            command.spawn().with_context(|| format!("{} cannot be started", program.display()))?;
        let (input, output) = (child.stdin.take(), child.stdout.take());
        let talk = input.zip(output.map(BufReader::new)).context("pipes that were asked for")?;
        let embree = Self { child, talk: RefCell::new(talk), folder: folder.to_owned() };
        embree.answer()?;
        Ok(embree)
    }

    /// Its process id.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    fn answer(&self) -> anyhow::Result<Vec<u64>> {
        let mut line = String::new();
        self.talk.borrow_mut().1.read_line(&mut line)?;
        let Some(numbers) = line.strip_prefix("ok") else {
            bail!(
                "the Embree process says: {}",
                if line.is_empty() { "nothing, it has ended" } else { line.trim() }
            );
        };
        numbers.split_whitespace().map(|n| n.parse().context("a number of the Embree process")).collect()
    }

    fn say(&self, line: &str) -> io::Result<()> {
        let input = &mut self.talk.borrow_mut().0;
        writeln!(input, "{line}")?;
        input.flush()
    }

    fn ask(&self, line: &str) -> anyhow::Result<Vec<u64>> {
        self.say(line)?;
        self.answer()
    }

    fn number(&self, line: &str) -> anyhow::Result<u64> {
        self.ask(line)?.first().copied().with_context(|| format!("no answer to \"{line}\""))
    }

    /// Hands over a scene; everything built before is freed.
    ///
    /// # Errors
    /// As all that follow: a file cannot be written, or the process complains or has ended.
    pub fn scene(&self, scene: &Scene) -> anyhow::Result<()> {
        let path = self.folder.join("scene.bin");
        scene.write(&path)?;
        self.ask(&format!("scene {}", path.display()))?;
        Ok(fs::remove_file(path)?)
    }

    /// Hands over rays, in place of earlier ones of the same kind.
    ///
    /// # Errors
    /// As [`Embree::scene`].
    pub fn rays(&self, set: &RaySet) -> anyhow::Result<()> {
        let path = self.folder.join("rays.bin");
        set.write(&path)?;
        let occlusion = u8::from(set.class == Class::Occlusion);
        self.ask(&format!("rays {} {occlusion} {}", set.class as u8, path.display()))?;
        Ok(fs::remove_file(path)?)
    }

    /// Builds the scene into a slot.
    ///
    /// # Errors
    /// As [`Embree::scene`].
    pub fn build(&self, slot: u8, quality: Quality, mode: Mode, threads: usize) -> anyhow::Result<Built> {
        let robust = u8::from(mode == Mode::Robust);
        let numbers = self.ask(&format!("build {slot} {} {robust} {threads}", quality as u8))?;
        let &[wall, cpu, bytes] = numbers.as_slice() else { bail!("a build has three figures") };
        Ok(Built { wall: wall as f64 * 1e-9, cpu: cpu as f64 * 1e-9, bytes })
    }

    /// Frees a slot.
    ///
    /// # Errors
    /// As [`Embree::scene`].
    pub fn drop_slot(&self, slot: u8) -> anyhow::Result<()> {
        self.ask(&format!("drop {slot}")).map(drop)
    }

    /// What the rays of a kind that was handed over meet.
    ///
    /// # Errors
    /// As [`Embree::scene`].
    pub fn hits(&self, slot: u8, class: Class) -> anyhow::Result<Vec<Option<Found>>> {
        let path = self.folder.join("hits.bin");
        self.ask(&format!("hits {slot} {} {}", class as u8, path.display()))?;
        let bytes = fs::read(&path)?;
        fs::remove_file(path)?;
        let number = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        let found = |b: &[u8]| {
            let found =
                Found { t: f32::from_bits(number(b)), instance: number(&b[4..]), prim: number(&b[8..]) };
            (found.instance != u32::MAX).then_some(found)
        };
        Ok(bytes.chunks_exact(12).map(found).collect())
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // It may have ended before.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What is built in a slot, as one who runs in turns.
pub struct Slot<'a> {
    /// The process.
    pub embree: &'a Embree,
    /// Which one.
    pub number: u8,
}

impl Competitor for Slot<'_> {
    fn run(&self, set: &RaySet, chunks: &[Range<usize>]) -> anyhow::Result<f64> {
        let mut line = format!("run {} {} {WARM_UP} {}", self.number, set.class as u8, chunks.len());
        for chunk in chunks {
            line.push_str(&format!(" {} {}", chunk.start, chunk.len()));
        }
        Ok(self.embree.number(&line)? as f64 * 1e-9)
    }
}
