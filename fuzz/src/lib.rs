//! What the fuzz targets share: a folder that scene files lie in, and what becomes of a file that is opened.
//!
//! Files are read as the program reads them, by name: each process has a folder of its own among
//! the system's temporary ones. Whatever a file holds, it must end with a description or with complaints; what is described is compiled too.
#![forbid(unsafe_code)]

#[cfg(feature = "compile")]
mod compile;

use std::{fs, path::PathBuf, sync::OnceLock};

use durer_core::math::Interval;
use durer_io::{
    FileAssets, hush_decoders,
    import::{self, Imported, Moment, Play, Reading},
};
use durer_scene::{Assets, ImageData, Limits, Location};

/// A picture of one pixel, for files that name one.
const PIXEL: &[u8] = b"Pf\n1 1\n-1.0\n\0\0\x80\x3f";
/// A triangle, for files that name a mesh.
const TRIANGLE: &[u8] =
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// The folder of this process.
fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        hush_decoders();
        let folder = std::env::temp_dir().join(format!("durer-fuzz-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        for (name, bytes) in [("a.pfm", PIXEL), ("a.ply", TRIANGLE), ("a.mtl", b"newmtl a\nmap_Kd a.pfm\n")] {
            fs::write(folder.join(name), bytes).expect("a file");
        }
        folder
    })
}

/// Puts a file into the folder.
pub fn put(name: &str, bytes: &[u8]) {
    fs::write(folder().join(name), bytes).expect("a file");
}

/// Opens the file `name` that holds `bytes`, looks at it at two moments, and compiles what is small.
pub fn scene(name: &str, bytes: &[u8]) {
    put(name, bytes);
    // What moves is looked at while it does.
    let moment = Moment { time: 0.0, shutter: Interval::new(0.0, 0.5) };
    let reading = Reading { play: Play::First, moment, ..Reading::default() };
    let mut imported = import::open(&folder().join(name), reading);
    imported.turn_to(Moment { time: 0.25, shutter: Interval::point(0.25) });
    #[cfg(feature = "compile")]
    compile::small(&mut imported);
    told(&imported);
}

/// Complaints are told with their places, as the program does.
fn told(imported: &Imported) {
    for said in imported.diagnostics.iter() {
        assert!(!said.message.is_empty());
        if let Location::Span(span) = &said.at {
            imported.sources.line_column(span.source, span.start);
        }
    }
}

/// Reads all grids of voxels of a file, up to some.
pub fn volume(name: &str, bytes: &[u8]) {
    put(name, bytes);
    let assets = FileAssets::new(folder().clone(), Default::default());
    for grid in assets.grids(name).unwrap_or_default().iter().take(4) {
        drop(assets.voxels(name, grid));
    }
}

/// Reads a picture that is called `name`.
pub fn picture(name: &str, bytes: &[u8]) {
    hush_decoders();
    if let Ok(image) = durer_io::image::read(bytes, name, Limits::default()) {
        let count = match &image.data {
            ImageData::U8(values) => values.len(),
            ImageData::U16(values) => values.len(),
            ImageData::F32(values) => values.len(),
        };
        assert_eq!(
            count as u64,
            u64::from(image.width) * u64::from(image.height) * u64::from(image.channels)
        );
    }
}
