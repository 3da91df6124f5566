//! Ptex files (<https://ptex.us>): of each face its size and what lies beside it, then its texels.
//!
//! All in little-endian: a header of 64 bytes and an extended one; then, packed with zlib, 20 bytes for each face and a texel
//! for each, which is all there is of faces of one value; then levels of detail. Only the first of these is read: smaller copies
//! are means of it. A level lists how each face is packed and how long that is, followed by all of it: as a texel, as zlib of
//! one channel after another, as differences of these, or in tiles which are packed likewise. The format is described by its
//! reader, that of Disney.
use std::{io::Read, sync::Arc};

use durer_scene::{AssetError, Image, ImageData, Limits, Ptex, PtexFace, PtexShape};
use exr::prelude::f16;
use flate2::bufread::ZlibDecoder;

use crate::gzip;

const MAGIC: &[u8] = b"Ptex";
const HEADER: usize = 64;
/// Bytes of a face's description.
const FACE: usize = 20;
/// Most columns and rows are 2 to this.
const MOST_LOG2: u8 = 15;
/// Bits of a face's description.
const IS_CONSTANT: u8 = 1;
const IS_PART: u8 = 8;

/// How numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stored {
    U8,
    U16,
    Half,
    Float,
}

impl Stored {
    fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 | Self::Half => 2,
            Self::Float => 4,
        }
    }
}

/// How a face is packed, and in how many bytes.
#[derive(Clone, Copy)]
struct Packed {
    how: u32,
    length: usize,
}

const AS_TEXEL: u32 = 0;
const AS_IT_IS: u32 = 1;
const AS_DIFFERENCES: u32 = 2;
const AS_TILES: u32 = 3;

impl Packed {
    fn list(bytes: &[u8]) -> Vec<Self> {
        let entry = |word: &[u8; 4]| {
            let word = u32::from_le_bytes(*word);
            Self { how: word >> 30, length: (word & 0x3FFF_FFFF) as usize }
        };
        bytes.as_chunks().0.iter().map(entry).collect()
    }
}

/// What is in a file.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn read(file: &[u8], path: &str, limits: Limits) -> Result<Ptex, AssetError> {
    let path = || path.to_owned();
    if !file.starts_with(MAGIC) {
        let reason = "this is no Ptex file: it does not begin with \"Ptex\"".to_owned();
        return Err(AssetError::Format { path: path(), reason });
    }
    let most = gzip::most(file, limits);
    parse(file, most).map_err(|reason| AssetError::Format { path: path(), reason })
}

/// A number of so many bytes at a place; 0 where there are none.
fn number(bytes: &[u8], at: usize, length: usize) -> u64 {
    let found = bytes.get(at..at + length).unwrap_or_default();
    found.iter().rev().fold(0, |all, byte| all << 8 | u64::from(*byte))
}

/// Takes the next bytes.
fn take<'a>(rest: &mut &'a [u8], length: u64, what: &str) -> Result<&'a [u8], String> {
    let length = usize::try_from(length).unwrap_or(usize::MAX);
    let (taken, left) =
        rest.split_at_checked(length).ok_or_else(|| format!("the file ends before {what} is whole"))?;
    *rest = left;
    Ok(taken)
}

/// Unpacks bytes that must become so many.
fn unpacked(packed: &[u8], length: usize, what: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(length.min(packed.len().saturating_mul(8)));
    let damaged = |e: &dyn std::fmt::Display| format!("{what} is damaged: {e}");
    ZlibDecoder::new(packed).take(length as u64 + 1).read_to_end(&mut bytes).map_err(|e| damaged(&e))?;
    if bytes.len() != length {
        return Err(damaged(&format!("it does not unpack to {length} bytes")));
    }
    Ok(bytes)
}

