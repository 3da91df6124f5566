//! How the tests run `durer` and read what it leaves.
use std::{
    path::PathBuf,
    process::{Command, Output},
};

use durer::scene::Limits;

/// A folder that vanishes, in which `durer` runs.
pub(crate) struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Puts a file there.
    pub(crate) fn with(self, name: &str, text: &str) -> Self {
        std::fs::write(self.path(name), text).expect("a file");
        self
    }

    /// A command that will run there.
    pub(crate) fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_durer"));
        command.current_dir(self.folder.path()).args(words.split_whitespace());
        command
    }

    /// Runs words that hold no blanks.
    pub(crate) fn run(&self, words: &str) -> Ran {
        Ran::of(self.command(words).output().expect("durer runs"))
    }

    /// Runs, and insists on success.
    pub(crate) fn done(&self, words: &str) -> Ran {
        let ran = self.run(words);
        assert_eq!(ran.code, 0, "durer {words}\n{}", ran.stderr);
        ran
    }

    /// Size of a picture file.
    pub(crate) fn size(&self, name: &str) -> (u32, u32) {
        let bytes = std::fs::read(self.path(name)).expect("a picture");
        let image = durer::image::read(&bytes, name, Limits::default()).expect("a sound picture");
        (image.width, image.height)
    }

    /// Channels of an OpenEXR file, by name.
    pub(crate) fn exr(&self, name: &str) -> Exr {
        let bytes = std::fs::read(self.path(name)).expect("a picture");
        let (width, _, channels) =
            durer::image::read_exr_channels(&bytes, name, Limits::default()).expect("a sound picture");
        Exr { width, channels: channels.into_iter().map(|c| (c.name, c.values)).collect() }
    }

    /// True if nothing was left but the files named.
    pub(crate) fn holds_only(&self, names: &[&str]) -> bool {
        let mut left: Vec<_> = std::fs::read_dir(self.folder.path())
            .expect("a folder")
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        left.sort();
        left == names
    }
}

/// What a run left.
pub(crate) struct Ran {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Ran {
    pub(crate) fn of(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self {
            code: output.status.code().expect("an exit status"),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).expect("JSON on stdout")
    }

    /// The numbers of the last line, `pixel R G B`.
    pub(crate) fn pixel(&self) -> [f32; 3] {
        let last = self.stdout.lines().last().expect("a line");
        let numbers = last.strip_prefix("pixel ").expect("a pixel line").split(' ');
        let numbers: Vec<f32> = numbers.map(|n| n.parse().expect("a number")).collect();
        numbers.try_into().expect("three numbers")
    }
}

/// A picture of floats.
pub(crate) struct Exr {
    width: u32,
    channels: Vec<(String, Vec<f32>)>,
}

impl Exr {
    pub(crate) fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|(name, _)| name.as_str()).collect()
    }

    pub(crate) fn channel(&self, name: &str) -> &[f32] {
        let found = self.channels.iter().find(|(n, _)| n == name);
        &found.unwrap_or_else(|| panic!("no channel {name} in {:?}", self.names())).1
    }

    /// Bits of the pixel in these channels.
    pub(crate) fn bits<const N: usize>(&self, names: [&str; N], [x, y]: [u32; 2]) -> [u32; N] {
        names.map(|name| self.channel(name)[(y * self.width + x) as usize].to_bits())
    }

    /// Bits of everything.
    pub(crate) fn all_bits(&self) -> Vec<u32> {
        self.channels.iter().flat_map(|(_, values)| values.iter().map(|v| v.to_bits())).collect()
    }
}
