//! Options over options: what `--diff` says, over what the command line says.
use clap::{ArgMatches, Args, Command, Error, FromArgMatches, parser::ValueSource};

use super::SampleOptions;
use crate::exit::WrongUsage;

impl SampleOptions {
    /// These options with others over them: `words` as they would stand on the command line, the scene among them.
    pub(crate) fn overlaid(&self, words: &str) -> Result<Self, WrongUsage> {
        let wrong = |why: String| WrongUsage(format!("--diff \"{words}\": {why}"));
        let split = shlex::split(words).ok_or_else(|| wrong("a quotation mark is not closed".to_owned()))?;
        if split.is_empty() {
            let why = "there is nothing in it\n  help: name what differs, such as --diff '--max-depth 2'";
            return Err(wrong(why.to_owned()));
        }
        let command = Self::augment_args(Command::new("--diff").no_binary_name(true).disable_help_flag(true));
        let said = |error: Error| {
            let text = error.to_string();
            let lines =
                text.lines().take_while(|line| !line.starts_with("Usage") && !line.contains("--help"));
            let lines: Vec<&str> = lines.map(str::trim).filter(|line| !line.is_empty()).collect();
            wrong(lines.join("\n  ").trim_start_matches("error: ").to_owned())
        };
        let mut matches = command.try_get_matches_from(split).map_err(said)?;
        let given =
            |matches: &ArgMatches, id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
        let (scene, accel) = (given(&matches, "scene"), given(&matches, "accel"));
        let (aperture, fnumber) = (given(&matches, "aperture"), given(&matches, "fnumber"));
        let (focus, focus_pixel) = (given(&matches, "focus"), given(&matches, "focus_pixel"));
        let mut new = self.clone();
        new.update_from_arg_matches_mut(&mut matches).map_err(said)?;
        // What has a default looks as if it had been given.
        if !scene {
            new.scene.scene.clone_from(&self.scene.scene);
        }
        if !accel {
            new.transport.accel = self.transport.accel;
        }
        new.scene.lenient |= self.scene.lenient;
        // Of two ways to say the same the new one counts.
        match (aperture, fnumber) {
            (true, _) => new.scene.fnumber = None,
            (_, true) => new.scene.aperture = None,
            _ => {}
        }
        match (focus, focus_pixel) {
            (true, _) => new.scene.focus_pixel = None,
            (_, true) => new.scene.focus = None,
            _ => {}
        }
        Ok(new)
    }
}