fn parse(file: &[u8], most: u64) -> Result<Ptex, String> {
    let mut rest = file;
    let head = take(&mut rest, HEADER as u64, "its header")?;
    let of = |at: usize, length: usize| number(head, at, length);
    if of(4, 4) != 1 {
        return Err(format!("version {} of Ptex is not known, expected 1", of(4, 4)));
    }
    let shape = match of(8, 4) {
        0 => PtexShape::Triangles,
        1 => PtexShape::Quads,
        other => return Err(format!("its faces are of kind {other}, expected 0 (triangles) or 1 (quads)")),
    };
    let stored = match of(12, 4) {
        0 => Stored::U8,
        1 => Stored::U16,
        2 => Stored::Half,
        3 => Stored::Float,
        other => return Err(format!("its numbers are of kind {other}, expected 0 to 3")),
    };
    let channels = of(20, 2) as usize;
    if !(1..=4).contains(&channels) {
        return Err(format!("it has {channels} channels, expected 1 to 4"));
    }
    let texel = channels * stored.bytes();
    let faces = of(24, 4);
    if faces.saturating_mul((FACE + texel) as u64) > most {
        return Err(format!("{faces} faces cannot be stored in {} bytes", file.len()));
    }
    let faces = faces as usize;
    let extended = take(&mut rest, of(28, 4), "its extended header")?;
    let described = take(&mut rest, of(32, 4), "the list of faces")?;
    let described = unpacked(described, faces * FACE, "the list of faces")?;
    let constants = take(&mut rest, of(36, 4), "the list of means")?;
    let constants = unpacked(constants, faces * texel, "the list of means")?;
    let levels = take(&mut rest, of(40, 4), "the list of levels")?;
    let mut level = take(&mut rest, number(levels, 0, 8), "the finest level")?;
    if faces > 0 && number(levels, 12, 4) != faces as u64 {
        return Err(format!("its finest level has {} faces of {faces}", number(levels, 12, 4)));
    }
    let list = take(&mut level, number(levels, 8, 4), "the list of a level")?;
    let list = Packed::list(&unpacked(list, 4 * faces, "the list of a level")?);
    let mut all = Texels { stored, channels, most, bytes: Vec::new() };
    let mut read = Vec::with_capacity(faces);
    let each = described.as_chunks::<FACE>().0.iter().zip(constants.chunks_exact(texel)).zip(list);
    for ((face, mean), packed) in each {
        let block = take(&mut level, packed.length as u64, "a face")?;
        read.push(all.face(face, (mean, faces), (packed.how, block))?);
    }
    let passed_over = if number(extended, 24, 8) > 0 { vec!["what was edited later"] } else { Vec::new() };
    Ok(Ptex { shape, faces: read, texels: Arc::new(all.image()), passed_over })
}

/// Texels that were read.
struct Texels {
    stored: Stored,
    channels: usize,
    /// The most bytes they may take.
    most: u64,
    bytes: Vec<u8>,
}

impl Texels {
    fn texel(&self) -> usize {
        self.channels * self.stored.bytes()
    }

    /// A face as it is described, of one value or packed.
    fn face(
        &mut self,
        described: &[u8; FACE],
        (mean, faces): (&[u8], usize),
        (how, block): (u32, &[u8]),
    ) -> Result<PtexFace, String> {
        let [columns, rows, edges, flags, ..] = *described;
        let edge_of = |edge: usize| (edges >> (2 * edge)) & 3;
        let beside = std::array::from_fn(|edge| {
            let face = number(described, 4 + 4 * edge, 4) as u32;
            ((face as usize) < faces).then(|| (face, edge_of(edge)))
        });
        let first = self.bytes.len() / self.texel();
        let is_constant = flags & IS_CONSTANT != 0 || [columns, rows] == [0, 0] || how == AS_TEXEL;
        let log2 = if is_constant { [0, 0] } else { [columns, rows] };
        if is_constant {
            // A face of one value has it among the means, too.
            self.bytes.extend_from_slice(mean);
        } else {
            let texels = self.unpack(log2, (how, block))?;
            self.bytes.extend(texels);
        }
        Ok(PtexFace { log2, first, beside, is_part: flags & IS_PART != 0 })
    }

    /// Bytes of so many columns and rows, with what is there already.
    fn room(&self, log2: [u8; 2]) -> Result<usize, String> {
        if log2.iter().any(|log2| *log2 > MOST_LOG2) {
            return Err(format!("a face has 2^{} by 2^{} texels, at most 2^15 are read", log2[0], log2[1]));
        }
        let bytes = self.texel() << (log2[0] + log2[1]);
        if (self.bytes.len() + bytes) as u64 > self.most {
            return Err(format!("its texels take more than {} bytes (a damaged or hostile file)", self.most));
        }
        Ok(bytes)
    }

