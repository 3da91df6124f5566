//! Ptex files from formulas, written apart from their reader.
use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};

/// How numbers are stored; values from 0 to 1 fill the range of whole ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stored {
    /// Bytes.
    U8,
    /// 16 bits.
    U16,
    /// 16 bits of a float; values must be 0 or normal.
    Half,
    /// Floats.
    Float,
}

/// How a face is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packed {
    /// One value, that of its first texel.
    Constant,
    /// zlib.
    Plain,
    /// zlib of differences.
    Differences,
    /// Tiles of 2 to these columns and rows, every other one as differences.
    Tiles([u8; 2]),
}

/// A face.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Logarithms of columns and rows.
    pub log2: [u8; 2],
    /// Face and edge beside each edge.
    pub beside: [Option<(u32, u8)>; 4],
    /// How it is packed.
    pub packed: Packed,
}

/// A file.
#[derive(Clone, Debug)]
pub struct File {
    /// Faces have three corners.
    pub is_triangles: bool,
    /// Numbers.
    pub stored: Stored,
    /// Numbers of a texel.
    pub channels: u16,
    /// Faces.
    pub faces: Vec<Face>,
    /// It says that it was edited.
    pub is_edited: bool,
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    packed.write_all(bytes).and_then(|()| packed.finish()).expect("memory")
}

impl File {
    fn number(&self, value: f32, out: &mut Vec<u8>) {
        match self.stored {
            Stored::U8 => out.push((value * 255.0).round() as u8),
            Stored::U16 => out.extend(((value * 65_535.0).round() as u16).to_le_bytes()),
            Stored::Half if value == 0.0 => out.extend([0; 2]),
            Stored::Half => out.extend((((value.abs().to_bits() >> 13) - (112 << 10)) as u16).to_le_bytes()),
            Stored::Float => out.extend(value.to_le_bytes()),
        }
    }

    fn differences(&self, bytes: &mut [u8]) {
        let size = match self.stored {
            Stored::U8 => 1,
            Stored::U16 => 2,
            Stored::Half | Stored::Float => return,
        };
        let at = |bytes: &[u8], i: usize| (0..size).map(|b| u32::from(bytes[i + b]) << (8 * b)).sum::<u32>();
        for i in (1..bytes.len() / size).rev() {
            let difference = at(bytes, i * size).wrapping_sub(at(bytes, (i - 1) * size));
            bytes[i * size..][..size].copy_from_slice(&difference.to_le_bytes()[..size]);
        }
    }

    /// Some texels of a face, one channel after another.
    fn part(
        &self,
        [x0, y0]: [usize; 2],
        [w, h]: [usize; 2],
        of: impl Fn(usize, usize, usize) -> f32,
    ) -> Vec<u8> {
        let mut out = Vec::new();
        for c in 0..usize::from(self.channels) {
            for y in 0..h {
                (0..w).for_each(|x| self.number(of(x0 + x, y0 + y, c), &mut out));
            }
        }
        out
    }

    /// The bytes, of a value for each face, column, row and channel.
    pub fn bytes(&self, value: impl Fn(usize, usize, usize, usize) -> f32) -> Vec<u8> {
        let (mut info, mut means, mut list, mut blocks) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (number, face) in self.faces.iter().enumerate() {
            let of = |x: usize, y: usize, c: usize| value(number, x, y, c);
            let whole = face.log2.map(|log2| 1usize << log2);
            let edges = (0..4).fold(0, |all, e| all | face.beside[e].map_or(0, |(_, edge)| edge) << (2 * e));
            let flags = u8::from(face.packed == Packed::Constant);
            info.extend([face.log2[0], face.log2[1], edges, flags]);
            for beside in face.beside {
                info.extend(beside.map_or(-1, |(face, _)| face as i32).to_le_bytes());
            }
            means.extend(self.part([0, 0], [1, 1], of));
            let (how, block) = match face.packed {
                Packed::Constant => (0, Vec::new()),
                Packed::Plain => (1, zlib(&self.part([0, 0], whole, of))),
                Packed::Differences => {
                    let mut bytes = self.part([0, 0], whole, of);
                    self.differences(&mut bytes);
                    (2, zlib(&bytes))
                }
                Packed::Tiles(log2) => (3, self.tiles(whole, log2, of)),
            };
            list.extend((how << 30 | block.len() as u32).to_le_bytes());
            blocks.extend(block);
        }
        let (info, means, list) = (zlib(&info), zlib(&means), zlib(&list));
        let level = [&list[..], &blocks].concat();
        let mut out = b"Ptex".to_vec();
        let mut put = |number: u64, bytes: usize| out.extend(&number.to_le_bytes()[..bytes]);
        put(1, 4);
        put(u64::from(!self.is_triangles), 4);
        put(self.stored as u64, 4);
        put(u64::from(u32::MAX), 4);
        put(self.channels.into(), 2);
        put(1, 2);
        put(self.faces.len() as u64, 4);
        put(40, 4);
        put(info.len() as u64, 4);
        put(means.len() as u64, 4);
        put(16, 4);
        put(2, 4);
        put(level.len() as u64, 8);
        put(0, 8);
        // The extended header: no large metadata, perhaps edits.
        put(0, 8);
        put(0, 8);
        put(0, 8);
        put(self.is_edited.into(), 8);
        put(0, 8);
        out.extend(info);
        out.extend(means);
        out.extend((level.len() as u64).to_le_bytes());
        out.extend((list.len() as u32).to_le_bytes());
        out.extend((self.faces.len() as u32).to_le_bytes());
        out.extend(level);
        out
    }

    fn tiles(&self, [w, h]: [usize; 2], log2: [u8; 2], of: impl Fn(usize, usize, usize) -> f32) -> Vec<u8> {
        let [tw, th] = log2.map(|log2| 1usize << log2);
        let (mut list, mut blocks) = (Vec::new(), Vec::new());
        for (number, (y, x)) in
            (0..h / th).flat_map(|y| (0..w / tw).map(move |x| (y * th, x * tw))).enumerate()
        {
            let mut bytes = self.part([x, y], [tw, th], &of);
            let how = if number % 2 == 0 { 1u32 } else { 2 };
            if how == 2 {
                self.differences(&mut bytes);
            }
            let block = zlib(&bytes);
            list.extend((how << 30 | block.len() as u32).to_le_bytes());
            blocks.extend(block);
        }
        let list = zlib(&list);
        [&log2[..], &(list.len() as u32).to_le_bytes(), &list, &blocks].concat()
    }
}

/// A file of one face of one texel.
pub fn pixel() -> Vec<u8> {
    let face = Face { log2: [0, 0], beside: [None; 4], packed: Packed::Constant };
    let file =
        File { is_triangles: false, stored: Stored::U8, channels: 3, faces: vec![face], is_edited: false };
    file.bytes(|_, _, _, _| 0.5)
}
