//! Files for the viewer to keep: the picture, and the scene as he changed it.
use durer::{
    Prepared,
    film::ToneMap,
    image::PictureFormat,
    picture::{Look, Picture},
};

use crate::{settings::Settings, stage::Opened, take::Take};

/// What is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SaveFormat {
    /// The picture.
    Picture(PictureFormat),
    /// The scene.
    Pbrt,
}

/// A file in the making.
#[derive(Debug)]
pub(crate) struct File {
    pub(crate) name: String,
    pub(crate) mime: &'static str,
    pub(crate) bytes: Vec<u8>,
}

impl SaveFormat {
    pub(crate) fn from_word(word: &str) -> Option<Self> {
        match word {
            "png" => Some(Self::Picture(PictureFormat::Png)),
            "exr" => Some(Self::Picture(PictureFormat::Exr)),
            "pbrt" => Some(Self::Pbrt),
            _ => None,
        }
    }

    fn suffix_and_mime(self) -> (&'static str, &'static str) {
        match self {
            Self::Picture(PictureFormat::Png) => ("png", "image/png"),
            Self::Picture(PictureFormat::Exr) => ("exr", "image/x-exr"),
            Self::Pbrt => ("pbrt", "text/plain; charset=utf-8"),
        }
    }
}

/// The file.
///
/// # Errors
/// Why there is none.
pub(crate) fn file(
    format: SaveFormat,
    scene: &str,
    (settings, opened): (&Settings, &Opened),
    (prepared, take): (&Prepared, &Take),
) -> Result<File, String> {
    let bytes = match format {
        SaveFormat::Picture(picture) => {
            let pixels = take.pixels().ok_or("there is no sample of the picture yet: wait a moment")?;
            let interrupted = !take.is_done(&prepared.job());
            let tonemap: ToneMap = settings.look.tonemap(&prepared.integrator_name);
            let look = Look { exposure: settings.look.exposure, tonemap };
            let whole = Picture { scene, prepared, pixels, render: take.busy(), interrupted };
            whole.encode(picture, look).map_err(|e| e.to_string())?
        }
        SaveFormat::Pbrt => return Err(format!("{}: not written yet", opened.studio.imported.desc.name)),
    };
    let (suffix, mime) = format.suffix_and_mime();
    Ok(File { name: format!("{}.{suffix}", stem(&settings.desc.name)), mime, bytes })
}

/// A name that is safe in a header and on every system.
fn stem(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_ ".contains(c) { c } else { '_' };
    let stem: String = name.chars().map(plain).take(80).collect();
    if stem.trim().is_empty() { "scene".to_owned() } else { stem }
}

/// The axis of the world that is up: the one that the camera's up is nearest to.
pub(crate) fn up(settings: &Settings) -> [f64; 3] {
    let up = settings.camera().world_from_camera.at(settings.options.time.into()).matrix3.y_axis;
    let size = up.abs();
    let axis = if size.z > size.x.max(size.y) { 2 } else { usize::from(size.y >= size.x) };
    std::array::from_fn(|i| if i == axis { up[axis].signum() } else { 0.0 })
}
