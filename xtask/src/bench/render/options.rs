//! The words after `bench render`.
use anyhow::{Context, bail};

use super::scene::{SCENES, Scene};

/// The scene that is timed beside POV-Ray.
const SPHERES: &str = "povray_spheres";

/// What was asked for.
pub(crate) struct Options {
    pub(super) json: bool,
    pub(super) runs: usize,
    /// How good the antialiased pictures beside POV-Ray are.
    pub(super) quality: bool,
    quick: bool,
    samples: Option<u32>,
    /// All if empty.
    scenes: Vec<String>,
    /// Beginnings of names; all if empty.
    renderers: Vec<String>,
}

impl Options {
    /// # Errors
    /// On words that are not known.
    pub(crate) fn parse(words: &[&str]) -> anyhow::Result<Self> {
        let mut options = Self {
            json: false,
            runs: 0,
            quality: false,
            quick: false,
            samples: None,
            scenes: Vec::new(),
            renderers: Vec::new(),
        };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            match *word {
                "--json" => options.json = true,
                "--quality" => options.quality = true,
                "--quick" => options.quick = true,
                "--runs" => {
                    options.runs = number(words.next(), 2).context("--runs wants a number of at least 2")?
                }
                "--spp" => {
                    let samples = number(words.next(), 2).context("--spp wants a number of at least 2")?;
                    options.samples = Some(samples as u32);
                }
                "--scene" => options.scenes = names(words.next()).context("--scene wants names")?,
                "--renderer" => options.renderers = names(words.next()).context("--renderer wants names")?,
                other => bail!("unknown option \"{other}\"; see `cargo xtask help`"),
            }
        }
        if options.runs == 0 {
            options.runs = if options.quick { 2 } else { 3 };
        }
        let known = |name: &String| name == SPHERES || SCENES.iter().any(|scene| scene.name == name);
        if let Some(unknown) = options.scenes.iter().find(|name| !known(name)) {
            let names: Vec<&str> = SCENES.iter().map(|scene| scene.name).chain([SPHERES]).collect();
            bail!("no scene \"{unknown}\"; there are {}", names.join(", "));
        }
        Ok(options)
    }

    pub(super) fn scenes(&self) -> impl Iterator<Item = &'static Scene> {
        SCENES.iter().filter(|scene| self.wants_scene(scene.name))
    }

    pub(super) fn with_spheres(&self) -> bool {
        self.wants_scene(SPHERES)
    }

    fn wants_scene(&self, name: &str) -> bool {
        self.scenes.is_empty() || self.scenes.iter().any(|wanted| wanted == name)
    }

    pub(super) fn wants_renderer(&self, name: &str) -> bool {
        self.renderers.is_empty() || self.renderers.iter().any(|wanted| name.starts_with(wanted.as_str()))
    }

    /// Samples per pixel.
    pub(super) fn samples(&self, scene: &Scene) -> u32 {
        // Squares, which Mitsuba's multijittered points want.
        self.samples.unwrap_or(if self.quick { (scene.samples / 4).max(4) } else { scene.samples })
    }
}

fn number(word: Option<&&str>, least: usize) -> Option<usize> {
    word?.parse().ok().filter(|number| *number >= least)
}

fn names(word: Option<&&str>) -> Option<Vec<String>> {
    let names: Vec<String> = word?.split(',').filter(|name| !name.is_empty()).map(str::to_owned).collect();
    (!names.is_empty()).then_some(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let words =
            ["--runs", "4", "--json", "--scene", "cornell,atrium", "--renderer", "durer,mitsuba", "--quick"];
        let options = Options::parse(&words).expect("good options");
        assert!(options.json && options.runs == 4 && !options.quality && !options.with_spheres());
        assert_eq!(options.scenes().map(|scene| scene.name).collect::<Vec<_>>(), ["cornell", "atrium"]);
        assert!(options.wants_renderer("mitsuba-llvm") && !options.wants_renderer("cycles"));
        assert!(options.scenes().all(|scene| options.samples(scene) == scene.samples / 4));
        for wrong in [&["--runs", "1"][..], &["--runs"], &["--fast"], &["--scene", "x"], &["--spp", "0"]] {
            assert!(Options::parse(wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn without_options_everything_is_measured() {
        let options = Options::parse(&[]).expect("no options");
        assert!(options.with_spheres() && options.scenes().count() == SCENES.len() && options.runs == 3);
    }
}
