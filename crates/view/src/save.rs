//! Files for the viewer to keep: the picture, and the scene as he changed it.
use durer::{
    Prepared, ToWrite,
    export::{Files, pbrt::Written},
    film::ToneMap,
    image::PictureFormat,
    picture::{Look, Picture},
};

use crate::{pack::packed, settings::Settings, stage::Opened, take::Take};

/// What is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SaveFormat {
    /// The picture.
    Picture(PictureFormat),
    /// The scene; with files that lie within the original, as an archive with all that it needs.
    Pbrt,
    /// The scene with all that it needs, as an archive.
    Zip,
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
            "zip" => Some(Self::Zip),
            _ => None,
        }
    }

    /// Words that [`SaveFormat::from_word`] knows.
    pub(crate) const WORDS: &str = "png, exr, pbrt or zip";

    fn suffix_and_mime(self) -> (&'static str, &'static str) {
        match self {
            Self::Picture(PictureFormat::Png) => ("png", "image/png"),
            Self::Picture(PictureFormat::Exr) => ("exr", "image/x-exr"),
            Self::Pbrt => ("pbrt", "text/plain; charset=utf-8"),
            Self::Zip => ("zip", "application/zip"),
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
    let stem = stem(&settings.desc.name);
    let (format, bytes) = match format {
        SaveFormat::Picture(picture) => {
            let pixels = take.pixels().ok_or("there is no sample of the picture yet: wait a moment")?;
            let interrupted = !take.is_done(&prepared.job());
            let tonemap: ToneMap = settings.look.tonemap(&prepared.integrator_name);
            let look = Look { exposure: settings.look.exposure, tonemap };
            let whole =
                Picture { scene, prepared, pixels, layers: Vec::new(), render: take.busy(), interrupted };
            (format, whole.encode(picture, look).map_err(|e| e.to_string())?)
        }
        SaveFormat::Pbrt | SaveFormat::Zip => scene_file(format, (scene, &stem), settings, opened)?,
    };
    let (suffix, mime) = format.suffix_and_mime();
    Ok(File { name: format!("{stem}.{suffix}"), mime, bytes })
}

/// The text alone if that says everything, else an archive.
fn scene_file(
    format: SaveFormat,
    names: (&str, &str),
    settings: &Settings,
    opened: &Opened,
) -> Result<(SaveFormat, Vec<u8>), String> {
    if format == SaveFormat::Pbrt {
        let alone = pbrt(Files::Embedded, names, settings, opened)?;
        if alone.beside.is_empty() {
            return Ok((format, alone.text.into_bytes()));
        }
    }
    let whole = pbrt(Files::All, names, settings, opened)?;
    Ok((SaveFormat::Zip, packed(names.1, whole)?))
}

/// The scene as the viewer changed it; `stem` is what the file will be called.
fn pbrt(
    files: Files,
    (scene, stem): (&str, &str),
    settings: &Settings,
    opened: &Opened,
) -> Result<Written, String> {
    let mut remarks =
        vec![format!("durer {}: {scene} as it was changed in durer view.", env!("CARGO_PKG_VERSION"))];
    if files == Files::Embedded {
        remarks.push("Paths of files start where the original lies: this file belongs there.".to_owned());
    }
    let Settings { desc, options, camera, .. } = settings;
    let (assets, prepared) = (&opened.studio.imported.assets, &*opened.prepared);
    let whole = ToWrite { desc, assets, options, camera: *camera, prepared };
    whole.pbrt(files, &format!("{stem}-files"), &remarks).map_err(|refused| {
        let list: String = refused.iter().map(|what| format!("\n  {what}")).collect();
        format!("this scene cannot be written as .pbrt, as the language has no words for it:{list}")
    })
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
