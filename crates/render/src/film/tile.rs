//! The unit of work for a thread, a process or a machine.

/// A rectangle of pixels: `x0 <= x < x1`, `y0 <= y < y1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Left edge.
    pub x0: u32,
    /// Top edge.
    pub y0: u32,
    /// Behind the right edge.
    pub x1: u32,
    /// Below the bottom edge.
    pub y1: u32,
}

impl Tile {
    /// Cuts `self` into squares of `size` pixels, smaller ones at the right and at the bottom.
    pub fn squares(self, size: u32) -> Vec<Self> {
        let mut tiles = Vec::new();
        for y in (self.y0..self.y1).step_by(size as usize) {
            for x in (self.x0..self.x1).step_by(size as usize) {
                tiles.push(Self { x0: x, y0: y, x1: (x + size).min(self.x1), y1: (y + size).min(self.y1) });
            }
        }
        tiles
    }
    /// Number of pixels.
    pub fn area(self) -> u64 {
        u64::from(self.x1 - self.x0) * u64::from(self.y1 - self.y0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_cover_every_pixel_once() {
        let all = Tile { x0: 3, y0: 1, x1: 71, y1: 40 };
        let mut seen = vec![0; 71 * 40];
        for t in all.squares(16) {
            for y in t.y0..t.y1 {
                for x in t.x0..t.x1 {
                    seen[(y * 71 + x) as usize] += 1;
                }
            }
        }
        assert_eq!(seen.iter().sum::<u64>(), all.area());
        assert!(seen.iter().all(|&n| n <= 1));
    }
}
