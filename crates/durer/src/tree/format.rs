//! The register of formats that trees are written in.
use std::path::Path;

use crate::scene::nearest_word;

use super::{dot::dot, glb::glb, page::Page, svg::svg, table};

/// A format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// All keys; a tree, or a page without the scene if there are several.
    Json,
    /// The data of the page: compact, with the scene. For those who work on the page.
    PageJson,
    /// A graph for Graphviz.
    Dot,
    /// A drawing.
    Svg,
    /// Lines in the scene.
    Glb,
    /// The page.
    Html,
    /// A table for programs.
    Csv,
    /// A list for people.
    Markdown,
}

/// All of them with the ends of their files' names; the first that fits counts.
pub const FORMATS: &[(Format, &str)] = &[
    (Format::PageJson, "page.json"),
    (Format::Json, "json"),
    (Format::Html, "html"),
    (Format::Svg, "svg"),
    (Format::Dot, "dot"),
    (Format::Glb, "glb"),
    (Format::Csv, "csv"),
    (Format::Markdown, "md"),
];

impl Format {
    /// The format that a file's name asks for, in any letter case.
    ///
    /// # Errors
    /// What is wrong with the name, and what to do.
    pub fn of(path: &Path) -> Result<Self, String> {
        let name = path.file_name().map(|n| n.to_string_lossy().to_lowercase()).unwrap_or_default();
        let fits = |(_, suffix): &&(Self, &str)| name.ends_with(&format!(".{suffix}"));
        if let Some((format, _)) = FORMATS.iter().find(fits) {
            return Ok(*format);
        }
        let known: Vec<&str> = FORMATS.iter().map(|f| f.1).filter(|s| *s != "page.json").collect();
        let list = known.iter().map(|s| format!(".{s}")).collect::<Vec<_>>().join(", ");
        let shown = path.display();
        Err(match path.extension() {
            None => format!("{shown}: the name does not say which format\n  help: add one of {list}"),
            Some(suffix) => {
                let suffix = suffix.to_string_lossy();
                let near = nearest_word(&suffix, known.iter().copied());
                let meant = near.map(|near| format!("did you mean .{near}? ")).unwrap_or_default();
                format!("{shown}: trees are not written as .{suffix}\n  help: {meant}There are {list}")
            }
        })
    }

    /// Whether it shows the scene around the rays.
    pub fn shows_scene(self) -> bool {
        matches!(self, Self::PageJson | Self::Svg | Self::Glb | Self::Html)
    }

    /// Whether it shows the pixel's other samples too.
    pub fn is_page(self) -> bool {
        matches!(self, Self::PageJson | Self::Html)
    }

    /// The file's bytes. Of the page they are its data, packed, for the program that shows it.
    ///
    /// # Errors
    /// If there is no room for it in the format.
    pub fn write(self, page: &Page) -> Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>> {
        Ok(match self {
            Self::Json => (page.json()? + "\n").into_bytes(),
            Self::PageJson => page.compact()?.into_bytes(),
            Self::Html => page.packed(Page::ROOM)?,
            Self::Dot => dot(&page.trees).into_bytes(),
            Self::Svg => svg(page).into_bytes(),
            Self::Glb => glb(page)?,
            Self::Csv => table::csv(&page.trees).into_bytes(),
            Self::Markdown => table::markdown(&page.trees).into_bytes(),
        })
    }
}
