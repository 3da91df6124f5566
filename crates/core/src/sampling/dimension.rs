//! Names of the random decisions along a path.
use super::hash::salt;

/// A random decision. Two decisions at one point of the ray tree never share a dimension; the way to the point is in
/// the sampler's branch (see [`super::Sampler::fork`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Dim {
    /// Position inside the pixel.
    Pixel,
    /// Moment within the shutter interval.
    Time,
    /// Point on the lens.
    Lens,
    /// Point on a light.
    Light,
    /// Direction of a scattered ray.
    Scatter,
    /// Which light.
    LightChoice,
    /// Which of the ways in which a surface scatters.
    Lobe,
    /// Whether a path goes on.
    Roulette,
    /// The leading wavelength.
    Lambda,
    /// How far a ray gets in a medium, and what it meets there.
    Medium,
}

impl Dim {
    /// How many there are.
    const COUNT: usize = 10;
    /// How many sets [`Dim::in_set`] knows.
    const SETS: usize = 5;

    /// Its number, made ready for hashing.
    #[inline]
    pub(super) fn salt(self) -> u64 {
        const SALTS: [u64; Dim::COUNT] = {
            let mut salts = [0; Dim::COUNT];
            let mut i = 0;
            while i < Dim::COUNT {
                salts[i] = salt(i as u64);
                i += 1;
            }
            salts
        };
        SALTS[self as usize]
    }

    /// The number of a set, made ready for hashing: that of no dimension.
    #[inline]
    pub(super) fn salt_of_set(set: usize) -> u64 {
        const SALTS: [u64; Dim::SETS] = [salt(!0), salt(!1), salt(!2), salt(!3), salt(!4)];
        SALTS[set]
    }

    /// Which Sobol dimensions it takes where eye and first hit of a path share one set of points, after `forks` ways taken
    /// since the eye; `None` elsewhere. The dimensions are those of the lowest t-values together with the place in the
    /// pixel, for up to 2^10 points. What a lamp sends and what a scattered ray brings is added and never multiplied: these
    /// take the same dimensions, differently scrambled, which leaves their errors uncorrelated.
    #[inline]
    pub(super) fn joint(self, forks: u8) -> Option<[usize; 2]> {
        match (self, forks) {
            (Self::Pixel, 0) => Some([0, 1]),
            (Self::Lens, 0) => Some([8, 9]),
            (Self::Time, 0) => Some([10, 6]),
            (Self::Lambda, 0) => Some([5, 6]),
            (Self::Scatter | Self::Light, 1) => Some([2, 3]),
            (Self::Lobe | Self::LightChoice, 1) => Some([4, 7]),
            _ => None,
        }
    }

    /// Elsewhere numbers that decide one thing together share a set of points: which one, and which Sobol dimensions of it.
    /// What is of two numbers has the first two, of which the projection is the best.
    #[inline]
    pub(super) fn in_set(self) -> (usize, [usize; 2]) {
        match self {
            Self::Pixel => (0, [0, 1]),
            Self::Lens => (0, [2, 3]),
            Self::Time => (0, [4, 5]),
            Self::Scatter => (1, [0, 1]),
            Self::Lobe => (1, [2, 3]),
            Self::Light => (2, [0, 1]),
            Self::LightChoice => (2, [2, 3]),
            Self::Roulette => (3, [0, 1]),
            Self::Lambda => (4, [0, 1]),
            Self::Medium => (3, [2, 3]),
        }
    }

    /// Where its numbers stand in the list of all that a path asks for, after `forks` ways taken since the eye; `None` where
    /// it is not asked for.
    #[inline]
    pub(super) fn position(self, forks: u8) -> Option<usize> {
        match (self, forks) {
            (Self::Pixel, 0) => Some(0),
            (Self::Lens, 0) => Some(2),
            (Self::Time, 0) => Some(4),
            (Self::Pixel | Self::Lens | Self::Time | Self::Lambda | Self::Medium, _) | (_, 0) => None,
            (hit, n) => Some(
                7 * usize::from(n) - 2
                    + match hit {
                        Self::Scatter => 0,
                        Self::Light => 2,
                        Self::Lobe => 4,
                        Self::LightChoice => 5,
                        _ => 6,
                    },
            ),
        }
    }

    /// The word in exports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pixel => "film",
            Self::Time => "time",
            Self::Lens => "lens",
            Self::Light => "light",
            Self::Scatter => "scatter",
            Self::LightChoice => "light-choice",
            Self::Lobe => "lobe",
            Self::Roulette => "roulette",
            Self::Lambda => "wavelength",
            Self::Medium => "medium",
        }
    }
}