    /// The texels of a face or tile, channels interleaved.
    fn unpack(&self, log2: [u8; 2], (how, block): (u32, &[u8])) -> Result<Vec<u8>, String> {
        let length = self.room(log2)?;
        match how {
            AS_TEXEL if block.len() == self.texel() => Ok(block.repeat(length / self.texel())),
            AS_TEXEL => Err("a tile of one value has another length than a texel".to_owned()),
            AS_IT_IS => Ok(self.interleaved(&unpacked(block, length, "a face")?)),
            AS_DIFFERENCES => {
                let mut bytes = unpacked(block, length, "a face")?;
                self.summed(&mut bytes);
                Ok(self.interleaved(&bytes))
            }
            _ => self.tiles(log2, block),
        }
    }

    /// Undoes differences; floats have none.
    fn summed(&self, bytes: &mut [u8]) {
        match self.stored {
            Stored::U8 => {
                bytes.iter_mut().fold(0u8, |before, byte| {
                    *byte = byte.wrapping_add(before);
                    *byte
                });
            }
            Stored::U16 => {
                bytes.as_chunks_mut::<2>().0.iter_mut().fold(0u16, |before, pair| {
                    let sum = u16::from_le_bytes(*pair).wrapping_add(before);
                    *pair = sum.to_le_bytes();
                    sum
                });
            }
            Stored::Half | Stored::Float => {}
        }
    }

    /// Channels that stand one after another become texels.
    fn interleaved(&self, bytes: &[u8]) -> Vec<u8> {
        let (size, texels) = (self.stored.bytes(), bytes.len() / self.texel());
        let mut out = Vec::with_capacity(bytes.len());
        for i in 0..texels {
            for channel in 0..self.channels {
                let at = (channel * texels + i) * size;
                out.extend_from_slice(bytes.get(at..at + size).unwrap_or_default());
            }
        }
        out
    }

    /// A face in tiles, row by row of tiles.
    fn tiles(&self, log2: [u8; 2], block: &[u8]) -> Result<Vec<u8>, String> {
        let mut rest = block;
        let head = take(&mut rest, 6, "the head of a face in tiles")?;
        let tile = [number(head, 0, 1) as u8, number(head, 1, 1) as u8];
        if tile.iter().zip(log2).any(|(tile, face)| *tile > face) {
            return Err("a tile is larger than its face".to_owned());
        }
        let count = 1usize << (log2[0] + log2[1] - tile[0] - tile[1]);
        let list = take(&mut rest, number(head, 2, 4), "the list of tiles")?;
        let list = Packed::list(&unpacked(list, 4 * count, "the list of tiles")?);
        let mut out = vec![0; self.room(log2)?];
        let row = self.texel() << log2[0];
        let tile_row = self.texel() << tile[0];
        for (number, packed) in list.into_iter().enumerate() {
            let block = take(&mut rest, packed.length as u64, "a tile")?;
            if packed.how == AS_TILES {
                return Err("a tile is made of tiles".to_owned());
            }
            let texels = self.unpack(tile, (packed.how, block))?;
            let across = 1 << (log2[0] - tile[0]);
            let (x, y) = (number % across, number / across);
            let first = (y << tile[1]) * row + x * tile_row;
            for (from, at) in texels.chunks_exact(tile_row).zip((first..).step_by(row)) {
                if let Some(to) = out.get_mut(at..at + tile_row) {
                    to.copy_from_slice(from);
                }
            }
        }
        Ok(out)
    }

    /// All of them as a picture of one row.
    fn image(self) -> Image {
        let width = (self.bytes.len() / self.texel()) as u32;
        let halves = || self.bytes.as_chunks::<2>().0.iter();
        let data = match self.stored {
            Stored::U16 => ImageData::U16(halves().map(|pair| u16::from_le_bytes(*pair)).collect()),
            Stored::Half => ImageData::F32(halves().map(|pair| f16::from_le_bytes(*pair).to_f32()).collect()),
            Stored::Float => ImageData::F32(
                self.bytes.as_chunks().0.iter().map(|number| f32::from_le_bytes(*number)).collect(),
            ),
            Stored::U8 => ImageData::U8(self.bytes),
        };
        Image { width, height: 1, channels: self.channels as u32, data }
    }
}
