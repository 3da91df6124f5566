//! Videos: frames on their way through `ffmpeg`, which is a program of its own.
use std::{
    ffi::OsString,
    fs,
    io::{ErrorKind, Read, Write},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
};

use anyhow::{Context, anyhow, bail};

/// How a kind of video is made.
struct Kind {
    suffix: &'static str,
    /// What `ffmpeg` calls the file format.
    format: &'static str,
    /// How frames are coded.
    options: &'static [&'static str],
}

/// Bright as the pictures are: pixels in sRGB, to the matrix that players expect. H.264 wants even sizes.
const H264: &[&str] = &[
    "-vf",
    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
    "-c:v",
    "libx264",
    "-crf",
    "16",
    "-pix_fmt",
    "yuv420p",
    "-colorspace",
    "bt709",
    "-color_primaries",
    "bt709",
    "-color_trc",
    "iec61966-2-1",
    "-movflags",
    "+faststart",
];
const VP9: &[&str] = &[
    "-vf",
    "scale=out_color_matrix=bt709:out_range=tv",
    "-c:v",
    "libvpx-vp9",
    "-crf",
    "20",
    "-b:v",
    "0",
    "-pix_fmt",
    "yuv420p",
    "-colorspace",
    "bt709",
    "-color_primaries",
    "bt709",
    "-color_trc",
    "iec61966-2-1",
];
/// Colours are chosen from all frames.
const GIF: &[&str] =
    &["-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=sierra2_4a", "-loop", "0"];

const KINDS: [Kind; 5] = [
    Kind { suffix: "mp4", format: "mp4", options: H264 },
    Kind { suffix: "mov", format: "mov", options: H264 },
    Kind { suffix: "mkv", format: "matroska", options: H264 },
    Kind { suffix: "webm", format: "webm", options: VP9 },
    Kind { suffix: "gif", format: "gif", options: GIF },
];

fn kind(path: &Path) -> Option<&'static Kind> {
    let suffix = path.extension()?.to_string_lossy().to_lowercase();
    KINDS.iter().find(|kind| kind.suffix == suffix)
}

/// Whether a name is that of a video.
pub(super) fn is_video(path: &Path) -> bool {
    kind(path).is_some()
}

/// Complains, with what to do, unless `ffmpeg` can be started.
pub(super) fn check_ffmpeg() -> anyhow::Result<()> {
    let asked = Command::new("ffmpeg").arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).status();
    match asked {
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => bail!(
            "videos are made by ffmpeg, which is not installed\n  help: install it (apt install ffmpeg, brew install \
             ffmpeg, winget install ffmpeg), or name pictures: -o out.####.png"
        ),
        Err(error) => Err(error).context("ffmpeg cannot be started"),
    }
}

/// A video that is being made, under another name until it is whole.
pub(super) struct Video {
    child: Child,
    path: PathBuf,
    temporary: PathBuf,
    size: (u32, u32),
    is_whole: bool,
}

impl Video {
    /// A video without frames.
    pub(super) fn start(path: &Path, (width, height): (u32, u32), fps: f32) -> anyhow::Result<Self> {
        let kind = kind(path).ok_or_else(|| anyhow!("{}: no video", path.display()))?;
        let mut name = OsString::from(".");
        name.push(path.file_name().unwrap_or_default());
        name.push(format!(".{}.part", std::process::id()));
        let temporary = path.with_file_name(name);
        let mut command = Command::new("ffmpeg");
        command.args(["-hide_banner", "-nostats", "-loglevel", "error", "-y"]);
        command.args(["-f", "rawvideo", "-pix_fmt", "rgb24"]);
        command.args(["-s", &format!("{width}x{height}"), "-r", &fps.to_string(), "-i", "-"]);
        command.args(kind.options).args(["-f", kind.format]).arg(&temporary);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        // Ctrl-C is for us: the frames so far shall become a whole file.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child = command.spawn().context("ffmpeg cannot be started")?;
        Ok(Self { child, path: path.to_owned(), temporary, size: (width, height), is_whole: false })
    }

    /// Adds a frame of 8-bit colours.
    pub(super) fn push(&mut self, (width, height): (u32, u32), rgb8: &[u8]) -> anyhow::Result<()> {
        if (width, height) != self.size {
            bail!("{}: the pictures of a video must have one size", self.path.display());
        }
        let written = self.child.stdin.as_mut().map_or(Ok(()), |stdin| stdin.write_all(rgb8));
        match written {
            Ok(()) => Ok(()),
            Err(_) => Err(self.complaint()),
        }
    }

    /// Ends the video with the frames that it has.
    pub(super) fn finish(mut self) -> anyhow::Result<()> {
        drop(self.child.stdin.take());
        let complaint = self.complaint();
        if !self.child.wait()?.success() {
            return Err(complaint);
        }
        fs::rename(&self.temporary, &self.path).with_context(|| self.path.display().to_string())?;
        self.is_whole = true;
        Ok(())
    }

    /// What `ffmpeg` says, once it has ended.
    fn complaint(&mut self) -> anyhow::Error {
        drop(self.child.stdin.take());
        let mut said = String::new();
        if let Some(mut stderr) = self.child.stderr.take() {
            // What cannot be read is not said.
            let _ = stderr.read_to_string(&mut said);
        }
        anyhow!("{}: ffmpeg could not make this video: {}", self.path.display(), said.trim())
    }
}

impl Drop for Video {
    fn drop(&mut self) {
        if !self.is_whole {
            // Nothing can be done if it has ended, or the file is gone.
            let _ = self.child.kill();
            let _ = self.child.wait();
            let _ = fs::remove_file(&self.temporary);
        }
    }
}
