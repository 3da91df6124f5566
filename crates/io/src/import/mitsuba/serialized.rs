//! Mitsuba's `.serialized` meshes, versions 3 and 4: compressed with zlib, several in a file, with a table of where each
//! begins at its end.
//!
//! Little-endian. Each mesh: `0x041c`, version, then compressed: flags, in version 4 a name that 0 ends, numbers of vertices
//! and triangles (u64), positions, normals, texture coordinates and colours as the flags say, in f32 or f64, indices (u32).
//! At the end: where each mesh begins (u32 in version 3, u64 in version 4), how many there are (u32).
use std::io::Read;

use durer_core::math::{Normal3, Point2, Point3};
use durer_scene::{AssetError, Limits, Mesh};
use flate2::read::ZlibDecoder;

const MAGIC: u16 = 0x041c;
const NORMALS: u32 = 0x0001;
const TEXCOORDS: u32 = 0x0002;
const COLORS: u32 = 0x0008;
const FACE_NORMALS: u32 = 0x0010;
const DOUBLE: u32 = 0x2000;
/// Longest name of a mesh.
const MOST_NAME: usize = 1 << 12;

/// Mesh `index` in `bytes`, which messages call `name`.
pub(super) fn mesh(bytes: &[u8], name: &str, index: usize, limits: Limits) -> Result<Mesh, AssetError> {
    let fail = |reason: String| AssetError::Format { path: name.to_owned(), reason };
    parsed(bytes, index, limits.unpacked_bytes.min(limits.file_bytes)).map_err(fail)
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// Where mesh `index` begins.
fn start(bytes: &[u8], version: u16, index: usize) -> Result<usize, String> {
    let short = || "the file ends too early".to_owned();
    let end = bytes.len().checked_sub(4).ok_or_else(short)?;
    let count = u32::from_le_bytes(number(bytes, end).ok_or_else(short)?) as usize;
    if index == 0 {
        return Ok(0);
    }
    if index >= count {
        return Err(format!("there is no mesh {index}: the file holds {count}, counted from 0"));
    }
    let size = if version >= 4 { 8 } else { 4 };
    let back = (count - index).checked_mul(size).ok_or_else(short)?;
    let at = end.checked_sub(back).ok_or_else(short)?;
    let place = match size {
        8 => number(bytes, at).map(u64::from_le_bytes),
        _ => number(bytes, at).map(|b| u32::from_le_bytes(b).into()),
    };
    place.and_then(|p| usize::try_from(p).ok()).ok_or_else(short)
}

fn parsed(bytes: &[u8], index: usize, most: u64) -> Result<Mesh, String> {
    let word = |at| number(bytes, at).map(u16::from_le_bytes);
    if word(0) != Some(MAGIC) {
        return Err("this is no serialized mesh of Mitsuba".to_owned());
    }
    let version = word(2).unwrap_or(0);
    if !matches!(version, 3 | 4) {
        return Err(format!("serialized meshes of version {version} are not read, only 3 and 4"));
    }
    let begin = start(bytes, version, index)?;
    if word(begin) != Some(MAGIC) {
        return Err(format!("mesh {index} does not begin where the file says"));
    }
    let packed = bytes.get(begin + 4..).unwrap_or_default();
    let mut input = Unpacked { stream: ZlibDecoder::new(packed).take(most), most };
    let flags = u32::from_le_bytes(input.array()?);
    if version == 4 {
        let mut length = 0;
        while input.array::<1>()? != [0] {
            length += 1;
            if length > MOST_NAME {
                return Err("the name of a mesh has no end".to_owned());
            }
        }
    }
    let [vertices, faces] = [u64::from_le_bytes(input.array()?), u64::from_le_bytes(input.array()?)];
    let mut floats = |per: u64| input.floats(vertices, per, flags & DOUBLE != 0);
    let of = |flag: u32| flags & flag != 0;
    let positions = floats(3)?.as_chunks::<3>().0.iter().map(|p| Point3::from(*p)).collect();
    let mut normals: Vec<Normal3> = match of(NORMALS) {
        true => floats(3)?.as_chunks::<3>().0.iter().map(|n| Normal3::from(*n)).collect(),
        false => Vec::new(),
    };
    if of(FACE_NORMALS) {
        normals.clear();
    }
    let uvs = match of(TEXCOORDS) {
        true => floats(2)?.as_chunks::<2>().0.iter().map(|uv| Point2::from(*uv)).collect(),
        false => Vec::new(),
    };
    let colors = match of(COLORS) {
        true => floats(3)?.as_chunks::<3>().0.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect(),
        false => Vec::new(),
    };
    let bytes = input.bytes(faces, 12)?;
    let indices = bytes.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect::<Vec<_>>();
    let indices = indices.as_chunks::<3>().0.to_vec();
    let mesh = Mesh { positions, indices, normals, uvs, colors, ..Mesh::default() };
    mesh.validate().map_err(|e| e.to_string())?;
    Ok(mesh)
}

/// What is unpacked as it is asked for.
struct Unpacked<R> {
    stream: std::io::Take<R>,
    most: u64,
}

impl<R: Read> Unpacked<R> {
    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        self.stream
            .read_exact(&mut bytes)
            .map_err(|e| format!("the mesh ends too early, or is damaged ({e})"))?;
        Ok(bytes)
    }
    /// `count` times `size` bytes; memory grows no faster than what is there.
    fn bytes(&mut self, count: u64, size: u64) -> Result<Vec<u8>, String> {
        let length = count.checked_mul(size).filter(|n| *n <= self.most);
        let length =
            length.ok_or_else(|| format!("the mesh has {count} entries, more than {} bytes", self.most))?;
        let mut bytes = Vec::new();
        let read = self.stream.by_ref().take(length).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
        if read as u64 == length { Ok(bytes) } else { Err("the mesh ends too early".to_owned()) }
    }
    fn floats(&mut self, count: u64, per: u64, double: bool) -> Result<Vec<f32>, String> {
        Ok(match double {
            true => {
                let bytes = self.bytes(count, 8 * per)?;
                bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b) as f32).collect()
            }
            false => {
                let bytes = self.bytes(count, 4 * per)?;
                bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
            }
        })
    }
}

#[cfg(test)]
mod tests;
