//! `cargo xtask assets`: every model of the test files through the program, into a page, thumbnails and contact sheets.
mod corpus;
mod page;
pub(crate) mod picture;
mod sheet;
mod trial;

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, bail};

use crate::{release_program, root, target_folder};
use corpus::{Corpus, Model};
use picture::Picture;
use trial::{Outcome, Trial};

/// Formats, each with the suffixes of its files; a format is also the name of the folder they lie in.
const FORMATS: &[(&str, &[&str])] = &[
    ("gltf", &[".gltf", ".glb"]),
    ("obj", &[".obj"]),
    ("ply", &[".ply", ".ply.gz"]),
    ("stl", &[".stl"]),
    ("pbrt", &[".pbrt"]),
];

/// Those that are taken if nothing was asked for.
const USUAL: &[&str] = &["gltf", "obj", "ply", "stl"];

/// Pixels per row of a thumbnail.
const THUMBNAIL: u32 = 160;

/// What was asked for.
#[derive(Debug)]
pub(crate) struct Options {
    folder: Option<PathBuf>,
    formats: Vec<String>,
    width: u32,
}

impl Options {
    /// From the words after `assets`.
    pub(crate) fn parse(words: &[&str]) -> anyhow::Result<Self> {
        let formats = USUAL.iter().map(|f| (*f).to_owned()).collect();
        let mut options = Self { folder: None, formats, width: 320 };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().with_context(|| format!("{word} wants a value"));
            match *word {
                "--folder" => options.folder = Some(PathBuf::from(value()?)),
                "--formats" => options.formats = value()?.split(',').map(str::to_owned).collect(),
                "--width" => {
                    let width = value()?.parse().ok().filter(|n| (THUMBNAIL..=2048).contains(n));
                    options.width =
                        width.with_context(|| format!("--width wants a number from {THUMBNAIL} to 2048"))?;
                }
                other => bail!("unknown option \"{other}\"; see `cargo xtask help`"),
            }
        }
        for format in &options.formats {
            let known: Vec<&str> = FORMATS.iter().map(|(name, _)| *name).collect();
            if !known.contains(&format.as_str()) {
                bail!("unknown format \"{format}\"; valid: {}", known.join(", "));
            }
        }
        Ok(options)
    }

    /// The folder of test files: as asked for, else as tests find it.
    fn folder(&self) -> anyhow::Result<PathBuf> {
        let shared = || std::env::var_os("DURER_SHARED").map(|folder| Path::new(&folder).join("assets"));
        let folder = match self.folder.clone().or_else(shared) {
            Some(folder) => folder,
            None => root()?.join("../shared/assets"),
        };
        folder.canonicalize().with_context(|| {
            let hint =
                "name the folder of test files with --folder, or set DURER_SHARED to the folder above it";
            format!("no test files at {}; {hint}", folder.display())
        })
    }
}

/// A model and what became of it.
struct Tried {
    model: Model,
    outcome: Outcome,
    /// The name of the thumbnail below `docs/assets/`.
    thumbnail: Option<String>,
    picture: Option<Picture>,
}

/// Tries every model, writes the page, the thumbnails and the contact sheets, prints a summary.
pub(crate) fn run(options: &Options) -> anyhow::Result<()> {
    let corpus = Corpus::open(&options.folder()?)?;
    let trial = Trial {
        program: release_program()?,
        assets: corpus.folder.clone(),
        work: fresh_folder(&target_folder()?.join("assets"))?,
        width: options.width,
    };
    // A page of some formats is for looking at; it must not replace the one of all.
    let complete = USUAL.iter().all(|usual| options.formats.iter().any(|format| format == usual));
    let to = if complete { root()?.join("docs") } else { trial.work.clone() };
    let (page, thumbnails) = (to.join("assets.md"), fresh_folder(&to.join("assets"))?);
    let mut groups = Vec::new();
    for format in &options.formats {
        let models = corpus.models(format, suffixes(format))?;
        if models.is_empty() {
            bail!("no models in {}", corpus.folder.join(format).display());
        }
        let mut tried = Vec::new();
        let count = models.len();
        for (number, model) in (1..).zip(models) {
            eprint!("{format} {number} of {count}: {}", model.file);
            let one = try_one(&trial, model, &thumbnails)?;
            eprintln!(" - {}", one.outcome.line());
            tried.push(one);
        }
        sheet::write(&trial.work, format, &tried, options.width)?;
        groups.push((format.clone(), tried));
    }
    fs::write(&page, page::text(&groups, options)).with_context(|| format!("{}", page.display()))?;
    summary(&groups);
    println!("\nwritten: {} and its thumbnails in {}", page.display(), thumbnails.display());
    println!("to look at, picture by picture: {}", trial.work.join("sheet-*.png").display());
    Ok(())
}

fn suffixes(format: &str) -> &'static [&'static str] {
    FORMATS.iter().find(|(name, _)| *name == format).map_or(&[], |(_, suffixes)| suffixes)
}

fn try_one(trial: &Trial, model: Model, thumbnails: &Path) -> anyhow::Result<Tried> {
    let (outcome, file) = trial.run(&model.file)?;
    let mut tried = Tried { thumbnail: None, picture: None, model, outcome };
    if let Some(file) = file {
        let picture = Picture::read(&file)?;
        let name = format!("{}.png", tried.model.file.replace(['/', ' '], "-"));
        picture.shrunk(THUMBNAIL).write_with_palette(&thumbnails.join(&name))?;
        tried.thumbnail = Some(name);
        tried.picture = Some(picture);
    }
    Ok(tried)
}

/// The folder, with nothing in it.
fn fresh_folder(folder: &Path) -> anyhow::Result<PathBuf> {
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("{} cannot be emptied", folder.display()))?;
    }
    fs::create_dir_all(folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    Ok(folder.to_path_buf())
}

fn summary(groups: &[(String, Vec<Tried>)]) {
    println!();
    for (format, tried) in groups {
        let drawn = tried.iter().filter(|t| t.picture.is_some()).count();
        println!("{format}: {drawn} of {} drawn", tried.len());
    }
    let all = || groups.iter().flat_map(|(_, tried)| tried);
    for one in all() {
        if let Outcome::Refused(reason) = &one.outcome {
            println!("refused: {}: {reason}", one.model.file);
        }
    }
    for one in all().filter(|t| t.model.credit.is_none()) {
        println!("no licence in the test files' README.md: {}", one.model.file);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let usual = Options::parse(&[]).expect("no options");
        assert!(usual.formats == USUAL && usual.width == 320, "{usual:?}");
        let asked =
            Options::parse(&["--formats", "ply,pbrt", "--width", "200", "--folder", "x"]).expect("good");
        assert_eq!((asked.formats, asked.width), (vec!["ply".to_owned(), "pbrt".to_owned()], 200));
        for bad in [&["--formats", "fbx"][..], &["--width", "12"], &["--width"], &["--wide"]] {
            assert!(Options::parse(bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn a_missing_folder_is_told_with_its_cure() {
        let options = Options::parse(&["--folder", "no such folder"]).expect("good options");
        let said = options.folder().expect_err("no folder").to_string();
        assert!(said.contains("no such folder") && said.contains("--folder"), "{said}");
    }
}
