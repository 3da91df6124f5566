//! Pictures as numbers.
use std::{fs, path::Path};

use anyhow::{Context, ensure};
use durer_io::image;
use durer_scene::{ImageData, Limits};

/// Linear red, green and blue, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) pixels: Vec<[f64; 3]>,
}

impl Picture {
    /// From a file of a format that durer reads.
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let name = path.display().to_string();
        let bytes = fs::read(path).with_context(|| name.clone())?;
        let read = image::read(&bytes, &name, Limits::default())?;
        let ImageData::F32(values) = &read.data else { anyhow::bail!("{name} holds no floats") };
        let channels = read.channels as usize;
        ensure!(channels >= 3, "{name} has {channels} channels instead of red, green and blue");
        let pixels = values.chunks_exact(channels).map(|v| [v[0], v[1], v[2]].map(f64::from));
        Ok(Self { width: read.width as usize, pixels: pixels.collect() })
    }

    /// Of pictures of one size; none of none.
    pub(super) fn mean(pictures: &[Self]) -> Option<Self> {
        let n = pictures.len() as f64;
        let mut mean = pictures.first()?.clone();
        for (i, pixel) in mean.pixels.iter_mut().enumerate() {
            for (channel, value) in pixel.iter_mut().enumerate() {
                *value = pictures.iter().map(|p| p.pixels[i][channel]).sum::<f64>() / n;
            }
        }
        Some(mean)
    }

    /// Rec. 709 luminance of each pixel.
    pub(super) fn luminance(&self) -> impl Iterator<Item = f64> {
        self.pixels.iter().map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b)
    }
}
