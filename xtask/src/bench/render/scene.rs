//! What is rendered: one pbrt file for all renderers, with the same film, filter and depth.
use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, ensure};

use super::super::built::assets;
use crate::root;

/// A scene and how it is taken.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) name: &'static str,
    /// Below `benches/render` or the folder of test files, by the name.
    source: Source,
    pub(super) width: u32,
    pub(super) height: u32,
    /// Samples per pixel.
    pub(super) samples: u32,
    /// Scattering events of a path at most, of which the last finds light.
    pub(super) depth: u32,
    /// Relative mean squared error to which seconds are told.
    pub(super) target: f64,
    /// Pixels that are brighter show a light and do not count.
    pub(super) bright: Option<f64>,
}

#[derive(Debug)]
enum Source {
    /// A file of ours.
    Own,
    /// A file of ours that shows a mesh of the test files.
    Mesh(&'static str),
    /// A folder of the test files.
    Shared,
}

const SQUARE: Scene = Scene {
    name: "",
    source: Source::Own,
    width: 512,
    height: 512,
    samples: 64,
    depth: 7,
    target: 1e-3,
    bright: None,
};

/// Samples are squares of even numbers, which suit all samplers.
pub(super) const SCENES: &[Scene] = &[
    Scene { name: "cornell", width: 256, height: 256, samples: 256, bright: Some(2.0), ..SQUARE },
    Scene { name: "atrium", source: Source::Mesh("atrium.ply"), samples: 16, target: 1e-2, ..SQUARE },
    Scene { name: "sphere8", source: Source::Mesh("sphere8.ply.gz"), target: 1e-4, ..SQUARE },
    Scene {
        name: "classroom",
        source: Source::Shared,
        width: 320,
        height: 180,
        depth: 17,
        target: 1e-1,
        ..SQUARE
    },
    Scene {
        name: "coffee",
        source: Source::Shared,
        width: 240,
        height: 300,
        depth: 17,
        target: 1e-2,
        ..SQUARE
    },
    Scene {
        name: "veach-ajar",
        source: Source::Shared,
        width: 320,
        height: 180,
        depth: 13,
        target: 1e-1,
        ..SQUARE
    },
];

/// Directives that each scene is given anew.
const TAKEN: [&str; 4] = ["Integrator", "Sampler", "PixelFilter", "Film"];

impl Scene {
    /// Leaves the scene with all its files in a folder below `folder`, and says where the file is. Readers need not follow
    /// names that lead out of it.
    pub(super) fn put_into(&self, folder: &Path) -> anyhow::Result<PathBuf> {
        let own = root()?.join("benches/render").join(format!("{}.pbrt", self.name));
        let shared = assets()?.join("pbrt").join(self.name);
        let folder = folder.join(self.name);
        let file = match self.source {
            Source::Own => own,
            Source::Mesh(mesh) => {
                copy(&assets()?.join("bench").join(mesh), &folder.join(mesh))?;
                own
            }
            Source::Shared => {
                for part in ["models", "textures"].map(Path::new) {
                    copy_files(&shared.join(part), &folder.join(part))?;
                }
                shared.join("scene-v4.pbrt")
            }
        };
        let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        let to = folder.join("scene.pbrt");
        fs::create_dir_all(&folder)?;
        fs::write(&to, self.taken(&text)?)?;
        Ok(to)
    }

    /// The text with our film, filter and depth, and every renderer's own sampler.
    fn taken(&self, text: &str) -> anyhow::Result<String> {
        let (head, world) = text.split_once("WorldBegin").context("the scene has no WorldBegin")?;
        let mut kept = format!(
            "Integrator \"path\" \"integer maxdepth\" {}\nPixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\n\
             Film \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {}\n",
            self.depth, self.width, self.height
        );
        let mut drops = false;
        for line in head.lines() {
            // Directives begin at the margin, what belongs to them does not.
            if line.starts_with(|c: char| c.is_ascii_uppercase()) {
                drops = TAKEN.iter().any(|word| line.starts_with(word));
            }
            if !drops {
                kept += line;
                kept.push('\n');
            }
        }
        ensure!(kept.contains("Camera"), "the scene has no camera before WorldBegin");
        Ok(format!("{kept}WorldBegin{world}"))
    }
}

fn copy_files(from: &Path, to: &Path) -> anyhow::Result<()> {
    // Not every scene has textures.
    let Ok(files) = fs::read_dir(from) else { return Ok(()) };
    for file in files {
        let file = file?;
        copy(&file.path(), &to.join(file.file_name()))?;
    }
    Ok(())
}

/// What is there already stays: the test files do not change.
fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    let size = |path: &Path| fs::metadata(path).map(|data| data.len()).ok();
    let wanted = size(from).with_context(|| format!("{} is not there", from.display()))?;
    if size(to) != Some(wanted) {
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder)?;
        }
        let bytes = fs::read(from)?;
        fs::write(to, bytes).with_context(|| format!("{} cannot be written", to.display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_film_is_ours_and_the_camera_the_scenes() {
        let text = "LookAt 0 0 1  0 0 0  0 1 0\nSampler \"sobol\"\n    \"integer pixelsamples\" [ 8 ]\nCamera \"perspective\"\n\
                    \x20   \"float fov\" [ 35 ]\n\nWorldBegin\nShape \"sphere\"\n";
        let taken = SQUARE.taken(text).expect("a scene");
        assert!(
            taken.contains("\"integer xresolution\" 512")
                && taken.contains("fov")
                && taken.contains("LookAt")
        );
        assert!(!taken.contains("pixelsamples") && taken.ends_with("WorldBegin\nShape \"sphere\"\n"));
        assert!(SQUARE.taken("Shape \"sphere\"").is_err());
    }

    #[test]
    fn names_are_unique() {
        for (i, scene) in SCENES.iter().enumerate() {
            assert!(SCENES[..i].iter().all(|other| other.name != scene.name));
        }
    }
}
