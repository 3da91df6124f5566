//! Small pictures: read, shrunk, written with a palette.
use std::{
    fs::File,
    io::{BufReader, BufWriter},
    path::Path,
};

use anyhow::{Context, bail};
use color_quant::NeuQuant;
use png::{BitDepth, ColorType, Compression, Decoder, Encoder};

/// sRGB pixels, rows from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(crate) rgb: Vec<[u8; 3]>,
}

impl Picture {
    /// One colour everywhere.
    pub(super) fn plain(width: u32, height: u32, color: [u8; 3]) -> Self {
        Self { width, height, rgb: vec![color; (width * height) as usize] }
    }

    /// A PNG file as durer writes them.
    pub(crate) fn read(path: &Path) -> anyhow::Result<Self> {
        let shown = path.display();
        let file = File::open(path).with_context(|| format!("{shown} cannot be opened"))?;
        let mut reader = Decoder::new(BufReader::new(file)).read_info()?;
        let mut bytes = vec![0; reader.output_buffer_size().context("too large a picture")?];
        let frame = reader.next_frame(&mut bytes)?;
        if (frame.color_type, frame.bit_depth) != (ColorType::Rgb, BitDepth::Eight) {
            bail!("{shown}: not a picture of three 8-bit channels");
        }
        let rgb = bytes.as_chunks::<3>().0.to_vec();
        Ok(Self { width: frame.width, height: frame.height, rgb })
    }

    /// With at most so many pixels per row, each the mean of those it covers.
    pub(super) fn shrunk(&self, width: u32) -> Self {
        let width = width.min(self.width).max(1);
        let height = (self.height * width / self.width).max(1);
        let mut small = Self::plain(width, height, [0; 3]);
        let part = |i: u32, of: u32, from: u32| (i * from / of, ((i + 1) * from / of).max(i * from / of + 1));
        for (at, pixel) in (0..).zip(&mut small.rgb) {
            let (x0, x1) = part(at % width, width, self.width);
            let (y0, y1) = part(at / width, height, self.height);
            let mut sums = [0u32; 3];
            for y in y0..y1 {
                for x in x0..x1 {
                    let from = self.rgb[(y * self.width + x) as usize];
                    sums.iter_mut().zip(from).for_each(|(sum, value)| *sum += u32::from(value));
                }
            }
            let count = (x1 - x0) * (y1 - y0);
            *pixel = sums.map(|sum| ((sum + count / 2) / count) as u8);
        }
        small
    }

    /// Puts another picture into this one, as far as it fits.
    pub(super) fn place(&mut self, other: &Self, [x0, y0]: [u32; 2]) {
        for y in 0..other.height.min(self.height.saturating_sub(y0)) {
            for x in 0..other.width.min(self.width.saturating_sub(x0)) {
                let to = ((y0 + y) * self.width + x0 + x) as usize;
                self.rgb[to] = other.rgb[(y * other.width + x) as usize];
            }
        }
    }

    /// As a PNG file of 24-bit pixels.
    pub(super) fn write(&self, path: &Path) -> anyhow::Result<()> {
        self.encode(path, None, self.rgb.as_flattened())
    }

    /// As a PNG file whose pixels name 256 colours, chosen to suit the picture.
    pub(super) fn write_with_palette(&self, path: &Path) -> anyhow::Result<()> {
        let rgba: Vec<u8> = self.rgb.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
        let chosen = NeuQuant::new(1, 256, &rgba);
        let indices: Vec<u8> = rgba.as_chunks::<4>().0.iter().map(|c| chosen.index_of(c) as u8).collect();
        self.encode(path, Some(chosen.color_map_rgb()), &indices)
    }

    fn encode(&self, path: &Path, palette: Option<Vec<u8>>, bytes: &[u8]) -> anyhow::Result<()> {
        let file = File::create(path).with_context(|| format!("{} cannot be written", path.display()))?;
        let mut encoder = Encoder::new(BufWriter::new(file), self.width, self.height);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_color(if palette.is_some() { ColorType::Indexed } else { ColorType::Rgb });
        encoder.set_compression(Compression::High);
        if let Some(palette) = palette {
            encoder.set_palette(palette);
        }
        encoder.write_header()?.write_image_data(bytes)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shrinking_takes_means_and_keeps_the_aspect() {
        let mut wide = Picture::plain(4, 2, [0; 3]);
        wide.rgb[0] = [200, 0, 0];
        wide.rgb[5] = [0, 100, 0];
        let small = wide.shrunk(2);
        assert_eq!((small.width, small.height), (2, 1));
        assert_eq!(small.rgb, [[50, 25, 0], [0, 0, 0]]);
        assert_eq!(wide.shrunk(400), wide);
    }

    #[test]
    fn a_picture_placed_at_an_edge_is_cut() {
        let mut sheet = Picture::plain(3, 3, [0; 3]);
        sheet.place(&Picture::plain(2, 2, [9; 3]), [2, 1]);
        let lit: Vec<usize> = (0..9).filter(|&i| sheet.rgb[i] == [9; 3]).collect();
        assert_eq!(lit, [5, 8]);
    }

    #[test]
    fn files_hold_what_was_written() {
        let path = std::env::temp_dir().join(format!("durer-xtask-{}.png", std::process::id()));
        let mut picture = Picture::plain(5, 4, [10, 20, 30]);
        picture.rgb[7] = [255, 0, 128];
        picture.write(&path).expect("written");
        assert_eq!(Picture::read(&path).expect("read"), picture);
        std::fs::remove_file(&path).expect("removed");
    }
}
