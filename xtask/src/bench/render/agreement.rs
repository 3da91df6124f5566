//! Whether two renderers compute the same picture: times to equal error of different pictures mean nothing.
use super::picture::Picture;

/// Edge of the blocks that are compared, in pixels.
const BLOCK: usize = 16;
/// Differences that count as none, as shares of the mean luminance: of the whole picture, and of blocks. Renderers differ in
/// how they filter textures and environments and where they end paths.
const BIAS: f64 = 0.01;
const BLOCKS: f64 = 0.05;

/// How the pictures of one renderer differ from those of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Agreement {
    /// Mean luminance by the other's, less 1.
    pub(super) bias: f64,
    /// Standard error of that.
    pub(super) error: f64,
    /// Root of the mean squared difference of blocks, less what noise explains, by the mean luminance.
    pub(super) blocks: f64,
}

impl Agreement {
    /// Of two means, each with the pictures that it is of.
    pub(super) fn of(a: (&Picture, &[Picture]), b: (&Picture, &[Picture]), mask: &[bool]) -> Self {
        let [first, second] = [Blocks::of(a.0, mask), Blocks::of(b.0, mask)];
        let error = |(mean, pictures): (&Picture, &[Picture])| {
            let whole = Blocks::of(mean, mask).mean();
            let n = pictures.len() as f64;
            let off = pictures.iter().map(|p| (Blocks::of(p, mask).mean() - whole).powi(2)).sum::<f64>();
            (off / (n - 1.0).max(1.0) / n).sqrt() / whole
        };
        // Squared differences of a block's mean between pictures of one renderer, as far as they stay in the mean.
        let noise = |(mean, pictures): (&Picture, &[Picture])| {
            let n = pictures.len() as f64;
            let off =
                pictures.iter().map(|p| Blocks::of(p, mask).squared_difference(&Blocks::of(mean, mask)));
            off.sum::<f64>() / (n - 1.0).max(1.0) / n
        };
        let unexplained = first.squared_difference(&second) - noise(a) - noise(b);
        Self {
            bias: first.mean() / second.mean() - 1.0,
            error: error(a).hypot(error(b)),
            blocks: unexplained.max(0.0).sqrt() / second.mean(),
        }
    }

    /// The same picture, as far as renderers agree.
    pub(super) fn holds(&self) -> bool {
        self.bias.abs() <= BIAS + 4.0 * self.error && self.blocks <= BLOCKS + 4.0 * self.error
    }
}

/// Mean luminance of squares of pixels, with the number of pixels in each.
struct Blocks(Vec<(f64, f64)>);

impl Blocks {
    fn of(picture: &Picture, mask: &[bool]) -> Self {
        let columns = picture.width.div_ceil(BLOCK);
        let rows = (picture.pixels.len() / picture.width.max(1)).div_ceil(BLOCK);
        let mut sums = vec![(0.0, 0.0); columns * rows];
        for (i, (value, _)) in picture.luminance().zip(mask).enumerate().filter(|(_, (_, counts))| **counts) {
            let block = &mut sums[i / picture.width / BLOCK * columns + i % picture.width / BLOCK];
            *block = (block.0 + value, block.1 + 1.0);
        }
        let filled = sums.into_iter().filter(|(_, n)| *n > 0.0);
        Self(filled.map(|(sum, n)| (sum / n, n)).collect())
    }

    fn mean(&self) -> f64 {
        let pixels: f64 = self.0.iter().map(|(_, n)| n).sum();
        self.0.iter().map(|(mean, n)| mean * n).sum::<f64>() / pixels
    }

    /// Of blocks, each as often as it has pixels.
    fn squared_difference(&self, other: &Self) -> f64 {
        let pixels: f64 = self.0.iter().map(|(_, n)| n).sum();
        let pairs = self.0.iter().zip(&other.0);
        pairs.map(|((a, n), (b, _))| (a - b).powi(2) * n).sum::<f64>() / pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Left and right halves of grey, with an unevenness that adds nothing to any block.
    fn halves(left: f64, right: f64, wave: f64) -> Picture {
        let value = |i: usize| {
            (if i % 32 < 16 { left } else { right }) + if i.is_multiple_of(2) { wave } else { -wave }
        };
        Picture { width: 32, pixels: (0..32 * 16).map(|i| [value(i); 3]).collect() }
    }

    fn compare(a: &[Picture], b: &[Picture]) -> Agreement {
        let mean = |pictures: &[Picture]| Picture::mean(pictures).expect("pictures");
        Agreement::of((&mean(a), a), (&mean(b), b), &[true; 32 * 16])
    }

    #[test]
    fn noise_is_no_difference_and_brightness_is() {
        let ours = [halves(1.0, 3.0, 0.1), halves(1.0, 3.0, -0.2)];
        assert!(compare(&ours, &[halves(1.0, 3.0, 0.3), halves(1.0, 3.0, 0.0)]).holds());
        let brighter = compare(&[halves(1.1, 3.3, 0.1), halves(1.1, 3.3, 0.0)], &ours);
        assert!(!brighter.holds() && (brighter.bias - 0.1).abs() < 1e-9);
    }

    #[test]
    fn a_mirrored_picture_of_the_same_brightness_is_another() {
        let found = compare(&[halves(1.0, 3.0, 0.0)], &[halves(3.0, 1.0, 0.0)]);
        assert!(found.bias.abs() < 1e-12 && (found.blocks - 1.0).abs() < 1e-9 && !found.holds());
    }
}
