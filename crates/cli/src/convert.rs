//! `durer convert`: a scene in another format, with all its files.
use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, bail};
use durer::{
    Glb, Options, Studio, ToWrite,
    export::{Beside, Content, Files},
    image::replace_file,
    scene::nearest_word,
};

use crate::{
    exit::{Exit, WrongUsage, emit, harmless, tell},
    load::{failure, import},
    options::{SampleOptions, TalkOptions},
    output::check_writable,
    report,
    value::whole,
};

const EXAMPLES: &str = "\
Examples:
  durer convert room.glb room.pbrt             and room-files/ with its pictures and meshes
  durer convert statue.ply statue.glb          one file, for viewers and other programs
  durer convert cornell cornell.pbrt           a built-in scene, to be changed
  durer convert room.gltf dusk.pbrt --camera side --env dusk.exr --spp 256

The scene is written as it would be rendered: with what the options say, and with the
camera and the lights that are made up for files without. Rendered, a .pbrt file gives
the very picture that the original gives. What .glb has no words for is named in
warnings; docs/convert.md lists it.

Files that were read for the scene are copied to STEM-files beside a .pbrt, so that both
can be moved together. A .glb holds everything. stdout holds the paths of what was written.";

/// Writes a scene in another format: .pbrt or .glb.
#[derive(clap::Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    sample: SampleOptions,
    /// The file to write; its suffix says the format.
    #[arg(value_name = "OUT", required_unless_present = "output", conflicts_with = "output")]
    out: Option<PathBuf>,
    /// The same as OUT.
    #[arg(long, short, value_name = "FILE", help_heading = "Writing")]
    output: Option<PathBuf>,
    /// Writes over files that are there.
    #[arg(long, help_heading = "Writing")]
    force: bool,
    /// Worker threads [default: all cores].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=4096))]
    #[arg(allow_negative_numbers = true, help_heading = "Running")]
    threads: Option<u32>,
    #[command(flatten)]
    talk: TalkOptions,
}

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Pbrt,
    Glb,
}

impl Format {
    const ALL: [(&'static str, Self); 2] = [("pbrt", Self::Pbrt), ("glb", Self::Glb)];

    fn of(path: &Path) -> Result<Self, WrongUsage> {
        let shown = path.display();
        let known = Self::ALL.map(|(suffix, _)| suffix);
        let Some(suffix) = path.extension().map(|s| s.to_string_lossy().to_lowercase()) else {
            let help = "add .pbrt or .glb to the name";
            return Err(WrongUsage(format!("{shown}: the name does not say which format\n  help: {help}")));
        };
        let found = Self::ALL.iter().find(|(known, _)| *known == suffix).map(|(_, format)| *format);
        found.ok_or_else(|| {
            let near = nearest_word(&suffix, known);
            let help =
                near.map_or_else(|| "use .pbrt or .glb".to_owned(), |near| format!("did you mean .{near}?"));
            WrongUsage(format!("{shown}: scenes are not written as .{suffix}\n  help: {help}"))
        })
    }
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let scene = &args.sample.scene.scene;
    let out = args.out.as_ref().or(args.output.as_ref()).context("no file to write")?;
    let format = Format::of(out)?;
    check_writable(out)?;
    // Its own files would be read and written at once.
    if out.canonicalize().is_ok_and(|there| Path::new(scene).canonicalize().is_ok_and(|own| own == there)) {
        return Err(WrongUsage(format!("{}: is the scene itself", out.display())).into());
    }
    if !args.force && out.exists() {
        bail!("{}: is there already\n  help: --force writes over it", out.display());
    }
    let wishes = Options { threads: args.threads.map(|n| n as usize), ..args.sample.wishes() };
    let imported = import(scene, &wishes);
    let failure = failure(&imported, &wishes);
    let (studio, prepared) = match Studio::open(imported, &wishes) {
        Ok(opened) => opened,
        Err(imported) => {
            report::print(scene, &imported, &args.talk);
            return Ok(failure);
        }
    };
    report::print(scene, &studio.imported, &args.talk);
    let camera = match &wishes.camera {
        None => 0,
        Some(wanted) => camera_called(&studio, wanted),
    };
    let whole = ToWrite {
        desc: &studio.imported.desc,
        assets: &studio.imported.assets,
        options: &studio.options,
        camera,
        prepared: &prepared,
    };
    match format {
        Format::Pbrt => args.pbrt(&whole, out)?,
        Format::Glb => args.glb(&whole, out)?,
    }
    if let Some(words) = whole.words()
        && !args.talk.quiet
    {
        tell(&format!("note: {words}"));
    }
    Ok(Exit::Done)
}

/// The index of a camera, by name or number; it is there.
fn camera_called(studio: &Studio, wanted: &str) -> usize {
    let cameras = &studio.imported.desc.cameras;
    let named = cameras.iter().position(|camera| camera.name == wanted);
    named.or_else(|| wanted.parse().ok()).filter(|index| *index < cameras.len()).unwrap_or(0)
}

impl Args {
    fn pbrt(&self, whole: &ToWrite<'_>, out: &Path) -> anyhow::Result<()> {
        let stem = out.file_stem().unwrap_or_default().to_string_lossy();
        let folder = format!("{stem}-files");
        let scene = &self.sample.scene.scene;
        let remarks = [format!("durer {}: converted from {scene}.", env!("CARGO_PKG_VERSION"))];
        let written = whole.pbrt(Files::All, &folder, &remarks).map_err(|refused| {
            let list: String = refused.iter().map(|what| format!("\n  {what}")).collect();
            anyhow::anyhow!("{scene} cannot be written as .pbrt, as the language has no words for it:{list}")
        })?;
        let beside = out.parent().unwrap_or(Path::new(""));
        if !written.beside.is_empty() {
            let folder = beside.join(&folder);
            if folder.exists() && !self.force {
                bail!("{}: is there already\n  help: --force writes into it", folder.display());
            }
            fs::create_dir_all(&folder).with_context(|| format!("{}: cannot be made", folder.display()))?;
            written.beside.iter().try_for_each(|file| put(beside, file))?;
        }
        // Last: whoever finds it finds its files, too.
        replace_file(out, written.text.as_bytes())?;
        let files = match written.beside.len() {
            0 => String::new(),
            _ => format!("{}\n", beside.join(&folder).display()),
        };
        emit(&format!("{}\n{files}", out.display()))
    }

    fn glb(&self, whole: &ToWrite<'_>, out: &Path) -> anyhow::Result<()> {
        let Glb { bytes, warnings } =
            whole.glb().map_err(|why| anyhow::anyhow!("{}: {why}", out.display()))?;
        if !self.talk.quiet {
            warnings.iter().for_each(|warning| tell(&format!("warning: {}", harmless(warning))));
        }
        replace_file(out, &bytes)?;
        emit(&format!("{}\n", out.display()))
    }
}

/// Writes a file beside the scene.
fn put(beside: &Path, file: &Beside) -> anyhow::Result<()> {
    let path = beside.join(&file.path);
    match &file.content {
        Content::Bytes(bytes) => replace_file(&path, bytes)?,
        // A conversion in place: the file is there already.
        Content::Copy(from) if path.canonicalize().is_ok_and(|there| there == *from) => {}
        Content::Copy(from) => {
            fs::copy(from, &path).with_context(|| format!("{}: cannot be written", path.display()))?;
        }
    }
    Ok(())
}
