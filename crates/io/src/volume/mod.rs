//! OpenVDB files (versions 222 to 226 of their format): clouds as Blender and Houdini write them.
//!
//! Read are trees of single or half floats in the usual shape (`Tree_float_5_4_3`), plain, with inactive values left out, by
//! zlib or by Blosc with LZ4; placed by scale, translation or a matrix. Level sets become fog as OpenVDB makes it: 0 at the
//! surface, rising to 1 a band below. Everything else is refused by name: other types, frustums, instances of trees, other
//! codecs in Blosc; and NanoVDB's files, which OpenVDB's tools convert.
//!
//! The format is described by its only implementation, OpenVDB's `io/File.cc`, `io/Compression.h` and `tree/*Node.h`.
mod bytes;
mod grid;
mod packed;
mod tree;

use durer_scene::{AssetError, Voxels};

use bytes::{Bytes, Why};
use grid::Descriptor;

/// The first eight bytes.
const MAGIC: [u8; 8] = [0x20, 0x42, 0x44, 0x56, 0, 0, 0, 0];
/// "NanoVDB0" and its successors.
const NANO: &[u8] = b"NanoVDB";

/// Most grids of a file.
const MOST_GRIDS: u32 = 10_000;

/// The names of the grids of a file.
///
/// # Errors
/// What is wrong with the file, or what of it is not read.
pub(crate) fn names(bytes: &[u8], path: &str) -> Result<Vec<String>, AssetError> {
    let grids = grids(bytes).map_err(|why| error(why, path))?;
    Ok(grids.into_iter().map(|grid| grid.name).collect())
}

/// The first grid called `name` of a file.
///
/// # Errors
/// What is wrong with the file, or what of it is not read.
pub(crate) fn voxels(bytes: &[u8], path: &str, name: &str) -> Result<Voxels, AssetError> {
    let read = || {
        let found = grids(bytes)?.into_iter().find(|grid| grid.name == name);
        found.ok_or_else(|| Why::Damaged(format!("it has no grid called \"{name}\"")))?.voxels(bytes)
    };
    read().map_err(|why| error(why, path))
}

fn error(why: Why, path: &str) -> AssetError {
    let path = path.to_owned();
    match why {
        Why::Damaged(reason) => AssetError::Format { path, reason },
        Why::Refused(reason) => AssetError::Unsupported { path, reason },
        Why::TooLarge(reason) => AssetError::Limits { path, reason },
    }
}

fn grids(data: &[u8]) -> Result<Vec<Descriptor>, Why> {
    if data.starts_with(NANO) {
        let advice = "a NanoVDB file; convert it back with OpenVDB's nanovdb_convert, .vdb files are read";
        return Err(Why::Refused(advice.to_owned()));
    }
    if !data.starts_with(&MAGIC) {
        return Err(Why::Damaged("not an OpenVDB file: it does not begin as one does".to_owned()));
    }
    let mut bytes = Bytes::new(data);
    bytes.skip(MAGIC.len())?;
    let version = bytes.u32()?;
    if !(222..=226).contains(&version) {
        return Err(Why::Refused(format!(
            "an OpenVDB file of version {version}; versions 222 (2013) to 226 are read: save it with a newer program"
        )));
    }
    bytes.skip(8)?;
    if bytes.u8()? == 0 {
        return Err(Why::Refused("an OpenVDB stream without offsets of its grids".to_owned()));
    }
    bytes.skip(36)?;
    grid::metadata(&mut bytes)?;
    let count = bytes.u32()?;
    if count > MOST_GRIDS {
        return Err(Why::Damaged(format!("the file claims to hold {count} grids")));
    }
    let mut all = Vec::new();
    for _ in 0..count {
        let found = Descriptor::read(&mut bytes)?;
        bytes.jump(found.end)?;
        all.push(found);
    }
    Ok(all)
}
